/* Loading plugins built with shorter, longer and foreign headers. */
#include "tests/unit/pipeline/fixture.h"
#include <dlfcn.h>

static void put_number(fixture *f, double value) {
    number *n = number_create(NUMBER, value);
    assert_int_equal(qc_bag_put(f->bag, "n", n), QC_OK);
    qc_object_release(n);
}

static const qc_stage *load(fixture *f, const char *path, const char *id) {
    const qc_stage *stage;
    assert_int_equal(qc_registry_load(f->registry, path), QC_OK);
    assert_int_equal(qc_registry_find(f->registry, id, &stage), QC_OK);
    assert_int_equal(stage->struct_size, sizeof(qc_stage));
    assert_int_equal(stage->port_size, sizeof(qc_port));
    assert_int_equal(stage->param_size, sizeof(qc_param));
    return stage;
}

static void shorter_tables_are_read_by_their_strides(void **state) {
    fixture *f = *state;
    const qc_stage *s = load(f, PLUGINS "shorter.so", "org.test.shorter");
    assert_string_equal(qc_stage_out(s, 0)->name, "first");
    assert_string_equal(qc_stage_out(s, 1)->name, "second");
    assert_string_equal(qc_stage_out(s, 1)->type, NUMBER);
    assert_string_equal(qc_stage_out(s, 0)->doc, "");
    assert_int_equal(qc_stage_out(s, 0)->flags, QC_PORT_OPTIONAL);
    assert_string_equal(qc_stage_param(s, 1)->name, "count");
    assert_string_equal(qc_stage_param(s, 1)->unit, "");
    put_number(f, 3);
    assert_int_equal(qc_pipeline_insert(f->pipeline, 0, "s", "org.test.shorter"), QC_OK);
    assert_int_equal(qc_pipeline_set(f->pipeline, "s", "count", "7"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "s.second") == 13);
}

static void longer_tables_are_cut_to_this_header(void **state) {
    fixture *f = *state;
    const qc_stage *s = load(f, PLUGINS "longer.so", "org.test.longer");
    assert_string_equal(qc_stage_in(s, 1)->name, "two");
    assert_string_equal(qc_stage_in(s, 1)->doc, "second");
    assert_string_equal(qc_stage_param(s, 1)->doc, "another");
    put_number(f, 3);
    assert_int_equal(qc_pipeline_insert(f->pipeline, 0, "s", "org.test.longer"), QC_OK);
    assert_int_equal(qc_pipeline_set(f->pipeline, "s", "a", "on"), QC_OK);
    assert_int_equal(qc_pipeline_run(f->pipeline, f->bag), QC_OK);
    assert_true(value_of(f->bag, "s.number") == 11);
}

/* Keeps the library in memory to look at its counters after the registry has let go of it. */
static void *hold(const char *path) {
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    assert_non_null(handle);
    return handle;
}
static int counter(void *handle, const char *name) {
    const int *value = dlsym(handle, name);
    assert_non_null(value);
    return *value;
}

static void plugins_are_opened_once_and_closed_with_the_registry(void **state) {
    fixture *f = *state;
    void *held = hold(PLUGINS "longer.so");
    qc_registry *registry;
    assert_int_equal(qc_registry_create(f->ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_load(registry, PLUGINS "longer.so"), QC_OK);
    assert_int_equal(qc_registry_load(registry, PLUGINS "longer.so"), QC_OK);
    assert_int_equal(qc_registry_count(registry), 6);
    assert_int_equal(counter(held, "opened"), 1);
    assert_int_equal(counter(held, "knows_host"), 1);
    assert_int_equal(counter(held, "closed"), 0);
    qc_registry_free(registry);
    assert_int_equal(counter(held, "closed"), 1);
    dlclose(held);
}

static void refused(fixture *f, const char *path, qc_status status, const char *text) {
    assert_int_equal(qc_registry_load(f->registry, path), status);
    assert_non_null(strstr(qc_ctx_error(f->ctx)->text, text));
    assert_int_equal(qc_registry_count(f->registry), 5);
}

static void foreign_libraries_are_refused_and_left_alone(void **state) {
    fixture *f = *state;
    void *refusing = hold(PLUGINS "refusing.so"), *other = hold(PLUGINS "other_major.so");
    refused(f, PLUGINS "refusing.so", QC_ERR_ABI, "refuses this host (quadcover");
    assert_int_equal(counter(refusing, "closed"), 0);
    refused(f, PLUGINS "other_major.so", QC_ERR_ABI, "ABI 2.0");
    assert_int_equal(counter(other, "called"), 0);
    refused(f, "libm.so.6/", QC_ERR_IO, "libm.so.6");
    refused(f, "/proc/self/cmdline", QC_ERR_IO, "cmdline");
    dlclose(refusing);
    dlclose(other);
}

static void one_bad_stage_refuses_the_whole_plugin(void **state) {
    fixture *f = *state;
    void *held = hold(PLUGINS "two_stages.so");
    refused(f, PLUGINS "two_stages.so", QC_ERR_ARGUMENT, "needs an id");
    assert_int_equal(counter(held, "closed"), 1);
    assert_string_equal(qc_registry_stage(f->registry, 0)->version, "1.0");
    dlclose(held);
}

static void interfaces_come_after_those_of_the_host(void **state) {
    fixture *f = *state;
    const qc_interface *found = NULL;
    assert_int_equal(qc_registry_load(f->registry, PLUGINS "offering.so"), QC_OK);
    assert_int_equal(qc_registry_count(f->registry), 5); /* no stage */
    assert_ptr_equal(qc_registry_interface(f->registry, GREETER, 0), &fixture_greeter);
    assert_string_equal(qc_registry_interface(f->registry, GREETER, 1)->name, "first");
    assert_string_equal(qc_registry_interface(f->registry, GREETER, 2)->name, "second");
    assert_null(qc_registry_interface(f->registry, GREETER, 3));
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "second", &found), QC_OK);
    assert_int_equal(found->flags, 3);
    assert_int_equal(qc_registry_find_interface(f->registry, GREETER, "secnd", &found),
                     QC_ERR_NOT_FOUND);
    assert_non_null(strstr(error_text(f), "closest: 'second'"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shorter_tables_are_read_by_their_strides, setup, teardown),
        cmocka_unit_test_setup_teardown(longer_tables_are_cut_to_this_header, setup, teardown),
        cmocka_unit_test_setup_teardown(plugins_are_opened_once_and_closed_with_the_registry, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(foreign_libraries_are_refused_and_left_alone, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(one_bad_stage_refuses_the_whole_plugin, setup, teardown),
        cmocka_unit_test_setup_teardown(interfaces_come_after_those_of_the_host, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
