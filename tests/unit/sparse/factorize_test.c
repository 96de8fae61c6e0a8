/* A = P^T L D L^H P, singular and indefinite matrices, subsets of the pattern. */
#include "support.h"

static void check_product(const qc_factor *F, const test_matrix *M, bool real) {
    const int64_t n2 = (int64_t)M->n * M->n;
    cplx *A = dense_of(M, real), *B = reconstruct(F);
    assert_true(max_difference(n2, A, B) <= 1e-14 * (1 + max_abs(n2, A)));
    for (int32_t k = 0; k < M->n; k++) {
        const int64_t at = M->colptr[F->S->perm[k] + 1] - 1;
        assert_true(fabs(F->diagonal[k] - M->real[at]) == 0);
    }
    free(A);
    free(B);
}

static void check_shapes(qc_ctx *ctx) {
    for (int shape = 0; shape < SHAPES; shape++)
        for (int32_t n = 0; n <= 200; n += n < 6 ? 1 : 61)
            for (int32_t ordering = 0; ordering < 2; ordering++) {
                test_matrix M = make_matrix(shape, n, 0.1);
                qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
                options.ordering = ordering;
                qc_factor *F = factor_of(ctx, &M, &options);
                check_product(F, &M, false);
                qc_factor_free(F);
                F = real_factor_of(ctx, &M, &options);
                check_product(F, &M, true);
                qc_factor_free(F);
                free_matrix(&M);
            }
}

static void product_is_the_matrix(void **state) {
    (void)state;
    for (int set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        if (!ctx) continue;
        assert_string_equal(qc_ctx_instructions(ctx), instruction_sets[set]);
        check_shapes(ctx);
        qc_ctx_free(ctx);
    }
}

/* A front of every small size: dense blocks of w columns which all touch the same m last rows. */
static void fronts_of_every_size(void **state) {
    (void)state;
    for (int set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        if (!ctx) continue;
        for (int32_t w = 1; w < 60; w += w < 14 ? 1 : 15)
            for (int32_t m = 0; m < 30; m += m < 14 ? 1 : 5) {
                int32_t(*edge)[2] = malloc(sizeof *edge * (size_t)((w + m) * (w + m)));
                int64_t ne = 0;
                for (int32_t i = 0; i < w + m; i++)
                    for (int32_t j = 0; j < i && j < w; j++) edge[ne][0] = i, edge[ne++][1] = j;
                test_matrix M = from_edges(w + m, ne, (const int32_t(*)[2])edge, 0.1);
                qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
                options.ordering = QC_ORDER_NATURAL;
                qc_factor *F = factor_of(ctx, &M, &options);
                check_product(F, &M, false);
                qc_factor_free(F);
                F = real_factor_of(ctx, &M, &options);
                check_product(F, &M, true);
                qc_factor_free(F);
                free_matrix(&M);
                free(edge);
            }
        qc_ctx_free(ctx);
    }
}

/* Scaling by 1e-6 or 1e6 scales D and leaves L. */
static void scale_does_not_matter(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (double scale = 1e-12; scale < 1e13; scale *= 1e24) {
        test_matrix M = make_matrix(GRID, 400, 1e-6);
        for (int64_t p = 0; p < M.colptr[M.n]; p++) {
            M.val[p].re *= scale;
            M.val[p].im *= scale;
        }
        qc_factor *F = factor_of(ctx, &M, NULL);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void pivot_summaries(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(DIAGONAL, 5, 1);
    for (int k = 0; k < 5; k++) M.val[k].re = k + 1;
    qc_factor *F = factor_of(ctx, &M, NULL);
    double lo, hi;
    qc_factor_pivots(F, &lo, &hi);
    assert_true(lo == 1 && hi == 5);
    assert_true(fabs(qc_factor_logdet(F) - log(120)) < 1e-13);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

/* A real Laplacian is singular; with a natural order the last row of each component is the pivot.
 */
static void singular_matrix_is_refused(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int32_t n = 2; n <= 1100; n = 3 * n + 1) {
        test_matrix M = make_matrix(GRID, n, 0);
        const qc_symmetric A = symmetric(&M);
        qc_symbolic *S = NULL;
        qc_factor *F = NULL;
        qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
        options.ordering = QC_ORDER_NATURAL;
        assert_int_equal(qc_analyze_real(ctx, &A, &options, &S), QC_OK);
        assert_int_equal(qc_factorize_real(ctx, S, &A, &F), QC_ERR_NOT_POSDEF);
        assert_int_equal(qc_ctx_error(ctx)->where, M.n - 1);
        assert_null(F);
        qc_symbolic_free(S);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void indefinite_pivot_is_named(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(2);
    for (int shape = 0; shape < SHAPES; shape++)
        for (int32_t bad = 0; bad < 144; bad += 37) {
            test_matrix M = make_matrix(shape, 160, 0.1);
            const int64_t at = M.colptr[bad + 1] - 1;
            const double good = M.val[at].re;
            const qc_hermitian A = hermitian(&M);
            qc_symbolic *S = NULL;
            qc_factor *F = NULL;
            qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
            options.ordering = QC_ORDER_NATURAL;
            assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_OK);
            assert_int_equal(qc_factorize(ctx, S, &A, &F), QC_OK);
            M.val[at].re = bad == 74 ? NAN : -good;
            assert_int_equal(qc_refactorize(ctx, F, &A), QC_ERR_NOT_POSDEF);
            assert_int_equal(qc_ctx_error(ctx)->where, bad);
            qc_complex x[160] = {{1, 0}};
            assert_int_equal(qc_solve(ctx, F, 1, x), QC_ERR_ARGUMENT);
            M.val[at].re = good;
            assert_int_equal(qc_refactorize(ctx, F, &A), QC_OK);
            check_product(F, &M, false);
            qc_factor_free(F);
            qc_symbolic_free(S);
            free_matrix(&M);
        }
    qc_ctx_free(ctx);
}

static void subset_of_the_pattern(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix full = make_matrix(GRID, 64, 1), part = make_matrix(PATH, 64, 1);
    /* the path along rows of the grid without the steps between rows is in the grid */
    int64_t q = 0;
    for (int32_t j = 0, p = 0; j < 64; j++) {
        part.colptr[j] = q;
        if (j) {
            if (j % 8) {
                part.row[q] = part.row[p];
                part.val[q++] = part.val[p];
            }
            p++;
        }
        part.row[q] = part.row[p];
        part.real[q] = part.val[p].re;
        part.val[q++] = part.val[p++];
    }
    part.colptr[64] = q;
    const qc_hermitian A = hermitian(&full), B = hermitian(&part);
    qc_symbolic *S = NULL, *T = NULL;
    qc_factor *F = NULL, *G = NULL;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_OK);
    assert_int_equal(qc_factorize(ctx, S, &B, &F), QC_OK);
    check_product(F, &part, false);
    assert_int_equal(qc_analyze(ctx, &B, NULL, &T), QC_OK);
    assert_int_equal(qc_factorize(ctx, T, &A, &G), QC_ERR_ARGUMENT);
    assert_null(G);
    qc_factor_free(F);
    qc_symbolic_free(S);
    qc_symbolic_free(T);
    free_matrix(&full);
    free_matrix(&part);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(product_is_the_matrix),      cmocka_unit_test(fronts_of_every_size),
        cmocka_unit_test(scale_does_not_matter),      cmocka_unit_test(pivot_summaries),
        cmocka_unit_test(singular_matrix_is_refused), cmocka_unit_test(indefinite_pivot_is_named),
        cmocka_unit_test(subset_of_the_pattern),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
