/* Matching flips (thesis 6.2.1) on matrices made of triangles, against refactorisation. */
#include "support.h"

/* Strip of triangles (t, t+1, t+2) and some random ones; every triangle is a clique. */
static test_matrix triangles(int32_t n, int32_t extra, int32_t (*triangle)[3], int32_t *count) {
    int32_t(*edge)[2] = malloc((size_t)(n + extra) * 3 * sizeof *edge);
    int64_t ne = 0;
    *count = 0;
    for (int32_t t = 0; t < n - 2 + extra; t++) {
        int32_t a = t, b = t + 1, c = t + 2;
        if (t >= n - 2) a = pick(n), b = pick(n), c = pick(n);
        if (a == b || b == c || a == c) continue;
        triangle[*count][0] = a, triangle[*count][1] = b, triangle[(*count)++][2] = c;
        edge[ne][0] = a, edge[ne++][1] = b;
        edge[ne][0] = b, edge[ne++][1] = c;
        edge[ne][0] = c, edge[ne++][1] = a;
    }
    test_matrix M = from_edges(n, ne, (const int32_t(*)[2])edge, 1.0);
    free(edge);
    return M;
}

static qc_complex *entry(test_matrix *M, int32_t row, int32_t column) {
    int64_t p = M->colptr[column];
    while (M->row[p] != row) p++;
    return &M->val[p];
}

/* D(k,l) += d and the conjugate */
static void add(test_matrix *M, int32_t k, int32_t l, qc_complex d) {
    qc_complex *a = k < l ? entry(M, k, l) : entry(M, l, k);
    a->re += d.re;
    a->im += k < l ? d.im : -d.im;
}

/* Turns A(k,l) by i^r, as a flip of the matching does. */
static qc_complex turn(test_matrix *M, int32_t k, int32_t l, int r) {
    const qc_complex *a = k < l ? entry(M, k, l) : entry(M, l, k);
    const cplx x = a->re + I * (k < l ? a->im : -a->im);
    const cplx powers[4] = {1, I, -1, -I}, d = x * powers[r] - x;
    return (qc_complex){creal(d), cimag(d)};
}

static void flips_equal_refactorisation(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    int32_t(*triangle)[3] = malloc(600 * sizeof *triangle), count;
    test_matrix M = triangles(300, 60, triangle, &count);
    const int64_t n2 = (int64_t)M.n * M.n;
    qc_factor *F = factor_of(ctx, &M, NULL);
    for (int step = 0; step < 200; step++) {
        const int32_t *t = triangle[pick(count)], at = pick(3);
        const int32_t k = t[at], l = t[(at + 1) % 3], m = t[(at + 2) % 3];
        const int r = 1 + pick(3);
        const qc_complex dl = turn(&M, k, l, r), dm = turn(&M, k, m, r);
        assert_int_equal(qc_flip(ctx, F, k, l, dl, m, dm), QC_OK);
        add(&M, k, l, dl);
        add(&M, k, m, dm);
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
