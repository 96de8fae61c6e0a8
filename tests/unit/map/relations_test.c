/* Integer relations: every solution is reached from free integers and back, exactly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "sdk/map/seams/relations.h"
#include "tests/unit/mesh/failing_allocator.h"

enum { SYMBOLS = 9, RELATIONS = 4, BOX = 3 };

static qc_ctx *context(void) {
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(NULL, &ctx), QC_OK);
    return ctx;
}

static uint32_t random_number(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

typedef struct problem {
    int32_t n, n_symbols, n_free;
    int64_t value[RELATIONS][SYMBOLS];
    qc__rows symbol, back;
} problem;

static void solve(qc_ctx *ctx, problem *s) {
    qc__relations *r = NULL;
    int32_t name[SYMBOLS];
    for (int32_t j = 0; j < SYMBOLS; j++) name[j] = j;
    assert_int_equal(qc__relations_create(ctx, s->n_symbols, &r), QC_OK);
    for (int32_t i = 0; i < s->n; i++)
        assert_int_equal(qc__relations_add(ctx, r, s->n_symbols, name, s->value[i], i, NULL),
                         QC_OK);
    assert_int_equal(qc__relations_solve(ctx, r, &s->n_free, &s->symbol, &s->back), QC_OK);
    qc__relations_free(r);
}
static void clear(problem *s) {
    qc__rows_free(&s->symbol);
    qc__rows_free(&s->back);
}

static double row_value(const qc__rows *rows, int32_t j, const double *x) {
    double sum = 0;
    for (int64_t i = rows->start[j]; i < rows->start[j + 1]; i++)
        sum += rows->value[i] * x[rows->column[i]];
    return sum;
}

static bool holds(const problem *s, const double *x) {
    for (int32_t i = 0; i < s->n; i++) {
        double sum = 0;
        for (int32_t j = 0; j < s->n_symbols; j++) sum += (double)s->value[i][j] * x[j];
        if (sum != 0) return false;
    }
    return true;
}

/* Free integers give solutions and come back. */
static void check_forwards(const problem *s, uint64_t *state) {
    double y[SYMBOLS + 1], x[SYMBOLS];
    for (int round = 0; round < 20; round++) {
        for (int32_t k = 0; k < s->n_free; k++) y[k] = (double)(random_number(state) % 41) - 20;
        for (int32_t j = 0; j < s->n_symbols; j++) x[j] = row_value(&s->symbol, j, y);
        assert_true(holds(s, x));
        for (int32_t k = 0; k < s->n_free; k++) assert_true(row_value(&s->back, k, x) == y[k]);
    }
}

/* Every solution in a box is reached. */
static int32_t check_box(const problem *s) {
    double x[SYMBOLS], y[SYMBOLS];
    int32_t found = 0, n = 1;
    for (int32_t j = 0; j < s->n_symbols; j++) n *= 2 * BOX + 1;
    for (int32_t code = 0; code < n; code++) {
        for (int32_t j = 0, rest = code; j < s->n_symbols; j++, rest /= 2 * BOX + 1)
            x[j] = rest % (2 * BOX + 1) - BOX;
        if (!holds(s, x)) continue;
        for (int32_t k = 0; k < s->n_free; k++) y[k] = row_value(&s->back, k, x);
        for (int32_t j = 0; j < s->n_symbols; j++) assert_true(row_value(&s->symbol, j, y) == x[j]);
        found++;
    }
    return found;
}

static void random_relations_are_solved(void **state) {
    (void)state;
    qc_ctx *ctx = context();
    uint64_t random = 5;
    int32_t found = 0;
    for (int round = 0; round < 300; round++) {
        problem s = {.n = 1 + round % RELATIONS, .n_symbols = round % 3 ? SYMBOLS : 5};
        const int64_t size = 1 + round % 11;
        for (int32_t i = 0; i < s.n; i++)
            for (int32_t j = 0; j < s.n_symbols; j++)
                if (random_number(&random) % 3)
                    s.value[i][j] = (int64_t)(random_number(&random) % (2 * size + 1)) - size;
        solve(ctx, &s);
        assert_true(s.n_free >= s.n_symbols - s.n);
        check_forwards(&s, &random);
        if (s.n_symbols == 5) found += check_box(&s);
        clear(&s);
    }
    assert_true(found > 1000);
    qc_ctx_free(ctx);
}

/* 6 a + 10 b + 15 c = 0 has no coefficient +-1: a = 5 p, b = 3 q, c = 2 r with p + q + r = 0. */
static void relations_without_unit_are_solved(void **state) {
    (void)state;
    qc_ctx *ctx = context();
    problem s = {.n = 1, .n_symbols = 3, .value = {{6, 10, 15}}};
    solve(ctx, &s);
    assert_int_equal(s.n_free, 2);
    for (int32_t j = 0; j < 3; j++)
        for (int64_t i = s.symbol.start[j]; i < s.symbol.start[j + 1]; i++) {
            const double unit = j == 0 ? 5 : j == 1 ? 3 : 2, k = s.symbol.value[i] / unit;
            assert_true(k == (double)(int64_t)k);
        }
    clear(&s);
    /* common factors do not count: 2 a = 4 b */
    problem t = {.n = 1, .n_symbols = 2, .value = {{2, -4}}};
    solve(ctx, &t);
    assert_int_equal(t.n_free, 1);
    assert_true(t.symbol.value[0] == 2 && t.symbol.value[1] == 1);
    clear(&t);
    qc_ctx_free(ctx);
}

static void contradictions_leave_zero(void **state) {
    (void)state;
    qc_ctx *ctx = context();
    problem s = {.n = 3, .n_symbols = 2, .value = {{1, 1}, {1, -1}, {3, 5}}};
    solve(ctx, &s);
    assert_int_equal(s.n_free, 0);
    assert_true(s.symbol.start[2] == 0);
    clear(&s);
    qc_ctx_free(ctx);
}

static void large_coefficients_are_refused(void **state) {
    (void)state;
    qc_ctx *ctx = context();
    qc__relations *r = NULL;
    const int32_t name[2] = {0, 1};
    const int64_t value[2] = {(int64_t)1 << 41, 3};
    assert_int_equal(qc__relations_create(ctx, 2, &r), QC_OK);
    assert_int_equal(qc__relations_add(ctx, r, 2, name, value, -1, NULL), QC_ERR_FAILED);
    qc__relations_free(r);
    qc_ctx_free(ctx);
}

/* Two chains which come back with the opposite sign, 2 L + s - t = 0, so that the level is given by
 * half a difference: integers all the same, and every solution is reached. */
static void doubled_levels_are_solved(void **state) {
    (void)state;
    qc_ctx *ctx = context();
    uint64_t random = 3;
    problem s = {.n = 2, .n_symbols = 5, .value = {{2, 1, -1, 0, 0}, {2, 0, 0, 4, 2}}};
    solve(ctx, &s);
    assert_int_equal(s.n_free, 3);
    check_forwards(&s, &random);
    assert_int_equal(check_box(&s), 87); /* sum over L of (7 - 2 |L|) times 3 or 4 */
    clear(&s);
    qc_ctx_free(ctx);
}

static qc_status solve_once(qc_ctx *ctx, const void *data) {
    const problem *s = data;
    qc__relations *r = NULL;
    qc__rows symbol, back;
    int32_t n_free = 0, name[SYMBOLS];
    for (int32_t j = 0; j < SYMBOLS; j++) name[j] = j;
    qc_status status = qc__relations_create(ctx, s->n_symbols, &r);
    if (status != QC_OK) return status;
    for (int32_t i = 0; i < s->n && status == QC_OK; i++)
        status = qc__relations_add(ctx, r, s->n_symbols, name, s->value[i], i, NULL);
    if (status == QC_OK) status = qc__relations_solve(ctx, r, &n_free, &symbol, &back);
    qc__relations_free(r);
    if (status != QC_OK) return status;
    qc__rows_free(&symbol);
    qc__rows_free(&back);
    return QC_OK;
}
static void failing_allocations_leave_nothing(void **state) {
    (void)state;
    const problem s = {
        .n = 3, .n_symbols = 5, .value = {{6, 10, 15, 4, 9}, {2, 1, -1, 0, 0}, {7, 0, 5, 3, 11}}};
    fail_every_allocation(solve_once, &s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_relations_are_solved),
        cmocka_unit_test(relations_without_unit_are_solved),
        cmocka_unit_test(contradictions_leave_zero),
        cmocka_unit_test(large_coefficients_are_refused),
        cmocka_unit_test(doubled_levels_are_solved),
        cmocka_unit_test(failing_allocations_leave_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
