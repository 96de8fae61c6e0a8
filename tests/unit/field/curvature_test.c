/* Principal directions on surfaces where they are known, by both estimators. */
#include "surfaces.h"

/* Exact principal direction at a point of the surface. */
typedef void exact_direction(const double p[3], double out[3]);

static void around_the_axis(const double p[3], double out[3]) {
    out[0] = -p[1];
    out[1] = p[0];
    out[2] = 0;
}

typedef struct deviation {
    double mean, kappa; /* mean angle to the exact cross; mean larger curvature, faces away from the
                           boundary */
} deviation;

static deviation measure(qc_ctx *ctx, const qc_mesh *mesh, int32_t estimator, double radius,
                         double z_min, double z_max, exact_direction *exact) {
    size_t F = (size_t)mesh->n_faces, n = 0;
    qc_complex *x = malloc(sizeof *x * F);
    double *kappa = malloc(sizeof *kappa * 2 * F), *real = malloc(sizeof *real * 3 * F);
    double *imaginary = malloc(sizeof *imaginary * 3 * F);
    assert_int_equal(qc_field_curvature(ctx, mesh, estimator, radius, x, kappa), QC_OK);
    assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
    deviation d = {0, 0};
    for (size_t t = 0; t < F; t++) {
        double p[3], v[3];
        centroid(mesh, t, p);
        assert_true(fabs(hypot(x[t].re, x[t].im) - 1) < 1e-12);
        assert_true(fabs(kappa[2 * t]) >= fabs(kappa[2 * t + 1]));
        if (p[2] < z_min || p[2] > z_max) continue;
        exact(p, v);
        d.mean += cross_angle(x[t], in_frame(real, imaginary, t, v));
        d.kappa += kappa[2 * t];
        n++;
    }
    free(x);
    free(kappa);
    free(real);
    free(imaginary);
    return (deviation){d.mean / (double)n, d.kappa / (double)n};
}

/* The larger curvature of a cylinder is across its axis: this also fixes which direction comes
 * first. */
static void cylinders_bend_around_their_axis(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, CYLINDER, 40, 26, 1);
    size_t F = (size_t)mesh->n_faces;
    qc_complex *x = malloc(sizeof *x * F);
    double *kappa = malloc(sizeof *kappa * 2 * F), *real = malloc(sizeof *real * 3 * F);
    double *imaginary = malloc(sizeof *imaginary * 3 * F);
    assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
    for (int32_t estimator = 0; estimator < 2; estimator++) {
        assert_int_equal(qc_field_curvature(ctx, mesh, estimator, 0.5, x, kappa), QC_OK);
        for (size_t t = 0; t < F; t++) {
            double p[3], v[3];
            centroid(mesh, t, p);
            if (p[2] < 1 || p[2] > 3) continue;
            around_the_axis(p, v);
            qc_complex around = in_frame(real, imaginary, t, v);
            assert_true(fabs(x[t].re * around.im - x[t].im * around.re) < 0.05);
            assert_true(fabs(kappa[2 * t] - 1) < 0.1);
            assert_true(fabs(kappa[2 * t + 1]) < 0.1);
        }
    }
    qc_object_release(mesh);
    free(x);
    free(kappa);
    free(real);
    free(imaginary);
}

static void directions_converge(void **state) {
    qc_ctx *ctx = *state;
    for (int32_t estimator = 0; estimator < 2; estimator++) {
        double before = 1;
        for (int n = 24; n <= 96; n *= 2) {
            qc_mesh *mesh = grid(ctx, TORUS, 2 * n, n, 1);
            double angle = measure(ctx, mesh, estimator, 12.0 / n, -2, 2, around_the_axis).mean;
            assert_true(angle < 0.03 && angle < before);
            before = angle;
            qc_object_release(mesh);
        }
        qc_mesh *mesh = ellipsoid(ctx, 96, 60, 1, 1, 3);
        deviation d = measure(ctx, mesh, estimator, 0.15, -2.4, 2.4, around_the_axis);
        assert_true(d.mean < 0.03);
        assert_true(d.kappa > 0.8 && d.kappa < 1.6); /* convex: positive */
        qc_object_release(mesh);
    }
}

static void scale_changes_curvature_only(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *one = ellipsoid(ctx, 24, 15, 1, 1.5, 2),
            *other = ellipsoid(ctx, 24, 15, 1e6, 1.5e6, 2e6);
    size_t F = (size_t)one->n_faces;
    qc_complex *x = malloc(sizeof *x * F), *y = malloc(sizeof *y * F);
    double *k = malloc(sizeof *k * 2 * F), *l = malloc(sizeof *l * 2 * F);
    double *v = malloc(sizeof *v * F), *w = malloc(sizeof *w * F);
    for (int32_t estimator = 0; estimator < 2; estimator++) {
        assert_int_equal(qc_field_curvature(ctx, one, estimator, 0.3, x, k), QC_OK);
        assert_int_equal(qc_field_curvature(ctx, other, estimator, 0.3e6, y, l), QC_OK);
        assert_int_equal(qc_field_stability(ctx, one, x, k, v), QC_OK);
        assert_int_equal(qc_field_stability(ctx, other, y, l, w), QC_OK);
        for (size_t t = 0; t < F; t++) {
            assert_true(fabs(k[2 * t] - 1e6 * l[2 * t]) < 1e-9);
            assert_true(fabs(v[t] - w[t]) < 1e-9);
        }
    }
    qc_object_release(one);
    qc_object_release(other);
    free(x);
    free(y);
    free(k);
    free(l);
    free(v);
    free(w);
}

static void threads_give_the_same_bits(void **state) {
    (void)state;
    qc_complex *x[2];
    size_t bytes = 0;
    for (uint32_t i = 0; i < 2; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i ? 4 : 1;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_mesh *mesh = ellipsoid(ctx, 60, 40, 1, 1.5, 2);
        bytes = sizeof **x * (size_t)mesh->n_faces;
        x[i] = malloc(bytes);
        assert_int_equal(
            qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN, 0.2, x[i], NULL),
            QC_OK);
        qc_object_release(mesh);
        qc_ctx_free(ctx);
    }
    assert_memory_equal(x[0], x[1], bytes);
    free(x[0]);
    free(x[1]);
}

/* A flat square has no principal directions: everything follows its boundary. */
static void flat_surfaces_follow_their_boundary(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 9, 9, 1e-3);
    size_t F = (size_t)mesh->n_faces;
    qc_complex *x = malloc(sizeof *x * F);
    double *kappa = malloc(sizeof *kappa * 2 * F), *weight = malloc(sizeof *weight * F);
    double *real = malloc(sizeof *real * 3 * F), *imaginary = malloc(sizeof *imaginary * 3 * F);
    uint8_t *trusted = calloc(F, 1);
    assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
    assert_int_equal(qc_field_curvature(ctx, mesh, 0, 0, x, kappa), QC_OK);
    assert_int_equal(qc_field_stability(ctx, mesh, x, kappa, weight), QC_OK);
    assert_int_equal(qc_field_extend(ctx, mesh, weight, 0.3, x, trusted), QC_OK);
    double side[3] = {1, 0, 0};
    for (size_t t = 0; t < F; t++) {
        assert_true(weight[t] == 0 && trusted[t] == 0);
        assert_true(cross_angle(x[t], in_frame(real, imaginary, t, side)) < 1e-9);
    }
    assert_int_equal(qc_field_align(ctx, mesh, NULL, 5, x, weight, trusted), QC_OK);
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++)
        if (mesh->twin[h] < 0) assert_true(trusted[h / 3] && weight[h / 3] == 5);
    qc_object_release(mesh);
    free(x);
    free(kappa);
    free(weight);
    free(real);
    free(imaginary);
    free(trusted);
}

static void bad_arguments_are_refused(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 2, 2, 1);
    qc_complex x[8];
    double w[8] = {0};
    uint8_t trusted[8] = {0};
    assert_int_equal(qc_field_curvature(ctx, mesh, 7, 1, x, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_curvature(ctx, mesh, 1, 0, x, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_extend(ctx, mesh, w, 1.5, x, trusted), QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_align(ctx, mesh, NULL, -1, x, w, trusted), QC_ERR_ARGUMENT);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cylinders_bend_around_their_axis),
        cmocka_unit_test(directions_converge),
        cmocka_unit_test(scale_changes_curvature_only),
        cmocka_unit_test(threads_give_the_same_bits),
        cmocka_unit_test(flat_surfaces_follow_their_boundary),
        cmocka_unit_test(bad_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
