/* Creases, boundaries and strokes. */
#include "unit/mesh/fixtures.h"

static void test_cube(void **state) {
    qc_mesh *m = voxels(*state, 2, 2, 2, "########", 1);
    qc_features *f = NULL;
    assert_int_equal(qc_features_detect(*state, m, 35 * PI / 180, 0, NULL, &f), QC_OK);
    qc_object_release(m); /* the features keep it alive */
    assert_int_equal(f->n_feature_edges, 24);
    assert_int_equal(f->n_creases, 24);
    assert_int_equal(f->n_corners, 8);
    for (int32_t e = 0; e < f->mesh->n_edges; e++)
        assert_int_equal(f->vertex[f->mesh->edge_vertex[2 * e]] > 0 || !f->edge[e], 1);
    qc_object_release(f);
    m = voxels(*state, 2, 2, 2, "########", 1);
    assert_int_equal(qc_features_detect(*state, m, 1.6, 0, NULL, &f), QC_OK);
    assert_int_equal(f->n_feature_edges, 0);
    qc_object_release(f);
    qc_object_release(m);
}

static int32_t warnings;
static void count_warnings(void *user, int32_t level, const char *stage, const char *text) {
    (void)user, (void)stage, (void)text;
    warnings += level == QC_LOG_WARNING;
}

static void test_boundary_and_lines(void **state) {
    (void)state;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.log = count_warnings;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    qc_mesh *m = grid(ctx, 6, 4, 0, 1);
    qc_features *f = NULL;
    /* 5 vertices per column; interior edges (6, 7), (7, 8); two pairs which are no edges */
    int32_t lines[] = {6, 7, 8, 7, 0, 12, 3, 99};
    assert_int_equal(qc_features_detect(ctx, m, 0.5, 4, lines, &f), QC_OK);
    assert_int_equal(f->n_creases, 0);
    assert_int_equal(f->n_feature_edges, 20 + 2);
    assert_int_equal(f->n_corners, 2); /* 6 and 8, the ends of the stroke */
    assert_int_equal(warnings, 1);
    qc_object_release(f);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_boundary_and_lines),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
