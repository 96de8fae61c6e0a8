/* Cancelling pairs: noise pairs go, E_D falls, the sum of the indices stays; at any price few are
 * left; the nearest pairs go first. */
#include "unit/optimize/scratch.h"

typedef struct start {
    qc_mesh *mesh;
    qc_matching *m;
    qc_distortion *d;
    double before;
    int32_t branch_points;
} start;

/* Thirty pairs more than the smooth field has, less those which meet. */
static start noisy(qc_ctx *ctx) {
    start s = {ellipsoid(ctx, 24, 20, 1, 1.2, 3), NULL, NULL, 0, 0};
    s.m = smooth_matching(ctx, s.mesh, false);
    assert_int_equal(qc_distortion_create(ctx, s.m, NULL, 1, &s.d), QC_OK);
    uint64_t seed = 17;
    for (int i = 0; i < 30; i++) {
        const qc_flip_step flip = random_flip(s.d, s.mesh, &seed);
        assert_int_equal(qc_distortion_change(ctx, s.d, 1, &flip, INFINITY, NULL, NULL), QC_OK);
    }
    qc_distortion_state state;
    qc_distortion_get_state(s.d, &state);
    s.before = state.energy;
    s.branch_points = state.branch_points;
    return s;
}

static void release(start *s) {
    qc_distortion_free(s->d);
    qc_object_release(s->m);
    qc_object_release(s->mesh);
}

static void noise_is_cancelled(void **state) {
    qc_ctx *ctx = *state;
    start s = noisy(ctx);
    int32_t cancelled = 0;
    assert_int_equal(qc_distortion_cancel(ctx, s.d, NULL, &cancelled), QC_OK);
    qc_distortion_state now;
    qc_distortion_get_state(s.d, &now);
    assert_true(cancelled >= 5);
    assert_true(now.branch_points <= s.branch_points - cancelled);
    assert_true(now.energy < 0.5 * s.before);
    check_energy(ctx, s.d, NULL);
    int32_t sum = 0;
    for (int32_t p = 0; p < s.mesh->n_vertices; p++) sum += now.index4[p];
    assert_int_equal(sum, 8);
    release(&s);
}

/* At any price: on a sphere what is left has one sign only. */
static void price_is_paid(void **state) {
    qc_ctx *ctx = *state;
    start s = noisy(ctx);
    qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
    options.increase = 1e6;
    options.neighbours = 8;
    for (int32_t cancelled = 1; cancelled > 0;)
        assert_int_equal(qc_distortion_cancel(ctx, s.d, &options, &cancelled), QC_OK);
    qc_distortion_state now;
    qc_distortion_get_state(s.d, &now);
    for (int32_t p = 0; p < s.mesh->n_vertices; p++) assert_true(now.index4[p] >= 0);
    check_energy(ctx, s.d, NULL);
    release(&s);
}

/* Nothing may rise, but near pairs go whatever they cost. */
static void near_pairs_go(void **state) {
    qc_ctx *ctx = *state;
    start s = noisy(ctx);
    qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
    options.increase = -1e6;
    options.spacing = 0.4;
    options.most = 1e6;
    int32_t cancelled = 0;
    assert_int_equal(qc_distortion_cancel(ctx, s.d, &options, &cancelled), QC_OK);
    assert_true(cancelled > 0);
    check_energy(ctx, s.d, NULL);
    release(&s);
}

/* The number of pairs is kept, and those are the cheapest. */
static void so_many_pairs_go(void **state) {
    qc_ctx *ctx = *state;
    double energy[2];
    for (int i = 0; i < 2; i++) {
        start s = noisy(ctx);
        qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
        options.increase = 1e6;
        options.pairs = i == 0 ? 1 : 4;
        int32_t cancelled = 0;
        assert_int_equal(qc_distortion_cancel(ctx, s.d, &options, &cancelled), QC_OK);
        assert_int_equal(cancelled, options.pairs);
        qc_distortion_state now;
        qc_distortion_get_state(s.d, &now);
        assert_true(now.branch_points < s.branch_points);
        energy[i] = now.energy;
        assert_true(energy[i] < s.before);
        check_energy(ctx, s.d, NULL);
        release(&s);
    }
    assert_true(energy[1] < energy[0]);
}

/* Without time pairs which would go at any price still go, and only those. */
static void near_pairs_go_without_time(void **state) {
    qc_ctx *ctx = *state;
    for (int near = 0; near < 2; near++) {
        start s = noisy(ctx);
        qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
        options.increase = 1e3;
        options.spacing = near ? 0.4 : 0;
        options.most = 1e6;
        int32_t cancelled = 0;
        qc_ctx_set_time_budget(ctx, 0);
        const qc__time time = qc__time_begin_step(ctx);
        assert_int_equal(qc_distortion_cancel(ctx, s.d, &options, &cancelled), QC_OK);
        qc__time_end_step(ctx, time);
        assert_int_equal(cancelled > 0, near);
        check_energy(ctx, s.d, NULL);
        release(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(noise_is_cancelled, set_up, tear_down),
        cmocka_unit_test_setup_teardown(price_is_paid, set_up, tear_down),
        cmocka_unit_test_setup_teardown(near_pairs_go, set_up, tear_down),
        cmocka_unit_test_setup_teardown(so_many_pairs_go, set_up, tear_down),
        cmocka_unit_test_setup_teardown(near_pairs_go_without_time, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
