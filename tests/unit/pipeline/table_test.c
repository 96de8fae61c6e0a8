/* Stage tables: nonsense is refused with the reason, missing texts become "". */
#include "tests/unit/pipeline/fixture.h"

static void refuse(fixture *f, const qc_stage *stage, qc_status status, const char *reason) {
    const uint32_t before = qc_registry_count(f->registry);
    assert_int_equal(qc_registry_add(f->registry, stage), status);
    assert_non_null(strstr(error_text(f), reason));
    assert_int_equal(qc_registry_count(f->registry), before);
}

static void heads_are_checked(void **state) {
    fixture *f = *state;
    qc_stage s = stage_add;
    refuse(f, NULL, QC_ERR_ARGUMENT, "no stage");
    s.struct_size = 8;
    refuse(f, &s, QC_ERR_ABI, "too short");
    s = stage_add, s.id = NULL;
    refuse(f, &s, QC_ERR_ARGUMENT, "needs an id");
    s = stage_add, s.id = "with space";
    refuse(f, &s, QC_ERR_ARGUMENT, "needs an id");
    s = stage_add, s.port_size = 4;
    refuse(f, &s, QC_ERR_ABI, "port_size 4");
    s = stage_add, s.param_size = 1u << 30;
    refuse(f, &s, QC_ERR_ABI, "param_size");
    s = stage_add, s.run = NULL;
    refuse(f, &s, QC_ERR_ARGUMENT, "no run function");
    s = stage_add, s.in = NULL;
    refuse(f, &s, QC_ERR_ARGUMENT, "NULL array");
    s = stage_add, s.n_params = UINT32_MAX;
    refuse(f, &s, QC_ERR_ARGUMENT, "implausible");
}

static void parameters_are_checked(void **state) {
    static const char *const none[] = {NULL};
    static const struct {
        qc_param param;
        const char *reason;
    } table[] = {
        {{NULL, QC_REAL, 0, 0, 0, 1, NULL, "", ""}, "needs a name"},
        {{"a.b", QC_REAL, 0, 0, 0, 1, NULL, "", ""}, "needs a name"},
        {{"a", 9, 0, 0, 0, 1, NULL, "", ""}, "unknown type"},
        {{"a", QC_REAL, 8, 0, 0, 1, NULL, "", ""}, "outside the params struct"},
        {{"a", QC_REAL, 4, 0, 0, 1, NULL, "", ""}, "outside the params struct"},
        {{"a", QC_REAL, UINT32_MAX - 7, 0, 0, 1, NULL, "", ""}, "outside the params struct"},
        {{"a", QC_REAL, 0, 0, 2, 1, NULL, "", ""}, "empty range"},
        {{"a", QC_REAL, 0, 2, 0, 1, NULL, "", ""}, "default outside"},
        {{"a", QC_INT, 0, 0.5, 0, 1, NULL, "", ""}, "fractional"},
        {{"a", QC_ENUM, 0, 0, 0, 0, NULL, "", ""}, "no choices"},
        {{"a", QC_ENUM, 0, 0, 0, 0, none, "", ""}, "no choices"},
        {{"a", QC_ENUM, 0, 2, 0, 0, modes, "", ""}, "default outside"},
    };
    fixture *f = *state;
    qc_stage s = stage_add;
    s.params_size = 8;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        s.params = &table[i].param;
        refuse(f, &s, QC_ERR_ARGUMENT, table[i].reason);
    }
    const qc_param twice[] = {{"a", QC_REAL, 0, 0, 0, 1, NULL, "", ""},
                              {"a", QC_REAL, 0, 0, 0, 1, NULL, "", ""}};
    s.params = twice;
    s.n_params = 2;
    refuse(f, &s, QC_ERR_ARGUMENT, "appears twice");
}

static void ports_are_checked(void **state) {
    fixture *f = *state;
    qc_port ports[2] = {{"a", NUMBER, 0, NULL}, {"a", NUMBER, 0, NULL}};
    qc_stage s = stage_add;
    s.in = ports;
    refuse(f, &s, QC_ERR_ARGUMENT, "port 'a' appears twice");
    ports[1].name = "b.c";
    refuse(f, &s, QC_ERR_ARGUMENT, "port 1 needs a name");
    ports[1] = (qc_port){"b", NULL, 0, NULL};
    refuse(f, &s, QC_ERR_ARGUMENT, "port 1 needs a name");
}

static void texts_are_never_null(void **state) {
    fixture *f = *state;
    const qc_port port = {"number", NUMBER, 0, NULL};
    const qc_param param = {"a", QC_ENUM, 0, 1, 0, 0, modes, NULL, NULL};
    const qc_stage s = {
        QC_STAGE_SIZES, "org.test.bare", NULL, NULL, NULL, NULL, &port, NULL, 1, 0, &param, 1, 4,
        stage_bad.run};
    const qc_stage *found;
    assert_int_equal(qc_registry_add(f->registry, &s), QC_OK);
    assert_int_equal(qc_registry_find(f->registry, "org.test.bare", &found), QC_OK);
    assert_string_equal(found->version, "");
    assert_string_equal(found->brief, "");
    assert_string_equal(found->doc, "");
    assert_string_equal(found->cite, "");
    assert_string_equal(qc_stage_in(found, 0)->doc, "");
    assert_string_equal(qc_stage_param(found, 0)->unit, "");
    assert_true(qc_stage_param(found, 0)->max == 1);
    assert_null(qc_stage_in(found, 1));
    assert_null(qc_stage_out(found, 0));
    assert_null(qc_stage_param(found, 1));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(heads_are_checked, setup, teardown),
        cmocka_unit_test_setup_teardown(parameters_are_checked, setup, teardown),
        cmocka_unit_test_setup_teardown(ports_are_checked, setup, teardown),
        cmocka_unit_test_setup_teardown(texts_are_never_null, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
