/* Pipelines as text: what is printed reads back the same; every error says where. */
#include "tests/unit/pipeline/fixture.h"

static void text_round_trips(void **state) {
    static const char json[] =
        "{ \"qc_pipeline\": 1, \"stages\": [\n"
        "    { \"stage\": \"qc.make\", \"version\": \"1.0\", \"as\": \"start\",\n"
        "      \"params\": { \"flag\": false, \"count\": -2, \"ratio\": 0.3, \"mode\": \"fast\", "
        "\"name\": \"a \\\"b\\\"\" } },\n"
        "    { \"stage\": \"qc.read\", \"version\": \"1.0\", \"as\": \"read\",\n"
        "      \"in\": { \"label\": \"given\" } },\n"
        "    { \"stage\": \"qc.add\", \"version\": \"1.0\", \"as\": \"add\",\n"
        "      \"params\": { \"amount\": -1e+30 },\n"
        "      \"in\": { \"number\": \"start.number\", \"more\": \"\" } } ] }\n";
    fixture *f = *state;
    qc_pipeline *p;
    char *text;
    assert_int_equal(qc_pipeline_parse(f->registry, json, &p), QC_OK);
    assert_int_equal(qc_pipeline_print(p, &text), QC_OK);
    assert_string_equal(text, json);
    qc_text_free(text);
    qc_pipeline_free(p);
}

static void empty_pipelines_and_short_forms(void **state) {
    fixture *f = *state;
    qc_pipeline *p;
    char *text;
    assert_int_equal(qc_pipeline_parse(f->registry, "{\"qc_pipeline\":1,\"stages\":[]}", &p),
                     QC_OK);
    assert_int_equal(qc_pipeline_print(p, &text), QC_OK);
    assert_string_equal(text, "{ \"qc_pipeline\": 1, \"stages\": [ ] }\n");
    qc_text_free(text);
    qc_pipeline_free(p);
    assert_int_equal(qc_pipeline_parse(f->registry,
                                       "{\"qc_pipeline\":1,\"stages\":[{\"stage\":\"org.test.tag\","
                                       "\"version\":\"2.4\"}]}",
                                       &p),
                     QC_OK);
    assert_string_equal(qc_pipeline_step_name(p, 0), "org.test.tag");
    assert_non_null(
        strstr(f->logged, "written with version 2.4 of stage org.test.tag; this is 2.5"));
    qc_pipeline_free(p);
}

#define STEP(inside) "{\"qc_pipeline\":1,\"stages\":[{" inside "}]}"

static void errors_say_where(void **state) {
    static const struct {
        const char *json;
        qc_status status;
        int64_t where;
        const char *text;
    } table[] = {
        {"", QC_ERR_INPUT, 1, "line 1"},
        {"{\n\n\"a\": }", QC_ERR_INPUT, 3, "line 3"},
        {"{\"qc_pipeline\":1,\n\"qc_pipeline\":1}", QC_ERR_INPUT, 2, "duplicate"},
        {"[]", QC_ERR_INPUT, -1, "JSON object"},
        {"{\"qc_pipeline\":2,\"stages\":[]}", QC_ERR_INPUT, -1, "expected {"},
        {"{\"qc_pipeline\":1,\"stages\":{}}", QC_ERR_INPUT, -1, "expected {"},
        {"{\"qc_pipeline\":1,\"stage\":[]}", QC_ERR_NOT_FOUND, -1,
         "'stage' in the pipeline (closest: 'stages')"},
        {"{\"qc_pipeline\":1,\"stages\":[1]}", QC_ERR_INPUT, -1, "step 1 must be"},
        {STEP("\"stage\":\"make\",\"as\":3"), QC_ERR_INPUT, -1, "step 1 must be"},
        {STEP("\"stage\":\"make\",\"parms\":{}"), QC_ERR_NOT_FOUND, -1,
         "'parms' in step 1 (closest: 'params')"},
        {STEP("\"stage\":\"maek\""), QC_ERR_NOT_FOUND, -1,
         "unknown stage 'maek' (closest: 'qc.make')"},
        {STEP("\"stage\":\"make\",\"params\":{\"ratio\":2}"), QC_ERR_ARGUMENT, -1,
         "is 2, not in [0, 1] edge"},
        {STEP("\"stage\":\"make\",\"params\":{\"ratio\":[]}"), QC_ERR_ARGUMENT, -1,
         "must be a number"},
        {STEP("\"stage\":\"make\",\"params\":{\"ratios\":1}"), QC_ERR_NOT_FOUND, -1,
         "(closest: 'ratio')"},
        {STEP("\"stage\":\"add\",\"in\":{\"number\":1}"), QC_ERR_ARGUMENT, -1, "must name"},
        {STEP("\"stage\":\"add\",\"in\":{\"numbr\":\"a\"}"), QC_ERR_NOT_FOUND, -1,
         "(closest: 'number')"},
        {"{\"qc_pipeline\":1,\"stages\":[{\"stage\":\"add\"},{\"stage\":\"add\"}]}",
         QC_ERR_ARGUMENT, -1, "is taken"},
    };
    fixture *f = *state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        qc_pipeline *p = NULL;
        assert_int_equal(qc_pipeline_parse(f->registry, table[i].json, &p), table[i].status);
        assert_null(p);
        assert_non_null(strstr(error_text(f), table[i].text));
        assert_int_equal(qc_ctx_error(f->ctx)->where, table[i].where);
    }
    qc_pipeline *p = NULL;
    assert_int_equal(qc_pipeline_parse(f->registry, NULL, &p), QC_ERR_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(text_round_trips, setup, teardown),
        cmocka_unit_test_setup_teardown(empty_pipelines_and_short_forms, setup, teardown),
        cmocka_unit_test_setup_teardown(errors_say_where, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
