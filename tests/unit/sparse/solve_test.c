/* Residuals, blocks of right-hand sides, equal bits for any number of
 * threads, the forward identity, refinement. */
#include <pthread.h>
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

/* Column q of a block does not depend on the other columns, and forward not even on there being a
 * block. */
static void check_complex(qc_ctx *ctx, const test_matrix *M, const cplx *A, int32_t nrhs) {
    const int64_t n = M->n;
    qc_factor *F = factor_of(ctx, M, NULL);
    qc_complex *b = random_vectors(n * nrhs), *x = random_vectors(n * nrhs), one[2 * 200];
    if (nrhs) memcpy(x, b, (size_t)(n * nrhs) * sizeof *x);
    assert_int_equal(qc_solve(ctx, F, nrhs, x), QC_OK);
    for (int64_t k = 0; k < nrhs; k++) {
        assert_true(residual(A, n, x + k * n, b + k * n) < 1e-13);
        const int32_t alone = nrhs == 1 ? 1 : 2;
        memcpy(one, b + k * n, (size_t)n * sizeof *one);
        memcpy(one + n, b, (size_t)n * sizeof *one);
        assert_int_equal(qc_solve(ctx, F, alone, one), QC_OK);
        assert_memory_equal(one, x + k * n, (size_t)n * sizeof *one);
    }
    if (nrhs) memcpy(x, b, (size_t)(n * nrhs) * sizeof *x);
    assert_int_equal(qc_solve_forward(ctx, F, nrhs, x), QC_OK);
    for (int64_t k = 0; k < nrhs; k++) {
        memcpy(one, b + k * n, (size_t)n * sizeof *one);
        assert_int_equal(qc_solve_forward(ctx, F, 1, one), QC_OK);
        assert_memory_equal(one, x + k * n, (size_t)n * sizeof *one);
    }
    free(b);
    free(x);
    qc_factor_free(F);
}

static void complex_solves(void **state) {
    (void)state;
    for (size_t set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(2, instruction_sets[set]);
        if (!ctx) continue;
        for (int shape = 0; shape < SHAPES; shape++) {
            test_matrix M = make_matrix(shape, 130, 0.2);
            cplx *A = dense_of(&M, false);
            for (int32_t nrhs = 0; nrhs <= 40; nrhs += nrhs < 3 ? 1 : nrhs < 10 ? 5 : 16)
                check_complex(ctx, &M, A, nrhs);
            free(A);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

static void check_real(qc_ctx *ctx, const test_matrix *M, const cplx *A, int32_t nrhs) {
    const int64_t n = M->n;
    qc_factor *F = real_factor_of(ctx, M, NULL);
    double *b = malloc((size_t)(n * nrhs) * 8), *x = malloc((size_t)(n * nrhs) * 8), y[200];
    for (int64_t i = 0; i < nrhs * n; i++) x[i] = b[i] = uniform();
    assert_int_equal(qc_solve_real(ctx, F, nrhs, x), QC_OK);
    for (int64_t k = 0; k < nrhs; k++) {
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
}

static void real_solves(void **state) {
    (void)state;
    for (size_t set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        if (!ctx) continue;
        for (int shape = 0; shape < SHAPES; shape++) {
            test_matrix M = make_matrix(shape, 130, 0.2);
            cplx *A = dense_of(&M, true);
            for (int32_t nrhs = 1; nrhs <= 17; nrhs += 8) check_real(ctx, &M, A, nrhs);
            free(A);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

/* A tree of several tasks: the same bits for any number of threads, one or many right-hand sides,
 * and forward no difference between them. */
static void threads_change_no_bit(void **state) {
    (void)state;
    test_matrix M = make_matrix(GRID, 6400, 0.01);
    const int64_t n = M.n;
    qc_complex *b = random_vectors(20 * n), *x = random_vectors(20 * n),
               *y = random_vectors(20 * n);
    for (size_t set = 0; set < 3; set++)
        for (int32_t nrhs = 1; nrhs <= 20; nrhs += 19)
            for (int forward = 0; forward < 2; forward++)
                for (uint32_t threads = 1; threads <= 4; threads += 3) {
                    qc_ctx *ctx = new_ctx_with(threads, instruction_sets[set]);
                    if (!ctx) continue;
                    qc_factor *F = factor_of(ctx, &M, NULL);
                    assert_true(F->S->plan.ntask > 1);
                    memcpy(y, b, (size_t)(nrhs * n) * sizeof *y);
                    assert_int_equal(forward ? qc_solve_forward(ctx, F, nrhs, y)
                                             : qc_solve(ctx, F, nrhs, y),
                                     QC_OK);
                    if (threads > 1) assert_memory_equal(x, y, (size_t)(nrhs * n) * sizeof *y);
                    memcpy(x, y, (size_t)(nrhs * n) * sizeof *y);
                    qc_factor_free(F);
                    qc_ctx_free(ctx);
                }
    free(b);
    free(x);
    free(y);
    free_matrix(&M);
}

typedef struct client {
    const qc_factor *F;
    qc_complex *x;
    qc_status status;
} client;

static void *solve_many(void *arg) {
    client *c = arg;
    qc_ctx *ctx = NULL;
    c->status = qc_ctx_create(NULL, &ctx);
    for (int k = 0; k < 20 && c->status == QC_OK; k++)
        c->status = qc_solve(ctx, c->F, k % 2 ? 1 : 3, c->x);
    qc_ctx_free(ctx);
    return NULL;
}

/* Solves keep nothing in the factor: threads which share one do not see each other. */
static void threads_share_a_factor(void **state) {
    (void)state;
    enum { CLIENTS = 3 };
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 1600, 0.9);
    const int64_t n = M.n;
    client c[CLIENTS];
    pthread_t thread[CLIENTS];
    qc_factor *F = factor_of(ctx, &M, NULL);
    qc_complex *b = random_vectors(3 * n);
    for (int k = 0; k < CLIENTS; k++) {
        c[k] = (client){F, random_vectors(3 * n), QC_OK};
        memcpy(c[k].x, b, (size_t)(3 * n) * sizeof *b);
        assert_int_equal(pthread_create(&thread[k], NULL, solve_many, &c[k]), 0);
    }
    for (int k = 0; k < CLIENTS; k++) {
        pthread_join(thread[k], NULL);
        assert_int_equal(c[k].status, QC_OK);
        assert_memory_equal(c[k].x, c[0].x, (size_t)(3 * n) * sizeof *b);
    }
    for (int k = 0; k < CLIENTS; k++) free(c[k].x);
    free(b);
    qc_factor_free(F);
    free_matrix(&M);
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

/* The error of the factor is made large by factorising a neighbour of A. Every right-hand side has
 * to reach rounding level in every component; b stays when nothing is solved. */
static void refinement_reaches_roundoff(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(2);
    test_matrix M = make_matrix(GRID, 900, 1e-2);
    const int64_t n = M.n;
    const qc_hermitian A = hermitian(&M);
    const qc_symmetric B = symmetric(&M);
    for (int64_t j = 0; j < n; j++) {
        M.val[M.colptr[j + 1] - 1].re *= 1 + 1e-4;
        M.real[M.colptr[j + 1] - 1] *= 1 + 1e-4;
    }
    qc_factor *F = factor_of(ctx, &M, NULL), *G = real_factor_of(ctx, &M, NULL);
    for (int64_t j = 0; j < n; j++) {
        M.val[M.colptr[j + 1] - 1].re /= 1 + 1e-4;
        M.real[M.colptr[j + 1] - 1] /= 1 + 1e-4;
    }
    for (int32_t nrhs = 1; nrhs <= 10; nrhs += 9) {
        qc_complex *x = random_vectors(nrhs * n), *b = random_vectors(nrhs * n);
        double *y = malloc((size_t)(nrhs * n) * sizeof *y), before, after;
        for (int64_t i = 0; i < nrhs * n; i++) y[i] = x[i].re;
        memcpy(b, x, (size_t)(nrhs * n) * sizeof *b);
        assert_int_equal(qc_solve_refined(ctx, F, &A, nrhs, -1, x, &before), QC_ERR_ARGUMENT);
        assert_memory_equal(x, b, (size_t)(nrhs * n) * sizeof *b);
        assert_int_equal(qc_solve_refined(ctx, F, &A, nrhs, 0, x, &before), QC_OK);
        assert_int_equal(qc_solve_refined(ctx, F, &A, nrhs, 20, b, &after), QC_OK);
        assert_true(before > 1e-7 && after < 1e-15);
        assert_int_equal(qc_solve_refined_real(ctx, G, &B, nrhs, 20, y, &after), QC_OK);
        assert_true(after < 1e-15);
        free(x);
        free(b);
        free(y);
    }
    qc_factor_free(F);
    qc_factor_free(G);
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
        cmocka_unit_test(complex_solves),        cmocka_unit_test(real_solves),
        cmocka_unit_test(threads_change_no_bit), cmocka_unit_test(threads_share_a_factor),
        cmocka_unit_test(forward_identity),      cmocka_unit_test(refinement_reaches_roundoff),
        cmocka_unit_test(kinds_do_not_mix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
