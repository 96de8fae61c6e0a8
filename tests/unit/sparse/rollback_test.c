/* Roll back and transactions: every bit comes back, also of the forward solution. */
#include "triangles.h"

typedef struct fixture {
    qc_ctx *ctx;
    test_matrix M;
    int32_t (*triangle)[3], count;
    qc_factor *F;
    qc_complex *b, *y;
} fixture;

static fixture open_fixture(const char *instructions) {
    fixture X = {.ctx = new_ctx_with(1, instructions)};
    if (!X.ctx) return X;
    X.triangle = malloc(400 * sizeof *X.triangle);
    X.M = triangles(250, 40, X.triangle, &X.count);
    X.F = factor_of(X.ctx, &X.M, NULL);
    X.b = malloc((size_t)X.M.n * sizeof *X.b);
    X.y = malloc((size_t)X.M.n * sizeof *X.y);
    for (int32_t i = 0; i < X.M.n; i++) X.b[i] = (qc_complex){uniform(), uniform()};
    return X;
}

static void close_fixture(fixture *X) {
    qc_factor_free(X->F);
    free_matrix(&X->M);
    free(X->triangle);
    free(X->b);
    free(X->y);
    qc_ctx_free(X->ctx);
}

static uint64_t all_bits(fixture *X) {
    uint64_t hash = fingerprint(X->F), bits;
    double energy;
    if (qc_forward_get(X->ctx, X->F, X->y) != QC_OK) return hash;
    assert_int_equal(qc_forward_energy(X->ctx, X->F, &energy), QC_OK);
    for (int32_t i = 0; i < 2 * X->M.n; i++) {
        memcpy(&bits, (const double *)X->y + i, 8);
        hash = (hash ^ bits) * 1099511628211u;
    }
    memcpy(&bits, &energy, 8);
    return (hash ^ bits) * 1099511628211u;
}

static void random_step(fixture *X) {
    const flip f = random_flip(&X->M, X->triangle, X->count);
    const int32_t row[3] = {f.k, f.l, f.m};
    const qc_complex w[3] = {{uniform(), 1}, {uniform(), 0}, {0, uniform()}};
    const int sigma[2] = {1, 1};
    const int32_t start[3] = {0, 1, 3};
    switch (pick(4)) {
    case 0:
        assert_int_equal(qc_updown(X->ctx, X->F, 1, 3, row, w), QC_OK);
        break;
    case 1:
        assert_int_equal(qc_updown_many(X->ctx, X->F, 2, sigma, start, row, w), QC_OK);
        break;
    case 2:
        if (qc_forward_add(X->ctx, X->F, 3, row, w) == QC_OK) break;
        /* fall through */
    default:
        assert_int_equal(apply_flip(X->ctx, X->F, f), QC_OK);
    }
}

/* instruction set, with or without a forward solution */
static void last_modification(void **state) {
    (void)state;
    for (int run = 0; run < 6; run++) {
        fixture X = open_fixture(instruction_sets[run / 2]);
        if (!X.ctx) continue;
        if (run % 2) assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_OK);
        assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_ERR_ARGUMENT);
        for (int step = 0; step < 30; step++) {
            const uint64_t before = all_bits(&X);
            random_step(&X);
            assert_true(before != all_bits(&X));
            assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_OK);
            assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_ERR_ARGUMENT);
            assert_true(before == all_bits(&X));
            random_step(&X);
        }
        close_fixture(&X);
    }
}

static void transactions_nest(void **state) {
    (void)state;
    for (int attached = 0; attached < 2; attached++) {
        fixture X = open_fixture(NULL);
        if (attached) assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_OK);
        const uint64_t outer = all_bits(&X);
        assert_int_equal(qc_factor_begin(X.ctx, X.F), QC_OK);
        for (int i = 0; i < 10; i++) random_step(&X);
        const uint64_t inner = all_bits(&X);
        assert_int_equal(qc_factor_begin(X.ctx, X.F), QC_OK);
        for (int i = 0; i < 10; i++) random_step(&X);
        assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_OK);
        assert_true(inner == all_bits(&X));
        assert_int_equal(qc_factor_begin(X.ctx, X.F), QC_OK);
        for (int i = 0; i < 10; i++) random_step(&X);
        assert_int_equal(qc_factor_commit(X.ctx, X.F), QC_OK);
        assert_true(inner != all_bits(&X));
        assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_OK);
        assert_true(outer == all_bits(&X));
        assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_ERR_ARGUMENT);
        assert_int_equal(qc_factor_commit(X.ctx, X.F), QC_ERR_ARGUMENT);
        close_fixture(&X);
    }
}

static void an_error_undoes_itself_only(void **state) {
    (void)state;
    for (int attached = 0; attached < 2; attached++) {
        fixture X = open_fixture(NULL);
        if (attached) assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_OK);
        const uint64_t outer = all_bits(&X);
        assert_int_equal(qc_factor_begin(X.ctx, X.F), QC_OK);
        for (int i = 0; i < 20; i++) {
            random_step(&X);
            const uint64_t before = all_bits(&X);
            const flip f = random_flip(&X.M, X.triangle, X.count);
            const qc_complex far = {30 * entry(&X.M, f.k, f.k)->re, 1};
            assert_int_equal(qc_flip(X.ctx, X.F, f.k, f.l, far, f.m, far), QC_ERR_NOT_POSDEF);
            assert_true(before == all_bits(&X));
        }
        assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_OK);
        assert_true(outer == all_bits(&X));
        close_fixture(&X);
    }
}

static void a_new_factorisation_ends_transactions(void **state) {
    (void)state;
    fixture X = open_fixture(NULL);
    const qc_hermitian A = hermitian(&X.M);
    assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_OK);
    const uint64_t fresh = all_bits(&X);
    assert_int_equal(qc_factor_begin(X.ctx, X.F), QC_OK);
    for (int i = 0; i < 5; i++) random_step(&X);
    assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_detach(X.ctx, X.F), QC_ERR_ARGUMENT);
    assert_int_equal(qc_refactorize(X.ctx, X.F, &A), QC_OK);
    assert_int_equal(qc_factor_rollback(X.ctx, X.F), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_attach(X.ctx, X.F, X.b), QC_OK);
    assert_true(fresh == all_bits(&X));
    close_fixture(&X);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(last_modification),
        cmocka_unit_test(transactions_nest),
        cmocka_unit_test(an_error_undoes_itself_only),
        cmocka_unit_test(a_new_factorisation_ends_transactions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
