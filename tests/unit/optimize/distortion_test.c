/* The distortion evaluator: E_D of trials and of accepted sequences of flips is that of the curl
 * removal from scratch, refused changes leave no trace. */
#include "unit/optimize/scratch.h"

#include "sdk/optimize/internal.h"

/* A sizing; with stretch its ratios go up to 2 in random directions. */
static qc_sizing *sizing_of(qc_ctx *ctx, const qc_mesh *mesh, bool stretched) {
    qc_sizing *sizing = NULL;
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.01, 0, NULL, &sizing), QC_OK);
    if (!stretched) return sizing;
    qc_complex *s = malloc(sizeof *s * (size_t)mesh->n_faces);
    uint64_t seed = 13;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double size = 0.5 * log(2) * uniform(&seed), angle = 2 * PI * uniform(&seed);
        s[t] = (qc_complex){size * cos(angle), size * sin(angle)};
    }
    assert_int_equal(qc_sizing_set_stretch(ctx, sizing, s), QC_OK);
    free(s);
    return sizing;
}

enum { NOT_SIZED, SIZED, STRETCHED };

/* Trials, changes of one to four flips and refusals, each against scratch now and then. */
static void random_walk(qc_ctx *ctx, qc_mesh *mesh, bool aligned, int sized, int steps) {
    qc_matching *m = smooth_matching(ctx, mesh, aligned);
    qc_sizing *sizing = sized ? sizing_of(ctx, mesh, sized == STRETCHED) : NULL;
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, sizing, 0.5, &d), QC_OK);
    check_energy(ctx, d, sizing);
    uint64_t seed = 7;
    for (int i = 0; i < steps; i++) {
        qc_flip_step flip[11];
        double alone[11], together = 0;
        bool accepted = true;
        for (int k = 0; k < 11; k++) flip[k] = random_flip(d, mesh, &seed);
        if (i % 16 == 0) assert_int_equal(qc_distortion_try(ctx, d, 11, flip, alone), QC_OK);
        const double before = present(d);
        assert_int_equal(qc_distortion_change(ctx, d, 1, flip, 0, &together, &accepted), QC_OK);
        assert_false(accepted);
        assert_true(present(d) == before);
        if (i % 16 == 0 && isfinite(alone[0]))
            assert_true(fabs(alone[0] - together) <= 1e-9 * together);
        const int n = 1 + i % 4;
        assert_int_equal(qc_distortion_change(ctx, d, n, flip, INFINITY, &together, &accepted),
                         QC_OK);
        if (accepted) assert_true(together == present(d));
        if (i % 64 == 63) check_energy(ctx, d, sizing);
    }
    check_energy(ctx, d, sizing);
    qc_distortion_free(d);
    qc_object_release(sizing);
    qc_object_release(m);
    qc_object_release(mesh);
}

static void walks_on_closed_surface(void **state) {
    random_walk(*state, ellipsoid(*state, 12, 8, 1, 1.3, 2), false, NOT_SIZED, 400);
}
static void walks_with_alignment(void **state) {
    random_walk(*state, ellipsoid(*state, 12, 8, 1, 1.3, 2), true, SIZED, 64);
}
static void walks_on_open_surface(void **state) {
    random_walk(*state, grid(*state, CYLINDER, 12, 8, 1), false, SIZED, 64);
}
static void walks_with_two_lengths(void **state) {
    random_walk(*state, ellipsoid(*state, 12, 8, 1, 1.3, 2), false, STRETCHED, 128);
}

/* The derivatives of the parts of the weak curl by the angles of the crosses, against differences.
 */
static void slopes_are_derivatives(void **state) {
    qc_ctx *ctx = *state;
    const double h = 1e-6;
    qc_mesh *mesh = ellipsoid(ctx, 12, 8, 1, 1.3, 2);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_sizing *sizing = sizing_of(ctx, mesh, true);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, sizing, 0.5, &d), QC_OK);
    const qc__cplx turn = cos(h) + I * sin(h);
    int n_odd = 0;
    for (int32_t i = 0; i < d->n; i++) {
        const qc__cplx xs = qc__c(d->x[d->side[i].s]), xt = qc__c(d->x[d->side[i].t]);
        const qc__cplx by_s =
            (qc__side_in_s(d, i, qc__z(xs * turn)) - qc__side_in_s(d, i, qc__z(xs / turn))) /
            (2 * h);
        const qc__cplx by_t =
            (qc__side_in_t(d, i, qc__z(xt * turn)) - qc__side_in_t(d, i, qc__z(xt / turn))) /
            (2 * h);
        assert_true(cabs(by_s - qc__side_slope_s(d, i, qc__z(xs))) < 1e-6 * cabs(by_s));
        assert_true(cabs(by_t - qc__side_slope_t(d, i, qc__z(xt))) < 1e-6 * cabs(by_t));
        n_odd += d->odd[i];
    }
    assert_true(n_odd > 0);
    qc_distortion_free(d);
    qc_object_release(sizing);
    qc_object_release(m);
    qc_object_release(mesh);
}

/* More flips at once than are worth sweeps: kept and refused. */
static void changes_many_at_once(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 16, 10, 1, 1.3, 2);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
    uint64_t seed = 11;
    qc_flip_step flip[70];
    for (int i = 0; i < 70; i++) flip[i] = random_flip(d, mesh, &seed);
    const double before = present(d);
    double energy = 0;
    bool accepted = true;
    assert_int_equal(qc_distortion_change(ctx, d, 70, flip, 0, &energy, &accepted), QC_OK);
    assert_true(!accepted && present(d) == before);
    check_energy(ctx, d, NULL);
    assert_int_equal(qc_distortion_change(ctx, d, 70, flip, INFINITY, &energy, &accepted), QC_OK);
    assert_true(accepted && present(d) == energy);
    check_energy(ctx, d, NULL);
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
}

/* Shares sum to E_D; theta is that of the matching made from the state. */
static void shares_sum_to_energy(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 16, 10, 1, 1.3, 2);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
    uint64_t seed = 5;
    const size_t E = (size_t)mesh->n_edges;
    double *share = malloc(sizeof *share * E), *theta = malloc(sizeof *theta * E);
    for (int i = 0; i < 20; i++) {
        const qc_flip_step flip = random_flip(d, mesh, &seed);
        assert_int_equal(qc_distortion_change(ctx, d, 1, &flip, INFINITY, NULL, NULL), QC_OK);
    }
    assert_int_equal(qc_distortion_shares(ctx, d, share, theta), QC_OK);
    qc_matching *now = NULL;
    assert_int_equal(qc_distortion_matching(ctx, d, &now), QC_OK);
    double sum = 0;
    for (size_t e = 0; e < E; e++) {
        sum += share[e];
        assert_true(fabs(theta[e] - now->theta[e]) < 1e-9);
    }
    assert_true(sum >= present(d) * (1 - 1e-9));
    qc_object_release(now);
    free(share);
    free(theta);
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
}

/* A flat torus has trivial holonomy: nothing can be flipped, E_D is zero. */
static void flat_torus_stays(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 12, 8, 1);
    qc_complex *x = random_crosses(mesh, 2);
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, NULL, 0, 0, x), QC_OK);
    qc_matching *m = match(ctx, mesh, x);
    free(x);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 0.5, &d), QC_OK);
    check_energy(ctx, d, NULL);
    const qc_flip_step flip = {0, 1};
    if (m->n_singular == 0 && !qc_distortion_can_flip(d, 0)) {
        double energy = 0;
        assert_int_equal(qc_distortion_try(ctx, d, 1, &flip, &energy), QC_ERR_ARGUMENT);
    }
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
}

static void refuses_bad_arguments(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 4, 4, 1);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 2, &d), QC_ERR_ARGUMENT);
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 0.5, &d), QC_OK);
    double energy = 0;
    qc_flip_step flip = {-1, 1};
    assert_int_equal(qc_distortion_try(ctx, d, 1, &flip, &energy), QC_ERR_ARGUMENT);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        flip.edge = e;
        flip.step = qc_distortion_can_flip(d, e) ? 2 : 1;
        assert_int_equal(qc_distortion_change(ctx, d, 1, &flip, 1, NULL, NULL), QC_ERR_ARGUMENT);
    }
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(walks_on_closed_surface, set_up, tear_down),
        cmocka_unit_test_setup_teardown(walks_with_alignment, set_up, tear_down),
        cmocka_unit_test_setup_teardown(walks_on_open_surface, set_up, tear_down),
        cmocka_unit_test_setup_teardown(walks_with_two_lengths, set_up, tear_down),
        cmocka_unit_test_setup_teardown(slopes_are_derivatives, set_up, tear_down),
        cmocka_unit_test_setup_teardown(changes_many_at_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(shares_sum_to_energy, set_up, tear_down),
        cmocka_unit_test_setup_teardown(flat_torus_stays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refuses_bad_arguments, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
