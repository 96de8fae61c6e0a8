/* Untangling: scrambled maps become injective with the same transitions and cones; clean maps come
 * back to the last bit. */
#include "tests/unit/map/seamless.h"
#include "sdk/map/untangle/energy.h"

static const surface_case CASES[] = {
    {"sphere", 1200, 0, 0, SMOOTH},   {"cube", 1200, 0, 0, SMOOTH},
    {"torus", 1200, 0, 0, MERIDIANS}, {"genus", 1600, 2, 0, SMOOTH},
    {"trinoid", 1200, 0, 0, SMOOTH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef struct clean {
    setting *s;
    qc_corner_map *map; /* exact, injective; without the map before rounding */
    qc_grid_map *grid;
    double *relaxed; /* 6 n_faces: the map before rounding                                        */
} clean;

static qc_grid_map *grid_of(qc_ctx *ctx, const qc_corner_map *map) {
    qc_grid_map *grid = NULL;
    must(ctx, qc_grid_map_create(ctx, map, 0, &grid));
    return grid;
}

/* The map with other corner values and without the map before rounding. */
static qc_corner_map *with_values(qc_ctx *ctx, const qc_corner_map *like, const int8_t *rotation,
                                  const double *uv) {
    qc_corner_map *map = NULL;
    must(ctx, qc_corner_map_create(ctx, like->mesh, uv, like->edge_length, like->cross, &map));
    must(ctx, qc_corner_map_set_rotation(ctx, map, rotation));
    return map;
}

static clean *clean_create(qc_ctx *ctx, const surface_case *c, double quads) {
    clean *k = ARRAY(clean, 1);
    qc_corner_map *rounded = NULL, *untangled = NULL;
    k->s = setting_create(ctx, c, quads);
    must(ctx, qc_map_round(ctx, k->s->map, NULL, &rounded));
    must(ctx, qc_map_untangle(ctx, rounded, NULL, &untangled));
    k->grid = grid_of(ctx, untangled);
    assert_int_equal(k->grid->n_flipped + k->grid->n_degenerate, 0);
    k->map = with_values(ctx, rounded, k->grid->rotation, untangled->uv);
    k->relaxed = ARRAY(double, 6 * (int64_t)k->s->mesh->n_faces);
    memcpy(k->relaxed, rounded->relaxed, 6 * (size_t)k->s->mesh->n_faces * sizeof(double));
    qc_object_release(untangled);
    qc_object_release(rounded);
    return k;
}
static void clean_free(clean *k) {
    qc_object_release(k->map);
    qc_object_release(k->grid);
    setting_free(k->s);
    free(k->relaxed);
    free(k);
}

static void clean_maps_come_back_to_the_last_bit(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        clean *k = clean_create(ctx, &CASES[i], 600);
        const size_t bytes = 6 * (size_t)k->s->mesh->n_faces * sizeof(double);
        qc_corner_map *once = NULL, *twice = NULL;
        must(ctx, qc_map_untangle(ctx, k->map, NULL, &once));
        must(ctx, qc_map_untangle(ctx, once, NULL, &twice));
        assert_memory_equal(k->map->uv, once->uv, bytes);
        assert_memory_equal(once->uv, twice->uv, bytes);
        qc_object_release(twice);
        qc_object_release(once);
        clean_free(k);
    }
    qc_ctx_free(ctx);
}

/* Moves all corners of v by i^turn delta. */
static void move_vertex(const qc_mesh *mesh, const int8_t *rotation, double *uv, int32_t v,
                        complex_t delta) {
    const int32_t start = mesh->vertex_corner[v];
    int32_t c = start, turn = 0;
    do {
        const complex_t d = qc__turn(delta, turn);
        const int32_t h = qc_next(c), e = mesh->halfedge_edge[h];
        uv[2 * (int64_t)c] += creal(d);
        uv[2 * (int64_t)c + 1] += cimag(d);
        turn += mesh->edge_halfedge[2 * e] == h ? rotation[e] : -rotation[e];
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
}

/* Throws the regular vertices within `rings` of a vertex by up to `far` units. */
static double *scrambled(const clean *k, int32_t centre, int32_t rings, double far,
                         uint64_t *random) {
    const qc_mesh *mesh = k->s->mesh;
    double *uv = ARRAY(double, 6 * (int64_t)mesh->n_faces);
    int32_t *distance = ARRAY(int32_t, mesh->n_vertices);
    memcpy(uv, k->map->uv, 6 * (size_t)mesh->n_faces * sizeof *uv);
    for (int32_t v = 0; v < mesh->n_vertices; v++) distance[v] = v == centre ? 0 : rings + 1;
    for (int32_t round = 0; round < rings; round++)
        for (int32_t e = 0; e < mesh->n_edges; e++)
            for (int side = 0; side < 2; side++) {
                const int32_t a = mesh->edge_vertex[2 * e + side];
                const int32_t b = mesh->edge_vertex[2 * e + 1 - side];
                if (distance[a] == round && distance[b] > rings) distance[b] = round + 1;
            }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (distance[v] <= rings && k->grid->holonomy[v] == 0 && k->s->matching->index4[v] == 0)
            move_vertex(mesh, k->grid->rotation, uv, v,
                        far * (uniform(random) + uniform(random) * I));
    free(distance);
    return uv;
}

static void assert_same_seams(const clean *k, const qc_grid_map *grid) {
    const qc_mesh *mesh = k->s->mesh;
    assert_memory_equal(k->grid->rotation, grid->rotation, (size_t)mesh->n_edges);
    assert_memory_equal(k->grid->translation, grid->translation,
                        2 * sizeof(int32_t) * (size_t)mesh->n_edges);
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        if (grid->holonomy[mesh->face_vertex[c]] == 0) continue;
        for (int i = 0; i < 2; i++)
            assert_true(ldexp(k->grid->uv[2 * c + i], -k->grid->bits) ==
                        ldexp(grid->uv[2 * c + i], -grid->bits));
    }
}

/* A scrambled map, untangled. */
typedef struct trial {
    double *uv;
    qc_corner_map *map, *out;
    qc_grid_map *before, *after;
} trial;

/* Takes uv. relaxed: with the map before rounding; options: NULL = default. */
static trial untangle(const clean *k, double *uv, bool relaxed,
                      const qc_untangle_options *options) {
    qc_ctx *ctx = k->s->ctx;
    trial t = {.uv = uv, .map = with_values(ctx, k->map, k->grid->rotation, uv)};
    if (relaxed) must(ctx, qc_corner_map_set_relaxed(ctx, t.map, k->relaxed));
    t.before = grid_of(ctx, t.map);
    assert_same_seams(k, t.before);
    must(ctx, qc_map_untangle(ctx, t.map, options, &t.out));
    t.after = grid_of(ctx, t.out);
    assert_same_seams(k, t.after);
    return t;
}

static void trial_free(trial *t) {
    qc_object_release(t->after);
    qc_object_release(t->before);
    qc_object_release(t->out);
    qc_object_release(t->map);
    free(t->uv);
}

static void scrambled_maps_are_untangled(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 77;
    for (int i = 0; i < N_CASES; i++) {
        clean *k = clean_create(ctx, &CASES[i], 600);
        for (int round = 0; round < 4; round++) {
            const int32_t centre = (int32_t)(fabs(uniform(&random)) * k->s->mesh->n_vertices);
            double *uv = scrambled(k, centre, 2 + round, 1.5, &random);
            trial t = untangle(k, uv, round % 2, NULL);
            assert_true(t.before->n_flipped > 3);
            if (t.after->n_flipped + t.after->n_degenerate > 0)
                fail_msg("%s, %d rings about %d: %d of %d flips left", CASES[i].shape, 2 + round,
                         (int)centre, (int)t.after->n_flipped, (int)t.before->n_flipped);
            trial_free(&t);
        }
        clean_free(k);
    }
    qc_ctx_free(ctx);
}

/* Half of all faces reversed: every vertex is thrown about. */
static void a_wholly_scrambled_sphere_is_untangled(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 5;
    clean *k = clean_create(ctx, &CASES[0], 300);
    trial t = untangle(k, scrambled(k, 0, 1000, 1.0, &random), false, NULL);
    assert_true(t.before->n_flipped > k->s->mesh->n_faces / 4);
    assert_int_equal(t.after->n_flipped + t.after->n_degenerate, 0);
    trial_free(&t);
    clean_free(k);
    qc_ctx_free(ctx);
}

/* The same bytes on 1, 2 and 3 threads. */
static void threads_change_nothing(void **state) {
    (void)state;
    double *first = NULL;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        qc_ctx *ctx = context(threads);
        uint64_t random = 13;
        clean *k = clean_create(ctx, &CASES[3], 600);
        const size_t bytes = 6 * (size_t)k->s->mesh->n_faces * sizeof(double);
        trial t = untangle(k, scrambled(k, 17, 4, 1.5, &random), false, NULL);
        if (!first) {
            first = ARRAY(double, 6 * (int64_t)k->s->mesh->n_faces);
            memcpy(first, t.out->uv, bytes);
        }
        assert_memory_equal(first, t.out->uv, bytes);
        trial_free(&t);
        clean_free(k);
        qc_ctx_free(ctx);
    }
    free(first);
}

/* An unlucky map is an answer, too: no iterations, no change, fold-overs still told by the grid. */
static void without_iterations_the_best_map_is_returned(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 3;
    clean *k = clean_create(ctx, &CASES[0], 600);
    qc_untangle_options options = QC_UNTANGLE_OPTIONS_INIT;
    options.max_iterations = 0;
    trial t = untangle(k, scrambled(k, 40, 3, 1.5, &random), false, &options);
    assert_int_equal(t.before->n_flipped, t.after->n_flipped);
    trial_free(&t);
    clean_free(k);
    qc_ctx_free(ctx);
}

/* Symmetric Dirichlet energy of a whole map. */
static double distortion(const clean *k, const qc_corner_map *map) {
    const int64_t n = k->s->mesh->n_faces;
    qc_complex *hat = ARRAY(qc_complex, 3 * n);
    double *area = ARRAY(double, n), energy = 0;
    must(k->s->ctx, qc__untangle_targets(k->s->ctx, k->s->mesh, map->edge_length, qc__thin_targets,
                                         hat, area));
    for (int64_t t = 0; t < n; t++) {
        qc_complex f[3], g[3];
        for (int i = 0; i < 3; i++)
            f[i] = (qc_complex){map->uv[6 * t + 2 * i], map->uv[6 * t + 2 * i + 1]};
        energy += qc__face_barrier(hat + 3 * t, area[t], f, g);
    }
    free(hat);
    free(area);
    return energy;
}

/* The distortion after so many steps of evening out. */
static double evened(const clean *k, const qc_corner_map *map, int32_t steps) {
    qc_untangle_options options = QC_UNTANGLE_OPTIONS_INIT;
    qc_corner_map *out = NULL;
    options.relax = steps;
    must(k->s->ctx, qc_map_untangle(k->s->ctx, map, &options, &out));
    qc_grid_map *grid = grid_of(k->s->ctx, out);
    assert_int_equal(grid->n_flipped + grid->n_degenerate, 0);
    assert_same_seams(k, grid);
    const double energy = distortion(k, out);
    qc_object_release(grid);
    qc_object_release(out);
    return energy;
}

/* Evening out lowers the distortion, keeps seams, and turns no face over. */
static void what_was_moved_is_evened_out(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 5;
    for (int i = 0; i < N_CASES; i++) {
        clean *k = clean_create(ctx, &CASES[i], 600);
        double *uv = scrambled(k, k->s->mesh->n_vertices / 3, 4, 1.5, &random), last = INFINITY;
        qc_corner_map *map = with_values(ctx, k->map, k->grid->rotation, uv);
        for (int32_t steps = 0; steps <= 80; steps = 4 * steps + 5) {
            const double energy = evened(k, map, steps);
            assert_true(energy < last || (steps > 20 && energy <= last * (1 + 1e-6)));
            last = energy;
        }
        free(uv);
        qc_object_release(map);
        clean_free(k);
    }
    qc_ctx_free(ctx);
}

/* A map which is squashed but nowhere folded is evened out too. */
static void what_is_distorted_is_evened_out(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 5;
    int better = 0;
    for (int i = 0; i < N_CASES; i++) {
        clean *k = clean_create(ctx, &CASES[i], 600);
        qc_corner_map *squashed = NULL;
        for (double by = 1; !squashed; by *= 0.9) {
            double *uv = scrambled(k, k->s->mesh->n_vertices / 3, 4, by, &random);
            qc_corner_map *map = with_values(ctx, k->map, k->grid->rotation, uv);
            qc_grid_map *grid = grid_of(ctx, map);
            if (grid->n_flipped + grid->n_degenerate == 0) squashed = map;
            if (!squashed) qc_object_release(map);
            qc_object_release(grid);
            free(uv);
        }
        const double before = evened(k, squashed, 0), after = evened(k, squashed, 50);
        assert_true(after <= before * (1 + 1e-6));
        better += after < 0.99 * before;
        qc_object_release(squashed);
        clean_free(k);
    }
    assert_true(better > 0);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clean_maps_come_back_to_the_last_bit),
        cmocka_unit_test(scrambled_maps_are_untangled),
        cmocka_unit_test(a_wholly_scrambled_sphere_is_untangled),
        cmocka_unit_test(what_was_moved_is_evened_out),
        cmocka_unit_test(what_is_distorted_is_evened_out),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(without_iterations_the_best_map_is_returned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
