/* Energies of one face: gradients against differences, minima at the target, the step to where a
 * face collapses. */
#include "sdk/map/untangle/face_energy.h"
#include "tests/unit/map/seamless.h"

enum { ROUNDS = 500 };

static void random_triangle(uint64_t *state, double size, qc_complex f[3]) {
    for (int k = 0; k < 3; k++) f[k] = (qc_complex){size * uniform(state), size * uniform(state)};
}
static double twice_area(const qc_complex f[3]) {
    return (f[1].re - f[0].re) * (f[2].im - f[0].im) - (f[2].re - f[0].re) * (f[1].im - f[0].im);
}
static void positive_triangle(uint64_t *state, qc_complex f[3]) {
    do random_triangle(state, 1, f);
    while (twice_area(f) < 0.1);
}
static void along(const qc_complex f[3], const qc_complex p[3], double t, qc_complex out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (qc_complex){f[k].re + t * p[k].re, f[k].im + t * p[k].im};
}
/* Counter-clockwise edges, opposite to the corners. */
static void edges_of(const qc_complex f[3], qc_complex e[3]) {
    for (int k = 0; k < 3; k++)
        e[k] = (qc_complex){f[(k + 2) % 3].re - f[(k + 1) % 3].re,
                            f[(k + 2) % 3].im - f[(k + 1) % 3].im};
}

static double energy(int kind, const qc_complex hat[3], double area, const qc_complex f[3],
                     qc_complex g[3]) {
    return kind == 0   ? qc__face_energy(hat, area, 0.1, 0, f, g)
           : kind == 1 ? qc__face_energy(hat, area, 0.2, 3, f, g)
                       : qc__face_barrier(hat, area, f, g);
}

static void gradients_are_slopes(void **state) {
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < ROUNDS; i++)
        for (int kind = 0; kind < 3; kind++) {
            qc_complex target[3], e[3], hat[3], f[3], p[3], g[3], unused[3], a[3], b[3];
            double area;
            positive_triangle(&random, target);
            edges_of(target, e);
            qc__target_hats(e, qc__thick_targets, hat, &area);
            if (kind == 2)
                positive_triangle(&random, f);
            else
                random_triangle(&random, 1, f);
            random_triangle(&random, 1, p);
            const double h = 1e-6, at = energy(kind, hat, area, f, g);
            double slope = 0;
            for (int k = 0; k < 3; k++) slope += g[k].re * p[k].re + g[k].im * p[k].im;
            along(f, p, h, a);
            along(f, p, -h, b);
            const double change =
                (energy(kind, hat, area, a, unused) - energy(kind, hat, area, b, unused)) / (2 * h);
            assert_true(fabs(change - slope) < 1e-4 * (fabs(slope) + fabs(at) + 1));
        }
}

/* At the target itself, turned or not, the energies are least; with a pull only where it is not
 * turned. */
static void targets_are_minima(void **state) {
    (void)state;
    uint64_t random = 8;
    for (int i = 0; i < ROUNDS; i++) {
        qc_complex f[3], e[3], hat[3], g[3], other[3];
        double area;
        positive_triangle(&random, f);
        edges_of(f, e);
        qc__target_hats(e, qc__thick_targets, hat, &area);
        assert_true(fabs(qc__jacobian_det(hat, f) - 1) < 1e-9 ||
                    fabs(area - 0.5 * twice_area(f)) > 1e-9); /* the latter: thickened */
        if (fabs(area - 0.5 * twice_area(f)) > 1e-9) continue;
        const double least = qc__face_barrier(hat, area, f, g);
        assert_true(fabs(least - 4 * area) < 1e-9 && fabs(g[0].re) + fabs(g[1].im) < 1e-9);
        for (int k = 0; k < 3; k++) other[k] = qc_quarter_turn(f[k], 1);
        assert_true(fabs(qc__face_barrier(hat, area, other, g) - least) < 1e-9);
        const double straight = qc__face_energy(hat, area, 0, 2, f, g);
        assert_true(fabs(straight - 2 * area) < 1e-9 && fabs(g[2].re) + fabs(g[0].im) < 1e-9);
        assert_true(qc__face_energy(hat, area, 0, 2, other, g) > straight + area);
    }
}

static void faces_are_positive_up_to_the_limit(void **state) {
    (void)state;
    uint64_t random = 21;
    int finite = 0;
    for (int i = 0; i < ROUNDS; i++) {
        qc_complex f[3], p[3], at[3];
        positive_triangle(&random, f);
        random_triangle(&random, 2, p);
        const double limit = qc__face_limit(f, p);
        assert_true(limit > 0);
        for (int k = 1; k < 50; k++) {
            along(f, p, (isfinite(limit) ? limit : 100) * 0.02 * k, at);
            assert_true(twice_area(at) > 0);
        }
        if (!isfinite(limit)) continue;
        finite++;
        along(f, p, limit, at);
        assert_true(fabs(twice_area(at)) < 1e-6 * (1 + limit * limit));
    }
    assert_true(finite > ROUNDS / 4);
    const qc_complex f[3] = {{0, 0}, {1, 0}, {0, 1}}, rest[3] = {{0, 0}, {0, 0}, {0, 0}};
    const qc_complex shift[3] = {{2, 1}, {2, 1}, {2, 1}}, down[3] = {{0, 0}, {0, 0}, {0, -2}};
    assert_true(isinf(qc__face_limit(f, rest)) && isinf(qc__face_limit(f, shift)));
    assert_true(fabs(qc__face_limit(f, down) - 0.5) < 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_are_slopes),
        cmocka_unit_test(targets_are_minima),
        cmocka_unit_test(faces_are_positive_up_to_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
