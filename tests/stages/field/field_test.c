/* The stages repair, features, size, field.* and matching, run one at a time on a bag. */
#include "unit/field/surfaces.h"

#include <qc/pipeline.h>

extern const qc_stage qc_stage_repair, qc_stage_features, qc_stage_size, qc_stage_field_curvature,
    qc_stage_field_smooth, qc_stage_field_smoothest, qc_stage_field_import, qc_stage_matching;

/* A unit cube, each side 8 x 8 squares: quads with vertices of their own on every side. */
static qc_polygon_mesh *cube(qc_ctx *ctx) {
    enum { N = 8 };
    qc_polygon_mesh *soup = NULL;
    assert_int_equal(
        qc_polygon_mesh_create(ctx, 6 * (N + 1) * (N + 1), 6 * N * N, 24 * N * N, 0, 0, 0, &soup),
        QC_OK);
    int32_t v = 0, f = 0;
    for (int side = 0; side < 6; side++) {
        int a = side / 2, b = (a + 1 + side % 2) % 3, c = 3 - a - b, first = v;
        for (int i = 0; i <= N; i++) {
            for (int j = 0; j <= N; j++) {
                soup->position[3 * v + a] = side % 2 ? 0 : 1;
                soup->position[3 * v + b] = (double)i / N;
                soup->position[3 * v++ + c] = (double)j / N;
            }
        }
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                int32_t k = first + i * (N + 1) + j;
                int32_t corners[4] = {k, k + N + 1, k + N + 2, k + 1};
                memcpy(soup->face_vertex + 4 * f++, corners, sizeof corners);
            }
        }
    }
    for (int32_t i = 0; i <= f; i++) soup->face_offset[i] = 4 * i;
    return soup;
}

static void run(qc_ctx *ctx, const qc_stage *stage, qc_bag *bag) {
    qc_status status = qc_stage_run(ctx, stage, NULL, bag);
    if (status) print_error("%s: %s\n", stage->id, qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
}

/* The cross field of a cube follows its edges everywhere and is singular at its corners only. */
static void cubes_get_their_field(void **state) {
    qc_ctx *ctx = *state;
    const qc_stage *after[] = {&qc_stage_field_smooth, &qc_stage_field_smoothest};
    for (int i = 0; i < 2; i++) {
        qc_bag *bag = NULL;
        qc_polygon_mesh *soup = cube(ctx);
        assert_int_equal(qc_bag_create(ctx, &bag), QC_OK);
        assert_int_equal(qc_bag_put(bag, "soup", soup), QC_OK);
        run(ctx, &qc_stage_repair, bag);
        run(ctx, &qc_stage_features, bag);
        run(ctx, &qc_stage_size, bag);
        run(ctx, &qc_stage_field_curvature, bag);
        if (i == 1) assert_int_equal(qc_bag_put(bag, "guide", qc_bag_get(bag, "field")), QC_OK);
        run(ctx, after[i], bag);
        run(ctx, &qc_stage_matching, bag);
        const qc_mesh *mesh = qc_bag_get(bag, "mesh");
        const qc_matching *m = qc_bag_get(bag, "matching");
        const qc_features *features = qc_bag_get(bag, "features");
        assert_int_equal(mesh->euler, 2);
        assert_int_equal(features->n_creases, 12 * 8);
        assert_int_equal(m->n_singular, 8);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (features->vertex[v] == 3) assert_int_equal(m->index4[v], 1);
        qc_bag_free(bag);
        qc_object_release(soup);
    }
}

typedef struct size_params {
    double quads, edge_length, edge_length_rel, turn, range, gradation, anisotropy;
    bool painted;
    const char *file;
} size_params;

static void sizes_have_a_precedence(void **state) {
    qc_ctx *ctx = *state;
    const struct {
        size_params params;
        double length, quads;
    } cases[] = {
        {{0, 0, 0, 0, 4, 0.25, 1, false, NULL}, 0.01, 10000},
        {{400, 0, 0, 0, 4, 0.25, 1, false, NULL}, 0.05, 400},
        {{400, 0, 0.1, 0, 4, 0.25, 1, false, NULL}, 0.1 * 1.4142135623730951, 0},
        {{400, 0.2, 0.1, 0, 4, 0.25, 1, false, NULL}, 0.2, 0},
    };
    qc_mesh *mesh = grid(ctx, PLANE, 4, 4, 1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        qc_bag *bag = NULL;
        assert_int_equal(qc_bag_create(ctx, &bag), QC_OK);
        assert_int_equal(qc_bag_put(bag, "mesh", mesh), QC_OK);
        assert_int_equal(qc_stage_run(ctx, &qc_stage_size, &cases[i].params, bag), QC_OK);
        const qc_sizing *sizing = qc_bag_get(bag, "sizing");
        assert_true(fabs(sizing->edge_length - cases[i].length) < 1e-12);
        assert_true(sizing->target_quads == cases[i].quads);
        qc_bag_free(bag);
    }
    qc_object_release(mesh);
}

/* Open and flat meshes go through the defaults; the field follows the boundary. */
static void flat_sheets_work(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 10, 10, 1e4);
    qc_bag *bag = NULL;
    assert_int_equal(qc_bag_create(ctx, &bag), QC_OK);
    assert_int_equal(qc_bag_put(bag, "mesh", mesh), QC_OK);
    run(ctx, &qc_stage_field_curvature, bag);
    run(ctx, &qc_stage_field_smooth, bag);
    run(ctx, &qc_stage_matching, bag);
    const qc_matching *m = qc_bag_get(bag, "matching");
    assert_int_equal(m->n_singular, 0);
    for (int32_t e = 0; e < mesh->n_edges; e++) assert_true(fabs(m->theta[e]) < 1e-6);
    qc_bag_free(bag);
    qc_object_release(mesh);
}

static void import_needs_a_file(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 2, 2, 1);
    qc_bag *bag = NULL;
    struct {
        const char *file;
    } params = {"/nonexistent/a.rawfield"};
    assert_int_equal(qc_bag_create(ctx, &bag), QC_OK);
    assert_int_equal(qc_bag_put(bag, "mesh", mesh), QC_OK);
    assert_int_equal(qc_stage_run(ctx, &qc_stage_field_import, NULL, bag), QC_ERR_ARGUMENT);
    assert_int_equal(qc_stage_run(ctx, &qc_stage_field_import, &params, bag), QC_ERR_IO);
    qc_bag_free(bag);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_get_their_field),
        cmocka_unit_test(sizes_have_a_precedence),
        cmocka_unit_test(flat_sheets_work),
        cmocka_unit_test(import_needs_a_file),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
