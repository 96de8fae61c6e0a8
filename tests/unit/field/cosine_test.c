/* Nonlinear smoothing (2007 paper, 4.3): slope against differences, descent to a critical point,
 * smooth fields stay, quarter turns of single crosses do not matter. */
#include "surfaces.h"
#include "unit/mesh/failing_allocator.h"

#include "sdk/field/internal.h"

typedef struct start {
    qc_mesh *mesh;
    qc_complex *x;
    double *weight;
    uint8_t *trusted;
    qc__cosine c;
    size_t F;
} start;

static start create(qc_ctx *ctx, qc_mesh *mesh, double lambda, uint64_t seed) {
    start s = {.mesh = mesh, .x = random_crosses(mesh, seed), .F = (size_t)mesh->n_faces};
    s.weight = malloc(s.F * sizeof *s.weight);
    s.trusted = malloc(s.F);
    for (size_t t = 0; t < s.F; t++) {
        s.weight[t] = uniform(&seed);
        s.trusted[t] = uniform(&seed) < 0.7;
    }
    assert_int_equal(qc__cosine_create(ctx, mesh, s.weight, s.trusted, lambda, s.x, &s.c), QC_OK);
    return s;
}

static void release(start *s) {
    qc__cosine_free(&s->c);
    qc_object_release(s->mesh);
    free(s->x);
    free(s->weight);
    free(s->trusted);
}

/* The energy of the header, from nothing but the matching of the crosses turned by alpha. */
static double energy_of_turned(qc_ctx *ctx, const start *s, const double *alpha, double lambda) {
    const qc_mesh *mesh = s->mesh;
    const double l2 = mesh->area / 1e4;
    double *area = malloc(s->F * sizeof *area), energy = 0;
    qc_complex *x = malloc(s->F * sizeof *x);
    assert_int_equal(qc_mesh_geometry(ctx, mesh, NULL, area, NULL, NULL, NULL, NULL), QC_OK);
    for (size_t t = 0; t < s->F; t++) {
        const double a = atan2(s->x[t].im, s->x[t].re) + alpha[t];
        x[t] = (qc_complex){cos(a), sin(a)};
        if (s->trusted[t])
            energy += (1 - lambda) * s->weight[t] * area[t] / l2 * alpha[t] * alpha[t];
    }
    qc_matching *m = match(ctx, mesh, x);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t *h = mesh->edge_halfedge + 2 * (size_t)e;
        if (h[1] >= 0)
            energy +=
                lambda * (area[h[0] / 3] + area[h[1] / 3]) / (3 * l2) * (1 - cos(4 * m->theta[e]));
    }
    qc_object_release(m);
    free(area);
    free(x);
    return energy;
}

static void the_slope_is_the_derivative(void **state) {
    qc_ctx *ctx = *state;
    const double lambda = 0.6, step = 1e-5;
    start s = create(ctx, ellipsoid(ctx, 10, 7, 1, 2, 3), lambda, 3);
    double *alpha = malloc(s.F * sizeof *alpha), *slope = malloc(s.F * sizeof *slope);
    double *unused = malloc(s.F * sizeof *unused);
    uint64_t seed = 5;
    for (size_t t = 0; t < s.F; t++) alpha[t] = 2 * uniform(&seed) - 1;
    const double energy = qc__cosine_energy(&s.c, alpha, slope);
    assert_true(fabs(energy - energy_of_turned(ctx, &s, alpha, lambda)) < 1e-10 * energy);
    for (size_t t = 0; t < s.F; t++) {
        const double here = alpha[t];
        alpha[t] = here + step;
        const double up = qc__cosine_energy(&s.c, alpha, unused);
        alpha[t] = here - step;
        const double down = qc__cosine_energy(&s.c, alpha, unused);
        alpha[t] = here;
        assert_true(fabs((up - down) / (2 * step) - slope[t]) < 1e-7 * energy);
    }
    free(alpha);
    free(slope);
    free(unused);
    release(&s);
}

static void rounds_fall_to_a_critical_point(void **state) {
    qc_ctx *ctx = *state;
    const double lambda[] = {0.02, 0.5, 0.99, 1};
    for (int i = 0; i < 8; i++) {
        qc_mesh *mesh = i % 2 ? grid(ctx, CYLINDER, 20, 10, 1) : ellipsoid(ctx, 20, 12, 1, 2, 3);
        start s = create(ctx, mesh, lambda[i / 2], 11);
        double *slope = malloc(s.F * sizeof *slope), largest = 0;
        const double first = qc__cosine_energy(&s.c, s.c.alpha, slope);
        double energy = first;
        bool changed = true;
        int rounds = 0;
        for (; changed && rounds < 200; rounds++) {
            assert_int_equal(qc__cosine_round(ctx, &s.c, &changed), QC_OK);
            const double now = qc__cosine_energy(&s.c, s.c.alpha, slope);
            assert_true(changed ? now < energy : now <= energy);
            energy = now;
        }
        assert_true(rounds < 200);
        assert_true(energy < 0.9 * first);
        for (size_t t = 0; t < s.F; t++) largest = fmax(largest, fabs(slope[t]));
        assert_true(largest < 1e-4 * first);
        free(slope);
        release(&s);
    }
}

/* Parallel on a plane and along the meridians of a cylinder: nothing turns, to the last bit. */
static void smooth_fields_stay(void **state) {
    qc_ctx *ctx = *state;
    for (int kind = PLANE; kind <= CYLINDER; kind++) {
        qc_mesh *mesh = grid(ctx, kind, 12, 7, 1);
        const size_t F = (size_t)mesh->n_faces;
        qc_complex *x = random_crosses(mesh, 1), *before = malloc(F * sizeof *before);
        double *real = malloc(3 * F * sizeof *real), *imaginary = malloc(3 * F * sizeof *imaginary);
        assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
        for (size_t t = 0; t < F; t++) {
            x[t] = in_frame(real, imaginary, t, (double[3]){0, kind == PLANE, kind != PLANE});
            const double r = hypot(x[t].re, x[t].im);
            x[t] = (qc_complex){x[t].re / r, x[t].im / r};
        }
        memcpy(before, x, F * sizeof *x);
        assert_int_equal(qc_field_smooth_cosine(ctx, mesh, NULL, NULL, 1, 50, x), QC_OK);
        for (size_t t = 0; t < F; t++)
            assert_true(hypot(x[t].re - before[t].re, x[t].im - before[t].im) < 1e-12);
        free(x);
        free(before);
        free(real);
        free(imaginary);
        qc_object_release(mesh);
    }
}

/* Each cross turned by quarters of its own: the same crosses come out, turned as much. */
static void quarter_turns_do_not_matter(void **state) {
    qc_ctx *ctx = *state;
    start s = create(ctx, ellipsoid(ctx, 20, 12, 1, 2, 3), 0.8, 21);
    qc_complex *y = malloc(s.F * sizeof *y);
    uint64_t seed = 2;
    for (size_t t = 0; t < s.F; t++) {
        y[t] = s.x[t];
        for (int k = (int)(4 * uniform(&seed)); k > 0; k--) y[t] = (qc_complex){-y[t].im, y[t].re};
    }
    assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, s.weight, s.trusted, 0.8, 200, s.x), 0);
    assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, s.weight, s.trusted, 0.8, 200, y), 0);
    for (size_t t = 0; t < s.F; t++) assert_true(cross_angle(s.x[t], y[t]) < 1e-6);
    free(y);
    release(&s);
}

/* One thread and four: the same bytes. A million times as large: the same crosses. */
static void scale_and_threads_do_not_matter(void **state) {
    (void)state;
    qc_complex *x[3];
    size_t F = 0;
    for (int i = 0; i < 3; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i == 1 ? 4 : 1;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        const double r = i == 2 ? 1e6 : 1;
        start s = create(ctx, ellipsoid(ctx, 40, 25, r, 1.5 * r, 2 * r), 0.9, 9);
        assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, s.weight, s.trusted, 0.9, 200, s.x),
                         QC_OK);
        F = s.F;
        x[i] = malloc(F * sizeof **x);
        memcpy(x[i], s.x, F * sizeof **x);
        release(&s);
        qc_ctx_free(ctx);
    }
    assert_memory_equal(x[0], x[1], F * sizeof **x);
    for (size_t t = 0; t < F; t++) assert_true(cross_angle(x[0][t], x[2][t]) < 1e-5);
    for (int i = 0; i < 3; i++) free(x[i]);
}

static void bad_arguments_leave_the_field_alone(void **state) {
    qc_ctx *ctx = *state;
    start s = create(ctx, grid(ctx, PLANE, 3, 3, 1), 0.5, 4);
    qc_complex *before = malloc(s.F * sizeof *before);
    memcpy(before, s.x, s.F * sizeof *before);
    assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, NULL, NULL, 1.1, 5, s.x), QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, NULL, NULL, (double)NAN, 5, s.x),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_smooth_cosine(ctx, s.mesh, NULL, NULL, 0.5, 0, s.x), QC_OK);
    assert_memory_equal(s.x, before, s.F * sizeof *before);
    free(before);
    release(&s);
}

static qc_status smooth_a_copy(qc_ctx *ctx, const void *data) {
    const start *s = data;
    qc_complex *x = malloc(s->F * sizeof *x);
    memcpy(x, s->x, s->F * sizeof *x);
    const qc_status status = qc_field_smooth_cosine(ctx, s->mesh, s->weight, s->trusted, 0.5, 3, x);
    if (status) assert_memory_equal(x, s->x, s->F * sizeof *x);
    free(x);
    return status;
}

static void failed_allocations_leave_the_field_alone(void **state) {
    start s = create(*state, ellipsoid(*state, 6, 5, 1, 2, 3), 0.5, 4);
    fail_every_allocation(smooth_a_copy, &s);
    release(&s);
}

/* Weights between 0 (umbilic or flat) and sqrt(2) (opposite curvatures), whatever the scale. */
static void anisotropy_is_a_ratio(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 2, 2, 1);
    const double kappa[16] = {0, 0, 3, 3, 1e-9, -1e-9, 5, 0, 1e200, -1e200, 1, -2, -4, -4, 2, 1};
    const double expected[8] = {0, 0, sqrt(2), 1, sqrt(2), 3 / sqrt(5), 0, 1 / sqrt(5)};
    double weight[8];
    qc_field_anisotropy(mesh, kappa, weight);
    for (int t = 0; t < 8; t++) assert_true(fabs(weight[t] - expected[t]) < 1e-14);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_slope_is_the_derivative),
        cmocka_unit_test(rounds_fall_to_a_critical_point),
        cmocka_unit_test(smooth_fields_stay),
        cmocka_unit_test(quarter_turns_do_not_matter),
        cmocka_unit_test(scale_and_threads_do_not_matter),
        cmocka_unit_test(bad_arguments_leave_the_field_alone),
        cmocka_unit_test(failed_allocations_leave_the_field_alone),
        cmocka_unit_test(anisotropy_is_a_ratio),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
