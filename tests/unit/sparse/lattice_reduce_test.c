/* A reduced basis is a basis, stands for the same form and the same target, and is shorter. */
#include "tests/unit/sparse/lattice_problem.h"

enum { N = 40 };

/* Fraction-free elimination is exact while the integers are small: |det U| = 1 by inversion. */
static void assert_unimodular(const double *U) {
    double A[N * N], inverse[N * N] = {0};
    memcpy(A, U, sizeof A);
    for (int i = 0; i < N; i++) inverse[i + i * N] = 1;
    for (int k = 0; k < N; k++) {
        int pivot = k;
        for (int i = k; i < N; i++)
            if (fabs(A[i + k * N]) > fabs(A[pivot + k * N])) pivot = i;
        assert_true(A[pivot + k * N] != 0);
        for (int j = 0; j < N; j++) {
            const double a = A[k + j * N], b = inverse[k + j * N];
            A[k + j * N] = A[pivot + j * N], A[pivot + j * N] = a;
            inverse[k + j * N] = inverse[pivot + j * N], inverse[pivot + j * N] = b;
        }
        const double d = A[k + k * N];
        for (int j = 0; j < N; j++) A[k + j * N] /= d, inverse[k + j * N] /= d;
        for (int i = 0; i < N; i++) {
            const double f = A[i + k * N];
            for (int j = 0; j < N && i != k && f != 0; j++) {
                A[i + j * N] -= f * A[k + j * N];
                inverse[i + j * N] -= f * inverse[k + j * N];
            }
        }
    }
    for (int i = 0; i < N * N; i++) {
        assert_true(U[i] == rint(U[i]));
        assert_true(fabs(inverse[i] - rint(inverse[i])) < 1e-6);
    }
}

static void it_is_a_shorter_basis(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    double P[N * N], t[N], s[N], work[N * N];
    static double U[N * N], G[N * N];
    for (int trial = 0; trial < 4; trial++) {
        cone_problem(N, P, t);
        memcpy(s, t, sizeof s);
        const int64_t budget = trial == 3 ? 5000 : INT64_MAX; /* the last one ends early */
        qc__lattice_basis B = {N, U, G, s, 0, budget};
        assert_int_equal(qc__lattice_reduce(ctx, &B, P, work), QC_OK);
        assert_unimodular(U);
        double before = 0, after = 0;
        for (int i = 0; i < N; i++) {
            double sum = 0;
            for (int j = 0; j < N; j++) sum += U[i + j * N] * s[j];
            assert_true(fabs(sum - t[i]) < 1e-9);
            before += P[i + i * N];
            after += G[i + i * N];
            for (int j = 0; j < N; j++) {
                double g = 0;
                for (int k = 0; k < N; k++)
                    for (int l = 0; l < N; l++) g += U[k + i * N] * P[k + l * N] * U[l + j * N];
                assert_true(fabs(g - G[i + j * N]) < 1e-9 * (G[i + i * N] + G[j + j * N]));
                if (trial < 3 && i != j) /* pairs are reduced */
                    assert_true(fabs(G[i + j * N]) <= 0.5001 * G[i + i * N]);
            }
        }
        assert_true(after < before);
    }
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_a_shorter_basis)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
