/* Rank-1 updates against refactorisation; failures leave every bit. */
#include "support.h"

static void check_against_matrix(const qc_factor *F, const test_matrix *M, bool real) {
    const int64_t n2 = (int64_t)M->n * M->n;
    cplx *A = dense_of(M, real), *B = reconstruct(F);
    assert_true(max_difference(n2, A, B) <= 1e-12 * (1 + max_abs(n2, A)));
    for (int32_t k = 0; k < M->n; k++) {
        const double a = creal(A[F->S->perm[k] * ((int64_t)M->n + 1)]);
        assert_true(fabs(F->diagonal[k] - a) <= 1e-12 * a);
    }
    free(A);
    free(B);
}

static void chain_of_updates(const char *instructions) {
    qc_ctx *ctx = new_ctx_with(1, instructions);
    if (!ctx) return;
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 100, 1);
        qc_factor *F = factor_of(ctx, &M, NULL);
        for (int step = 0; step < 60; step++) {
            int32_t row[2];
            const int nw = random_clique(&M, row) ? 2 : 1, sigma = step % 3 ? 1 : -1;
            const double size = sigma < 0 ? 0.2 : 0.5;
            const qc_complex w[2] = {{size * uniform(), size * uniform()},
                                     {size * uniform(), size * uniform()}};
            const uint64_t before = fingerprint(F);
            const qc_status status = qc_updown(ctx, F, sigma, nw, row, w);
            if (status == QC_OK) {
                add_square(&M, sigma, nw, row, w);
            } else {
                assert_int_equal(status, QC_ERR_NOT_POSDEF);
                assert_true(before == fingerprint(F));
            }
        }
        check_against_matrix(F, &M, false);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void chain_equals_refactorisation(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) chain_of_updates(instruction_sets[i]);
}

static void real_chain_of_updates(const char *instructions) {
    qc_ctx *ctx = new_ctx_with(1, instructions);
    if (!ctx) return;
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 100, 1);
        qc_factor *F = real_factor_of(ctx, &M, NULL);
        for (int step = 0; step < 60; step++) {
            int32_t row[2];
            const int nw = random_clique(&M, row) ? 2 : 1, sigma = step % 3 ? 1 : -1;
            const double size = sigma < 0 ? 0.2 : 0.5;
            const qc_complex w[2] = {{size * uniform(), 0}, {size * uniform(), 0}};
            const double real[2] = {w[0].re, w[1].re};
            if (qc_updown_real(ctx, F, sigma, nw, row, real) == QC_OK)
                add_square(&M, sigma, nw, row, w);
        }
        check_against_matrix(F, &M, true);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void real_chain_equals_refactorisation(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) real_chain_of_updates(instruction_sets[i]);
}

static void update_then_downdate_is_identity(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 400, 0.5);
    const int64_t n2 = (int64_t)M.n * M.n;
    qc_factor *F = factor_of(ctx, &M, NULL);
    cplx *before = reconstruct(F);
    for (int step = 0; step < 50; step++) {
        int32_t row[2];
        if (!random_clique(&M, row)) continue;
        const qc_complex w[2] = {{uniform(), uniform()}, {uniform(), uniform()}};
        assert_int_equal(qc_updown(ctx, F, 1, 2, row, w), QC_OK);
        assert_int_equal(qc_updown(ctx, F, -1, 2, row, w), QC_OK);
    }
    cplx *after = reconstruct(F);
    assert_true(max_difference(n2, before, after) < 1e-12 * max_abs(n2, before));
    free(before);
    free(after);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void failing_downdates(const char *instructions) {
    qc_ctx *ctx = new_ctx_with(1, instructions);
    if (!ctx) return;
    int failed_late = 0;
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 120, 0.01);
        qc_factor *F = factor_of(ctx, &M, NULL);
        const uint64_t before = fingerprint(F);
        for (int step = 0; step < 40; step++) {
            int32_t row[2];
            const int nw = random_clique(&M, row) ? 2 : 1;
            const double size = 0.8 * sqrt(M.val[M.colptr[row[0] + 1] - 1].re);
            const qc_complex w[2] = {{size, 0}, {0, size}};
            const qc_status status = qc_updown(ctx, F, -1, nw, row, w);
            if (status == QC_OK) { /* one entry can be right for such a step: undo it */
                qc_factor_free(F);
                F = factor_of(ctx, &M, NULL);
                continue;
            }
            assert_int_equal(status, QC_ERR_NOT_POSDEF);
            const int64_t where = qc_ctx_error(ctx)->where;
            assert_true(where >= 0 && where < M.n);
            failed_late += where != row[0] && where != row[nw - 1];
            assert_true(before == fingerprint(F));
        }
        qc_factor_free(F);
        free_matrix(&M);
    }
    assert_true(failed_late > 0); /* after columns had been changed */
    qc_ctx_free(ctx);
}

static void failed_downdate_changes_nothing(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) failing_downdates(instruction_sets[i]);
}

static void arguments_are_checked(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(BLOCKS, 70, 1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    const int32_t apart[2] = {0, 60}, outside = 70;
    const qc_complex w[2] = {{1, 0}, {1, 0}};
    assert_int_equal(qc_updown(ctx, F, 1, 2, apart, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown(ctx, F, 1, 1, &outside, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown(ctx, F, 0, 1, apart, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown(ctx, F, 1, 0, apart, w), QC_OK);
    assert_true(before == fingerprint(F));
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chain_equals_refactorisation),
        cmocka_unit_test(real_chain_equals_refactorisation),
        cmocka_unit_test(update_then_downdate_is_identity),
        cmocka_unit_test(failed_downdate_changes_nothing),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
