/* Geometry of triangle meshes: exact values, Gauss-Bonnet, independence of scale, slivers. */
#include "unit/mesh/fixtures.h"

typedef struct geometry {
    double *length, *area, *cotangent, *angle, *normal, *gauss;
} geometry;

static geometry measure(qc_ctx *ctx, const qc_mesh *m) {
    size_t f = (size_t)m->n_faces;
    geometry g = {malloc((size_t)m->n_edges * 8),
                  malloc(f * 8),
                  malloc(f * 24),
                  malloc(f * 24),
                  malloc(f * 24),
                  malloc((size_t)m->n_vertices * 8)};
    assert_int_equal(
        qc_mesh_geometry(ctx, m, g.length, g.area, g.cotangent, g.angle, g.normal, g.gauss), QC_OK);
    return g;
}

static void discard(geometry *g) {
    free(g->length);
    free(g->area);
    free(g->cotangent);
    free(g->angle);
    free(g->normal);
    free(g->gauss);
}

static void check_mesh(qc_ctx *ctx, qc_mesh *m) {
    geometry g = measure(ctx, m);
    double total = 0, area = 0, length = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) total += g.gauss[v];
    for (int32_t e = 0; e < m->n_edges; e++) length += g.length[e];
    for (int32_t f = 0; f < m->n_faces; f++) {
        double *c = g.cotangent + 3 * f, *a = g.angle + 3 * f, *n = g.normal + 3 * f;
        area += g.area[f];
        assert_near(a[0] + a[1] + a[2], PI, 1e-12);
        assert_near(c[0] * c[1] + c[1] * c[2] + c[2] * c[0], 1, 1e-9);
        assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-12);
        for (int k = 0; k < 3; k++) assert_near(c[k], cos(a[k]) / sin(a[k]), 1e-9);
    }
    assert_near(total, 2 * PI * m->euler, 1e-9);
    assert_near(area / m->area, 1, 1e-12);
    assert_near(length / m->n_edges / m->mean_edge_length, 1, 1e-12);
    discard(&g);
    qc_object_release(m);
}

static void test_identities(void **state) {
    check_mesh(*state, grid(*state, 9, 7, 3, 1));
    check_mesh(*state, grid(*state, 9, 7, 1, 1e6));
    check_mesh(*state, grid(*state, 4, 7, 0, 1e-6));
    check_mesh(*state, plate(*state, 2, 1));
}

static void test_scale(void **state) {
    qc_mesh *a = grid(*state, 9, 7, 3, 1), *b = grid(*state, 9, 7, 3, ldexp(1, -60));
    geometry g = measure(*state, a), s = measure(*state, b);
    for (int32_t c = 0; c < 3 * a->n_faces; c++) {
        assert_true(g.angle[c] == s.angle[c] && g.cotangent[c] == s.cotangent[c]);
        assert_true(g.normal[c] == s.normal[c]);
    }
    discard(&g);
    discard(&s);
    qc_object_release(a);
    qc_object_release(b);
}

static void test_slivers(void **state) {
    /* a needle, a cap and a point */
    double p[] = {0, 0, 0, 1, 0, 0, 1, 1e-200, 0, 0.5, 0, 0, 0, 0, 0};
    int32_t t[] = {0, 1, 2, 1, 0, 3, 4, 3, 0};
    qc_mesh *m;
    assert_int_equal(qc_mesh_create(*state, 5, p, 3, t, &m), QC_OK);
    geometry g = measure(*state, m);
    for (int i = 0; i < 9; i++) {
        assert_true(isfinite(g.cotangent[i]) && isfinite(g.angle[i]) && isfinite(g.normal[i]));
        assert_true(fabs(g.cotangent[i]) <= 1e14);
    }
    for (int f = 0; f < 3; f++) {
        double *n = g.normal + 3 * f;
        assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-12);
        assert_true(g.area[f] > 0);
    }
    discard(&g);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identities),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_slivers),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
