/* Smoothing (5.3): the energy falls, its gradient vanishes at the result, the rest of the contract.
 */
#include "surfaces.h"

typedef struct guided {
    qc_mesh *mesh;
    size_t F;
    qc_complex *guide, *x;
    double *weight;
    uint8_t *trusted;
} guided;

static guided random_guide(qc_ctx *ctx, qc_mesh *mesh, uint64_t seed) {
    guided g = {mesh, (size_t)mesh->n_faces, random_crosses(mesh, seed), NULL, NULL, NULL};
    g.x = malloc(sizeof *g.x * g.F);
    g.weight = malloc(sizeof *g.weight * g.F);
    g.trusted = malloc(g.F);
    memcpy(g.x, g.guide, sizeof *g.x * g.F);
    for (size_t t = 0; t < g.F; t++) {
        g.weight[t] = uniform(&seed);
        g.trusted[t] = uniform(&seed) < 0.4;
    }
    (void)ctx;
    return g;
}

static void release(guided *g) {
    qc_object_release(g->mesh);
    free(g->guide);
    free(g->x);
    free(g->weight);
    free(g->trusted);
}

/* Energy (5.3) of x and its derivative by the rotation of each face (3 n_faces may be slivers: none
 * here). */
static double energy(qc_ctx *ctx, const guided *g, double lambda, double *gradient) {
    const qc_mesh *mesh = g->mesh;
    double *area = malloc(sizeof *area * g->F),
           *length = malloc(sizeof *length * (size_t)mesh->n_edges);
    assert_int_equal(qc_mesh_geometry(ctx, mesh, length, area, NULL, NULL, NULL, NULL), QC_OK);
    qc_matching *m = match(ctx, mesh, g->x);
    double E = 0, l = sqrt(mesh->area) / 100;
    for (size_t t = 0; t < g->F; t++) {
        qc_complex a = g->guide[t], b = g->x[t];
        double d = atan2(b.im, b.re) - atan2(a.im, a.re);
        d -= PI / 2 * round(2 * d / PI);
        double w = g->trusted[t] ? (1 - lambda) * g->weight[t] * area[t] / (l * l) : 0;
        E += w * d * d;
        gradient[t] = 2 * w * d;
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[2 * e], k = mesh->edge_halfedge[2 * e + 1];
        if (k < 0) continue;
        double omega = length[e] * length[e] / ((area[h / 3] + area[k / 3]) / 3);
        E += lambda * omega * m->theta[e] * m->theta[e];
        gradient[h / 3] -= 2 * lambda * omega * m->theta[e];
        gradient[k / 3] += 2 * lambda * omega * m->theta[e];
    }
    qc_object_release(m);
    free(area);
    free(length);
    return E;
}

static void rounds_lower_the_energy_to_a_critical_point(void **state) {
    qc_ctx *ctx = *state;
    double lambdas[] = {0.05, 0.5, 0.95, 1};
    for (int kind = 0; kind < 2; kind++) {
        for (int i = 0; i < 4; i++) {
            qc_mesh *mesh = kind ? grid(ctx, CYLINDER, 15, 10, 1) : ellipsoid(ctx, 16, 9, 1, 2, 3);
            guided g = random_guide(ctx, mesh, 6);
            double *gradient = malloc(sizeof *gradient * g.F), largest = 0;
            double before = energy(ctx, &g, lambdas[i], gradient), E = before;
            for (int round = 0; round < 60; round++) {
                assert_int_equal(qc_field_smooth(ctx, mesh, g.guide, g.weight, g.trusted, NULL, 0,
                                                 lambdas[i], 1, g.x),
                                 QC_OK);
                double after = energy(ctx, &g, lambdas[i], gradient);
                assert_true(after <= E * (1 + 1e-9));
                E = after;
            }
            assert_true(E < 0.9 * before);
            for (size_t t = 0; t < g.F; t++) largest = fmax(largest, fabs(gradient[t]));
            assert_true(largest < 1e-7 * before);
            free(gradient);
            release(&g);
        }
    }
}

static void many_rounds_are_one_round_many_times(void **state) {
    qc_ctx *ctx = *state;
    guided g = random_guide(ctx, ellipsoid(ctx, 12, 8, 1, 1, 2), 7);
    qc_complex *y = malloc(sizeof *y * g.F);
    memcpy(y, g.guide, sizeof *y * g.F);
    for (int i = 0; i < 3; i++)
        assert_int_equal(
            qc_field_smooth(ctx, g.mesh, g.guide, g.weight, g.trusted, NULL, 0, 0.7, 1, g.x),
            QC_OK);
    assert_int_equal(qc_field_smooth(ctx, g.mesh, NULL, g.weight, g.trusted, NULL, 0, 0.7, 3, y),
                     QC_OK);
    for (size_t t = 0; t < g.F; t++) assert_true(cross_angle(g.x[t], y[t]) < 1e-9);
    free(y);
    release(&g);
}

static void strong_alignment_keeps_the_guide(void **state) {
    qc_ctx *ctx = *state;
    guided g = random_guide(ctx, ellipsoid(ctx, 12, 8, 1, 1, 2), 8);
    for (size_t t = 0; t < g.F; t++) g.weight[t] += 0.1;
    assert_int_equal(qc_field_smooth(ctx, g.mesh, NULL, g.weight, g.trusted, NULL, 0, 0, 10, g.x),
                     QC_OK);
    for (size_t t = 0; t < g.F; t++)
        if (g.trusted[t]) assert_true(cross_angle(g.x[t], g.guide[t]) < 1e-3);
    release(&g);
}

static void scale_and_threads_do_not_matter(void **state) {
    (void)state;
    qc_complex *x[3];
    int8_t *m[3];
    size_t F = 0, E = 0;
    for (int i = 0; i < 3; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i == 1 ? 4 : 1;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        double s = i == 2 ? 1e6 : 1;
        guided g = random_guide(ctx, ellipsoid(ctx, 40, 25, s, 1.5 * s, 2 * s), 9);
        assert_int_equal(
            qc_field_smooth(ctx, g.mesh, NULL, g.weight, g.trusted, NULL, 0, 0.8, 20, g.x), QC_OK);
        qc_matching *match_i = match(ctx, g.mesh, g.x);
        F = g.F;
        E = (size_t)g.mesh->n_edges;
        x[i] = malloc(sizeof **x * F);
        m[i] = malloc(E);
        memcpy(x[i], g.x, sizeof **x * F);
        memcpy(m[i], match_i->m, E);
        qc_object_release(match_i);
        release(&g);
        qc_ctx_free(ctx);
    }
    assert_memory_equal(x[0], x[1], sizeof **x * F);
    for (size_t t = 0; t < F; t++) assert_true(cross_angle(x[0][t], x[2][t]) < 1e-6);
    assert_memory_equal(m[0], m[1], E);
    assert_memory_equal(m[0], m[2], E);
    for (int i = 0; i < 3; i++) {
        free(x[i]);
        free(m[i]);
    }
}

static void bad_arguments_leave_the_field_alone(void **state) {
    qc_ctx *ctx = *state;
    guided g = random_guide(ctx, grid(ctx, PLANE, 3, 3, 1), 10);
    assert_int_equal(qc_field_smooth(ctx, g.mesh, NULL, NULL, NULL, NULL, 0, 1.1, 5, g.x),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_smooth(ctx, g.mesh, NULL, NULL, NULL, NULL, 0, (double)NAN, 5, g.x),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_field_smooth(ctx, g.mesh, NULL, NULL, NULL, NULL, 0, 0.5, 0, g.x), QC_OK);
    assert_memory_equal(g.x, g.guide, sizeof *g.x * g.F);
    release(&g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounds_lower_the_energy_to_a_critical_point),
        cmocka_unit_test(many_rounds_are_one_round_many_times),
        cmocka_unit_test(strong_alignment_keeps_the_guide),
        cmocka_unit_test(scale_and_threads_do_not_matter),
        cmocka_unit_test(bad_arguments_leave_the_field_alone),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
