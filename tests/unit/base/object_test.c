/* Reference counts: destroyed once, by the last release, from any thread. */
#include "tests/unit/base/base_test.h"

typedef struct thing {
    qc_object object;
    int *destroyed;
} thing;

static void destroy(qc_object *o) {
    ++*((thing *)o)->destroyed;
}

static void the_last_release_destroys(void **state) {
    (void)state;
    int destroyed = 0;
    thing t = {.destroyed = &destroyed};
    qc_object_init(&t.object, "test.thing/1", destroy);
    assert_string_equal(t.object.type, "test.thing/1");
    assert_ptr_equal(qc_object_retain(&t), &t);
    qc_object_release(&t);
    assert_int_equal(destroyed, 0);
    qc_object_release(&t);
    assert_int_equal(destroyed, 1);
    assert_null(qc_object_retain(NULL));
    qc_object_release(NULL);
}

static void retain_release(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    (void)worker;
    for (int64_t i = begin; i < end; i++) {
        qc_object_retain(arg);
        qc_object_release(arg);
    }
}

static void counts_are_thread_safe(void **state) {
    (void)state;
    counter c;
    int destroyed = 0;
    thing t = {.destroyed = &destroyed};
    qc_ctx *ctx = counting_context(&c, 4);
    qc_object_init(&t.object, "test.thing/1", destroy);
    qc__parallel_for(ctx, 100000, 100, retain_release, &t);
    assert_int_equal(t.object.references, 1);
    assert_int_equal(destroyed, 0);
    qc_object_release(&t);
    assert_int_equal(destroyed, 1);
    free_counting_context(ctx, &c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_release_destroys),
        cmocka_unit_test(counts_are_thread_safe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
