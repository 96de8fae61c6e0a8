/* Matching flips (thesis 6.2.1) on matrices made of triangles, against refactorisation. */
#include "triangles.h"

static void flips_equal_refactorisation(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    int32_t(*triangle)[3] = malloc(600 * sizeof *triangle), count;
    test_matrix M = triangles(300, 60, triangle, &count);
    const int64_t n2 = (int64_t)M.n * M.n;
    qc_factor *F = factor_of(ctx, &M, NULL);
    for (int step = 0; step < 200; step++) {
        const flip f = random_flip(&M, triangle, count);
        assert_int_equal(apply_flip(ctx, F, f), QC_OK);
        add_flip(&M, f);
        if (step % 40 == 0 || step == 199) {
            cplx *A = dense_of(&M, false), *B = reconstruct(F);
            assert_true(max_difference(n2, A, B) < 1e-12 * max_abs(n2, A));
            free(A);
            free(B);
            qc_factor *fresh = factor_of(ctx, &M, NULL);
            for (int32_t i = 0; i < M.n; i++)
                assert_true(fabs(fresh->D[i] - F->D[i]) < 1e-11 * fresh->D[i]);
            qc_factor_free(fresh);
        }
    }
    qc_factor_free(F);
    free_matrix(&M);
    free(triangle);
    qc_ctx_free(ctx);
}

static void special_flips(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(DENSE, 5, 1);
    const qc_complex none = {0, 0}, d = {0.2, -0.3};
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    assert_int_equal(qc_flip(ctx, F, 0, 1, none, 2, none), QC_OK);
    assert_int_equal(qc_flip(ctx, F, 0, 0, d, 2, d), QC_ERR_ARGUMENT);
    assert_int_equal(qc_flip(ctx, F, 0, 1, d, 5, d), QC_ERR_ARGUMENT);
    assert_true(before == fingerprint(F));
    assert_int_equal(qc_flip(ctx, F, 3, 1, d, 1, d), QC_OK); /* both ends are one row */
    assert_int_equal(qc_flip(ctx, F, 0, 4, d, 2, none), QC_OK);
    add(&M, 3, 1, d);
    add(&M, 3, 1, d);
    add(&M, 0, 4, d);
    cplx *A = dense_of(&M, false), *B = reconstruct(F);
    assert_true(max_difference(25, A, B) < 1e-14 * max_abs(25, A));
    free(A);
    free(B);
    qc_factor_free(F);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void failed_flip_changes_nothing(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    int32_t(*triangle)[3] = malloc(600 * sizeof *triangle), count;
    test_matrix M = triangles(200, 40, triangle, &count);
    qc_factor *F = factor_of(ctx, &M, NULL);
    const uint64_t before = fingerprint(F);
    for (int32_t t = 0; t < count; t++) {
        const int32_t *v = triangle[t];
        const double far = 3 * entry(&M, v[0], v[0])->re + 3 * entry(&M, v[1], v[1])->re;
        const qc_complex d = {far, far};
        assert_int_equal(qc_flip(ctx, F, v[0], v[1], d, v[2], d), QC_ERR_NOT_POSDEF);
        assert_true(before == fingerprint(F));
    }
    qc_factor_free(F);
    free_matrix(&M);
    free(triangle);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flips_equal_refactorisation),
        cmocka_unit_test(special_flips),
        cmocka_unit_test(failed_flip_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
