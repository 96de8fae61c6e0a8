/* Without time the optimisation leaves what it was given, says so, and the mesh is valid; with time
 * enough the budget changes nothing. */
#include "golden.h"

static int late;

static void count_late(void *user, int32_t level, const char *stage, const char *text) {
    (void)user;
    (void)stage;
    if (level == QC_LOG_WARNING && strstr(text, "lack of time")) late++;
}

static qc_ctx *context(double budget) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = 1;
    options.log = count_late;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    qc_ctx_set_time_budget(ctx, budget);
    late = 0;
    return ctx;
}

/* Irregular vertices of the quads made. */
static int64_t irregular_within(double budget) {
    qc_ctx *ctx = context(budget);
    qc_shape_options shape = QC_SHAPE_OPTIONS_INIT;
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_mesh *mesh = NULL;
    qc_remesh_result result = {0};
    shape.resolution = 1500;
    options.quads = 1000;
    options.mode = QC_MODE_BEST;
    assert_int_equal(qc_shape_create(ctx, "ellipsoid", &shape, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &options, &pipeline), QC_OK);
    assert_int_equal(qc_remesh(ctx, pipeline, soup, NULL, &result), QC_OK);
    golden_check(ctx, "ellipsoid", options.quads, &result);
    const int64_t irregular = result.report->quads.irregular;
    qc_remesh_result_clear(&result);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    qc_object_release(soup);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
    return irregular;
}

static void no_time_is_enough(void **state) {
    (void)state;
    const int64_t all = irregular_within(-1);
    assert_int_equal(late, 0);
    assert_int_equal(irregular_within(1e6), all);
    assert_int_equal(late, 0);
    irregular_within(0);
    assert_true(late >= 2); /* curl and balance at least */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_time_is_enough)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
