/* Interfaces by id and name: built-in and offered tables, the parameter which names one, stages and
 * plugins which ask for one. */
#include "tests/unit/pipeline/fixture.h"

static const qc_interface loud = {sizeof(qc_interface), 0, "loud", "says HELLO"};
static const qc_interface louder = {sizeof(qc_interface), 0, "loud", NULL};

static void tables_are_found_by_id_and_name(void **state) {
    fixture *f = *state;
    const qc_interface *found = NULL;
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, NULL, &found), QC_OK);
    assert_ptr_equal(found, &fixture_greeter);
    assert_int_equal(qc_registry_offer(f->registry, GREETER, &loud), QC_OK);
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "", &found), QC_OK);
    assert_ptr_equal(found, &fixture_greeter);
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "loud", &found), QC_OK);
    assert_ptr_equal(found, &loud);
    assert_int_equal(qc_registry_offer(f->registry, GREETER, &louder), QC_OK);
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "loud", &found), QC_OK);
    assert_ptr_equal(found, &louder); /* the latest of a name */
    assert_ptr_equal(qc_registry_interface(f->registry, GREETER, 0), &fixture_greeter);
    assert_ptr_equal(qc_registry_interface(f->registry, GREETER, 2), &louder);
    assert_null(qc_registry_interface(f->registry, GREETER, 3));
    assert_null(qc_registry_interface(f->registry, "test.greeter/2", 0));
}

static void unknown_names_get_the_closest_or_the_list(void **state) {
    fixture *f = *state;
    const qc_interface *found = &loud;
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "bultin", &found),
                     QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "no " GREETER " is called 'bultin' (closest: 'builtin')");
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "xyz", &found),
                     QC_ERR_NOT_FOUND);
    assert_non_null(strstr(error_text(f), "load the plugin which has it; there is: builtin"));
    assert_int_equal(qc_registry_find_interface(f->registry, "no.such/1", NULL, &found),
                     QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "nothing offers no.such/1");
    assert_ptr_equal(found, &loud);
}

static void tables_need_a_size_and_a_name(void **state) {
    fixture *f = *state;
    qc_interface table = loud;
    table.struct_size--;
    assert_int_equal(qc_registry_offer(f->registry, GREETER, &table), QC_ERR_ABI);
    table = loud;
    table.name = "";
    assert_int_equal(qc_registry_offer(f->registry, GREETER, &table), QC_ERR_ARGUMENT);
    assert_int_equal(qc_registry_offer(f->registry, "", &loud), QC_ERR_ARGUMENT);
    assert_int_equal(qc_registry_offer(f->registry, GREETER, NULL), QC_ERR_ARGUMENT);
    assert_null(qc_registry_interface(f->registry, GREETER, 1));
    f->allowed = 0;
    for (int i = 0; i < 100; i++) /* until the arena is full */
        if (qc_registry_offer(f->registry, GREETER, &loud) != QC_OK) break;
    assert_int_equal(qc_ctx_error(f->ctx)->status, QC_ERR_NOMEM);
    f->allowed = -1;
}

static void plugins_get_the_table_of_the_host(void **state) {
    fixture *f = *state;
    const qc_host *host = &f->registry->host;
    assert_ptr_equal(host->get_interface(host, GREETER), &fixture_greeter);
    assert_null(host->get_interface(host, "no.such/1"));
}

/* A stage which asks for the greeter its parameter names. */
typedef struct greet_options {
    const char *greeter;
} greet_options;
static const qc_interface *greeted;
static qc_status run_greet(const qc_run *run, const void *params) {
    greeted = run->find(run, GREETER, ((const greet_options *)params)->greeter);
    return greeted ? QC_OK : QC_ERR_NOT_FOUND;
}
static const char *const greeters[] = {GREETER, NULL};
static const qc_param greet_params[] = {QC_PARAM_INTERFACE(greet_options, greeter, greeters, "")};
static const qc_stage stage_greet = {QC_STAGE_SIZES,
                                     "org.test.greet",
                                     "1.0",
                                     "greets",
                                     "",
                                     "",
                                     NULL,
                                     NULL,
                                     0,
                                     0,
                                     greet_params,
                                     1,
                                     sizeof(greet_options),
                                     run_greet};

static void a_parameter_names_a_table(void **state) {
    fixture *f = *state;
    assert_int_equal(qc_registry_add(f->registry, &stage_greet), QC_OK);
    assert_int_equal(qc_pipeline_insert(f->pipeline, 0, "greet", "org.test.greet"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_ptr_equal(greeted, &fixture_greeter);
    assert_int_equal(qc_pipeline_set(f->pipeline, "greet", "greeter", "laud"), QC_ERR_NOT_FOUND);
    assert_string_equal(qc_pipeline_get(f->pipeline, "greet", "greeter"), "");
    assert_int_equal(qc_registry_offer(f->registry, GREETER, &loud), QC_OK);
    assert_int_equal(qc_pipeline_set(f->pipeline, "greet", "greeter", "laud"), QC_ERR_NOT_FOUND);
    assert_string_equal(error_text(f), "parameter 'greeter' of stage 'greet': no " GREETER
                                       " is called 'laud' (closest: 'loud')");
    assert_int_equal(qc_pipeline_set(f->pipeline, "greet", "greeter", "loud"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_ptr_equal(greeted, &loud);
    assert_int_equal(qc_pipeline_set(f->pipeline, "greet", "greeter", ""), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_ptr_equal(greeted, &fixture_greeter);
}

static void a_stage_alone_has_the_built_in_tables(void **state) {
    fixture *f = *state;
    greet_options options = {NULL};
    assert_int_equal(qc_stage_run(f->ctx, &stage_greet, &options, f->bag), QC_OK);
    assert_ptr_equal(greeted, &fixture_greeter);
    options.greeter = "loud";
    assert_int_equal(qc_stage_run(f->ctx, &stage_greet, &options, f->bag), QC_ERR_NOT_FOUND);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(tables_are_found_by_id_and_name, setup, teardown),
        cmocka_unit_test_setup_teardown(unknown_names_get_the_closest_or_the_list, setup, teardown),
        cmocka_unit_test_setup_teardown(tables_need_a_size_and_a_name, setup, teardown),
        cmocka_unit_test_setup_teardown(plugins_get_the_table_of_the_host, setup, teardown),
        cmocka_unit_test_setup_teardown(a_parameter_names_a_table, setup, teardown),
        cmocka_unit_test_setup_teardown(a_stage_alone_has_the_built_in_tables, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
