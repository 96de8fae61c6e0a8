/* Lookup and replacement of stages; libraries that are no plugins. */
#include "tests/unit/pipeline/fixture.h"

static void stages_are_found_with_and_without_prefix(void **state) {
    fixture *f = *state;
    const qc_stage *a, *b;
    assert_int_equal(qc_registry_count(f->registry), 5);
    assert_int_equal(qc_registry_find(f->registry, "qc.make", &a), QC_OK);
    assert_int_equal(qc_registry_find(f->registry, "make", &b), QC_OK);
    assert_ptr_equal(a, b);
    assert_ptr_equal(a, qc_registry_stage(f->registry, 0));
    assert_null(qc_registry_stage(f->registry, 5));
    assert_int_equal(qc_registry_find(f->registry, "tag", &a), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "unknown stage 'tag' (closest: 'org.test.tag')");
    assert_int_equal(qc_registry_find(f->registry, "zzzzzzzzzzzzzzzz", &a), QC_ERR_NOT_FOUND);
}

static void a_known_id_is_replaced_in_place(void **state) {
    fixture *f = *state;
    qc_stage mine = stage_make;
    mine.version = "9";
    assert_int_equal(qc_pipeline_insert(f->pipeline, 0, NULL, "make"), QC_OK);
    assert_int_equal(qc_registry_add(f->registry, &mine), QC_OK);
    assert_int_equal(qc_registry_count(f->registry), 5);
    assert_string_equal(qc_registry_stage(f->registry, 0)->version, "9");
    /* A pipeline built before keeps the stage it was built with. */
    assert_string_equal(qc_pipeline_step_stage(f->pipeline, 0)->version, "1.0");
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
}

static void a_library_must_be_a_plugin(void **state) {
    fixture *f = *state;
    assert_int_equal(qc_registry_load(f->registry, "no_such_plugin.so"), QC_ERR_IO);
    assert_non_null(strstr(error_text(f), "no_such_plugin.so"));
    assert_int_equal(qc_registry_load(f->registry, ""), QC_ERR_ARGUMENT);
    assert_int_equal(qc_registry_count(f->registry), 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(stages_are_found_with_and_without_prefix, setup, teardown),
        cmocka_unit_test_setup_teardown(a_known_id_is_replaced_in_place, setup, teardown),
        cmocka_unit_test_setup_teardown(a_library_must_be_a_plugin, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
