/* Enumeration of a window against brute force. */
#include "tests/unit/sparse/lattice_problem.h"

enum { N = 12, WIDTH = 5, REACH = 4 };

static double best_change(const qc__lattice *Q, const int32_t *index, double *y, int32_t k) {
    if (k == WIDTH) {
        double sum = 0;
        for (int i = 0; i < WIDTH; i++) {
            sum += Q->g[index[i]] * y[i];
            for (int j = 0; j < WIDTH; j++)
                sum += 0.5 * y[i] * y[j] * Q->P[index[i] + index[j] * N];
        }
        return sum;
    }
    double best = INFINITY;
    for (y[k] = -REACH; y[k] <= REACH; y[k]++) best = fmin(best, best_change(Q, index, y, k + 1));
    return best;
}

static void windows_are_solved_exactly(void **state) {
    (void)state;
    double P[N * N], t[N], z[N], g[N], y[WIDTH];
    int32_t gained = 0, far = 0;
    for (int trial = 0; trial < 60; trial++) {
        int32_t index[WIDTH];
        qc__lattice Q = {.n = N, .P = P, .t = t, .z = z, .g = g};
        int64_t work = 0;
        cone_problem(N, P, t);
        for (int i = 0; i < N; i++) z[i] = rint(t[i]);
        for (int i = 0; i < WIDTH; i++) index[i] = (trial + 7 * i) % N;
        const double before = qc__lattice_gradient(&Q);
        const double expected = best_change(&Q, index, y, 0);
        for (int i = 0; i < WIDTH; i++) y[i] = 0;
        const double change = qc__lattice_window(&Q, index, WIDTH, 1e-12, y, &work);
        /* brute force sees only steps up to REACH */
        assert_true(change <= fmin(expected, 0) + 1e-9 * before);
        assert_true(work > 0);
        for (int i = 0; i < WIDTH; i++) {
            z[index[i]] += y[i];
            far += fabs(y[i]) > 1;
        }
        const double after = qc__lattice_gradient(&Q);
        assert_true(fabs(after - before - change) <= 1e-9 * (before + 1));
        gained += change < 0;
        for (int i = 0; i < WIDTH; i++) y[i] = 7;
        assert_true(qc__lattice_window(&Q, index, WIDTH, 1e-9 * before, y, &work) == 0);
        for (int i = 0; i < WIDTH; i++) assert_true(y[i] == 7);
    }
    assert_true(gained > 10 && far > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(windows_are_solved_exactly)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
