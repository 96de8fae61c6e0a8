/* Curl reduction: E_D falls and is that of the state, rules are kept, the result does not depend on
 * the number of threads, cancelling leaves a valid state. */
#include "unit/optimize/scratch.h"

static double reduce(qc_ctx *ctx, const qc_matching *m, int create, double spacing,
                     qc_distortion **out) {
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
    const double before = present(d);
    qc_reduce_options options = QC_REDUCE_OPTIONS_INIT;
    options.create = create;
    options.spacing = spacing;
    options.evaluations = 200;
    assert_int_equal(qc_distortion_reduce(ctx, d, &options), QC_OK);
    *out = d;
    return before;
}

static double distance(const qc_mesh *mesh, int32_t p, int32_t q) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double d = mesh->position[3 * p + i] - mesh->position[3 * q + i];
        sum += d * d;
    }
    return sqrt(sum);
}

static double nearest(const qc_mesh *mesh, const int32_t *index4) {
    double least = 1e300;
    for (int32_t p = 0; p < mesh->n_vertices; p++)
        for (int32_t q = 0; q < p; q++)
            if (index4[p] && index4[q]) least = fmin(least, distance(mesh, p, q));
    return least;
}

static void energy_falls(void **state) {
    qc_ctx *ctx = *state;
    for (int create = 0; create < 2; create++) {
        qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
        qc_matching *m = smooth_matching(ctx, mesh, false);
        const double spacing = create ? 0 : 0.5 * nearest(mesh, m->index4);
        qc_distortion *d = NULL;
        const double before = reduce(ctx, m, create, spacing, &d);
        assert_true(present(d) < 0.99 * before);
        check_energy(ctx, d, NULL);
        qc_distortion_state s;
        qc_distortion_get_state(d, &s);
        if (!create) {
            assert_true(s.branch_points <= m->n_singular);
            assert_true(nearest(mesh, s.index4) >= spacing);
        }
        for (int32_t p = 0; p < mesh->n_vertices; p++)
            assert_true(s.index4[p] >= -2 && s.index4[p] <= 1);
        qc_distortion_free(d);
        qc_object_release(m);
        qc_object_release(mesh);
    }
}

static void threads_do_not_matter(void **state) {
    (void)state;
    int8_t *first = NULL;
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = threads;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_mesh *mesh = ellipsoid(ctx, 20, 16, 1, 1.2, 3);
        qc_matching *m = smooth_matching(ctx, mesh, true);
        qc_distortion *d = NULL;
        reduce(ctx, m, 1, 0, &d);
        qc_distortion_state s;
        qc_distortion_get_state(d, &s);
        assert_true(s.changes > 0);
        if (!first) {
            first = malloc((size_t)mesh->n_edges);
            memcpy(first, s.m, (size_t)mesh->n_edges);
        } else {
            assert_memory_equal(first, s.m, (size_t)mesh->n_edges);
        }
        qc_distortion_free(d);
        qc_object_release(m);
        qc_object_release(mesh);
        qc_ctx_free(ctx);
    }
    free(first);
}

static bool stop(void *user, const char *stage, double fraction) {
    int *calls = user;
    (void)stage;
    (void)fraction;
    return --*calls > 0;
}

static void cancelled_state_is_valid(void **state) {
    (void)state;
    int calls = 1 << 30;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = stop;
    options.user = &calls;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    for (int after = 1; after < 40; after += 6) {
        qc_distortion *d = NULL;
        assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
        const double before = present(d);
        calls = after;
        const qc_status status = qc_distortion_reduce(ctx, d, NULL);
        calls = 1 << 30;
        assert_true(status == QC_OK || status == QC_ERR_CANCELLED);
        assert_true(present(d) <= before);
        qc_ctx *other = NULL;
        assert_int_equal(qc_ctx_create(NULL, &other), QC_OK);
        check_energy(other, d, NULL);
        qc_ctx_free(other);
        qc_distortion_free(d);
    }
    qc_object_release(m);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
}

/* Any budget: the state is valid, and no worse. */
static void budgets_are_kept(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    for (int i = 0; i < 4; i++) {
        qc_distortion *d = NULL;
        assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
        const double before = present(d);
        qc_reduce_options options = QC_REDUCE_OPTIONS_INIT;
        options.create = i % 2;
        if (i < 2)
            options.seconds = 1e-9;
        else
            options.evaluations = 10;
        assert_int_equal(qc_distortion_reduce(ctx, d, &options), QC_OK);
        assert_true(present(d) <= before);
        qc_distortion_state s;
        qc_distortion_get_state(d, &s);
        assert_true(s.evaluations < 120); /* a budget is checked once a round */
        check_energy(ctx, d, NULL);
        qc_distortion_free(d);
    }
    qc_object_release(m);
    qc_object_release(mesh);
}

/* A step without time changes nothing and succeeds. */
static void no_time_no_change(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_distortion *d = NULL;
    assert_int_equal(qc_distortion_create(ctx, m, NULL, 1, &d), QC_OK);
    qc_ctx_set_time_budget(ctx, 0);
    const qc__time time = qc__time_begin_step(ctx);
    assert_int_equal(qc_distortion_reduce(ctx, d, NULL), QC_OK);
    qc__time_end_step(ctx, time);
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    assert_int_equal(s.changes, 0);
    qc_ctx_set_time_budget(ctx, -1);
    assert_int_equal(qc_distortion_reduce(ctx, d, NULL), QC_OK);
    qc_distortion_get_state(d, &s);
    assert_true(s.changes > 0);
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
}

typedef struct curve {
    double x, energy, branch_points;
    int n;
    bool good;
} curve;

static void on_sample(void *user, const char *stage, const char *name, double x, double y) {
    (void)stage;
    curve *c = user;
    c->good = c->good && x >= c->x;
    c->x = x;
    c->n++;
    if (strcmp(name, "branch_points") == 0) {
        c->branch_points = y;
        return;
    }
    c->good = c->good && strcmp(name, "E_D_rel") == 0 && (c->n == 1 || y < c->energy);
    c->energy = y;
}

/* Figure 6.1: each kept change is a point of both curves; the last one is the state. */
static void curves_are_sampled(void **state) {
    (void)state;
    curve c = {0, 0, 0, 0, true};
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    o.sample = on_sample;
    o.user = &c;
    qc_ctx *ctx;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
    qc_matching *m = smooth_matching(ctx, mesh, false);
    qc_distortion *d = NULL;
    reduce(ctx, m, 1, 0, &d);
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    assert_true(c.good && c.n >= 4 && c.n % 2 == 0);
    assert_true(c.x <= (double)s.evaluations && c.branch_points == s.branch_points);
    assert_true(fabs(c.energy - 100 * s.energy / s.whole) <= 1e-12 * c.energy);
    qc_distortion_free(d);
    qc_object_release(m);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(energy_falls, set_up, tear_down),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(cancelled_state_is_valid),
        cmocka_unit_test_setup_teardown(budgets_are_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_time_no_change, set_up, tear_down),
        cmocka_unit_test(curves_are_sampled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
