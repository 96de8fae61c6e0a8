/* Sparse right-hand sides: the reach, values equal to those of dense solves, wanted entries. */
#include "support.h"

enum { N = 200, NB = 6 };

/* y on the reach has the bits of the dense forward solve, which is zero elsewhere. */
static void forward_equals_dense_forward(void **state) {
    (void)state;
    for (size_t set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        for (int shape = 0; ctx && shape < SHAPES; shape++) {
            test_matrix M = make_matrix(shape, 150, 0.2);
            qc_factor *F = factor_of(ctx, &M, NULL);
            for (int32_t nb = 0; nb < NB; nb++) {
                int32_t row[NB], index[N], count = -1, again = -1, q = 0;
                qc_complex b[NB], y[N], dense[N];
                memset(dense, 0, sizeof dense);
                for (int32_t p = 0; p < nb; p++) {
                    row[p] = pick(M.n); /* may repeat: entries add */
                    b[p] = (qc_complex){uniform(), uniform()};
                    dense[row[p]].re += b[p].re;
                    dense[row[p]].im += b[p].im;
                }
                assert_int_equal(qc_solve_forward_sparse(ctx, F, nb, row, b, 0, NULL, NULL, &count),
                                 QC_OK);
                assert_in_range(count, nb > 0, M.n);
                if (count > 1)
                    assert_int_equal(
                        qc_solve_forward_sparse(ctx, F, nb, row, b, count - 1, index, y, &again),
                        QC_ERR_ARGUMENT);
                assert_int_equal(
                    qc_solve_forward_sparse(ctx, F, nb, row, b, count, index, y, &again), QC_OK);
                assert_int_equal(count, again);
                assert_int_equal(qc_solve_forward(ctx, F, 1, dense), QC_OK);
                for (int32_t i = 0; i < M.n; i++) {
                    const bool reached = q < count && index[q] == i;
                    assert_true(dense[i].re == (reached ? y[q].re : 0));
                    assert_true(dense[i].im == (reached ? y[q].im : 0));
                    q += reached;
                }
                assert_int_equal(q, count);
            }
            qc_factor_free(F);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

static void real_forward_equals_dense_forward(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 150, 0.2);
        qc_factor *F = real_factor_of(ctx, &M, NULL);
        const int32_t row[2] = {pick(M.n), pick(M.n)};
        const double b[2] = {uniform(), uniform()};
        double dense[N] = {0}, y[N];
        int32_t index[N], count;
        dense[row[0]] += b[0];
        dense[row[1]] += b[1];
        assert_int_equal(qc_solve_forward_real(ctx, F, 1, dense), QC_OK);
        assert_int_equal(qc_solve_forward_sparse_real(ctx, F, 2, row, b, N, index, y, &count),
                         QC_OK);
        for (int32_t q = 0; q < count; q++) {
            assert_true(dense[index[q]] == y[q]);
            dense[index[q]] = 0;
        }
        for (int32_t i = 0; i < M.n; i++) assert_true(dense[i] == 0);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void wanted_entries_equal_the_dense_solve(void **state) {
    (void)state;
    for (size_t set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        for (int shape = 0; ctx && shape < SHAPES; shape++) {
            test_matrix M = make_matrix(shape, 150, 0.2);
            qc_factor *F = factor_of(ctx, &M, NULL), *G = real_factor_of(ctx, &M, NULL);
            for (int32_t nb = 0; nb < NB; nb++) {
                int32_t row[NB], want[NB];
                qc_complex b[NB], x[NB], dense[N];
                double br[NB], xr[NB], dense_real[N] = {0};
                memset(dense, 0, sizeof dense);
                for (int32_t p = 0; p < NB; p++) want[p] = pick(M.n);
                for (int32_t p = 0; p < nb; p++) {
                    row[p] = p ? pick(M.n) : want[0];
                    b[p] = (qc_complex){uniform(), uniform()};
                    br[p] = b[p].re;
                    dense[row[p]].re += b[p].re;
                    dense[row[p]].im += b[p].im;
                    dense_real[row[p]] += br[p];
                }
                assert_int_equal(qc_solve_entries(ctx, F, nb, row, b, NB, want, x), QC_OK);
                assert_int_equal(qc_solve_entries_real(ctx, G, nb, row, br, NB, want, xr), QC_OK);
                assert_int_equal(qc_solve(ctx, F, 1, dense), QC_OK);
                assert_int_equal(qc_solve_real(ctx, G, 1, dense_real), QC_OK);
                for (int32_t p = 0; p < NB; p++) {
                    assert_true(x[p].re == dense[want[p]].re && x[p].im == dense[want[p]].im);
                    assert_true(xr[p] == dense_real[want[p]]);
                }
            }
            qc_factor_free(F);
            qc_factor_free(G);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

static void wrong_rows_are_refused(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(PATH, 10, 1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const int32_t bad[2] = {10, -1}, good = 3;
    const qc_complex one = {1, 0};
    qc_complex y[10];
    int32_t index[10], count;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(qc_solve_forward_sparse(ctx, F, 1, &bad[k], &one, 10, index, y, &count),
                         QC_ERR_ARGUMENT);
        assert_int_equal(qc_ctx_error(ctx)->where, bad[k]);
        assert_int_equal(qc_solve_entries(ctx, F, 1, &good, &one, 1, &bad[k], y), QC_ERR_ARGUMENT);
    }
    assert_int_equal(qc_solve_entries(ctx, F, -1, &good, &one, 1, &good, y), QC_ERR_ARGUMENT);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_equals_dense_forward),
        cmocka_unit_test(real_forward_equals_dense_forward),
        cmocka_unit_test(wanted_entries_equal_the_dense_solve),
        cmocka_unit_test(wrong_rows_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
