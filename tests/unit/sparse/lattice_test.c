/* Lattice rounding against brute force, greedy start against a dense reference. */
#include "support.h"

/* P = B^T B + shift, with strong couplings for small shift. */
static void random_problem(int32_t n, double shift, double *P, double *t) {
    double *B = malloc((size_t)n * (size_t)n * sizeof *B);
    for (int64_t i = 0; i < (int64_t)n * n; i++) B[i] = uniform();
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double sum = i == j ? shift : 0;
            for (int64_t k = 0; k < n; k++) sum += B[k + i * n] * B[k + j * n];
            P[i + j * n] = sum;
        }
    for (int64_t i = 0; i < n; i++) t[i] = 5 * uniform();
    free(B);
}

static double energy(int32_t n, const double *P, const double *t, const double *z) {
    double sum = 0;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) sum += 0.5 * (z[i] - t[i]) * P[i + j * n] * (z[j] - t[j]);
    return sum;
}

/* Best energy over all changes of up to `radius` entries by +-1. */
static double best_neighbour(int32_t n, const double *P, const double *t, double *z, int32_t radius,
                             int32_t from) {
    double best = energy(n, P, t, z);
    for (int32_t i = from; i < n && radius > 0; i++) {
        const double kept = z[i];
        for (int sign = -1; sign <= 1; sign += 2) {
            z[i] = kept + sign;
            best = fmin(best, best_neighbour(n, P, t, z, radius - 1, i + 1));
        }
        z[i] = kept;
    }
    return best;
}

static void result_is_locally_optimal(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    double P[144], t[12], z[12];
    for (int32_t n = 1; n <= 12; n++)
        for (int trial = 0; trial < 6; trial++)
            for (int32_t start = 0; start < 2; start++) {
                double last = INFINITY;
                random_problem(n, trial % 2 ? 0.02 : 1, P, t);
                for (int32_t radius = 0; radius <= 3; radius++) {
                    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
                    qc_lattice_result result;
                    options.start = start;
                    options.radius = radius;
                    assert_int_equal(qc_lattice_round(ctx, n, P, t, &options, z, &result), QC_OK);
                    const double e = energy(n, P, t, z);
                    assert_true(fabs(e - result.energy) <= 1e-12 * (1 + e));
                    for (int32_t i = 0; i < n; i++) assert_true(z[i] == floor(z[i]));
                    if (radius == 0 && start == QC_ROUND_DIRECT)
                        assert_true(result.energy == result.energy_direct);
                    const double best = best_neighbour(n, P, t, z, radius, 0);
                    assert_true(best >= e - 1e-10 * (1 + e));
                    if (radius == 1) last = e;
                    if (radius > 1) assert_true(e <= last * (1 + 1e-12) + 1e-12);
                }
            }
    qc_ctx_free(ctx);
}

/* Solves M x = b for a small symmetric positive definite M by elimination. */
static void dense_solve(int n, double *M, double *b) {
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            const double f = M[i + k * n] / M[k + k * n];
            for (int j = k; j < n; j++) M[i + j * n] -= f * M[k + j * n];
            b[i] -= f * b[k];
        }
    for (int k = n; k-- > 0;) {
        for (int j = k + 1; j < n; j++) b[k] -= M[k + j * n] * b[j];
        b[k] /= M[k + k * n];
    }
}

/* Free values and energy once the fixed entries are at z. */
static double relax(int n, const double *P, const double *t, const bool *fixed, const double *z,
                    double *x) {
    double M[900], b[30];
    int at[30], m = 0;
    for (int i = 0; i < n; i++)
        if (!fixed[i]) at[m++] = i;
    for (int i = 0; i < m; i++) {
        b[i] = 0;
        for (int j = 0; j < n; j++)
            if (fixed[j]) b[i] -= P[at[i] + j * n] * (z[j] - t[j]);
        for (int j = 0; j < m; j++) M[i + j * m] = P[at[i] + at[j] * n];
    }
    dense_solve(m, M, b);
    for (int j = 0; j < n; j++) x[j] = z[j];
    for (int i = 0; i < m; i++) x[at[i]] = t[at[i]] + b[i];
    return energy(n, P, t, x);
}

static void greedy_fixes_the_cheapest(void **state) {
    (void)state;
    enum { N = 30 };
    qc_ctx *ctx = new_ctx(1);
    for (int n = 1; n <= N; n += n < 10 ? 3 : 10) {
        double P[N * N], t[N], z[N], expected[N], x[N];
        bool fixed[N] = {false};
        random_problem(n, 0.3, P, t);
        (void)relax(n, P, t, fixed, t, x);
        for (int step = 0; step < n; step++) {
            double best = INFINITY, y[N];
            int at = -1;
            for (int i = 0; i < n; i++) {
                if (fixed[i]) continue;
                fixed[i] = true;
                expected[i] = floor(x[i] + 0.5);
                const double e = relax(n, P, t, fixed, expected, y);
                if (e < best) best = e, at = i;
                fixed[i] = false;
            }
            fixed[at] = true;
            (void)relax(n, P, t, fixed, expected, x);
        }
        qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
        options.radius = 0;
        assert_int_equal(qc_lattice_round(ctx, n, P, t, &options, z, NULL), QC_OK);
        for (int i = 0; i < n; i++) assert_true(z[i] == expected[i]);
    }
    qc_ctx_free(ctx);
}

static void larger_problem_is_finished_and_optimal(void **state) {
    (void)state;
    enum { N = 150 };
    qc_ctx *ctx = new_ctx(1);
    double *P = malloc(N * N * sizeof *P), t[N], z[N], again[N];
    random_problem(N, 5, P, t);
    for (int scale = 0; scale < 2; scale++) { /* 2^-20: the same bits of z are needed */
        qc_lattice_result result;
        assert_int_equal(qc_lattice_round(ctx, N, P, t, NULL, scale ? again : z, &result), QC_OK);
        assert_true(result.energy <= result.energy_direct);
        for (int i = 0; i < N * N; i++) P[i] = ldexp(P[i], -20);
    }
    assert_memory_equal(z, again, sizeof z);
    assert_true(best_neighbour(N, P, t, z, 1, 0) >= energy(N, P, t, z) * (1 - 1e-9));
    free(P);
    qc_ctx_free(ctx);
}

/* Smallest change by exactly three entries, from the formula of thesis 6.3.1. */
static double best_triple(int32_t n, const double *P, const double *t, const double *z) {
    double *g = calloc((size_t)n, sizeof *g), best = INFINITY;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) g[i] += P[i + j * n] * (z[j] - t[j]);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = i + 1; j < n; j++)
            for (int64_t k = j + 1; k < n; k++)
                for (int signs = 0; signs < 8; signs++) {
                    const double a = signs & 1 ? 1 : -1, b = signs & 2 ? 1 : -1,
                                 c = signs & 4 ? 1 : -1;
                    best = fmin(best, 0.5 * (P[i + i * n] + P[j + j * n] + P[k + k * n]) +
                                          a * g[i] + b * g[j] + c * g[k] + a * b * P[i + j * n] +
                                          a * c * P[i + k * n] + b * c * P[j + k * n]);
                }
    free(g);
    return best;
}

/* Random forms, and entries which interact like points of the plane: strong couplings. */
static void pruning_misses_no_triple(void **state) {
    (void)state;
    enum { N = 50 };
    qc_ctx *ctx = new_ctx(1);
    double *P = malloc(N * N * sizeof *P), t[N], z[N];
    int improved = 0;
    for (int trial = 0; trial < 12; trial++) {
        double place[2 * N], energy_of[2];
        random_problem(N, 0.1, P, t);
        for (int i = 0; i < 2 * N; i++) place[i] = uniform();
        for (int i = 0; i < N && trial % 4; i++) {
            for (int j = 0; j < N; j++)
                P[i + j * N] = (trial % 2 && (i + j) % 2 ? -1 : 1) *
                                   exp(-(1 + trial) * hypot(place[2 * i] - place[2 * j],
                                                            place[2 * i + 1] - place[2 * j + 1])) +
                               (i == j ? 0.01 : 0);
        }
        for (int32_t radius = 2; radius <= 3; radius++) {
            qc_lattice_options options = {sizeof options, trial % 3 ? QC_ROUND_DIRECT : 1, radius,
                                          trial % 4 < 2 ? 0 : -1, 1};
            assert_int_equal(qc_lattice_round(ctx, N, P, t, &options, z, NULL), QC_OK);
            energy_of[radius - 2] = energy(N, P, t, z);
        }
        improved += energy_of[1] < energy_of[0] * (1 - 1e-9);
        assert_true(best_triple(N, P, t, z) >= -1e-9 * energy_of[1]);
        assert_true(best_neighbour(N, P, t, z, 2, 0) >= energy_of[1] * (1 - 1e-9));
    }
    assert_true(improved > 0);
    free(P);
    qc_ctx_free(ctx);
}

static bool stop(void *user, const char *stage, double fraction) {
    int *left = user;
    (void)stage;
    (void)fraction;
    return (*left)-- > 0;
}

static void errors(void **state) {
    (void)state;
    int left = 0;
    qc_ctx *ctx = NULL;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = stop;
    options.user = &left;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    double P[400], t[20], z[20] = {7};
    random_problem(20, 1, P, t);
    for (int reports = 0; reports < 1000; reports++) {
        left = reports;
        const qc_status status = qc_lattice_round(ctx, 20, P, t, NULL, z, NULL);
        if (status == QC_OK) break;
        assert_int_equal(status, QC_ERR_CANCELLED);
        assert_true(z[0] == 7);
        qc_ctx_free(ctx);
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    }
    left = 1000000;
    assert_int_equal(qc_lattice_round(ctx, 0, NULL, NULL, NULL, NULL, NULL), QC_OK);
    P[5 + 5 * 20] = -1;
    assert_int_equal(qc_lattice_round(ctx, 20, P, t, NULL, z, NULL), QC_ERR_NOT_POSDEF);
    assert_int_equal(qc_ctx_error(ctx)->where, 5);
    t[3] = NAN;
    assert_int_equal(qc_lattice_round(ctx, 20, P, t, NULL, z, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 3);
    qc_lattice_options wide = QC_LATTICE_OPTIONS_INIT;
    wide.radius = 4;
    assert_int_equal(qc_lattice_round(ctx, 20, P, t, &wide, z, NULL), QC_ERR_ARGUMENT);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(result_is_locally_optimal),
        cmocka_unit_test(greedy_fixes_the_cheapest),
        cmocka_unit_test(larger_problem_is_finished_and_optimal),
        cmocka_unit_test(pruning_misses_no_triple),
        cmocka_unit_test(errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
