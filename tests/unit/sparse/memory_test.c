/* Every allocation fails once: no leak, no crash, outputs untouched, factors as before. */
#include "support.h"

typedef struct counter {
    int64_t calls, fail_at, live;
} counter;

static void *counting_resize(void *user, void *p, size_t old_size, size_t new_size) {
    counter *c = user;
    (void)old_size;
    if (new_size == 0) {
        if (p) c->live--;
        free(p);
        return NULL;
    }
    if (++c->calls == c->fail_at) return NULL;
    if (!p) c->live++;
    void *q = realloc(p, new_size);
    assert_non_null(q);
    return q;
}

/* A transaction with a forward solution; whatever fails, rolling back gives the bits of before. */
static qc_status modify(qc_ctx *ctx, qc_factor *F, const int32_t row[2], const qc_complex w[2],
                        const qc_complex *b) {
    const uint64_t before = fingerprint(F);
    const int sigma[3] = {1, -1, 1};
    const int32_t start[4] = {0, 1, 1, 2};
    double energy;
    qc_status status = qc_forward_attach(ctx, F, b);
    if (status == QC_OK) status = qc_factor_begin(ctx, F);
    if (status != QC_OK) return status;
    status = qc_forward_add(ctx, F, 2, row, w);
    if (status == QC_OK) status = qc_forward_energy(ctx, F, &energy);
    if (status == QC_OK) status = qc_updown_many(ctx, F, 3, sigma, start, row, w);
    if (status == QC_OK) status = qc_updown(ctx, F, 1, 2, row, w);
    assert_int_equal(qc_factor_rollback(ctx, F), QC_OK);
    assert_true(before == fingerprint(F));
    return status;
}

static qc_status run_complex(qc_ctx *ctx, const test_matrix *M) {
    const qc_hermitian A = hermitian(M);
    qc_symbolic *S = NULL;
    qc_factor *F = NULL;
    int32_t row[2] = {M->row[M->colptr[5]], 5};
    const qc_complex w[2] = {{0.1, 0.2}, {0.3, 0}};
    qc_complex *x = calloc((size_t)M->n * 12, sizeof *x);
    int32_t *index = malloc((size_t)M->n * sizeof *index), count;
    double condition;
    x[3].re = 1;
    qc_status status = qc_analyze(ctx, &A, NULL, &S);
    assert_true((status == QC_OK) == (S != NULL));
    if (status == QC_OK) status = qc_factorize(ctx, S, &A, &F);
    assert_true((status == QC_OK) == (F != NULL));
    qc_symbolic_free(S);
    if (status == QC_OK) status = qc_refactorize(ctx, F, &A);
    const uint64_t before = status == QC_OK ? fingerprint(F) : 0;
    if (status == QC_OK) {
        status = qc_updown(ctx, F, 1, 2, row, w);
        if (status != QC_OK) assert_true(before == fingerprint(F));
    }
    if (status == QC_OK) status = modify(ctx, F, row, w, x);
    if (status == QC_OK) status = qc_solve(ctx, F, 1, x);
    if (status == QC_OK) status = qc_solve(ctx, F, 12, x);
    if (status == QC_OK)
        status = qc_solve_forward_sparse(ctx, F, 2, row, w, M->n, index, x, &count);
    if (status == QC_OK) status = qc_solve_entries(ctx, F, 2, row, w, 2, row, x);
    if (status == QC_OK) status = qc_solve_refined(ctx, F, &A, 1, 1, x, NULL);
    if (status == QC_OK) status = qc_condition(ctx, F, &A, &condition);
    qc_factor_free(F);
    free(x);
    free(index);
    return status;
}

static qc_status run_lattice(qc_ctx *ctx, const test_matrix *M) {
    (void)M;
    double P[16] = {4, 1, 0, 1, 1, 4, 1, 0, 0, 1, 4, 1, 1, 0, 1, 4};
    const double t[4] = {0.4, 0.5, -1.5, 2.2};
    double z[4] = {9, 9, 9, 9};
    const qc_status status = qc_lattice_round(ctx, 4, P, t, NULL, z, NULL);
    if (status != QC_OK) assert_true(z[0] == 9 && z[3] == 9);
    return status;
}

static void fail_every_allocation(qc_status run(qc_ctx *, const test_matrix *)) {
    test_matrix M = make_matrix(GRID, 900, 0.5);
    counter c = {0, -1, 0};
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.resize = counting_resize;
    options.user = &c;
    options.threads = 2;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    assert_int_equal(run(ctx, &M), QC_OK); /* the context starts its threads */
    const int64_t base = c.live;
    for (int64_t at = 1;; at++) {
        c.calls = 0;
        c.fail_at = at;
        const qc_status status = run(ctx, &M);
        assert_int_equal(c.live, base);
        if (c.calls < at) {
            assert_int_equal(status, QC_OK);
            break;
        }
        assert_int_equal(status, QC_ERR_NOMEM);
        assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_NOMEM);
    }
    qc_ctx_free(ctx);
    assert_int_equal(c.live, 0);
    free_matrix(&M);
}

static void factor_survives_failing_allocations(void **state) {
    (void)state;
    fail_every_allocation(run_complex);
}

static void second_refactorisation_allocates_nothing(void **state) {
    (void)state;
    test_matrix M = make_matrix(GRID, 2500, 0.5);
    counter c = {0, -1, 0};
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.resize = counting_resize;
    options.user = &c;
    options.threads = 2;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    const qc_hermitian A = hermitian(&M);
    qc_factor *F = factor_of(ctx, &M, NULL);
    assert_int_equal(qc_refactorize(ctx, F, &A), QC_OK);
    const uint64_t first = fingerprint(F);
    const int64_t calls = c.calls;
    assert_int_equal(qc_refactorize(ctx, F, &A), QC_OK);
    assert_int_equal(c.calls, calls);
    assert_true(first == fingerprint(F));
    qc_factor_free(F);
    qc_ctx_free(ctx);
    assert_int_equal(c.live, 0);
    free_matrix(&M);
}

static void lattice_survives_failing_allocations(void **state) {
    (void)state;
    fail_every_allocation(run_lattice);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(factor_survives_failing_allocations),
        cmocka_unit_test(second_refactorisation_allocates_nothing),
        cmocka_unit_test(lattice_survives_failing_allocations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
