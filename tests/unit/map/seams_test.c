/* Seams: number of free variables, integers and their way back, closed walks about vertices, W F +
 * O x is seamless. */
#include "tests/unit/map/seamless.h"

static const surface_case CASES[] = {
    {"sphere", 400, 0, 0, SMOOTH},        {"sphere", 400, 0, 0.05, ROUGH},
    {"sphere", 300, 0, 0.05, ANY_TURNS},  {"torus", 400, 0, 0, MERIDIANS},
    {"torus", 400, 0, 0.05, SMOOTH},      {"torus", 400, 0, 0.05, ANY_TURNS},
    {"flat-torus", 400, 0, 0, SMOOTH},    {"flat-torus", 400, 0, 0, ROUGH},
    {"genus", 800, 2, 0, SMOOTH},         {"genus", 800, 2, 0.05, ANY_TURNS},
    {"genus", 1200, 5, 0, ROUGH},         {"trinoid", 600, 0, 0, SMOOTH},
    {"trinoid", 600, 0, 0.05, ANY_TURNS}, {"hyperboloid", 400, 0, 0, SMOOTH},
    {"costa", 700, 0, 0.05, ROUGH},       {"cube", 400, 0, 0, SMOOTH},
    {"knot", 800, 0, 0.2, SMOOTH},        {"knot", 800, 0, 0.2, ROUGH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef void check(const surface_case *c, const setting *s, int32_t lattice,
                   const qc__seams *seams);

static void for_all(check *body, int32_t lattices) {
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        setting *s = setting_create(ctx, &CASES[i], 300);
        for (int32_t lattice = 0; lattice < lattices; lattice++) {
            qc__seams *seams = setting_seams(s, lattice);
            body(&CASES[i], s, lattice, seams);
            qc__seams_free(seams);
        }
        setting_free(s);
    }
    qc_ctx_free(ctx);
}

static int32_t count_cones(const setting *s) {
    int8_t *shift = ARRAY(int8_t, s->mesh->n_vertices);
    must(s->ctx, qc_cover_shifts(s->ctx, &s->cover, shift));
    int32_t n = 0;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++)
        n += !qc_vertex_on_boundary(s->mesh, v) && (shift[v] != 0 || s->matching->index4[v] != 0);
    free(shift);
    return n;
}

/* Dimension of the first cohomology with the holonomy as coefficients, plus the positions of cones,
 * minus the global shift: 2 g + b - 2 (4.1), one more for every boundary loop; with trivial
 * holonomy the constants and (closed surfaces) the fundamental class add one each, and the shift
 * acts on the cones only. */
static void free_variables_are_counted(const surface_case *c, const setting *s, int32_t lattice,
                                       const qc__seams *seams) {
    const qc_mesh *mesh = s->mesh;
    int8_t *turn = ARRAY(int8_t, mesh->n_faces);
    uint8_t trivial = 0;
    (void)lattice;
    must(s->ctx, qc_cover_comb(s->ctx, &s->cover, NULL, turn, NULL, &trivial));
    free(turn);
    const int32_t g = mesh->genus, loops = mesh->n_boundary_loops, b = count_cones(s);
    int32_t expected = 2 * g + b - 2 + loops;
    if (trivial) expected += 1 + (loops == 0) - (b > 0);
    if (c->kind == MERIDIANS) assert_true(trivial && b == 0 && expected == 2 * g);
    if (c->kind == SMOOTH && loops == 0 && g != 1) assert_true(b > 0 && expected == 2 * g + b - 2);
    assert_int_equal(seams->n_cones, b);
    assert_int_equal(seams->n_free, 2 * expected);
    /* the same from the cut graph */
    const int32_t relations = seams->n_nodes - (loops == 0 && trivial);
    assert_int_equal(seams->n_free, 2 * (seams->n_segments + b - relations - (!trivial || b > 0)));
}
static int32_t kinds[4];
static void cones_are_counted_by_turning(const surface_case *c, const setting *s, int32_t lattice,
                                         const qc__seams *seams) {
    (void)c;
    (void)s;
    (void)lattice;
    for (int32_t i = 0; i < seams->n_cones; i++) kinds[seams->cone_turn[i]]++;
}
static void test_count(void **state) {
    (void)state;
    for_all(free_variables_are_counted, 3);
    for_all(cones_are_counted_by_turning, 1);
    for (int i = 0; i < 4; i++) assert_true(kinds[i] > 0); /* the cases cover all turnings */
}

static void assert_integer(complex_t z, double unit) {
    assert_true(creal(z) / unit == rint(creal(z) / unit) &&
                cimag(z) / unit == rint(cimag(z) / unit));
}

/* Carries a chart once around v, from a corner of the first wedge: f_end = i^turn f + shift. */
static int32_t once_around(const setting *s, const qc__seams *seams, const complex_t *symbol,
                           int32_t v, complex_t *shift) {
    const qc_mesh *mesh = s->mesh;
    int32_t c = mesh->vertex_corner[v], turn = 0;
    while (seams->corner_wedge[c] != seams->vertex_wedge[v]) c = qc_corner_ccw(mesh, c);
    const int32_t start = c;
    *shift = 0;
    do {
        const int32_t h = qc_next(c), e = mesh->halfedge_edge[h], k = seams->edge_segment[e];
        const int32_t r = combed_turn(s, h);
        const complex_t tau = k < 0                      ? 0
                              : seams->edge_left[e] == h ? symbol[k]
                                                         : -qc__turn(symbol[k], r);
        turn = (turn + r) & 3;
        *shift = qc__turn(*shift, r) + tau;
        c = qc_corner_ccw(mesh, c);
    } while (c != start);
    return turn;
}

static void integers_close_around_vertices(const surface_case *c, const setting *s, int32_t lattice,
                                           const qc__seams *seams) {
    uint64_t state = 11;
    (void)c;
    for (int round = 0; round < 3; round++) {
        double *y = ARRAY(double, seams->n_free);
        for (int32_t j = 0; j < seams->n_free; j++) y[j] = random_integer(&state, 40);
        complex_t *symbol = symbol_values(seams, y);
        for (int32_t j = 0; j < seams->n_segments + seams->n_cones; j++) {
            const bool cone = j >= seams->n_segments;
            if (!cone) assert_integer(symbol[j], lattice == QC_LATTICE_EVEN ? 2.0 : 1.0);
            if (cone) assert_integer(symbol[j], lattice == QC_LATTICE_INTEGER ? 0.5 : 1.0);
        }
        double *back = free_values(seams, symbol);
        for (int32_t j = 0; j < seams->n_free + seams->n_fixed; j++)
            assert_true(back[j] == (j < seams->n_free ? y[j] : 0));
        free(back);
        for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
            if (qc_vertex_on_boundary(s->mesh, v)) continue;
            const int32_t cone = seams->vertex_cone[v];
            complex_t shift = 0;
            const int32_t turn = once_around(s, seams, symbol, v, &shift);
            if (cone < 0) assert_true(turn == 0 && shift == 0);
            if (cone < 0) continue;
            const complex_t p = symbol[seams->n_segments + cone];
            assert_int_equal(turn, seams->cone_turn[cone]);
            assert_true(qc__turn(p, turn) + shift == p);
        }
        free(symbol);
        free(y);
    }
}
static void test_integers(void **state) {
    (void)state;
    for_all(integers_close_around_vertices, 3);
}

/* f'_w = i^{a_w} F_v + sum i^b symbol; at cones the position stands for F_v. */
static void any_values_make_a_seamless_map(const surface_case *c, const setting *s, int32_t lattice,
                                           const qc__seams *seams) {
    const qc_mesh *mesh = s->mesh;
    uint64_t state = 5;
    (void)c;
    (void)lattice;
    complex_t *F = ARRAY(complex_t, mesh->n_vertices);
    complex_t *wedge = ARRAY(complex_t, seams->n_wedges);
    double *y = ARRAY(double, seams->n_free), *value = ARRAY(double, qc__seams_symbols(seams));
    for (int32_t j = 0; j < seams->n_free; j++) y[j] = uniform(&state);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        F[v] = seams->vertex_cone[v] >= 0 ? 0 : uniform(&state) + uniform(&state) * I;
    complex_t *symbol = symbol_values(seams, y);
    qc__seams_symbol_values(seams, y, value);
    qc__seams_wedge_values(seams, value, wedge);
    qc_complex *f = ARRAY(qc_complex, 3 * (int64_t)mesh->n_faces);
    double size = 1;
    for (int32_t at = 0; at < 3 * mesh->n_faces; at++) {
        const int32_t v = mesh->face_vertex[at], w = seams->corner_wedge[at];
        assert_true(w >= seams->vertex_wedge[v] && w < seams->vertex_wedge[v + 1]);
        const complex_t z = qc__turn(F[v], seams->wedge_turn[w]) + wedge[w];
        f[at] = qc__pair(z);
        size = fmax(size, cabs(z));
    }
    assert_true(seam_deviation(s, seams, symbol, f) <= 1e-12 * size);
    free(f);
    free(symbol);
    free(F);
    free(wedge);
    free(value);
    free(y);
}
static void test_seamless(void **state) {
    (void)state;
    for_all(any_values_make_a_seamless_map, 2);
}

/* The map of the Hodge step crosses every segment with one translation. */
static void the_integral_has_one_translation_a_segment(const surface_case *c, const setting *s,
                                                       int32_t lattice, const qc__seams *seams) {
    const qc_complex *f = s->map->f;
    complex_t *symbol = measured_symbols(seams, f);
    double size = 1;
    (void)c;
    (void)lattice;
    for (int32_t at = 0; at < 3 * s->mesh->n_faces; at++)
        size = fmax(size, cabs(qc__complex(f[at])));
    assert_true(seam_deviation(s, seams, symbol, f) <= 1e-10 * size);
    free(symbol);
}
static void test_integral(void **state) {
    (void)state;
    for_all(the_integral_has_one_translation_a_segment, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_count),
        cmocka_unit_test(test_integers),
        cmocka_unit_test(test_seamless),
        cmocka_unit_test(test_integral),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
