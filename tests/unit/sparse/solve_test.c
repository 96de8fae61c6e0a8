/* Residuals, blocks of right-hand sides, the forward identity, sparse forward solves, refinement.
 */
#include "support.h"

static qc_complex *random_vectors(int64_t count) {
    qc_complex *x = malloc(((size_t)count + 1) * sizeof *x);
    for (int64_t i = 0; i < count; i++) x[i] = (qc_complex){uniform(), uniform()};
    return x;
}

static double residual(const cplx *A, int64_t n, const qc_complex *x, const qc_complex *b) {
    double max = 0, largest = 1;
    for (int64_t i = 0; i < n; i++) {
        cplx sum = -(b[i].re + I * b[i].im);
        for (int64_t j = 0; j < n; j++) sum += A[i + j * n] * (x[j].re + I * x[j].im);
        max = fmax(max, cabs(sum));
        largest = fmax(largest, hypot(x[i].re, x[i].im));
    }
    return max / largest;
}

static void complex_solves(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(2);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 130, 0.2);
        const int64_t n = M.n;
        cplx *A = dense_of(&M, false);
        qc_factor *F = factor_of(ctx, &M, NULL);
        for (int32_t nrhs = 0; nrhs <= 19; nrhs += nrhs < 2 ? 1 : 7) {
            qc_complex *b = random_vectors(n * nrhs), *x = random_vectors(n * nrhs), one[200];
            if (nrhs) memcpy(x, b, (size_t)(n * nrhs) * sizeof *x);
            assert_int_equal(qc_solve(ctx, F, nrhs, x), QC_OK);
            for (int64_t k = 0; k < nrhs; k++) {
                assert_true(residual(A, n, x + k * n, b + k * n) < 1e-13);
                memcpy(one, b + k * n, (size_t)n * sizeof *one); /* a block changes no bit */
                assert_int_equal(qc_solve(ctx, F, 1, one), QC_OK);
                assert_memory_equal(one, x + k * n, (size_t)n * sizeof *one);
            }
            free(b);
            free(x);
        }
        qc_factor_free(F);
        free(A);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void real_solves(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 130, 0.2);
        const int64_t n = M.n;
        cplx *A = dense_of(&M, true);
        qc_factor *F = real_factor_of(ctx, &M, NULL);
        double *b = malloc((size_t)n * 80), *x = malloc((size_t)n * 80), y[200];
        for (int64_t i = 0; i < 10 * n; i++) x[i] = b[i] = uniform();
        assert_int_equal(qc_solve_real(ctx, F, 10, x), QC_OK);
        for (int64_t k = 0; k < 10; k++) {
            double energy = 0, norm = 0;
            for (int64_t i = 0; i < n; i++) {
                cplx sum = -b[k * n + i];
                for (int64_t j = 0; j < n; j++) sum += A[i + j * n] * x[k * n + j];
                assert_true(cabs(sum) < 1e-12);
                energy += b[k * n + i] * x[k * n + i];
            }
            memcpy(y, b + k * n, (size_t)n * sizeof *y);
            assert_int_equal(qc_solve_forward_real(ctx, F, 1, y), QC_OK);
            for (int64_t i = 0; i < n; i++) norm += y[i] * y[i];
            assert_true(fabs(norm - energy) <= 1e-13 * energy);
        }
        free(b);
        free(x);
        qc_factor_free(F);
        free(A);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

/* B^H A^{-1} C = Y_B^H Y_C (thesis 6.2.1) */
static void forward_identity(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 400, 1e-3);
    const int64_t n = M.n;
    qc_factor *F = factor_of(ctx, &M, NULL);
    qc_complex *b = random_vectors(2 * n), *x = random_vectors(2 * n), *y = random_vectors(2 * n);
    memcpy(x, b, (size_t)(2 * n) * sizeof *x);
    memcpy(y, b, (size_t)(2 * n) * sizeof *x);
    assert_int_equal(qc_solve(ctx, F, 2, x), QC_OK);
    assert_int_equal(qc_solve_forward(ctx, F, 2, y), QC_OK);
    cplx direct[2] = {0, 0}, by_forward[2] = {0, 0};
    for (int64_t k = 0; k < 2; k++)
        for (int64_t i = 0; i < n; i++) {
            direct[k] += (b[i].re - I * b[i].im) * (x[k * n + i].re + I * x[k * n + i].im);
            by_forward[k] += (y[i].re - I * y[i].im) * (y[k * n + i].re + I * y[k * n + i].im);
        }
    assert_true(cabs(direct[0] - by_forward[0]) < 1e-11 * cabs(direct[0]));
    assert_true(cabs(direct[1] - by_forward[1]) < 1e-11 * cabs(direct[0]));
    free(b);
    free(x);
    free(y);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void sparse_forward_equals_dense_forward(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 150, 0.2);
        qc_factor *F = factor_of(ctx, &M, NULL);
        for (int32_t nb = 0; nb < 6; nb++) {
            int32_t row[6];
            qc_complex b[6], y[200], dense[200];
            memset(dense, 0, sizeof dense);
            for (int32_t p = 0; p < nb; p++) {
                row[p] = pick(M.n); /* may repeat: entries add */
                b[p] = (qc_complex){uniform(), uniform()};
                dense[row[p]].re += b[p].re;
                dense[row[p]].im += b[p].im;
            }
            for (int32_t i = 0; i < M.n; i++) y[i] = (qc_complex){NAN, NAN};
            assert_int_equal(qc_solve_forward_sparse(ctx, F, nb, row, b, y), QC_OK);
            assert_int_equal(qc_solve_forward(ctx, F, 1, dense), QC_OK);
            for (int32_t i = 0; i < M.n; i++)
                assert_true(y[i].re == dense[i].re && y[i].im == dense[i].im);
        }
        const int32_t outside = M.n;
        const qc_complex one = {1, 0};
        qc_complex y[200];
        assert_int_equal(qc_solve_forward_sparse(ctx, F, 1, &outside, &one, y), QC_ERR_ARGUMENT);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void refinement_reaches_roundoff(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 900, 1e-7);
    const qc_hermitian A = hermitian(&M);
    qc_factor *F = factor_of(ctx, &M, NULL);
    qc_complex *x = random_vectors(M.n);
    double residual_after = 1;
    assert_int_equal(qc_solve_refined(ctx, F, &A, 2, x, &residual_after), QC_OK);
    assert_true(residual_after < 1e-15);
    free(x);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void kinds_do_not_mix(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(PATH, 4, 1);
    qc_factor *F = factor_of(ctx, &M, NULL), *G = real_factor_of(ctx, &M, NULL);
    qc_complex x[4];
    double y[4];
    memset(x, 0, sizeof x);
    memset(y, 0, sizeof y);
    assert_int_equal(qc_solve(ctx, G, 1, x), QC_ERR_ARGUMENT);
    assert_int_equal(qc_solve_real(ctx, F, 1, y), QC_ERR_ARGUMENT);
    assert_int_equal(qc_solve_forward(ctx, G, 1, x), QC_ERR_ARGUMENT);
    assert_int_equal(qc_flip(ctx, G, 0, 1, x[0], 1, x[0]), QC_ERR_ARGUMENT);
    assert_int_equal(qc_solve(ctx, F, -1, x), QC_ERR_ARGUMENT);
    qc_factor_free(F);
    qc_factor_free(G);
    qc_factor_free(NULL);
    qc_symbolic_free(NULL);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(complex_solves),
        cmocka_unit_test(real_solves),
        cmocka_unit_test(forward_identity),
        cmocka_unit_test(sparse_forward_equals_dense_forward),
        cmocka_unit_test(refinement_reaches_roundoff),
        cmocka_unit_test(kinds_do_not_mix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
