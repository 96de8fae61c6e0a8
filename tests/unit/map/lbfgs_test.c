/* L-BFGS: convex quadratics with and without preconditioner, Rosenbrock's valley, monotone energy.
 */
#include "tests/unit/map/seamless.h"
#include "sdk/map/untangle/lbfgs.h"

enum { N = 60 };

/* 1/2 sum_i w_i (x_i - i)^2 + 1/2 sum (x_i - x_{i+1} + 1)^2: minimum 0 at x_i = i. */
typedef struct quadratic {
    double weight[N];
    int32_t evaluations;
} quadratic;

static double quadratic_value(void *user, const double *x, double *gradient) {
    quadratic *q = user;
    double energy = 0;
    q->evaluations++;
    for (int i = 0; i < N; i++) {
        const double r = x[i] - i;
        energy += 0.5 * q->weight[i] * r * r;
        gradient[i] = q->weight[i] * r;
    }
    for (int i = 0; i + 1 < N; i++) {
        const double r = x[i] - x[i + 1] + 1;
        energy += 0.5 * r * r;
        gradient[i] += r;
        gradient[i + 1] -= r;
    }
    return energy;
}

static qc_status by_diagonal(qc_ctx *ctx, void *user, double *p) {
    const quadratic *q = user;
    (void)ctx;
    for (int i = 0; i < N; i++) p[i] /= q->weight[i] + 2;
    return QC_OK;
}

static qc_status refuse(qc_ctx *ctx, void *user, double *p) {
    (void)user;
    (void)p;
    return qc__fail(ctx, QC_ERR_FAILED, 3, "no preconditioner");
}

static quadratic ill_conditioned(void) {
    quadratic q = {.evaluations = 0};
    for (int i = 0; i < N; i++) q.weight[i] = pow(10.0, i % 5);
    return q;
}

static void a_convex_quadratic_is_minimised(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    int32_t steps[2];
    for (int with = 0; with < 2; with++) {
        quadratic q = ill_conditioned();
        const qc__lbfgs_problem problem = {N, &q, quadratic_value, with ? by_diagonal : NULL, NULL};
        double x[N] = {0}, energy = -1;
        must(ctx, qc__lbfgs(ctx, &problem, 2000, 1e-16, x, &energy, &steps[with]));
        for (int i = 0; i < N; i++) assert_true(fabs(x[i] - i) < 1e-6);
        assert_true(energy >= 0 && energy < 1e-12);
    }
    assert_true(steps[1] < steps[0]);
    qc_ctx_free(ctx);
}

static double rosenbrock(void *user, const double *x, double *gradient) {
    const double a = 1 - x[0], b = x[1] - x[0] * x[0];
    (void)user;
    gradient[0] = -2 * a - 400 * x[0] * b;
    gradient[1] = 200 * b;
    return a * a + 100 * b * b;
}

static void rosenbrocks_valley_is_followed(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    const qc__lbfgs_problem problem = {2, NULL, rosenbrock, NULL, NULL};
    const double start[][2] = {{-1.2, 1}, {5, -7}, {0, 0}, {-40, 30}};
    for (size_t i = 0; i < sizeof start / sizeof *start; i++) {
        double x[2] = {start[i][0], start[i][1]}, energy = -1;
        int32_t steps = 0;
        must(ctx, qc__lbfgs(ctx, &problem, 1000, 1e-15, x, &energy, &steps));
        assert_true(fabs(x[0] - 1) < 1e-5 && fabs(x[1] - 1) < 1e-5);
        assert_true(steps > 0 && steps < 300);
    }
    qc_ctx_free(ctx);
}

/* More steps never give a higher energy; zero steps change nothing. */
static void energy_falls_with_every_step(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    const qc__lbfgs_problem problem = {2, NULL, rosenbrock, NULL, NULL};
    double before = INFINITY;
    for (int32_t most = 0; most < 30; most++) {
        double x[2] = {-1.2, 1}, g[2], energy = -1;
        int32_t steps = -1;
        must(ctx, qc__lbfgs(ctx, &problem, most, 0, x, &energy, &steps));
        assert_true(steps <= most && energy <= before);
        assert_true(energy == rosenbrock(NULL, x, g));
        if (most == 0) assert_true(x[0] == -1.2 && x[1] == 1);
        before = energy;
    }
    qc_ctx_free(ctx);
}

static void a_minimum_is_left_alone(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    const qc__lbfgs_problem problem = {2, NULL, rosenbrock, NULL, NULL};
    double x[2] = {1, 1}, energy = -1;
    must(ctx, qc__lbfgs(ctx, &problem, 10, 1e-7, x, &energy, NULL));
    assert_true(x[0] == 1 && x[1] == 1 && energy == 0);
    qc_ctx_free(ctx);
}

static void an_error_of_the_preconditioner_is_passed_on(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    quadratic q = ill_conditioned();
    const qc__lbfgs_problem problem = {N, &q, quadratic_value, refuse, NULL};
    double x[N] = {0}, energy = 5;
    assert_int_equal(qc__lbfgs(ctx, &problem, 10, 1e-7, x, &energy, NULL), QC_ERR_FAILED);
    assert_true(energy == 5);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_convex_quadratic_is_minimised),
        cmocka_unit_test(rosenbrocks_valley_is_followed),
        cmocka_unit_test(energy_falls_with_every_step),
        cmocka_unit_test(a_minimum_is_left_alone),
        cmocka_unit_test(an_error_of_the_preconditioner_is_passed_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
