/* The rule of the latest earlier output, wires, and refusals before anything runs. */
#include "tests/unit/pipeline/fixture.h"

static void step(fixture *f, const char *name, const char *id) {
    assert_int_equal(qc_pipeline_insert(f->pipeline, qc_pipeline_count(f->pipeline), name, id),
                     QC_OK);
}
static void put(fixture *f, const char *name, const char *type, double value) {
    number *n = number_create(type, value);
    assert_int_equal(qc_bag_put(f->bag, name, n), QC_OK);
    qc_object_release(n);
}
static void refused(fixture *f, int64_t where, const char *stage, const char *text) {
    assert_int_equal(qc_pipeline_check(f->pipeline, f->bag), QC_ERR_WIRING);
    assert_string_equal(error_text(f), text);
    assert_string_equal(qc_ctx_error(f->ctx)->stage, stage);
    assert_int_equal(qc_ctx_error(f->ctx)->where, where);
    f->trace[0] = '\0';
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_ERR_WIRING);
    assert_string_equal(f->trace, ""); /* nothing ran */
}

static void the_latest_output_of_the_type_is_taken(void **state) {
    fixture *f = *state;
    put(f, "start", NUMBER, 10);
    step(f, "a", "add"); /* 10 + 1 */
    step(f, "b", "add"); /* 11 + 1 */
    step(f, "t", "org.test.tag");
    step(f, "c", "add"); /* 12 + 1200 + 1 */
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "c.number") == 1213);
}

static void a_wire_names_a_step_or_an_object(void **state) {
    fixture *f = *state;
    put(f, "first", NUMBER, 10);
    put(f, "second", NUMBER, 20);
    step(f, "a", "add");
    step(f, "b", "add");
    assert_int_equal(qc_pipeline_wire(f->pipeline, "a", "number", "first"), QC_OK);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "b", "number", "second"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "a.number") == 11 && value_of(f->bag, "b.number") == 21);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "b", "number", "a.number"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "b.number") == 12);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "b", "nubmer", NULL), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "step 'b' has no input 'nubmer' (closest: 'number')");
}

static void an_optional_input_can_be_left_unwired(void **state) {
    fixture *f = *state;
    put(f, "n", NUMBER, 1);
    put(f, "l", LABEL, 50);
    step(f, NULL, "add");
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "add.number") == 52);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "add", "more", ""), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "add.number") == 2);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "add", "number", ""), QC_OK);
    refused(f, 0, "add",
            "step 'add': input 'number' needs test.number/1, which is wired to nothing; "
            "provided by: qc.make, qc.add, org.test.tag, qc.read, qc.bad");
}

static void unmet_ports_are_refused_before_anything_runs(void **state) {
    fixture *f = *state;
    step(f, NULL, "make");
    step(f, NULL, "read");
    refused(f, 1, "read",
            "step 'read': input 'label' needs test.label/1, which no earlier step "
            "gives; provided by: org.test.tag");
    step(f, "late", "org.test.tag"); /* after it does not help */
    refused(f, 1, "read",
            "step 'read': input 'label' needs test.label/1, which no earlier step "
            "gives; provided by: org.test.tag");
    assert_int_equal(qc_pipeline_wire(f->pipeline, "read", "label", "late.label"), QC_OK);
    refused(f, 1, "read",
            "step 'read': input 'label' needs test.label/1, but 'late.label' is not "
            "there before this step; provided by: org.test.tag");
    assert_int_equal(qc_pipeline_wire(f->pipeline, "read", "label", "make.number"), QC_OK);
    refused(f, 1, "read",
            "step 'read': input 'label' needs test.label/1, but 'make.number' is of "
            "type test.number/1; provided by: org.test.tag");
    assert_int_equal(qc_pipeline_insert(f->pipeline, 1, "early", "org.test.tag"), QC_OK);
    assert_int_equal(qc_pipeline_wire(f->pipeline, "read", "label", NULL), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
}

static void optional_outputs_are_taken_when_given(void **state) {
    fixture *f = *state;
    put(f, "n", NUMBER, 5);
    step(f, "tag", "org.test.tag");
    step(f, "add", "add");
    assert_int_equal(qc_pipeline_wire(f->pipeline, "add", "more", ""), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "add.number") == 6); /* from the bag */
    assert_int_equal(qc_pipeline_set(f->pipeline, "tag", "extra", "true"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "add.number") == -4); /* from tag.extra */
    assert_int_equal(qc_pipeline_wire(f->pipeline, "add", "number", "tag.extra"), QC_OK);
    assert_int_equal(qc_pipeline_set(f->pipeline, "tag", "extra", "false"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_ERR_WIRING);
    assert_string_equal(error_text(f), "step 'add': input 'number' needs test.number/1, but "
                                       "'tag.extra' was not given");
}

static void running_again_gives_the_same(void **state) {
    fixture *f = *state;
    put(f, "n", NUMBER, 5);
    step(f, "a", "add");
    step(f, "b", "add");
    for (int i = 0; i < 3; i++) {
        assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
        assert_true(value_of(f->bag, "b.number") == 7);
        assert_int_equal(qc_pipeline_run_range(f->pipeline, 0, 1, f->bag), QC_OK);
        assert_true(value_of(f->bag, "a.number") == 6);
    }
    put(f, "a.number", NUMBER, 100);
    assert_int_equal(qc_pipeline_run_range(f->pipeline, 1, 2, f->bag), QC_OK);
    assert_true(value_of(f->bag, "b.number") == 101);
    assert_int_equal(qc_pipeline_run_range(f->pipeline, 1, 3, f->bag), QC_ERR_ARGUMENT);
}

static void step_names_are_unique(void **state) {
    fixture *f = *state;
    step(f, NULL, "add");
    assert_int_equal(qc_pipeline_insert(f->pipeline, 1, NULL, "qc.add"), QC_ERR_ARGUMENT);
    assert_string_equal(error_text(f), "step name 'add' is taken; give the new step another one");
    assert_int_equal(qc_pipeline_insert(f->pipeline, 1, "a\nb", "qc.add"), QC_ERR_ARGUMENT);
    assert_int_equal(qc_pipeline_insert(f->pipeline, 2, "x", "qc.add"), QC_ERR_ARGUMENT);
    assert_int_equal(qc_pipeline_remove(f->pipeline, 1), QC_ERR_ARGUMENT);
    assert_int_equal(qc_pipeline_remove(f->pipeline, 0), QC_OK);
    assert_int_equal(qc_pipeline_count(f->pipeline), 0);
    assert_null(qc_pipeline_step_name(f->pipeline, 0));
    assert_null(qc_pipeline_step_stage(f->pipeline, 0));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_latest_output_of_the_type_is_taken, setup, teardown),
        cmocka_unit_test_setup_teardown(a_wire_names_a_step_or_an_object, setup, teardown),
        cmocka_unit_test_setup_teardown(an_optional_input_can_be_left_unwired, setup, teardown),
        cmocka_unit_test_setup_teardown(unmet_ports_are_refused_before_anything_runs, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(optional_outputs_are_taken_when_given, setup, teardown),
        cmocka_unit_test_setup_teardown(running_again_gives_the_same, setup, teardown),
        cmocka_unit_test_setup_teardown(step_names_are_unique, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
