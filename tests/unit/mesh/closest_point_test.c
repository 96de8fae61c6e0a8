/* Closest points by the built-in tree against a search; the answer does not depend on the start. */
#include <math.h>
#include <qc/closest_point.h>
#include <string.h>

#include "unit/mesh/fixtures.h"

static double unit(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24);
}

/* Distance to one triangle by a fine search over barycentric coordinates: an upper bound which is
 * close. */
static double searched_distance(const double *x, const int32_t *v, const double *p) {
    enum { STEPS = 60 };
    double best = INFINITY;
    for (int i = 0; i <= STEPS; i++)
        for (int j = 0; i + j <= STEPS; j++) {
            const double s = (double)i / STEPS, t = (double)j / STEPS;
            double sum = 0;
            for (int k = 0; k < 3; k++) {
                const double d = (1 - s - t) * x[3 * v[0] + k] + s * x[3 * v[1] + k] +
                                 t * x[3 * v[2] + k] - p[k];
                sum += d * d;
            }
            best = fmin(best, sqrt(sum));
        }
    return best;
}

/* Barycentric coordinates of a point at that distance. */
static void check_weights(const double *x, const int32_t *v, const double weight[3],
                          const double *p, double distance) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double at =
            weight[0] * x[3 * v[0] + i] + weight[1] * x[3 * v[1] + i] + weight[2] * x[3 * v[2] + i];
        sum += (at - p[i]) * (at - p[i]);
        assert_true(weight[i] >= 0);
    }
    assert_near(weight[0] + weight[1] + weight[2], 1, 1e-12);
    assert_near(sqrt(sum), distance, 1e-12);
}

static void the_tree_finds_the_closest_triangle(void **state) {
    enum { TRIANGLES = 60, POINTS = 40 };
    qc_ctx *ctx = *state;
    double x[9 * TRIANGLES], p[3 * POINTS];
    int32_t vertex[3 * TRIANGLES];
    uint32_t seed = 5;
    for (int t = 0; t < TRIANGLES; t++)
        for (int i = 0; i < 9; i++)
            x[9 * t + i] = (i < 3 ? unit(&seed) : x[9 * t + i % 3] + 0.2 * unit(&seed));
    memcpy(x + 9, x, 3 * sizeof *x); /* a needle and a point */
    memcpy(x + 12, x + 9, 3 * sizeof *x);
    memcpy(x + 24, x + 18, 3 * sizeof *x);
    memcpy(x + 21, x + 18, 3 * sizeof *x);
    for (int32_t i = 0; i < 3 * TRIANGLES; i++) vertex[i] = i;
    for (int i = 0; i < 3 * POINTS; i++) p[i] = 2 * unit(&seed) - 0.5;
    const qc_closest_point *closest = &qc_closest_point_builtin;
    qc_closest_tree *tree = NULL;
    assert_int_equal(closest->build(closest, ctx, TRIANGLES, x, vertex, &tree), QC_OK);
    for (int i = 0; i < POINTS; i++) {
        int32_t triangle = i;
        double weight[3];
        const double distance = closest->query(tree, p + 3 * i, &triangle, weight);
        double best = INFINITY;
        for (int t = 0; t < TRIANGLES; t++)
            best = fmin(best, searched_distance(x, vertex + 3 * t, p + 3 * i));
        assert_true(distance <= best + 1e-12);
        assert_true(distance > best - 0.01);
        check_weights(x, vertex + 3 * triangle, weight, p + 3 * i, distance);
    }
    closest->destroy(tree);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tree_finds_the_closest_triangle),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
