/* qc_report_measure against figures known in closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <qc/qc.h>
#include <stdlib.h>
#include <string.h>

static int setup(void **state) {
    return qc_ctx_create(NULL, (qc_ctx **)state) == QC_OK ? 0 : -1;
}
static int teardown(void **state) {
    qc_ctx_free(*state);
    return 0;
}

enum { N = 4 }; /* the unit square as N x N cells */

static int32_t at(int i, int j) {
    return (int32_t)(j * (N + 1) + i);
}

static void grid_points(double *x) {
    for (int j = 0; j <= N; j++)
        for (int i = 0; i <= N; i++) {
            x[3 * at(i, j)] = (double)i / N;
            x[3 * at(i, j) + 1] = (double)j / N;
            x[3 * at(i, j) + 2] = 0;
        }
}

static qc_mesh *grid_mesh(qc_ctx *ctx) {
    double x[3 * (N + 1) * (N + 1)];
    int32_t face[6 * N * N], *f = face;
    grid_points(x);
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            const int32_t two[6] = {at(i, j), at(i + 1, j),     at(i + 1, j + 1),
                                    at(i, j), at(i + 1, j + 1), at(i, j + 1)};
            memcpy(f, two, sizeof two);
            f += 6;
        }
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, (N + 1) * (N + 1), x, 2 * N * N, face, &mesh), QC_OK);
    return mesh;
}

static qc_polygon_mesh *grid_quads(qc_ctx *ctx, double height) {
    qc_polygon_mesh *p = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, (N + 1) * (N + 1), N * N, 4 * N * N, 0, 0, 0, &p),
                     QC_OK);
    grid_points(p->position);
    for (int32_t v = 0; v < p->n_vertices; v++) p->position[3 * v + 2] = height;
    for (int f = 0; f < N * N; f++) {
        const int i = f % N, j = f / N;
        const int32_t four[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        memcpy(p->face_vertex + 4 * f, four, sizeof four);
        p->face_offset[f + 1] = 4 * (f + 1);
    }
    return p;
}

/* f = stretch_u x + i stretch_v y, in units of `edge_length`. */
static qc_corner_map *grid_map(qc_ctx *ctx, const qc_mesh *mesh, double edge_length, double su,
                               double sv) {
    double uv[12 * N * N];
    for (int c = 0; c < 6 * N * N; c++) {
        uv[2 * c] = su * mesh->position[3 * mesh->face_vertex[c]] / edge_length;
        uv[2 * c + 1] = sv * mesh->position[3 * mesh->face_vertex[c] + 1] / edge_length;
    }
    qc_corner_map *map = NULL;
    assert_int_equal(qc_corner_map_create(ctx, mesh, uv, edge_length, NULL, &map), QC_OK);
    return map;
}

static void a_flat_grid_is_perfect(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid_mesh(ctx);
    qc_polygon_mesh *quads = grid_quads(ctx, 0.125);
    qc_corner_map *map = grid_map(ctx, mesh, 1.0 / N, 1, 1);
    qc_report *r = NULL;
    assert_int_equal(qc_report_create(ctx, &r), QC_OK);
    assert_int_equal(qc_report_measure(ctx, mesh, NULL, NULL, map, quads, NULL, r), QC_OK);
    assert_int_equal(r->quads.faces, N * N);
    assert_int_equal(r->quads.non_quads, 0);
    assert_int_equal(r->quads.irregular, 0);
    assert_int_equal(r->quads.euler, 1);
    assert_true(r->quads.edges == 2 * N * (N + 1));
    assert_true(fabs(r->quads.edge_sum - 2.0 * (N + 1)) < 1e-12);
    assert_true(fabs(r->quads.angle_sum / r->quads.corners - 2 * atan(1)) < 1e-12);
    assert_true(fabs(r->quads.min_scaled_jacobian - 1) < 1e-12);
    assert_true(fabs(r->quads.hausdorff - 0.125) < 1e-12);
    assert_true(fabs(r->quads.distance_sum / r->quads.distance_samples - 0.125) < 1e-12);
    assert_int_equal(r->uv.flipped + r->uv.degenerate, 0);
    assert_true(r->uv.max_seam_error < 1e-12);
    assert_true(fabs(r->uv.area - 1) < 1e-12);
    assert_true(r->uv.arap_sum < 1e-12);
    qc_object_release(r);
    qc_object_release(map);
    qc_object_release(quads);
    qc_object_release(mesh);
}

/* Singular values a, b: (a - 1)^2 + (b - 1)^2, with b < 0 when the map turns faces over. */
static void distortion_is_that_of_the_singular_values(void **state) {
    qc_ctx *ctx = *state;
    const double stretch[3][2] = {{2, 1}, {0.5, 1.5}, {1, -0.5}};
    qc_mesh *mesh = grid_mesh(ctx);
    for (int i = 0; i < 3; i++) {
        const double a = stretch[i][0], b = stretch[i][1];
        qc_corner_map *map = grid_map(ctx, mesh, 0.25, a, b);
        qc_report *r = NULL;
        assert_int_equal(qc_report_create(ctx, &r), QC_OK);
        assert_int_equal(qc_report_measure(ctx, mesh, NULL, NULL, map, NULL, NULL, r), QC_OK);
        assert_true(fabs(r->uv.arap_sum / r->uv.area - (a - 1) * (a - 1) - (b - 1) * (b - 1)) <
                    1e-12);
        assert_int_equal(r->uv.flipped, b < 0 ? mesh->n_faces : 0);
        qc_object_release(r);
        qc_object_release(map);
    }
    qc_object_release(mesh);
}

static void reports_add_up(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid_mesh(ctx);
    qc_polygon_mesh *near = grid_quads(ctx, 0.125), *far = grid_quads(ctx, 0.5);
    qc_report *a = NULL, *b = NULL, *sum = NULL;
    assert_int_equal(qc_report_create(ctx, &a), QC_OK);
    assert_int_equal(qc_report_create(ctx, &b), QC_OK);
    assert_int_equal(qc_report_create(ctx, &sum), QC_OK);
    assert_int_equal(qc_report_measure(ctx, mesh, NULL, NULL, NULL, near, NULL, a), QC_OK);
    assert_int_equal(qc_report_measure(ctx, mesh, NULL, NULL, NULL, far, NULL, b), QC_OK);
    qc_report_add(sum, a);
    qc_report_add(sum, b);
    assert_int_equal(sum->quads.faces, 2 * N * N);
    assert_int_equal(sum->quads.euler, 2);
    assert_true(fabs(sum->quads.hausdorff - 0.5) < 1e-12);
    assert_true(fabs(sum->quads.min_scaled_jacobian - 1) < 1e-12);
    assert_true(fabs(sum->quads.distance_sum / sum->quads.distance_samples - 0.3125) < 1e-12);
    assert_int_equal(sum->input.components, 2);
    qc_object_release(a);
    qc_object_release(b);
    qc_object_release(sum);
    qc_object_release(near);
    qc_object_release(far);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_grid_is_perfect),
        cmocka_unit_test(distortion_is_that_of_the_singular_values),
        cmocka_unit_test(reports_add_up),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
