/* The symbolic analysis against a dense elimination, and its answers to bad input. */
#include "support.h"

/* Column counts of L by dense elimination of the pattern in the order of S. */
static int64_t dense_count(const test_matrix *M, const qc_symbolic *S, double *flops) {
    const int64_t n = M->n;
    cplx *A = dense_of(M, false);
    bool *B = calloc((size_t)(n * n) + 1, sizeof *B);
    for (int64_t i = 0; i < n * n; i++) B[S->inverse[i % n] + S->inverse[i / n] * n] = A[i] != 0;
    int64_t total = 0;
    *flops = 0;
    for (int64_t k = 0; k < n; k++) {
        int64_t count = 0;
        for (int64_t i = k + 1; i < n; i++) {
            if (!B[i + k * n]) continue;
            count++;
            for (int64_t j = k + 1; j < n; j++)
                if (B[j + k * n]) B[j + i * n] = true;
        }
        total += count + 1;
        *flops += (double)(count * (count + 1) + count);
    }
    free(A);
    free(B);
    return total;
}

static void check_structure(const qc_symbolic *S) {
    bool *seen = calloc((size_t)S->n + 1, sizeof *seen);
    for (int32_t k = 0; k < S->n; k++) {
        assert_int_equal(S->inverse[S->perm[k]], k);
        assert_false(seen[S->perm[k]]);
        seen[S->perm[k]] = true;
    }
    free(seen);
    assert_int_equal(S->super[S->nsuper], S->n);
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int64_t w = S->super[s + 1] - S->super[s], r = S->rowptr[s + 1] - S->rowptr[s];
        const int32_t *rows = S->rows + S->rowptr[s];
        assert_true(w >= 1 && r >= w);
        for (int64_t i = 0; i < r; i++) {
            assert_true(i == 0 || rows[i] > rows[i - 1]);
            if (i < w)
                assert_int_equal(rows[i], S->super[s] + i);
            else
                assert_int_equal(S->rows[S->rowptr[S->parent[s]] + S->relative[S->rowptr[s] + i]],
                                 rows[i]);
        }
        if (r > w)
            assert_int_equal(S->parent[s], S->super_of[rows[w]]);
        else
            assert_int_equal(S->parent[s], -1);
    }
}

static void counts_match_dense_elimination(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++)
        for (int32_t n = 0; n <= 90; n += n < 4 ? 1 : 29)
            for (int32_t ordering = 0; ordering < 2; ordering++) {
                test_matrix M = make_matrix(shape, n, 1);
                const qc_hermitian A = hermitian(&M);
                qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
                options.ordering = ordering;
                qc_symbolic *S = NULL;
                assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_OK);
                check_structure(S);
                qc_symbolic_info info;
                double flops;
                info.struct_size = sizeof info;
                qc_symbolic_get_info(S, &info);
                assert_int_equal(info.nnz_l, dense_count(&M, S, &flops));
                assert_true(info.flops == flops);
                assert_true(info.stored >= info.nnz_l);
                assert_int_equal(info.n, M.n);
                qc_symbolic_free(S);
                free_matrix(&M);
            }
    qc_ctx_free(ctx);
}

static void given_order_is_kept_up_to_equivalence(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 49, 1);
    const qc_hermitian A = hermitian(&M);
    qc_symbolic *amd = NULL, *given = NULL;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &amd), QC_OK);
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    options.ordering = QC_ORDER_GIVEN;
    options.permutation = amd->perm;
    assert_int_equal(qc_analyze(ctx, &A, &options, &given), QC_OK);
    assert_int_equal(given->nnz_l, amd->nnz_l);
    qc_symbolic_free(amd);
    qc_symbolic_free(given);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void bad_input_is_named(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    const int64_t colptr[] = {0, 1, 3, 5};
    int32_t row[] = {0, 0, 1, 1, 2};
    qc_hermitian A = {3, colptr, row, NULL};
    qc_symbolic *S = NULL, *const untouched = (qc_symbolic *)(void *)&S;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_OK);
    qc_symbolic_free(S);
    S = untouched;
    row[4] = 3;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 2);
    row[3] = 2, row[4] = 1;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_ERR_ARGUMENT);
    row[3] = 0, row[4] = 1; /* no diagonal */
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 2);
    row[3] = 1, row[4] = 2;
    const int32_t twice[] = {0, 1, 1};
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    options.ordering = QC_ORDER_GIVEN;
    options.permutation = twice;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 2);
    options.ordering = 99;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    assert_ptr_equal(S, untouched);
    qc_ctx_free(ctx);
}

/* The order read back leaves the same fill. */
static void permutation_can_be_given_back(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(RANDOM, 150, 1);
    const qc_hermitian A = hermitian(&M);
    qc_symbolic *S = NULL, *T = NULL;
    qc_symbolic_info first = QC_SYMBOLIC_INFO_INIT, second = QC_SYMBOLIC_INFO_INIT;
    int32_t order[150];
    bool seen[150] = {false};
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    assert_int_equal(qc_analyze(ctx, &A, NULL, &S), QC_OK);
    qc_symbolic_get_permutation(S, order);
    for (int k = 0; k < 150; k++) {
        assert_in_range(order[k], 0, 149);
        assert_false(seen[order[k]]);
        seen[order[k]] = true;
    }
    options.ordering = QC_ORDER_GIVEN;
    options.permutation = order;
    assert_int_equal(qc_analyze(ctx, &A, &options, &T), QC_OK);
    qc_symbolic_get_info(S, &first);
    qc_symbolic_get_info(T, &second);
    assert_int_equal(first.nnz_l, second.nnz_l);
    qc_symbolic_free(S);
    qc_symbolic_free(T);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_match_dense_elimination),
        cmocka_unit_test(given_order_is_kept_up_to_equivalence),
        cmocka_unit_test(bad_input_is_named),
        cmocka_unit_test(permutation_can_be_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
