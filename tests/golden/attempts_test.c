/* A step after qc.round which refuses the map is given others, with other integers, a few times;
 * what a user set is as before afterwards. */
#include "golden.h"

static int calls, refusals;

static qc_status refuse(const qc_run *run, const void *params) {
    (void)params;
    if (calls++ < refusals) return (run->fail)(run, QC_ERR_FAILED, -1, "not this map");
    return QC_OK;
}

static const qc_port in[] = {{"map", QC_TYPE_CORNER_MAP, 0, "any"}};
static const qc_stage picky = {QC_STAGE_SIZES,   .id = "org.test.picky",
                               .version = "1.0", .brief = "refuses the first maps",
                               .doc = "",        .cite = "",
                               .in = in,         .n_in = 1,
                               .run = refuse};

static qc_status run_with_refusals(int count, const char **seed) {
    qc_ctx *ctx = golden_context(1);
    qc_shape_options shape = QC_SHAPE_OPTIONS_INIT;
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_mesh *mesh = NULL;
    qc_remesh_result result = {0};
    static char text[32];
    shape.resolution = 500;
    options.quads = 300;
    assert_int_equal(qc_shape_create(ctx, "sphere", &shape, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_add(registry, &picky), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &options, &pipeline), QC_OK);
    uint32_t at = 0;
    while (strcmp(qc_pipeline_step_stage(pipeline, at)->id, "qc.round") != 0) at++;
    assert_int_equal(qc_pipeline_insert(pipeline, at + 1, "picky", "org.test.picky"), QC_OK);
    assert_int_equal(qc_pipeline_set(pipeline, "round", "seed", "7"), QC_OK);
    calls = 0;
    refusals = count;
    const qc_status status = qc_remesh(ctx, pipeline, soup, NULL, &result);
    if (status != QC_OK) assert_string_equal(qc_ctx_error(ctx)->text, "not this map");
    snprintf(text, sizeof text, "%s", qc_pipeline_get(pipeline, "round", "seed"));
    *seed = text;
    qc_remesh_result_clear(&result);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    qc_object_release(soup);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
    return status;
}

static void other_integers_are_tried(void **state) {
    (void)state;
    const char *seed;
    assert_int_equal(run_with_refusals(0, &seed), QC_OK);
    assert_int_equal(calls, 1);
    assert_int_equal(run_with_refusals(2, &seed), QC_OK);
    assert_int_equal(calls, 3);
    assert_string_equal(seed, "7");
}

static void attempts_end(void **state) {
    (void)state;
    const char *seed;
    assert_int_equal(run_with_refusals(1000, &seed), QC_ERR_FAILED);
    assert_in_range(calls, 2, 13);
    assert_string_equal(seed, "7");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_integers_are_tried),
        cmocka_unit_test(attempts_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
