/* Blocks: alignment, growth, sizes reported back to the allocator, refusals. */
#include "tests/unit/base/base_test.h"

static void blocks_are_aligned_and_counted(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    char *p[40];
    for (size_t i = 0; i < 40; i++) {
        p[i] = qc__malloc(ctx, i, 3);
        assert_non_null(p[i]);
        assert_int_equal((uintptr_t)p[i] % 64, 0);
        memset(p[i], 1, 3 * i);
    }
    for (size_t i = 0; i < 40; i++) qc__free(p[i]);
    qc__free(NULL);
    free_counting_context(ctx, &c);
}

static void growing_keeps_the_contents(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    int32_t *a = NULL;
    int64_t capacity = 0;
    for (int32_t i = 0; i < 1000; i++) {
        assert_true(qc__reserve(ctx, (void **)&a, &capacity, i + 1, sizeof *a));
        a[i] = i;
    }
    for (int32_t i = 0; i < 1000; i++) assert_int_equal(a[i], i);
    a = qc__realloc(ctx, a, 10, sizeof *a);
    assert_int_equal(a[9], 9);
    qc__free(a);
    free_counting_context(ctx, &c);
}

static void overflow_and_refusal_are_out_of_memory(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    assert_null(qc__malloc(ctx, SIZE_MAX / 2, 4));
    assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_NOMEM);
    assert_null(qc__malloc(ctx, SIZE_MAX - 10, 1));
    int32_t *a = QC__ZERO(ctx, int32_t, 4);
    int64_t capacity = 4;
    qc__clear_error(ctx);
    c.allowed = 0;
    assert_null(qc__realloc(ctx, a, 100, sizeof *a));
    assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_NOMEM);
    assert_false(qc__reserve(ctx, (void **)&a, &capacity, 5, sizeof *a));
    assert_int_equal(capacity, 4);
    assert_int_equal(a[3], 0); /* untouched */
    qc__free(a);
    free_counting_context(ctx, &c);

    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    o.resize = counting_resize;
    o.user = &c;
    c.allowed = 0;
    ctx = NULL;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_ERR_NOMEM);
    assert_null(ctx);
}

static void arenas_free_everything_at_once(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    qc__arena *arena = qc__arena_create(ctx);
    for (size_t i = 0; i < 3000; i++) {
        char *p = qc__arena_alloc(arena, i % 97);
        assert_int_equal((uintptr_t)p % 16, 0);
        memset(p, 1, i % 97);
    }
    memset(qc__arena_alloc(arena, 1 << 20), 1, 1 << 20);
    assert_null(qc__arena_alloc(arena, SIZE_MAX - 3));
    c.allowed = 0;
    assert_null(qc__arena_alloc(arena, 1 << 20));
    qc__arena_free(arena);
    qc__arena_free(NULL);
    free_counting_context(ctx, &c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_aligned_and_counted),
        cmocka_unit_test(growing_keeps_the_contents),
        cmocka_unit_test(overflow_and_refusal_are_out_of_memory),
        cmocka_unit_test(arenas_free_everything_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
