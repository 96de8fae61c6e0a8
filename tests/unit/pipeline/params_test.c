/* Text <-> value, ranges, names. */
#include "tests/unit/pipeline/fixture.h"

static fixture *with_make(void **state) {
    fixture *f = *state;
    assert_int_equal(qc_pipeline_insert(f->pipeline, 0, NULL, "make"), QC_OK);
    return f;
}
static qc_status set(fixture *f, const char *param, const char *text) {
    return qc_pipeline_set(f->pipeline, "make", param, text);
}
static const char *get(fixture *f, const char *param) {
    return qc_pipeline_get(f->pipeline, "make", param);
}

static void assert_defaults(fixture *f) {
    assert_string_equal(get(f, "flag"), "true");
    assert_string_equal(get(f, "count"), "3");
    assert_string_equal(get(f, "ratio"), "0.1");
    assert_string_equal(get(f, "mode"), "best");
    assert_string_equal(get(f, "name"), "");
    assert_null(get(f, "nothing"));
    const kinds *k = f->pipeline->step[0].params;
    assert_true(k->flag && k->count == 3 && k->ratio == 0.1 && k->mode == 1 && !k->name);
}

static void defaults_come_from_the_table(void **state) {
    assert_defaults(with_make(state));
}

static void text_becomes_a_value_and_back(void **state) {
    static const char *const table[][3] = {{"flag", "off", "false"},
                                           {"flag", "1", "true"},
                                           {"count", "-10", "-10"},
                                           {"count", "1e6", "1000000"},
                                           {"count", "+7", "7"},
                                           {"ratio", "1e-300", "1e-300"},
                                           {"ratio", "1", "1"},
                                           {"mode", "fast", "fast"},
                                           {"name", "a b=\xc3\xa9", "a b=\xc3\xa9"},
                                           {"ratio", "0.30000000000000004", "0.30000000000000004"},
                                           {"name", "", ""}};
    fixture *f = with_make(state);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_int_equal(set(f, table[i][0], table[i][1]), QC_OK);
        assert_string_equal(get(f, table[i][0]), table[i][2]);
    }
    const kinds *k = f->pipeline->step[0].params;
    assert_null(k->name);
}

static void bad_values_are_refused_and_change_nothing(void **state) {
    static const char *const table[][3] = {{"flag", "maybe", "not true or false"},
                                           {"flag", "", "not true or false"},
                                           {"count", "1.5", "not a whole number"},
                                           {"count", "", "not a whole number"},
                                           {"count", "12x", "not a whole number"},
                                           {"count", "-11", "is -11, not in [-10, 1000000000]"},
                                           {"count", "1e300", "not in [-10"},
                                           {"count", "99999999999999999999", "not in [-10"},
                                           {"count", "nan", "not a whole number"},
                                           {"ratio", "nan", "not a number"},
                                           {"ratio", "1.5", "is 1.5, not in [0, 1] edge"},
                                           {"ratio", "inf", "not in [0, 1]"},
                                           {"ratio", "0,5", "not a number"},
                                           {"mode", "fats", "one of fast best (closest: 'fast')"}};
    fixture *f = with_make(state);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_int_equal(set(f, table[i][0], table[i][1]), QC_ERR_ARGUMENT);
        assert_non_null(strstr(error_text(f), table[i][2]));
        assert_string_equal(qc_ctx_error(f->ctx)->stage, "make");
    }
    assert_defaults(f);
}

static void an_unknown_name_answers_with_the_closest(void **state) {
    fixture *f = with_make(state);
    assert_int_equal(set(f, "cuont", "1"), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f),
                        "unknown parameter 'cuont' of stage 'make' (closest: 'count')");
    assert_int_equal(qc_pipeline_set(f->pipeline, "mkae", "count", "1"), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "the pipeline has no step 'mkae' (closest: 'make')");
    assert_int_equal(set(f, "zzzzzzzzz", "1"), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "unknown parameter 'zzzzzzzzz' of stage 'make'");
}

static void structs_filled_by_hand_are_checked(void **state) {
    fixture *f = *state;
    kinds k = {true, 3, 0.5, 0, NULL};
    assert_int_equal(qc_stage_run(f->ctx, &stage_make, &k, f->bag), QC_OK);
    assert_true(value_of(f->bag, "number") == 3.5);
    k.mode = 2;
    assert_int_equal(qc_stage_run(f->ctx, &stage_make, &k, f->bag), QC_ERR_ARGUMENT);
    assert_non_null(strstr(error_text(f), "parameter 'mode' of stage 'make' is 2"));
    k.mode = 1;
    k.ratio = -0.5;
    assert_int_equal(qc_stage_run(f->ctx, &stage_make, &k, f->bag), QC_ERR_ARGUMENT);
    assert_non_null(strstr(error_text(f), "ratio"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(defaults_come_from_the_table, setup, teardown),
        cmocka_unit_test_setup_teardown(text_becomes_a_value_and_back, setup, teardown),
        cmocka_unit_test_setup_teardown(bad_values_are_refused_and_change_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(an_unknown_name_answers_with_the_closest, setup, teardown),
        cmocka_unit_test_setup_teardown(structs_filled_by_hand_are_checked, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
