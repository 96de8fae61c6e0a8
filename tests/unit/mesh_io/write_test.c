/* What is written reads back the same, bit by bit; nothing is left of a failed write. */
#include "unit/mesh_io/common.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const char PATH[] = "mesh_io_write_test.obj";

static void test_round_trip(void **state) {
    qc_polygon_mesh *m = NULL, *n = NULL;
    assert_int_equal(qc_polygon_mesh_create(*state, 6, 3, 11, 4, 2,
                                            QC_POLYGON_FACE_GROUP | QC_POLYGON_FACE_LINE, &m),
                     QC_OK);
    const double values[] = {0.1,
                             1.0 / 3,
                             -2e-310,
                             1e300,
                             123456789.123456789,
                             -0.0,
                             5,
                             1e22,
                             0x1p-1074,
                             3.5,
                             0x1.fffffffffffffp1023,
                             1e-7,
                             0.30000000000000004};
    for (int i = 0; i < 18; i++) m->position[i] = values[i % 13];
    for (int i = 0; i < 8; i++) m->uv[i] = values[(i + 5) % 13] / 3;
    const int32_t vertex[] = {0, 1, 2, 3, 3, 2, 1, 5, 4, 3, 2},
                  uv[] = {0, 1, 2, 3, -1, -1, -1, 1, 1, 0, 2};
    const int32_t offset[] = {0, 4, 7, 11}, group[] = {1, 1, 2}, line[] = {0, 5, 5, 2};
    memcpy(m->face_vertex, vertex, sizeof vertex);
    memcpy(m->corner_uv, uv, sizeof uv);
    memcpy(m->face_offset, offset, sizeof offset);
    memcpy(m->face_group, group, sizeof group);
    memcpy(m->line, line, sizeof line);
    assert_int_equal(qc_polygon_mesh_write(*state, m, PATH, "two\nlines"), QC_OK);
    assert_int_equal(qc_polygon_mesh_read(*state, PATH, &n), QC_OK);
    assert_int_equal(n->n_vertices, 6);
    assert_memory_equal(n->position, m->position, 18 * sizeof(double));
    assert_memory_equal(n->uv, m->uv, 8 * sizeof(double));
    assert_memory_equal(n->face_vertex, vertex, sizeof vertex);
    assert_memory_equal(n->corner_uv, uv, sizeof uv);
    assert_memory_equal(n->face_offset, offset, sizeof offset);
    assert_memory_equal(n->face_group, group, sizeof group);
    assert_memory_equal(n->line, line, sizeof line);
    assert_int_equal(n->face_line[0], 2 + 6 + 4 + 1 + 1); /* behind comments, v, vt and g */
    qc_object_release(m);
    qc_object_release(n);
    remove(PATH);
}

static void test_not_finite(void **state) {
    qc_polygon_mesh *m = parse_text(*state, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
    m->position[4] = NAN;
    assert_int_equal(qc_polygon_mesh_write(*state, m, PATH, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 1);
    assert_int_equal(access(PATH, F_OK), -1);
    m->position[4] = 0;
    assert_int_equal(qc_polygon_mesh_write(*state, m, "/nonexistent/a.obj", NULL), QC_ERR_IO);
    qc_object_release(m);
}

static bool cancel(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return false;
}

static void test_cancelled(void **state) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = cancel;
    qc_ctx *ctx = NULL;
    qc_polygon_mesh *m = parse_text(*state, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    assert_int_equal(qc_polygon_mesh_write(ctx, m, PATH, NULL), QC_ERR_CANCELLED);
    assert_int_equal(access(PATH, F_OK), -1);
    qc_ctx_free(ctx);
    qc_object_release(m);
}

/* Larger than any buffer. */
static void test_large(void **state) {
    enum { N = 20000 };
    qc_polygon_mesh *m = NULL, *n = NULL;
    assert_int_equal(qc_polygon_mesh_create(*state, N, N, 3 * N, 0, 0, 0, &m), QC_OK);
    for (int i = 0; i < 3 * N; i++) {
        m->position[i] = sin(i) * pow(10, i % 7 - 3);
        m->face_vertex[i] = (i * 7919) % N;
    }
    for (int i = 0; i <= N; i++) m->face_offset[i] = 3 * i;
    assert_int_equal(qc_polygon_mesh_write(*state, m, PATH, NULL), QC_OK);
    assert_int_equal(qc_polygon_mesh_read(*state, PATH, &n), QC_OK);
    assert_memory_equal(n->position, m->position, 3 * N * sizeof(double));
    assert_memory_equal(n->face_vertex, m->face_vertex, 3 * N * sizeof(int32_t));
    qc_object_release(m);
    qc_object_release(n);
    remove(PATH);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_cancelled), cmocka_unit_test(test_large)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
