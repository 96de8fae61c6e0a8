/* Runs: progress, cancelling, failing stages and failing allocations; the bag is all or nothing. */
#include "tests/unit/pipeline/fixture.h"

static void build(fixture *f) {
    const qc_status s = qc_pipeline_insert(f->pipeline, 0, NULL, "make") ||
                        qc_pipeline_insert(f->pipeline, 1, "a", "add") ||
                        qc_pipeline_insert(f->pipeline, 2, "b", "add");
    assert_int_equal(s, QC_OK);
}

static void progress_is_shared_among_the_steps(void **state) {
    fixture *f = *state;
    build(f);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_string_equal(f->trace, "make a b");
    assert_false(f->backwards);
    assert_true(f->last == 1.0);
    assert_string_equal(f->logged, "1 b: adding");
    const qc__range outer = qc__range_begin(f->ctx, NULL, 0, 0.5);
    f->last = 0;
    assert_int_equal(qc_pipeline_run_range(f->pipeline, 1, 3, f->bag), QC_OK);
    qc__range_end(f->ctx, outer);
    assert_true(!f->backwards && f->last == 0.5);
    assert_true(qc_pipeline_seconds(f->pipeline, 0) >= 0);
}

static void cancelling_leaves_the_bag_as_it_was(void **state) {
    fixture *f = *state;
    build(f);
    for (double at = 0; at <= 1; at += 0.05) {
        f->cancel_at = at;
        assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_ERR_CANCELLED);
        assert_int_equal(qc_ctx_error(f->ctx)->status, QC_ERR_CANCELLED);
        assert_int_equal(qc_bag_count(f->bag), 0);
        assert_int_equal(live_objects, 0);
    }
    f->cancel_at = 2;
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_int_equal(qc_bag_count(f->bag), 3);
}

static void failing_stages_are_named(void **state) {
    static const struct {
        const char *how;
        qc_status status;
        int64_t where;
        const char *text;
    } table[] = {
        {"text", QC_ERR_FAILED, 7, "face 7 is folded"},
        {"silent", QC_ERR_NOT_POSDEF, -1, "stage 'trial' failed: not positive definite"},
        {"nothing", QC_ERR_FAILED, -1,
         "stage 'trial' did not give its output 'number' (test.number/1)"},
        {"type", QC_ERR_ARGUMENT, -1,
         "stage 'trial' publishes an object of type test.label/1 on "
         "output 'number' of type test.number/1"},
        {"port", QC_ERR_ARGUMENT, -1,
         "stage 'trial' publishes an object of type test.number/1 on "
         "output 'nowhere', which it does not have"},
    };
    fixture *f = *state;
    build(f);
    assert_int_equal(qc_pipeline_insert(f->pipeline, 2, "trial", "bad"), QC_OK);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_int_equal(qc_pipeline_set(f->pipeline, "trial", "how", table[i].how), QC_OK);
        assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), table[i].status);
        const qc_error *e = qc_ctx_error(f->ctx);
        assert_int_equal(e->status, table[i].status);
        assert_int_equal(e->where, table[i].where);
        assert_string_equal(e->text, table[i].text);
        assert_string_equal(e->stage, "trial");
        assert_int_equal(qc_bag_count(f->bag), 0);
        assert_int_equal(live_objects, 0);
    }
    assert_int_equal(qc_pipeline_set(f->pipeline, "trial", "how", "twice"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "trial.number") == 2);
    assert_int_equal(qc_pipeline_run(f->pipeline, NULL), QC_ERR_ARGUMENT);
}

static void any_allocation_may_fail(void **state) {
    fixture *f = *state;
    build(f);
    int64_t n = 0;
    for (qc_status status = QC_ERR_NOMEM; status != QC_OK; n++) {
        f->allowed = n;
        status = qc_pipeline_run(f->pipeline, f->bag);
        f->allowed = -1;
        if (status == QC_OK) break;
        assert_int_equal(status, QC_ERR_NOMEM);
        assert_int_equal(qc_ctx_error(f->ctx)->status, QC_ERR_NOMEM);
        assert_int_equal(qc_bag_count(f->bag), 0);
        assert_int_equal(live_objects, 0);
    }
    assert_true(n > 5);
    assert_true(value_of(f->bag, "b.number") == 5.1);
}

static void building_survives_failing_allocations(void **state) {
    static const char json[] =
        "{\"qc_pipeline\":1,\"stages\":[{\"stage\":\"make\",\"params\":"
        "{\"name\":\"x\"}},{\"stage\":\"add\",\"in\":{\"number\":\"make.number\"}}]}";
    fixture *f = *state;
    for (int64_t n = 0;; n++) {
        qc_registry *registry = NULL;
        qc_pipeline *pipeline = NULL;
        char *text = NULL;
        f->allowed = n;
        qc_status status = qc_registry_create(f->ctx, &registry);
        if (status == QC_OK) status = qc_pipeline_parse(registry, json, &pipeline);
        if (status == QC_OK) status = qc_pipeline_print(pipeline, &text);
        f->allowed = -1;
        qc_text_free(text);
        qc_pipeline_free(pipeline);
        qc_registry_free(registry);
        if (status == QC_OK) break;
        assert_int_equal(status, QC_ERR_NOMEM);
    }
}

static void one_stage_runs_without_a_pipeline(void **state) {
    fixture *f = *state;
    assert_int_equal(qc_stage_run(f->ctx, &stage_add, NULL, f->bag), QC_ERR_WIRING);
    assert_string_equal(error_text(f),
                        "stage 'add': input 'number' needs test.number/1, which is not in the bag");
    number *n = number_create(NUMBER, 5);
    qc_bag_put(f->bag, "any", n);
    qc_object_release(n);
    assert_int_equal(qc_stage_run(f->ctx, &stage_add, NULL, f->bag), QC_OK);
    assert_true(value_of(f->bag, "number") == 6);
    assert_int_equal(qc_stage_run(f->ctx, &stage_add, &(double){-2}, f->bag), QC_OK);
    assert_true(value_of(f->bag, "number") == 4); /* its own name comes first */
    assert_string_equal(f->trace, "add");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(progress_is_shared_among_the_steps, setup, teardown),
        cmocka_unit_test_setup_teardown(cancelling_leaves_the_bag_as_it_was, setup, teardown),
        cmocka_unit_test_setup_teardown(failing_stages_are_named, setup, teardown),
        cmocka_unit_test_setup_teardown(any_allocation_may_fail, setup, teardown),
        cmocka_unit_test_setup_teardown(building_survives_failing_allocations, setup, teardown),
        cmocka_unit_test_setup_teardown(one_stage_runs_without_a_pipeline, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
