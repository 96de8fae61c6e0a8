/* The forward solution carried along: equal to a solve from the start, to the last bit to that of
 * its own kernels. */
#include "triangles.h"

static void random_vector(int32_t n, qc_complex *x) {
    for (int32_t i = 0; i < n; i++) x[i] = (qc_complex){uniform(), uniform()};
}

static double difference(int32_t n, const qc_complex *x, const qc_complex *y) {
    return max_difference(n, (const cplx *)x, (const cplx *)y) / max_abs(n, (const cplx *)x);
}

/* Flips, changes of b, both in one sweep; y against qc_solve_forward and against attaching anew. */
static void follows_flips(const char *instructions) {
    qc_ctx *ctx = new_ctx_with(1, instructions);
    if (!ctx) return;
    int32_t(*triangle)[3] = malloc(600 * sizeof *triangle), count;
    test_matrix M = triangles(300, 60, triangle, &count);
    const size_t size = (size_t)M.n * sizeof(qc_complex);
    qc_complex *b = malloc(size), *y = malloc(size), *x = malloc(size);
    qc_factor *F = factor_of(ctx, &M, NULL);
    double energy, again;
    random_vector(M.n, b);
    assert_int_equal(qc_forward_attach(ctx, F, b), QC_OK);
    for (int step = 0; step < 60; step++) {
        const flip f = random_flip(&M, triangle, count);
        const int32_t row[3] = {f.k, f.l, pick(M.n)};
        const qc_complex db[3] = {{uniform(), 0}, {0, uniform()}, {uniform(), uniform()}};
        if (step % 3) {
            assert_int_equal(qc_forward_add(ctx, F, 3, row, db), QC_OK);
            for (int i = 0; i < 3; i++) {
                b[row[i]].re += db[i].re;
                b[row[i]].im += db[i].im;
            }
        }
        if (step % 4) {
            assert_int_equal(apply_flip(ctx, F, f), QC_OK);
            add_flip(&M, f);
        }
        assert_int_equal(qc_forward_get(ctx, F, y), QC_OK);
        assert_int_equal(qc_forward_energy(ctx, F, &energy), QC_OK);
        memcpy(x, b, size);
        assert_int_equal(qc_solve_forward(ctx, F, 1, x), QC_OK);
        assert_true(difference(M.n, x, y) < 1e-13);
        double sum = 0;
        for (int32_t i = 0; i < M.n; i++) sum += x[i].re * x[i].re + x[i].im * x[i].im;
        assert_true(fabs(sum - energy) < 1e-13 * sum);
    }
    assert_int_equal(qc_forward_attach(ctx, F, b), QC_OK);
    assert_int_equal(qc_forward_get(ctx, F, x), QC_OK);
    assert_int_equal(qc_forward_energy(ctx, F, &again), QC_OK);
    assert_memory_equal(x, y, size);
    assert_true(energy == again);
    free(b);
    free(x);
    free(y);
    qc_factor_free(F);
    free_matrix(&M);
    free(triangle);
    qc_ctx_free(ctx);
}

static void equals_a_solve(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) follows_flips(instruction_sets[i]);
}

static void real_equals_a_solve(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 90, 1);
        const size_t size = (size_t)M.n * sizeof(double);
        double *b = malloc(size), *y = malloc(size), energy, sum = 0;
        qc_factor *F = real_factor_of(ctx, &M, NULL);
        for (int32_t i = 0; i < M.n; i++) b[i] = uniform();
        assert_int_equal(qc_forward_attach_real(ctx, F, b), QC_OK);
        for (int step = 0; step < 20; step++) {
            const int32_t row = pick(M.n);
            const double w = uniform();
            assert_int_equal(qc_forward_add_real(ctx, F, 1, &row, &w), QC_OK);
            b[row] += w;
            if (step % 2) assert_int_equal(qc_updown_real(ctx, F, 1, 1, &row, &w), QC_OK);
        }
        assert_int_equal(qc_forward_energy(ctx, F, &energy), QC_OK);
        assert_int_equal(qc_forward_get_real(ctx, F, y), QC_OK);
        assert_int_equal(qc_solve_forward_real(ctx, F, 1, b), QC_OK);
        for (int32_t i = 0; i < M.n; i++) {
            assert_true(fabs(b[i] - y[i]) < 1e-13);
            sum += b[i] * b[i];
        }
        assert_true(fabs(sum - energy) < 1e-13 * sum);
        free(b);
        free(y);
        qc_factor_free(F);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static void follows_a_new_factorisation(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, 100, 1), N = make_matrix(GRID, 100, 2);
    const qc_hermitian A = hermitian(&N);
    qc_complex b[100], x[100], y[100];
    qc_factor *F = factor_of(ctx, &M, NULL);
    random_vector(100, b);
    memcpy(x, b, sizeof x);
    assert_int_equal(qc_forward_attach(ctx, F, b), QC_OK);
    assert_int_equal(qc_refactorize(ctx, F, &A), QC_OK);
    assert_int_equal(qc_forward_get(ctx, F, y), QC_OK);
    assert_int_equal(qc_solve_forward(ctx, F, 1, x), QC_OK);
    assert_true(difference(100, x, y) < 1e-14);
    qc_factor_free(F);
    free_matrix(&M);
    free_matrix(&N);
    qc_ctx_free(ctx);
}

static void arguments_are_checked(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(PATH, 10, 1);
    qc_factor *F = factor_of(ctx, &M, NULL);
    qc_complex b[10] = {{1, 0}};
    const int32_t bad = 10, good = 3;
    double energy;
    assert_int_equal(qc_forward_energy(ctx, F, &energy), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_add(ctx, F, 1, &good, b), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_attach(ctx, F, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_attach_real(ctx, F, &energy), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_detach(ctx, F), QC_OK);
    assert_int_equal(qc_forward_attach(ctx, F, b), QC_OK);
    assert_int_equal(qc_forward_add(ctx, F, 1, &bad, b), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_add(ctx, F, -1, &good, b), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_get_real(ctx, F, &energy), QC_ERR_ARGUMENT);
    assert_int_equal(qc_forward_detach(ctx, F), QC_OK);
    assert_int_equal(qc_forward_get(ctx, F, b), QC_ERR_ARGUMENT);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_a_solve),
        cmocka_unit_test(real_equals_a_solve),
        cmocka_unit_test(follows_a_new_factorisation),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
