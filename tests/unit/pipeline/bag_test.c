/* Bags share their objects, keep the order of arrival and move as a whole. */
#include "tests/unit/pipeline/fixture.h"

static void put(fixture *f, const char *name, const char *type, double value) {
    number *n = number_create(type, value);
    assert_int_equal(qc_bag_put(f->bag, name, n), QC_OK);
    qc_object_release(n);
}

static void objects_are_shared_and_ordered(void **state) {
    fixture *f = *state;
    put(f, "a", NUMBER, 1);
    put(f, "b", LABEL, 2);
    put(f, "c", NUMBER, 3);
    assert_int_equal(live_objects, 3);
    assert_int_equal(qc_bag_count(f->bag), 3);
    assert_string_equal(qc_bag_name(f->bag, 1), "b");
    assert_null(qc_bag_name(f->bag, 3));
    assert_null(qc_bag_get(f->bag, "d"));
    assert_true(((const number *)qc_bag_latest(f->bag, NUMBER))->value == 3);
    assert_null(qc_bag_latest(f->bag, "test.other/1"));
}

static void a_replaced_object_is_the_latest(void **state) {
    fixture *f = *state;
    put(f, "a", NUMBER, 1);
    put(f, "b", NUMBER, 2);
    put(f, "a", NUMBER, 3);
    assert_int_equal(live_objects, 2);
    assert_int_equal(qc_bag_count(f->bag), 2);
    assert_string_equal(qc_bag_name(f->bag, 1), "a");
    assert_true(((const number *)qc_bag_latest(f->bag, NUMBER))->value == 3);
    qc_bag_put(f->bag, "a", qc_bag_get(f->bag, "a")); /* the object itself */
    assert_true(value_of(f->bag, "a") == 3);
}

static void nonsense_is_refused(void **state) {
    fixture *f = *state;
    assert_int_equal(qc_bag_put(f->bag, "a", NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_bag_put(f->bag, "", f), QC_ERR_ARGUMENT);
    qc_bag_free(NULL);
}

static void out_of_memory_leaves_the_bag_as_it_was(void **state) {
    fixture *f = *state;
    put(f, "a", NUMBER, 1);
    number *n = number_create(NUMBER, 2);
    f->allowed = 0;
    assert_int_equal(qc_bag_put(f->bag, "a", n), QC_ERR_NOMEM);
    f->allowed = -1;
    assert_int_equal(n->object.references, 1);
    assert_true(value_of(f->bag, "a") == 1);
    qc_object_release(n);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(objects_are_shared_and_ordered, setup, teardown),
        cmocka_unit_test_setup_teardown(a_replaced_object_is_the_latest, setup, teardown),
        cmocka_unit_test_setup_teardown(nonsense_is_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(out_of_memory_leaves_the_bag_as_it_was, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
