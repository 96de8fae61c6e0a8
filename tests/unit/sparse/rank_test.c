/* Rank-k modifications in one sweep: against the matrix, against single ones, all or nothing. */
#include "support.h"

enum { MOST = 9 };

/* k vectors with up to two rows each; row and w: 2 k */
typedef struct vectors {
    int32_t k, start[MOST + 1], row[2 * MOST];
    int sigma[MOST];
    qc_complex w[2 * MOST];
    double real[2 * MOST];
} vectors;

static vectors random_vectors(const test_matrix *M, int32_t k, double size) {
    vectors V = {.k = k};
    for (int32_t q = 0; q < k; q++) {
        int32_t *row = V.row + V.start[q];
        V.sigma[q] = pick(3) ? 1 : -1;
        V.start[q + 1] = V.start[q] + (q == 4 ? 0 : random_clique(M, row) ? 2 : 1);
    }
    for (int32_t i = 0; i < V.start[k]; i++) {
        V.w[i] = (qc_complex){size * uniform(), size * uniform()};
        V.real[i] = V.w[i].re;
    }
    return V;
}

static void add_all(test_matrix *M, const vectors *V) {
    for (int32_t q = 0; q < V->k; q++)
        add_square(M, V->sigma[q], V->start[q + 1] - V->start[q], V->row + V->start[q],
                   V->w + V->start[q]);
}

static void check(const qc_factor *F, const test_matrix *M) {
    const int64_t n2 = (int64_t)M->n * M->n;
    cplx *A = dense_of(M, F->components == 1), *B = reconstruct(F);
    assert_true(max_difference(n2, A, B) <= 1e-12 * (1 + max_abs(n2, A)));
    free(A);
    free(B);
}

static qc_status update(qc_ctx *ctx, qc_factor *F, const vectors *V) {
    return F->components == 1
               ? qc_updown_many_real(ctx, F, V->k, V->sigma, V->start, V->row, V->real)
               : qc_updown_many(ctx, F, V->k, V->sigma, V->start, V->row, V->w);
}

static void many_equal_refactorisation(void **state) {
    (void)state;
    for (int run = 0; run < 6; run++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[run / 2]);
        if (!ctx) continue;
        for (int shape = 0; shape < SHAPES; shape++) {
            test_matrix M = make_matrix(shape, 80, 1);
            qc_factor *F = run % 2 ? real_factor_of(ctx, &M, NULL) : factor_of(ctx, &M, NULL);
            for (int32_t k = 0; k <= MOST; k++) {
                const vectors V = random_vectors(&M, k, 0.3);
                const uint64_t before = fingerprint(F);
                const qc_status status = update(ctx, F, &V);
                if (status == QC_OK) {
                    add_all(&M, &V);
                } else {
                    assert_int_equal(status, QC_ERR_NOT_POSDEF);
                    assert_true(before == fingerprint(F));
                }
            }
            check(F, &M);
            qc_factor_free(F);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

/* The downdate alone fails, after the update it does not: updates go first in every column. */
static void updates_go_first(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 49, 0.1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    const int sigma[2] = {-1, 1};
    const int32_t start[3] = {0, 1, 2}, row[2] = {10, 10};
    const qc_complex w[2] = {{3, 0}, {0, 3}};
    assert_int_equal(qc_updown(ctx, F, -1, 1, row, w), QC_ERR_NOT_POSDEF);
    assert_int_equal(qc_updown_many(ctx, F, 1, sigma, start, row, w), QC_ERR_NOT_POSDEF);
    assert_true(before == fingerprint(F));
    assert_int_equal(qc_updown_many(ctx, F, 2, sigma, start, row, w), QC_OK);
    check(F, &M);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void arguments_are_checked(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(BLOCKS, 70, 1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    const int sigma[2] = {1, 1}, wrong[2] = {1, 2};
    const int32_t start[3] = {0, 1, 3}, row[3] = {0, 0, 60}, down[3] = {0, 2, 1};
    const qc_complex w[3] = {{1, 0}, {1, 0}, {1, 0}};
    assert_int_equal(qc_updown_many(ctx, F, 2, sigma, start, row, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many(ctx, F, 2, wrong, start, row, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many(ctx, F, 2, sigma, down, row, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many(ctx, F, -1, sigma, start, row, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many(ctx, F, 1, sigma, start, NULL, w), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many_real(ctx, F, 0, NULL, NULL, NULL, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_updown_many(ctx, F, 0, NULL, NULL, NULL, NULL), QC_OK);
    assert_true(before == fingerprint(F));
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static bool refuse(void *user, const char *stage, double fraction) {
    (void)stage;
    (void)fraction;
    return !*(bool *)user;
}

static void cancelling_changes_nothing(void **state) {
    (void)state;
    enum { RANK = 40 };
    bool stop = false;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.progress = refuse;
    options.user = &stop;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    test_matrix M = make_matrix(DENSE, 350, 1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    int sigma[RANK];
    int32_t start[RANK + 1], row[RANK];
    qc_complex w[RANK];
    for (int32_t q = 0; q < RANK; q++) {
        sigma[q] = 1;
        start[q] = row[q] = q;
        w[q] = (qc_complex){1, 1};
    }
    start[RANK] = RANK;
    stop = true;
    assert_int_equal(qc_updown_many(ctx, F, RANK, sigma, start, row, w), QC_ERR_CANCELLED);
    assert_true(before == fingerprint(F));
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_equal_refactorisation),
        cmocka_unit_test(updates_go_first),
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(cancelling_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
