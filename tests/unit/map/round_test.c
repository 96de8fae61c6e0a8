/* Rounding: integer-seamless results on all lattices, energies that add up, densities that are met,
 * and the same integers on any number of threads and at any scale. */
#include "tests/unit/map/seamless.h"

static const surface_case CASES[] = {
    {"sphere", 600, 0, 0, SMOOTH},     {"cube", 600, 0, 0, SMOOTH},
    {"torus", 600, 0, 0, MERIDIANS},   {"torus", 600, 0, 0.05, SMOOTH},
    {"flat-torus", 600, 0, 0, SMOOTH}, {"genus", 800, 2, 0, SMOOTH},
    {"trinoid", 600, 0, 0, SMOOTH},    {"hyperboloid", 600, 0, 0, SMOOTH},
    {"knot", 800, 0, 0.2, SMOOTH},     {"costa", 800, 0, 0, SMOOTH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

static qc_corner_map *rounded(const setting *s, int32_t lattice) {
    qc_round_options options = QC_ROUND_OPTIONS_INIT;
    qc_corner_map *map = NULL;
    options.lattice = lattice;
    options.quantize = QC_QUANTIZE_NEVER;
    must(s->ctx, qc_map_round(s->ctx, s->map, &options, &map));
    return map;
}

static complex_t corner(const qc_corner_map *map, int32_t c) {
    return map->uv[2 * (int64_t)c] + map->uv[2 * (int64_t)c + 1] * I;
}

static void results_are_integer_seamless(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        setting *s = setting_create(ctx, &CASES[i], 700);
        qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
        qc_grid_map *grid = NULL;
        must(ctx, qc_grid_map_create(ctx, map, 1e-9, &grid));
        qc_object_release(grid);
        const double area = map_area(map);
        if (s->mesh->n_boundary_loops == 0) assert_true(fabs(area - rint(area)) < 1e-8 * area);
        assert_true(map->rotation && map->cross);
        for (int32_t e = 0; e < s->mesh->n_edges; e++) {
            const int32_t left = s->mesh->edge_halfedge[2 * e];
            if (s->mesh->twin[left] >= 0)
                assert_int_equal(map->rotation[e] & 3, combed_turn(s, left));
        }
        qc_object_release(map);
        setting_free(s);
    }
    qc_ctx_free(ctx);
}

/* Translations of the edges and fixed points of the cones lie on the lattice asked for. */
static void lattices_are_kept(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    int32_t halves = 0;
    for (int i = 0; i < N_CASES; i++)
        for (int32_t lattice = 0; lattice < 3; lattice++) {
            setting *s = setting_create(ctx, &CASES[i], 700);
            qc_corner_map *map = rounded(s, lattice);
            const double unit = lattice == QC_LATTICE_EVEN ? 2 : 1;
            for (int32_t e = 0; e < s->mesh->n_edges; e++) {
                const int32_t left = s->mesh->edge_halfedge[2 * e], right = s->mesh->twin[left];
                if (right < 0) continue;
                for (int end = 0; end < 2; end++) {
                    const int32_t a = end ? qc_prev(left) : qc_next(left);
                    const int32_t b = end ? qc_next(right) : qc_prev(right);
                    const complex_t tau =
                        corner(map, b) - qc__turn(corner(map, a), map->rotation[e]);
                    const complex_t miss =
                        tau / unit - (rint(creal(tau) / unit) + rint(cimag(tau) / unit) * I);
                    assert_true(cabs(miss) < 1e-9);
                }
            }
            const double cell = lattice == QC_LATTICE_INTEGER ? 0.5 : 1;
            for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
                if (s->matching->index4[v] == 0 || qc_vertex_on_boundary(s->mesh, v)) continue;
                const complex_t p = corner(map, s->mesh->vertex_corner[v]);
                const complex_t near =
                    rint(creal(p) / cell) * cell + rint(cimag(p) / cell) * cell * I;
                assert_true(cabs(p - near) < 1e-9);
                halves += rint(creal(p)) != creal(near) || rint(cimag(p)) != cimag(near);
            }
            qc_object_release(map);
            setting_free(s);
        }
    assert_true(halves > 0);
    qc_ctx_free(ctx);
}

/* What is reported is what the map has: E_D of the map before rounding, E_H of the difference; and
 * the two are orthogonal, in the weighted norm where faces were stiffened. */
static void check_energies(qc_ctx *ctx, const surface_case *c, int32_t *stiffened) {
    setting *s = setting_create(ctx, c, 700);
    qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
    const int64_t n = 3 * (int64_t)s->mesh->n_faces;
    const double scale = s->sizing->edge_length / map->edge_length;
    qc_complex *z = combed_form(s), *h = ARRAY(qc_complex, n);
    const qc_complex *f = (const qc_complex *)(const void *)map->uv;
    const qc_complex *g = (const qc_complex *)(const void *)map->relaxed;
    for (int64_t i = 0; i < n; i++) {
        z[i] = (qc_complex){scale * z[i].re, scale * z[i].im};
        h[i] = (qc_complex){f[i].re - g[i].re, f[i].im - g[i].im};
    }
    const double small = 1e-9 * map->field_energy;
    assert_true(fabs(energy_of(s, s->cotangent, g, z) - map->curl_energy) <= small);
    assert_true(fabs(energy_of(s, s->cotangent, h, NULL) - map->harmonic_energy) <= small);
    const double all = energy_of(s, s->stiffness, f, z);
    const double apart = energy_of(s, s->stiffness, g, z) + energy_of(s, s->stiffness, h, NULL);
    assert_true(fabs(all - apart) <= 1e-9 * (map->field_energy + all));
    if (s->map->weight)
        ++*stiffened;
    else if (c->kind != ROUGH) /* keeping crowded cones apart may cost more than direct rounding */
        assert_true(map->harmonic_energy <= map->harmonic_energy_direct * (1 + 1e-9) + 1e-12);
    free(h);
    free(z);
    qc_object_release(map);
    setting_free(s);
}
static void energies_add_up(void **state) {
    (void)state;
    static const surface_case rough[] = {{"sphere", 400, 0, 0.05, ROUGH},
                                         {"knot", 600, 0, 0.2, ROUGH}};
    qc_ctx *ctx = context(1);
    int32_t stiffened = 0;
    for (int i = 0; i < N_CASES; i++) check_energies(ctx, &CASES[i], &stiffened);
    assert_int_equal(stiffened, 0);
    for (int i = 0; i < 2; i++) check_energies(ctx, &rough[i], &stiffened);
    assert_true(stiffened > 0);
    qc_ctx_free(ctx);
}

static void densities_are_met(void **state) {
    (void)state;
    static const double wanted[] = {300, 1000, 5000, 20000};
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++)
        for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
            setting *s = setting_create(ctx, &CASES[i], wanted[k]);
            qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
            const double quads = map_area(map);
            if (fabs(quads / wanted[k] - 1) > 0.05)
                fail_msg("%s: %g quads instead of %g", CASES[i].shape, quads, wanted[k]);
            qc_object_release(map);
            setting_free(s);
        }
    qc_ctx_free(ctx);
}

static void threads_change_nothing(void **state) {
    (void)state;
    for (int i = 0; i < N_CASES; i++) {
        double *first = NULL;
        for (uint32_t threads = 1; threads <= 3; threads++) {
            qc_ctx *ctx = context(threads);
            setting *s = setting_create(ctx, &CASES[i], 700);
            qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
            const size_t bytes = 6 * (size_t)s->mesh->n_faces * sizeof(double);
            if (!first) {
                first = ARRAY(double, 6 * (int64_t)s->mesh->n_faces);
                memcpy(first, map->uv, bytes);
            }
            assert_memory_equal(first, map->uv, bytes);
            qc_object_release(map);
            setting_free(s);
            qc_ctx_free(ctx);
        }
        free(first);
    }
}

/* The mesh and the target length multiplied by `factor`, with the same crosses and matching. */
static setting *scaled(const setting *s, double factor) {
    const qc_mesh *m = s->mesh;
    double *position = ARRAY(double, 3 * (int64_t)m->n_vertices);
    for (int32_t i = 0; i < 3 * m->n_vertices; i++) position[i] = factor * m->position[i];
    qc_mesh *mesh = NULL;
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    must(s->ctx,
         qc_mesh_create(s->ctx, m->n_vertices, position, m->n_faces, m->face_vertex, &mesh));
    must(s->ctx, qc_face_field_create(s->ctx, mesh, s->matching->field->x, NULL, NULL, &field));
    must(s->ctx, qc_matching_create(s->ctx, field, s->matching->m, &matching));
    free(position);
    qc_object_release(field);
    return setting_of(s->ctx, mesh, matching, s->sizing->target_quads);
}

static void integers_do_not_depend_on_scale(void **state) {
    (void)state;
    /* noise leaves no two cut graphs of one length */
    static const surface_case noisy[] = {
        {"sphere", 600, 0, 0.05, SMOOTH},
        {"torus", 600, 0, 0.05, SMOOTH},
        {"genus", 800, 2, 0.05, SMOOTH},
        {"trinoid", 600, 0, 0.05, SMOOTH},
    };
    static const double factors[] = {1e-6, 1e6};
    qc_ctx *ctx = context(1);
    for (size_t i = 0; i < sizeof noisy / sizeof *noisy; i++) {
        setting *s = setting_create(ctx, &noisy[i], 700);
        qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
        qc_grid_map *grid = NULL;
        must(ctx, qc_grid_map_create(ctx, map, 0, &grid));
        for (size_t k = 0; k < 2; k++) {
            setting *other = scaled(s, factors[k]);
            qc_corner_map *other_map = rounded(other, QC_LATTICE_QUADS);
            qc_grid_map *other_grid = NULL;
            must(ctx, qc_grid_map_create(ctx, other_map, 0, &other_grid));
            assert_memory_equal(grid->rotation, other_grid->rotation, (size_t)s->mesh->n_edges);
            assert_memory_equal(grid->translation, other_grid->translation,
                                2 * sizeof(int32_t) * (size_t)s->mesh->n_edges);
            for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++)
                assert_true(cabs(corner(map, c) - corner(other_map, c)) < 1e-6);
            assert_true(fabs(other_map->edge_length / (factors[k] * map->edge_length) - 1) < 1e-9);
            qc_object_release(other_grid);
            qc_object_release(other_map);
            setting_free(other);
        }
        qc_object_release(grid);
        qc_object_release(map);
        setting_free(s);
    }
    qc_ctx_free(ctx);
}

/* A sphere and a torus in one mesh: each component gets its own shift and its own periods. */
static void components_are_rounded_apart(void **state) {
    (void)state;
    static const surface_case parts[] = {{"sphere", 400, 0, 0, SMOOTH},
                                         {"torus", 400, 0, 0, SMOOTH},
                                         {"hyperboloid", 400, 0, 0, SMOOTH}};
    qc_ctx *ctx = context(1);
    qc_mesh *part[3];
    int32_t nv = 0, nf = 0;
    for (int i = 0; i < 3; i++) {
        part[i] = case_mesh(ctx, &parts[i]);
        nv += part[i]->n_vertices;
        nf += part[i]->n_faces;
    }
    double *position = ARRAY(double, 3 * nv);
    int32_t *face = ARRAY(int32_t, 3 * nf);
    nv = nf = 0;
    for (int i = 0; i < 3; i++) {
        for (int32_t v = 0; v < 3 * part[i]->n_vertices; v++)
            position[3 * nv + v] = part[i]->position[v] + (v % 3 == 0 ? 5 * i : 0);
        for (int32_t c = 0; c < 3 * part[i]->n_faces; c++)
            face[3 * nf + c] = nv + part[i]->face_vertex[c];
        nv += part[i]->n_vertices;
        nf += part[i]->n_faces;
        qc_object_release(part[i]);
    }
    qc_mesh *mesh = NULL;
    must(ctx, qc_mesh_create(ctx, nv, position, nf, face, &mesh));
    free(position);
    free(face);
    setting *s = setting_of(ctx, mesh, case_matching(ctx, &parts[0], mesh), 1500);
    for (int32_t lattice = 0; lattice < 3; lattice++) {
        qc_corner_map *map = rounded(s, lattice);
        qc_grid_map *grid = NULL;
        if (lattice != QC_LATTICE_INTEGER) must(ctx, qc_grid_map_create(ctx, map, 1e-9, &grid));
        assert_true(fabs(map_area(map) / 1500 - 1) < 0.05);
        qc_object_release(grid);
        qc_object_release(map);
    }
    setting_free(s);
    qc_ctx_free(ctx);
}

/* Without a target number the edge length is meant literally. */
static void edge_lengths_are_literal(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    setting *s = setting_create(ctx, &CASES[0], 700);
    qc_sizing *sizing = NULL;
    qc_seamless_map *seamless = s->map;
    must(ctx, qc_sizing_create(ctx, s->mesh, s->sizing->edge_length, 0, NULL, &sizing));
    qc_object_release(s->sizing);
    s->sizing = sizing;
    must(ctx, qc_seamless_map_create(ctx, s->matching, sizing, NULL, &s->map));
    qc_object_release(seamless);
    qc_corner_map *map = rounded(s, QC_LATTICE_QUADS);
    assert_true(map->edge_length == sizing->edge_length);
    qc_object_release(map);
    setting_free(s);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_are_integer_seamless),
        cmocka_unit_test(lattices_are_kept),
        cmocka_unit_test(energies_add_up),
        cmocka_unit_test(densities_are_met),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(integers_do_not_depend_on_scale),
        cmocka_unit_test(components_are_rounded_apart),
        cmocka_unit_test(edge_lengths_are_literal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
