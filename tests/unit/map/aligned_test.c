/* Maps with hard features: counts of points, levels and variables; features are isolines at
 * integers, exactly; energies add up; scale and threads change nothing. */
#include "sdk/map/periods/align.h"
#include "tests/unit/map/hard_features.h"
#include "tests/unit/mesh/failing_allocator.h"

/* Free variables: the levels of the chains less the shift; with a hole the translation once around
 * it, on the torus those of both loops, of which the feature makes one part zero. */
static const aligned_case CASES[] = {
    {"plate", NULL, 9, false, false, 4, 4, 2, 1},
    {"ring", NULL, 12, true, false, 8, 8, 8, 1},
    {"cube", "cube", 600, false, false, 8, 12, -1, 1},
    {"hyperboloid", "hyperboloid", 600, false, true, 0, 2, 2, 1},
    {"torus", "torus", 600, false, true, 0, 1, 3, 1},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef void check(const aligned_case *c, setting *s);
static void for_all(check *body) {
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        setting *s = aligned_setting(ctx, &CASES[i], 400);
        body(&CASES[i], s);
        setting_free(s);
    }
    qc_ctx_free(ctx);
}

static complex_t corner(const double *uv, int32_t c) {
    return uv[2 * (int64_t)c] + uv[2 * (int64_t)c + 1] * I;
}

/* Across feature e in the chart of its first face: the part which is constant, at both ends. */
static void levels_of(const setting *s, const double *uv, int32_t e, int32_t direction,
                      double level[2]) {
    const int32_t h = s->mesh->edge_halfedge[2 * e];
    const complex_t a = corner(uv, qc_next(h)), b = corner(uv, qc_prev(h));
    level[0] = direction % 2 ? creal(a) : cimag(a);
    level[1] = direction % 2 ? creal(b) : cimag(b);
    (void)s;
}

static void variables_are_counted(const aligned_case *c, setting *s) {
    qc__seams *seams = setting_seams(s, QC_LATTICE_QUADS);
    int32_t features = 0;
    for (int32_t e = 0; e < s->mesh->n_edges; e++) features += s->matching->axis[e] >= 0;
    assert_true(features > 0);
    assert_int_equal(seams->n_cones, c->points);
    if (c->n_free >= 0 && seams->n_free != c->n_free)
        fail_msg("%s: %d free variables, not %d", c->name, (int)seams->n_free, (int)c->n_free);
    qc__seams_free(seams);
}
static void test_count(void **state) {
    (void)state;
    for_all(variables_are_counted);
}

/* With any integers, and any values elsewhere: relations hold exactly, levels are integers. */
static void integers_make_features_isolines(const aligned_case *c, setting *s) {
    uint64_t state = 5;
    (void)c;
    for (int32_t lattice = 0; lattice < 3; lattice++) {
        qc__seams *seams = setting_seams(s, lattice);
        double *y = ARRAY(double, seams->n_free), *value = ARRAY(double, qc__seams_symbols(seams));
        complex_t *wedge = ARRAY(complex_t, seams->n_wedges);
        complex_t *F = ARRAY(complex_t, s->mesh->n_vertices);
        qc_complex *f = ARRAY(qc_complex, 3 * (int64_t)s->mesh->n_faces);
        for (int32_t j = 0; j < seams->n_free; j++) y[j] = random_integer(&state, 40);
        for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
            const double re = rint(1e4 * uniform(&state)) / 1024;
            const double im = rint(1e4 * uniform(&state)) / 1024;
            F[v] = (qc__seams_is_given(seams, v, 0) ? 0 : re) +
                   (qc__seams_is_given(seams, v, 1) ? 0 : im) * I;
        }
        qc__seams_symbol_values(seams, y, value);
        qc__seams_wedge_values(seams, value, wedge);
        qc__periods_corners(seams, wedge, F, f);
        complex_t *symbol = symbol_values(seams, y);
        assert_true(seam_deviation(s, seams, symbol, f) == 0);
        for (int32_t e = 0; e < s->mesh->n_edges; e++) {
            const int32_t h = s->mesh->edge_halfedge[2 * e];
            double level[2];
            if (s->matching->axis[e] < 0) continue;
            levels_of(s, &f[0].re, e, s->matching->axis[e] + s->map->face_turn[h / 3], level);
            assert_true(level[0] == level[1] && level[0] == rint(level[0]));
        }
        free(symbol);
        free(f);
        free(F);
        free(wedge);
        free(value);
        free(y);
        qc__seams_free(seams);
    }
}
static void test_integers(void **state) {
    (void)state;
    for_all(integers_make_features_isolines);
}

static qc_corner_map *rounded(const setting *s) {
    qc_corner_map *map = NULL;
    must(s->ctx, qc_map_round(s->ctx, s->map, NULL, &map));
    return map;
}

static void rounded_features_are_isolines(const aligned_case *c, setting *s) {
    qc_corner_map *map = rounded(s);
    qc_grid_map *grid = NULL;
    (void)c;
    must(s->ctx, qc_grid_map_create(s->ctx, map, 1e-9, &grid));
    qc_object_release(grid);
    assert_non_null(map->axis);
    double area = 0;
    for (int32_t t = 0; t < s->mesh->n_faces; t++) {
        const complex_t a = corner(map->uv, 3 * t + 1) - corner(map->uv, 3 * t);
        const complex_t b = corner(map->uv, 3 * t + 2) - corner(map->uv, 3 * t);
        area += 0.5 * cimag(conj(a) * b);
    }
    assert_true(fabs(area - rint(area)) < 1e-8 * area && fabs(area / 400 - 1) < 0.15);
    for (int32_t e = 0; e < s->mesh->n_edges; e++) {
        double level[2], before[2];
        assert_int_equal(map->axis[e] >= 0, s->matching->axis[e] >= 0);
        if (map->axis[e] < 0) continue;
        const int32_t h = s->mesh->edge_halfedge[2 * e];
        assert_int_equal(map->axis[e], (s->matching->axis[e] + s->map->face_turn[h / 3]) & 3);
        levels_of(s, map->uv, e, map->axis[e], level);
        levels_of(s, map->relaxed, e, map->axis[e], before);
        assert_true(level[0] == level[1] && level[0] == rint(level[0]));
        assert_true(fabs(before[0] - before[1]) < 1e-9);
        const complex_t way = corner(map->uv, qc_prev(h)) - corner(map->uv, qc_next(h));
        assert_true(creal(qc__turn(way, -map->axis[e])) > 0);
    }
    qc_object_release(map);
}
static void test_rounding(void **state) {
    (void)state;
    for_all(rounded_features_are_isolines);
}

/* E of the rounded map is E_D of the aligned one and E_H, and no aligned map near it is better. */
static void energies_add_up(const aligned_case *c, setting *s) {
    qc_corner_map *map = rounded(s);
    qc_complex *z = combed_form(s);
    const int64_t n = 3 * (int64_t)s->mesh->n_faces;
    const double scale = s->sizing->edge_length / map->edge_length;
    (void)c;
    for (int64_t i = 0; i < n; i++) z[i] = (qc_complex){scale * z[i].re, scale * z[i].im};
    const qc_complex *f = (const qc_complex *)(const void *)map->uv;
    const qc_complex *g = (const qc_complex *)(const void *)map->relaxed;
    const double small = 1e-9 * map->field_energy, curl = energy_of(s, s->cotangent, g, z);
    assert_true(fabs(curl - map->curl_energy) <= small);
    assert_true(curl >= scale * scale * s->map->curl_energy - small);
    assert_true(fabs(energy_of(s, s->cotangent, f, z) - curl - map->harmonic_energy) <= small);
    free(z);
    qc_object_release(map);
}
static void test_energies(void **state) {
    (void)state;
    for_all(energies_add_up);
}

/* Where quads are as large as the gaps between features, every gap keeps one row of them. */
static void features_stay_apart(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    static const double quads[] = {12, 20, 40};
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < sizeof quads / sizeof *quads; k++) {
            setting *s = aligned_setting(ctx, &CASES[i], quads[k]);
            qc_corner_map *map = rounded(s);
            for (int32_t t = 0; t < s->mesh->n_faces; t++) {
                const complex_t a = corner(map->uv, 3 * t + 1) - corner(map->uv, 3 * t);
                const complex_t b = corner(map->uv, 3 * t + 2) - corner(map->uv, 3 * t);
                if (!(cimag(conj(a) * b) > 0))
                    fail_msg("%s, %g quads: face %d is folded", CASES[i].name, quads[k], (int)t);
            }
            qc_object_release(map);
            setting_free(s);
        }
    qc_ctx_free(ctx);
}

static void test_threads(void **state) {
    (void)state;
    for (int i = 0; i < N_CASES; i++) {
        double *first = NULL;
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            qc_ctx *ctx = context(threads);
            setting *s = aligned_setting(ctx, &CASES[i], 400);
            qc_corner_map *map = rounded(s);
            const size_t bytes = 6 * (size_t)s->mesh->n_faces * sizeof(double);
            if (first) assert_memory_equal(first, map->uv, bytes);
            if (!first) {
                first = ARRAY(double, 6 * (int64_t)s->mesh->n_faces);
                memcpy(first, map->uv, bytes);
            }
            qc_object_release(map);
            setting_free(s);
            qc_ctx_free(ctx);
        }
        free(first);
    }
}

/* A mesh a million times as large or small gets the same integers and, nearly, the same map. */
static void scale_changes_nothing(void **state) {
    (void)state;
    static const double scales[] = {1, 1e6, 1e-6};
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        double *first = NULL;
        if (CASES[i].shape && strcmp(CASES[i].shape, "torus") == 0)
            continue; /* feature by radius */
        for (int k = 0; k < 3; k++) {
            aligned_case c = CASES[i];
            c.scale = scales[k];
            setting *s = aligned_setting(ctx, &c, 400);
            qc_corner_map *map = rounded(s);
            const int64_t n = 6 * (int64_t)s->mesh->n_faces;
            if (k == 0) first = ARRAY(double, n);
            if (k == 0) memcpy(first, map->uv, (size_t)n * sizeof *first);
            for (int64_t j = 0; j < n; j++)
                if (fabs(map->uv[j] - first[j]) > 1e-6)
                    fail_msg("%s times %g: %g, not %g", c.name, scales[k], map->uv[j], first[j]);
            qc_object_release(map);
            setting_free(s);
        }
        free(first);
    }
    qc_ctx_free(ctx);
}

static qc_status round_once(qc_ctx *ctx, const void *data) {
    qc_corner_map *map = NULL;
    const qc_status status = qc_map_round(ctx, data, NULL, &map);
    assert_int_equal(status == QC_OK, map != NULL);
    qc_object_release(map);
    return status;
}
static void failing_allocations_leave_nothing(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    const aligned_case c = {"small ring", NULL, 3, true, false, 8, 8, 8, 1};
    setting *s = aligned_setting(ctx, &c, 12);
    fail_every_allocation(round_once, s->map);
    setting_free(s);
    qc_ctx_free(ctx);
}

/* The plate with a vertex of index 3/4, where one quad meets, two of whose sides are one edge. */
static setting *glued(qc_ctx *ctx, int32_t *vertex) {
    setting *plain = aligned_setting(ctx, &CASES[0], 400);
    qc_mesh *mesh = qc_object_retain(plain->mesh);
    const int32_t n = CASES[0].resolution, v = n / 2 * (n + 1) + n / 2,
                  first = mesh->vertex_corner[v];
    int8_t *m = ARRAY(int8_t, mesh->n_edges);
    qc_matching *matching = NULL;
    memcpy(m, plain->matching->m, (size_t)mesh->n_edges);
    for (int32_t i = 0, c = first; i < 3; i++, c = qc_corner_ccw(mesh, c)) {
        const int32_t h = qc_prev(c), e = mesh->halfedge_edge[h];
        m[e] = (int8_t)(m[e] + (mesh->edge_halfedge[2 * e] == h ? 1 : -1));
    }
    must(ctx, qc_matching_create(ctx, plain->matching->field, m, &matching));
    free(m);
    setting_free(plain);
    *vertex = v;
    return setting_of(ctx, mesh, matching, 400);
}
static void test_glued(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    qc_round_options options = QC_ROUND_OPTIONS_INIT;
    qc_corner_map *map = NULL;
    int32_t v;
    setting *s = glued(ctx, &v);
    assert_int_equal(s->matching->index4[v], 3);
    assert_int_equal(qc_map_round(ctx, s->map, &options, &map), QC_ERR_FAILED);
    assert_null(map);
    assert_int_equal(qc_ctx_error(ctx)->where, v);
    setting_free(s);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_count),
        cmocka_unit_test(test_glued),
        cmocka_unit_test(test_integers),
        cmocka_unit_test(test_rounding),
        cmocka_unit_test(test_energies),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(features_stay_apart),
        cmocka_unit_test(scale_changes_nothing),
        cmocka_unit_test(failing_allocations_leave_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
