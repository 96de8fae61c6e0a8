/* Free coordinates of a seamless map: the gradient is the transpose of the corner values, the
 * preconditioner inverts the Dirichlet form, and snapped maps are exact. */
#include "sdk/map/periods/free_map.h"
#include "sdk/map/periods/snap.h"
#include "tests/unit/map/hard_features.h"

static const surface_case SURFACES[] = {
    {"sphere", 300, 0, 0, SMOOTH},     {"genus", 500, 2, 0.3, ROUGH},
    {"torus", 300, 0, 0.1, ANY_TURNS}, {"torus", 300, 0, 0, MERIDIANS},
    {"trinoid", 300, 0, 0, SMOOTH},
};
static const aligned_case ALIGNED[] = {
    {"ring", NULL, 9, true, false, 8, 8, 8, 1},
    {"cube", "cube", 400, false, false, 8, 12, -1, 1},
    {"hyperboloid", "hyperboloid", 400, false, true, 0, 2, 2, 1},
};
enum { N_SURFACES = 5, N_ALIGNED = 3 };

typedef struct fixture {
    setting *s;
    qc__seams *seams;
    qc__periods *periods;
    qc__free_map *map;
    double *P, *y, *x;
    qc_complex *f;
} fixture;

static void open_fixture(fixture *k, setting *s, int32_t lattice) {
    const int64_t n_corners = 3 * (int64_t)s->mesh->n_faces;
    k->s = s;
    k->seams = setting_seams(s, lattice);
    const int64_t n = k->seams->n_free;
    must(s->ctx, qc__periods_create(s->ctx, k->seams, s->stiffness, NULL, &k->periods));
    k->P = ARRAY(double, n *n);
    k->y = ARRAY(double, n);
    k->f = ARRAY(qc_complex, n_corners);
    must(s->ctx, qc__period_matrix(s->ctx, k->periods, k->P));
    must(s->ctx, qc__free_map_create(s->ctx, k->periods, k->P, &k->map));
    k->x = ARRAY(double, k->map->n);
    memcpy(k->f, s->map->f, sizeof *k->f * (size_t)n_corners);
    must(s->ctx, qc__seams_read(s->ctx, k->seams, k->f, k->y));
    qc__free_map_read(k->map, k->f, k->y, k->x);
}
static void close_fixture(fixture *k) {
    qc__free_map_free(k->map);
    qc__periods_free(k->periods);
    qc__seams_free(k->seams);
    free(k->P);
    free(k->y);
    free(k->x);
    free(k->f);
    setting_free(k->s);
}

typedef void check(fixture *k);
static void for_all(check *body) {
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_SURFACES + N_ALIGNED; i++)
        for (int32_t lattice = 0; lattice < 3; lattice++) {
            fixture k = {0};
            open_fixture(&k,
                         i < N_SURFACES ? setting_create(ctx, &SURFACES[i], 300)
                                        : aligned_setting(ctx, &ALIGNED[i - N_SURFACES], 300),
                         lattice);
            body(&k);
            close_fixture(&k);
        }
    qc_ctx_free(ctx);
}

static double sum_of_products(int64_t n, const double *a, const double *b) {
    double sum = 0;
    for (int64_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static void gradient_is_the_transpose(fixture *k) {
    const int64_t n = k->map->n, n_corners = 3 * (int64_t)k->s->mesh->n_faces;
    uint64_t state = 3;
    double *x = ARRAY(double, n), *gradient = ARRAY(double, n);
    qc_complex *f = ARRAY(qc_complex, n_corners), *g = ARRAY(qc_complex, n_corners);
    for (int64_t i = 0; i < n; i++) x[i] = k->x[i] + uniform(&state);
    for (int64_t c = 0; c < n_corners; c++) g[c] = (qc_complex){uniform(&state), uniform(&state)};
    qc__free_map_corners(k->map, k->x, k->f);
    qc__free_map_corners(k->map, x, f);
    qc__free_map_gradient(k->map, g, gradient);
    for (int64_t c = 0; c < n_corners; c++)
        f[c] = (qc_complex){f[c].re - k->f[c].re, f[c].im - k->f[c].im};
    for (int64_t i = 0; i < n; i++) x[i] -= k->x[i];
    const double left = sum_of_products(2 * n_corners, &f[0].re, &g[0].re);
    const double right = sum_of_products(n, x, gradient);
    assert_true(fabs(left - right) < 1e-9 * (double)n_corners);
    free(x);
    free(gradient);
    free(f);
    free(g);
}
static void test_gradient(void **state) {
    (void)state;
    for_all(gradient_is_the_transpose);
}

/* H q for the Dirichlet form: its gradient at q, less the one at 0. */
static void apply_form(fixture *k, const double *q, double *out) {
    const int64_t n_corners = 3 * (int64_t)k->s->mesh->n_faces;
    qc_complex *f = ARRAY(qc_complex, n_corners), *g = ARRAY(qc_complex, n_corners);
    double *zero = ARRAY(double, k->map->n);
    qc_complex *at_zero = ARRAY(qc_complex, n_corners);
    qc__free_map_corners(k->map, zero, at_zero);
    qc__free_map_corners(k->map, q, f);
    for (int32_t c = 0; c < (int32_t)n_corners; c++) {
        const int32_t a = qc_next(c), b = qc_prev(c);
        const complex_t d = qc__complex(f[b]) - qc__complex(f[a]) - qc__complex(at_zero[b]) +
                            qc__complex(at_zero[a]);
        const complex_t pull = 0.5 * k->s->stiffness[c] * d;
        g[b] = qc__pair(qc__complex(g[b]) + pull);
        g[a] = qc__pair(qc__complex(g[a]) - pull);
    }
    qc__free_map_gradient(k->map, g, out);
    free(f);
    free(g);
    free(zero);
    free(at_zero);
}

static void preconditioner_inverts_the_form(fixture *k) {
    const int64_t n = k->map->n;
    uint64_t state = 9;
    double *p = ARRAY(double, n), *q = ARRAY(double, n), *back = ARRAY(double, n);
    for (int64_t i = 0; i < n; i++) q[i] = uniform(&state);
    apply_form(k, q, p); /* in the range, where a variable moves nothing */
    memcpy(q, p, sizeof *q * (size_t)n);
    must(k->s->ctx, qc__free_map_precondition(k->s->ctx, k->map, q));
    apply_form(k, q, back);
    double size = 0, error = 0;
    for (int64_t i = 0; i < n; i++) {
        size = fmax(size, fabs(p[i]));
        error = fmax(error, fabs(back[i] - p[i]));
    }
    assert_true(error < 1e-5 * size);
    free(p);
    free(q);
    free(back);
}
static void test_preconditioner(void **state) {
    (void)state;
    for_all(preconditioner_inverts_the_form);
}

/* Transitions to the last bit, values hardly moved, multiples of the unit. */
static void snapped_maps_are_exact(fixture *k) {
    const qc_mesh *mesh = k->s->mesh;
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    qc_complex *f = ARRAY(qc_complex, n_corners);
    int32_t bits = 0, folded = -1, before = 0;
    memcpy(f, k->f, sizeof *f * (size_t)n_corners);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const complex_t a = qc__complex(f[3 * t + 1]) - qc__complex(f[3 * t]);
        const complex_t b = qc__complex(f[3 * t + 2]) - qc__complex(f[3 * t]);
        before += cimag(conj(a) * b) <= 0;
    }
    must(k->s->ctx, qc__snap(k->s->ctx, k->seams, f, k->y, &bits, &folded));
    assert_true(bits >= 24);
    assert_int_equal(folded, before);
    complex_t *symbol = symbol_values(k->seams, k->y);
    assert_true(seam_deviation(k->s, k->seams, symbol, f) == 0);
    for (int64_t c = 0; c < n_corners; c++) {
        const double u = ldexp(f[c].re, bits), v = ldexp(f[c].im, bits);
        assert_true(u == rint(u) && v == rint(v) && fmax(fabs(u), fabs(v)) < 1099511627776.0);
        if (k->seams->n_levels == 0) {
            assert_true(hypot(f[c].re - k->f[c].re, f[c].im - k->f[c].im) < 1e-5);
        }
    }
    free(symbol);
    free(f);
}
static void test_snap(void **state) {
    (void)state;
    for_all(snapped_maps_are_exact);
}

/* A face turned over by less than the unit is set right by moving a vertex. */
static void test_slivers(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    fixture k = {0};
    open_fixture(&k, setting_create(ctx, &SURFACES[0], 300), QC_LATTICE_QUADS);
    const qc_mesh *mesh = k.s->mesh;
    int32_t bits = 0, folded = 0, v = 0;
    must(ctx, qc__snap(ctx, k.seams, k.f, k.y, &bits, &folded));
    assert_int_equal(folded, 0);
    while (k.seams->vertex_given[v] >= 0 ||
           k.seams->vertex_wedge[v + 1] != k.seams->vertex_wedge[v] + 1)
        v++;
    /* v onto the opposite edge of its first face, a quarter of a unit beyond */
    const int32_t c = mesh->vertex_corner[v];
    const complex_t a = qc__complex(k.f[qc_next(c)]), b = qc__complex(k.f[qc_prev(c)]);
    const complex_t beyond = 0.25 * ldexp(1, -bits) * I * (b - a) / cabs(b - a);
    const complex_t step = 0.5 * (a + b) - beyond - qc__complex(k.f[c]);
    int32_t d = c;
    do {
        k.f[d] = qc__pair(qc__complex(k.f[d]) + step);
        d = qc_corner_ccw(mesh, d);
    } while (d != c);
    must(ctx, qc__snap(ctx, k.seams, k.f, k.y, &bits, &folded));
    assert_int_equal(folded, 0);
    close_fixture(&k);
    qc_ctx_free(ctx);
}

static void test_too_far(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    fixture k = {0};
    open_fixture(&k, setting_create(ctx, &SURFACES[0], 300), QC_LATTICE_QUADS);
    int32_t bits = 0, folded = 0;
    k.f[5].re = 1e12;
    assert_int_equal(qc__snap(ctx, k.seams, k.f, k.y, &bits, &folded), QC_ERR_FAILED);
    close_fixture(&k);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gradient), cmocka_unit_test(test_preconditioner),
        cmocka_unit_test(test_snap),     cmocka_unit_test(test_slivers),
        cmocka_unit_test(test_too_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
