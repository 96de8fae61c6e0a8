/* Low extrema of a function go together with their saddles, high ones keep place and value, and
 * nothing else changes (qc_scalar_simplify). */
#include "surfaces.h"

/* Neighbours of v above and below; ties count by number. */
static void count_around(const qc_mesh *mesh, const double *g, int32_t v, int32_t *up,
                         int32_t *down) {
    *up = *down = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t a = mesh->edge_vertex[2 * e], b = mesh->edge_vertex[2 * e + 1];
        if (a != v && b != v) continue;
        const int32_t w = a == v ? b : a;
        if (g[w] > g[v] || (g[w] == g[v] && w > v))
            (*up)++;
        else
            (*down)++;
    }
}

static int32_t extrema(const qc_mesh *mesh, const double *g) {
    int32_t n = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int32_t up, down;
        count_around(mesh, g, v, &up, &down);
        n += up == 0 || down == 0;
    }
    return n;
}

static double *height(const qc_mesh *mesh, int axis, double noise, uint64_t seed) {
    double *g = malloc(sizeof *g * (size_t)mesh->n_vertices);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        g[v] = mesh->position[3 * v + axis] + noise * (uniform(&seed) - 0.5);
    return g;
}

static double *copy(const qc_mesh *mesh, const double *g) {
    double *out = malloc(sizeof *out * (size_t)mesh->n_vertices);
    memcpy(out, g, sizeof *out * (size_t)mesh->n_vertices);
    return out;
}

static void noise_goes(void **state) {
    qc_ctx *ctx = *state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        qc_mesh *sphere = ellipsoid(ctx, 24, 25, 1, 2, 3), *torus = grid(ctx, TORUS, 48, 24, 1);
        const qc_mesh *mesh[] = {sphere, torus};
        for (int i = 0; i < 2; i++) {
            double *g = height(mesh[i], i == 0 ? 2 : 0, 0.3, seed);
            const int32_t before = extrema(mesh[i], g);
            int32_t removed = 0;
            assert_true(before > 10);
            assert_int_equal(qc_scalar_simplify(ctx, mesh[i], 0.15, g, &removed), QC_OK);
            assert_int_equal(extrema(mesh[i], g), 2);
            assert_int_equal(removed, before - 2);
            free(g);
        }
        qc_object_release(sphere);
        qc_object_release(torus);
    }
}

/* A monkey saddle with a small cap is a monkey saddle without; a high cap stays to the last bit,
 * and so does everything outside of the caps. */
static void only_low_hills_change(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 40, 40, 1);
    double *g = malloc(sizeof *g * (size_t)mesh->n_vertices);
    int32_t changed = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double x = mesh->position[3 * v] - 0.5, y = mesh->position[3 * v + 1] - 0.5;
        g[v] = 4 * (x * x * x - 3 * x * y * y) + 0.01 * exp(-400 * (x * x + y * y)) +
               0.4 * exp(-100 * ((x + 0.3) * (x + 0.3) + y * y));
    }
    double *out = copy(mesh, g), *same = copy(mesh, g), *high = copy(mesh, g);
    const int32_t before = extrema(mesh, g);
    int32_t removed = 0;
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.02, out, &removed), QC_OK);
    assert_true(removed >= 1);
    assert_int_equal(extrema(mesh, out), before - removed);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double x = mesh->position[3 * v] - 0.5, y = mesh->position[3 * v + 1] - 0.5;
        changed += out[v] != g[v];
        if (hypot(x, y) > 0.15 && fabs(x) < 0.4 && fabs(y) < 0.4) assert_true(out[v] == g[v]);
    }
    assert_true(changed > 0);
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0, same, &removed), QC_OK);
    assert_memory_equal(same, g, sizeof *g * (size_t)mesh->n_vertices);
    assert_int_equal(removed, 0);
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.5, high, NULL), QC_OK);
    assert_true(extrema(mesh, high) <= extrema(mesh, out));
    free(g);
    free(out);
    free(same);
    free(high);
    qc_object_release(mesh);
}

/* On a ridge the mean of a low hill sinks below its far shore. */
static void ridges_stay_ridges(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 60, 30, 1);
    double *g = malloc(sizeof *g * (size_t)mesh->n_vertices);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double x = mesh->position[3 * v], y = mesh->position[3 * v + 1] - 0.51;
        g[v] = 0.002 * sin(30 * x) - 0.1 * x * x - 3 * y * y;
    }
    const int32_t before = extrema(mesh, g);
    int32_t removed = 0;
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.02, g, &removed), QC_OK);
    assert_true(removed >= 2);
    assert_int_equal(extrema(mesh, g), before - removed);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double *p = mesh->position + 3 * v;
        int32_t up, down;
        count_around(mesh, g, v, &up, &down);
        if (p[0] > 0.1 && p[0] < 0.95 && fabs(p[1] - 0.5) < 0.4) assert_true(up > 0 && down > 0);
    }
    free(g);
    qc_object_release(mesh);
}

static void scale_and_place_change_nothing(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 36, 18, 1);
    double *g = height(mesh, 0, 0.25, 7), *h = copy(mesh, g);
    for (int32_t v = 0; v < mesh->n_vertices; v++) h[v] = ldexp(g[v], 20);
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.1, g, NULL), QC_OK);
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.1, h, NULL), QC_OK);
    for (int32_t v = 0; v < mesh->n_vertices; v++) assert_true(h[v] == ldexp(g[v], 20));
    for (int32_t v = 0; v < mesh->n_vertices; v++) g[v] = 5; /* nothing to do */
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.1, g, NULL), QC_OK);
    for (int32_t v = 0; v < mesh->n_vertices; v++) assert_true(g[v] == 5);
    g[3] = INFINITY;
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 0.1, g, NULL), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 3);
    assert_int_equal(qc_scalar_simplify(ctx, mesh, 1.5, h, NULL), QC_ERR_ARGUMENT);
    free(g);
    free(h);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_goes),
        cmocka_unit_test(only_low_hills_change),
        cmocka_unit_test(ridges_stay_ridges),
        cmocka_unit_test(scale_and_place_change_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
