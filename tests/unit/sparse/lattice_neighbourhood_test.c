/* The search with a budget: optimal for few entries, far below single and triple steps for many,
 * repeatable, and bounded by its budget. */
#include "tests/unit/sparse/lattice_problem.h"

static double rounded(qc_ctx *ctx, int32_t n, const double *P, const double *t, int64_t budget,
                      uint64_t seed, double *z) {
    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
    qc_lattice_result result;
    options.budget = budget;
    options.seed = seed;
    assert_int_equal(qc_lattice_round(ctx, n, P, t, &options, z, &result), QC_OK);
    return result.energy;
}

static double best_of_all(int32_t n, const double *P, const double *t, double *z, int32_t k) {
    if (k == n) {
        double sum = 0;
        for (int64_t i = 0; i < n; i++)
            for (int64_t j = 0; j < n; j++)
                sum += 0.5 * (z[i] - t[i]) * P[i + j * n] * (z[j] - t[j]);
        return sum;
    }
    double best = INFINITY;
    for (z[k] = floor(t[k]) - 2; z[k] < t[k] + 3; z[k]++)
        best = fmin(best, best_of_all(n, P, t, z, k + 1));
    return best;
}

static void few_entries_are_optimal(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    double P[36], t[6], z[6];
    for (int trial = 0; trial < 30; trial++) {
        const int32_t n = 1 + trial % 6;
        cone_problem(n, P, t);
        const double best = best_of_all(n, P, t, z, 0);
        assert_true(rounded(ctx, n, P, t, -1, 0, z) <= best * (1 + 1e-9));
    }
    qc_ctx_free(ctx);
}

static void many_entries_are_below_triples(void **state) {
    (void)state;
    enum { N = 70 };
    qc_ctx *ctx = new_ctx(1);
    double *P = malloc(N * N * sizeof *P), t[N], z[N], triples = 0, search = 0, other = 0;
    for (int trial = 0; trial < 8; trial++) {
        cone_problem(N, P, t);
        triples += rounded(ctx, N, P, t, 0, 0, z);
        search += rounded(ctx, N, P, t, -1, 0, z);
        other += rounded(ctx, N, P, t, -1, 99, z);
    }
    assert_true(search < 0.95 * triples);
    assert_true(fabs(other - search) < 0.05 * search);
    free(P);
    qc_ctx_free(ctx);
}

static void results_repeat(void **state) {
    (void)state;
    enum { N = 60 };
    double *P = malloc(N * N * sizeof *P), t[N], z[N], again[N];
    cone_problem(N, P, t);
    for (int64_t budget = 1; budget <= 1000000; budget *= 1000)
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            qc_ctx *ctx = new_ctx(threads);
            rounded(ctx, N, P, t, budget, 5, threads == 1 ? z : again);
            if (threads > 1) assert_memory_equal(z, again, sizeof z);
            qc_ctx_free(ctx);
        }
    free(P);
}

/* The form is zero only at t: integers are found and stay. */
static void integers_stay(void **state) {
    (void)state;
    enum { N = 50 };
    qc_ctx *ctx = new_ctx(1);
    double *P = malloc(N * N * sizeof *P), t[N], z[N];
    cone_problem(N, P, t);
    for (int i = 0; i < N; i++) t[i] = rint(t[i] * 1000);
    assert_true(rounded(ctx, N, P, t, -1, 0, z) == 0);
    assert_memory_equal(z, t, sizeof z);
    free(P);
    qc_ctx_free(ctx);
}

static void older_options_are_read(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    double P[400], t[20], z[20], again[20];
    cone_problem(20, P, t);
    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
    options.struct_size = offsetof(qc_lattice_options, budget);
    options.budget = 1;
    options.seed = 77;
    assert_int_equal(qc_lattice_round(ctx, 20, P, t, &options, z, NULL), QC_OK);
    assert_int_equal(qc_lattice_round(ctx, 20, P, t, NULL, again, NULL), QC_OK);
    assert_memory_equal(z, again, sizeof z);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_entries_are_optimal), cmocka_unit_test(many_entries_are_below_triples),
        cmocka_unit_test(results_repeat),          cmocka_unit_test(integers_stay),
        cmocka_unit_test(older_options_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
