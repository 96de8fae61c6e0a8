/* The default pipeline on every procedural surface. */
#include "tests/golden/golden.h"

static const golden_failure expected_failure[] = {{NULL, NULL, NULL}};

static qc_polygon_mesh *shape(qc_ctx *ctx, const char *name, int32_t resolution, double noise) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    options.resolution = resolution;
    options.noise = noise;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    qc_object_release(mesh);
    return soup;
}

static void on_all_shapes(double quads) {
    qc_ctx *ctx = golden_context(2);
    size_t n = 0;
    const qc_shape_info *info = qc_shape_list(&n);
    for (size_t i = 0; i < n; i++) {
        qc_polygon_mesh *soup = shape(ctx, info[i].name, 0, 0);
        qc_remesh_result result = {0};
        golden(ctx, info[i].name, soup, quads, NULL, expected_failure, &result);
        if (result.mesh) {
            assert_int_equal(result.mesh->n_boundary_loops, info[i].boundary_loops);
            assert_int_equal(result.mesh->genus, info[i].genus < 0 ? 2 : info[i].genus);
        }
        qc_remesh_result_clear(&result);
        qc_object_release(soup);
    }
    qc_ctx_free(ctx);
}

static void a_thousand_quads(void **state) {
    (void)state;
    on_all_shapes(1000);
}

static void four_thousand_quads(void **state) {
    (void)state;
    on_all_shapes(4000);
}

/* Same bytes on 1, 2 and 3 threads, from input to quads. */
static void threads_change_nothing(void **state) {
    (void)state;
    static const char *const names[] = {"knot", "genus", "trinoid"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        qc_remesh_result first = {0};
        for (uint32_t threads = 1; threads <= 3; threads++) {
            qc_ctx *ctx = golden_context(threads);
            qc_polygon_mesh *soup = shape(ctx, names[i], 3000, 0.02);
            qc_remesh_result other = {0}, *result = threads == 1 ? &first : &other;
            golden(ctx, names[i], soup, 1500, NULL, expected_failure, result);
            assert_int_equal(result->quads->n_vertices, first.quads->n_vertices);
            assert_int_equal(result->quads->n_faces, first.quads->n_faces);
            assert_memory_equal(result->quads->position, first.quads->position,
                                3 * sizeof(double) * (size_t)first.quads->n_vertices);
            assert_memory_equal(result->quads->face_vertex, first.quads->face_vertex,
                                sizeof(int32_t) * (size_t)first.quads->n_corners);
            qc_remesh_result_clear(&other);
            qc_object_release(soup);
            qc_ctx_free(ctx);
        }
        qc_remesh_result_clear(&first);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thousand_quads),
        cmocka_unit_test(four_thousand_quads),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
