/* Condition estimates and determinants against dense elimination. */
#include "support.h"

/* A <- A^{-1} by Gauss and Jordan (positive definite: no pivoting); returns log det A. */
static double invert(int64_t n, cplx *A) {
    double logdet = 0;
    for (int64_t k = 0; k < n; k++) {
        const cplx pivot = A[k + k * n];
        logdet += log(cabs(pivot));
        A[k + k * n] = 1;
        for (int64_t j = 0; j < n; j++) A[k + j * n] /= pivot;
        for (int64_t i = 0; i < n; i++) {
            const cplx factor = A[i + k * n];
            if (i == k) continue;
            A[i + k * n] = 0;
            for (int64_t j = 0; j < n; j++) A[i + j * n] -= factor * A[k + j * n];
        }
    }
    return logdet;
}

static double norm1(int64_t n, const cplx *A) {
    double norm = 0;
    for (int64_t j = 0; j < n; j++) {
        double sum = 0;
        for (int64_t i = 0; i < n; i++) sum += cabs(A[i + j * n]);
        norm = fmax(norm, sum);
    }
    return norm;
}

/* A <- S A S with S from 1 to 10^-decades */
static void grade(test_matrix *M, double decades) {
    for (int32_t j = 0; j < M->n; j++)
        for (int64_t p = M->colptr[j]; p < M->colptr[j + 1]; p++) {
            const double s = pow(10, -decades * (M->row[p] + j) / M->n);
            M->val[p].re *= s;
            M->val[p].im *= s;
            M->real[p] *= s;
        }
}

static void check_pair(qc_ctx *ctx, const test_matrix *M, bool real) {
    const int64_t n = M->n;
    const qc_hermitian A = hermitian(M);
    const qc_symmetric B = symmetric(M);
    qc_factor *F = real ? real_factor_of(ctx, M, NULL) : factor_of(ctx, M, NULL);
    cplx *dense = dense_of(M, real);
    double estimate = 0, exact = norm1(n, dense);
    assert_int_equal(real ? qc_condition_real(ctx, F, &B, &estimate)
                          : qc_condition(ctx, F, &A, &estimate),
                     QC_OK);
    const double logdet = invert(n, dense);
    exact *= norm1(n, dense);
    assert_true(estimate <= exact * (1 + 1e-6) && estimate >= exact / 3);
    assert_true(fabs(qc_factor_logdet(F) - logdet) <= 1e-10 * fmax(1, fabs(logdet)));
    free(dense);
    qc_factor_free(F);
}

static void estimates_are_close_to_exact_condition_numbers(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++)
        for (int graded = 0; graded < 3; graded++)
            for (int32_t n = 1; n <= 61; n += 20) {
                test_matrix M = make_matrix(shape, n, graded == 2 ? 1e-6 : 0.3);
                grade(&M, 4.0 * graded);
                check_pair(ctx, &M, false);
                check_pair(ctx, &M, true);
                free_matrix(&M);
            }
    qc_ctx_free(ctx);
}

/* det (A + w w^H) after an update, real and complex. */
static void determinants_follow_updates(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 49, 0.1);
    const int64_t n = M.n;
    qc_factor *F = factor_of(ctx, &M, NULL), *G = real_factor_of(ctx, &M, NULL);
    cplx *A = dense_of(&M, false), *B = dense_of(&M, true);
    for (int32_t k = 0; k + 1 < 49; k += 7) {
        const int32_t row[2] = {k, k + 1};
        const qc_complex w[2] = {{uniform(), uniform()}, {uniform(), uniform()}};
        const double v[2] = {w[0].re, w[1].re};
        assert_int_equal(qc_updown(ctx, F, 1, 2, row, w), QC_OK);
        assert_int_equal(qc_updown_real(ctx, G, 1, 2, row, v), QC_OK);
        for (int a = 0; a < 2; a++)
            for (int b = 0; b < 2; b++) {
                A[row[a] + row[b] * n] += (w[a].re + I * w[a].im) * (w[b].re - I * w[b].im);
                B[row[a] + row[b] * n] += v[a] * v[b];
            }
    }
    assert_true(fabs(qc_factor_logdet(F) - invert(n, A)) < 1e-11 * (double)n);
    assert_true(fabs(qc_factor_logdet(G) - invert(n, B)) < 1e-11 * (double)n);
    free(A);
    free(B);
    qc_factor_free(F);
    qc_factor_free(G);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void wrong_arguments_are_refused(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(PATH, 6, 1), other = make_matrix(PATH, 7, 1);
    const qc_hermitian A = hermitian(&M), B = hermitian(&other);
    const qc_symmetric R = symmetric(&M);
    qc_factor *F = factor_of(ctx, &M, NULL);
    double value = 5;
    assert_int_equal(qc_condition(ctx, F, &B, &value), QC_ERR_ARGUMENT);
    assert_int_equal(qc_condition_real(ctx, F, &R, &value), QC_ERR_ARGUMENT);
    assert_true(value == 5);
    assert_int_equal(qc_condition(ctx, F, &A, &value), QC_OK);
    qc_factor_free(F);
    free_matrix(&M);
    free_matrix(&other);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimates_are_close_to_exact_condition_numbers),
        cmocka_unit_test(determinants_follow_updates),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
