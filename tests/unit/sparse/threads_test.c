/* Same bytes for any number of threads; the host's BLAS setting returns; cancelling. */
#include "support.h"
#include <cblas.h>

/* Large enough for several tasks and for fronts which call BLAS. */
static test_matrix big(void) {
    const int32_t side = 90, n = side * side;
    int64_t q = 0;
    test_matrix M = {n, malloc(((size_t)n + 1) * 8), malloc((size_t)n * 3 * 4),
                     malloc((size_t)n * 3 * 16), malloc((size_t)n * 3 * 8)};
    for (int32_t j = 0; j < n; j++) {
        M.colptr[j] = q;
        const int32_t before[3] = {j >= side ? j - side : -1, j % side ? j - 1 : -1, j};
        for (int k = 0; k < 3; k++) {
            if (before[k] < 0) continue;
            const double phase = 3 * uniform();
            M.row[q] = before[k];
            M.val[q] =
                before[k] == j ? (qc_complex){4.01, 0} : (qc_complex){-cos(phase), -sin(phase)};
            M.real[q++] = before[k] == j ? 4.01 : -1;
        }
    }
    M.colptr[n] = q;
    return M;
}

static void check_thread_counts(const test_matrix *M, const char *instructions) {
    uint64_t expected[2] = {0, 0};
    qc_complex *first = NULL;
    const size_t size = (size_t)M->n * 20;
    static const uint32_t counts[] = {1, 2, 3, 8};
    for (size_t i_count = 0; i_count < 4; i_count++) {
        const uint32_t threads = counts[i_count];
        qc_ctx *ctx = new_ctx_with(threads, instructions);
        if (!ctx) return;
        qc_factor *F = factor_of(ctx, M, NULL), *G = real_factor_of(ctx, M, NULL);
        assert_true(F->S->plan.ntask > 2);
        qc_complex *x = malloc(size * sizeof *x);
        double residual = 1;
        const qc_hermitian A = hermitian(M);
        for (size_t i = 0; i < size; i++) x[i] = (qc_complex){sin((double)i), cos((double)i)};
        assert_int_equal(qc_solve_refined(ctx, F, &A, 1, 0, x, &residual), QC_OK);
        assert_true(residual < 1e-15);
        assert_int_equal(qc_solve(ctx, F, 20, x), QC_OK);
        if (threads == 1) {
            expected[0] = fingerprint(F);
            expected[1] = fingerprint(G);
            first = x;
        } else {
            assert_true(fingerprint(F) == expected[0] && fingerprint(G) == expected[1]);
            assert_memory_equal(x, first, size * sizeof *x);
            free(x);
        }
        qc_factor_free(F);
        qc_factor_free(G);
        qc_ctx_free(ctx);
    }
    free(first);
}

static void same_bytes_for_any_number_of_threads(void **state) {
    (void)state;
    test_matrix M = big();
    for (int set = 0; set < 3; set++) check_thread_counts(&M, instruction_sets[set]);
    free_matrix(&M);
}

static void blas_setting_of_the_host_returns(void **state) {
    (void)state;
    const int host = openblas_get_num_threads();
    openblas_set_num_threads(2);
    const int set = openblas_get_num_threads();
    qc_ctx *ctx = new_ctx_with(2, "portable"); /* calls BLAS for wide fronts */
    test_matrix M = big();
    const qc_hermitian A = hermitian(&M);
    qc_factor *F = factor_of(ctx, &M, NULL);
    assert_true(F->S->plan.largest_width >= F->kernels->blas_width);
    assert_int_equal(openblas_get_num_threads(), set);
    M.val[M.colptr[M.n] - 1].re = -1; /* the failing path as well */
    assert_int_equal(qc_refactorize(ctx, F, &A), QC_ERR_NOT_POSDEF);
    assert_int_equal(openblas_get_num_threads(), set);
    qc__blas_begin();
    qc__blas_begin();
    assert_int_equal(openblas_get_num_threads(), 1);
    qc__blas_end();
    assert_int_equal(openblas_get_num_threads(), 1);
    qc__blas_end();
    assert_int_equal(openblas_get_num_threads(), set);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
    openblas_set_num_threads(host);
}

static bool count_down(void *user, const char *stage, double fraction) {
    int *left = user;
    (void)stage;
    assert_true(fraction >= 0 && fraction <= 1);
    return (*left)-- > 0;
}

static void cancel_at_every_report(void **state) {
    (void)state;
    test_matrix M = big();
    const qc_hermitian A = hermitian(&M);
    int left = 0;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = count_down;
    options.user = &left;
    options.threads = 2;
    qc_complex *x = calloc((size_t)M.n * 40, sizeof *x);
    for (int reports = 0;; reports++) {
        qc_ctx *ctx = NULL;
        qc_symbolic *S = NULL;
        qc_factor *F = NULL;
        left = reports;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_status status = qc_analyze(ctx, &A, NULL, &S);
        if (status == QC_OK) status = qc_factorize(ctx, S, &A, &F);
        assert_true((status == QC_OK) == (F != NULL));
        if (status == QC_OK) status = qc_solve(ctx, F, 40, x);
        qc_symbolic_free(S);
        qc_factor_free(F);
        qc_ctx_free(ctx);
        if (status == QC_OK) break;
        assert_int_equal(status, QC_ERR_CANCELLED);
        assert_true(reports < 1000);
    }
    free(x);
    free_matrix(&M);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_bytes_for_any_number_of_threads),
        cmocka_unit_test(blas_setting_of_the_host_returns),
        cmocka_unit_test(cancel_at_every_report),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
