/* A step after qc.round which refuses the map is given others, with other integers, a few times;
 * what a user set is as before afterwards. */
#include "golden.h"

enum { MOST = 24 };
static int calls, refusals, kept[MOST]; /* feature edges which are hard, by call */
static int optimised;                   /* times */

static qc_status refuse(const qc_run *run, const void *params) {
    (void)params;
    const qc_features *features = run->input(run, "features");
    if (calls < MOST) kept[calls] = features && features->hard ? features->n_feature_edges : 0;
    if (calls++ < refusals) return (run->fail)(run, QC_ERR_FAILED, -1, "not this map");
    return QC_OK;
}

static const qc_port in[] = {{"map", QC_TYPE_CORNER_MAP, 0, "any"},
                             {"features", QC_TYPE_FEATURES, QC_PORT_OPTIONAL, "any"}};
static const qc_stage picky = {QC_STAGE_SIZES,   .id = "org.test.picky",
                               .version = "1.0", .brief = "refuses the first maps",
                               .doc = "",        .cite = "",
                               .in = in,         .n_in = 2,
                               .run = refuse};

static qc_status count_optimisation(const qc_run *run, const void *params) {
    (void)run, (void)params;
    optimised++;
    return QC_OK;
}

static const qc_port matching[] = {{"matching", QC_TYPE_MATCHING, 0, "any"}};
static const qc_stage counting = {QC_STAGE_SIZES,
                                  .id = "org.test.counting",
                                  .version = "1.0",
                                  .brief = "counts its runs",
                                  .doc = "",
                                  .cite = "",
                                  .in = matching,
                                  .n_in = 1,
                                  .run = count_optimisation};

/* Puts a stage behind the step which runs another one. */
static void insert_after(qc_pipeline *pipeline, const char *stage, const char *name,
                         const char *new) {
    uint32_t at = 0;
    while (strcmp(qc_pipeline_step_stage(pipeline, at)->id, stage) != 0) at++;
    assert_int_equal(qc_pipeline_insert(pipeline, at + 1, name, new), QC_OK);
}

static qc_status run_mode_with_refusals(const char *name, int32_t mode, int count,
                                        const char **seed) {
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
    options.mode = mode;
    assert_int_equal(qc_shape_create(ctx, name, &shape, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_add(registry, &picky), QC_OK);
    assert_int_equal(qc_registry_add(registry, &counting), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &options, &pipeline), QC_OK);
    insert_after(pipeline, "qc.round", "picky", "org.test.picky");
    if (mode != QC_MODE_FAST)
        insert_after(pipeline, "qc.optimize.cancel", "counting", "org.test.counting");
    assert_int_equal(qc_pipeline_set(pipeline, "round", "seed", "7"), QC_OK);
    calls = optimised = 0;
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

static qc_status run_with_refusals(const char *name, int count, const char **seed) {
    return run_mode_with_refusals(name, QC_MODE_FAST, count, seed);
}

static void other_integers_are_tried(void **state) {
    (void)state;
    const char *seed;
    assert_int_equal(run_with_refusals("sphere", 0, &seed), QC_OK);
    assert_int_equal(calls, 1);
    assert_int_equal(run_with_refusals("sphere", 2, &seed), QC_OK);
    assert_int_equal(calls, 3);
    assert_string_equal(seed, "7");
}

static void attempts_end(void **state) {
    (void)state;
    const char *seed;
    assert_int_equal(run_with_refusals("sphere", 1000, &seed), QC_ERR_FAILED);
    assert_in_range(calls, 2, 13);
    assert_string_equal(seed, "7");
}

/* The features of a cube go step by step, not all at once. */
static void features_are_given_up_step_by_step(void **state) {
    (void)state;
    const char *seed;
    int steps = 0;
    assert_int_equal(run_with_refusals("cube", 1000, &seed), QC_ERR_FAILED);
    assert_in_range(calls, 6, MOST);
    for (int i = 1; i < calls; i++) {
        assert_true(kept[i] <= kept[i - 1]);
        steps += kept[i] < kept[i - 1];
    }
    assert_true(kept[0] > 0 && kept[calls - 1] == 0);
    assert_in_range(steps, 4, MOST);
    assert_int_equal(run_with_refusals("cube", 3, &seed), QC_OK);
    assert_true(kept[3] > kept[0] / 2 && kept[3] < kept[0]);
}

/* Branch points are optimised once; where that is in vain the field is taken as it was. */
static void branch_points_are_optimised_once(void **state) {
    (void)state;
    const char *seed;
    assert_int_equal(run_mode_with_refusals("cube", QC_MODE_BEST, 0, &seed), QC_OK);
    assert_int_equal(optimised, 1);
    assert_int_equal(calls, 1);
    assert_int_equal(run_mode_with_refusals("cube", QC_MODE_BEST, 1000, &seed), QC_ERR_FAILED);
    assert_int_equal(optimised, 1);
    assert_in_range(calls, 6, MOST);
    assert_true(kept[0] > 0 && kept[calls - 1] == 0);
    assert_int_equal(run_mode_with_refusals("cube", QC_MODE_BEST, 4, &seed), QC_OK);
    assert_int_equal(optimised, 1);
    assert_true(kept[4] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(branch_points_are_optimised_once),
        cmocka_unit_test(other_integers_are_tried),
        cmocka_unit_test(attempts_end),
        cmocka_unit_test(features_are_given_up_step_by_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
