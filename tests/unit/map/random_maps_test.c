/* 500 random maps (genus, cones, boundaries, charts, coincidences, fold-overs, broken seams): the
 * quads are those of a second, slow extraction; or the error names a place. */
#include "unit/map/aligned.h"
#include "unit/map/reference_extract.h"

enum { N_MAPS = 500 };

static int between(maps_rng *r, int low, int high) {
    return low + (int)(maps_random(r) % (uint32_t)(high - low + 1));
}

static maps_list random_torus(maps_rng *r, double jitter) {
    for (;;) {
        const double a[2] = {between(r, 1, 7), between(r, -3, 3)};
        const double b[2] = {between(r, -3, 3), between(r, 1, 7)};
        const int k = between(r, 3, 7);
        if (a[0] * b[1] - a[1] * b[0] >= 3) return maps_torus(k, a, b, jitter, r);
    }
}

/* A connected or scattered set of voxels; the mesh may turn out not to be a manifold. */
static maps_list random_polycube(maps_rng *r, double jitter) {
    uint8_t voxel[27] = {0};
    const int size = between(r, 1, 3), filled = between(r, 1, 3);
    for (int i = 0; i < size * size * size; i++) voxel[i] = between(r, 0, 3) < filled;
    voxel[0] = 1;
    return maps_voxels(size, voxel, between(r, 2, 4), between(r, 1, 4), jitter, r);
}

static maps_list random_list(maps_rng *r) {
    const double jitter = between(r, 0, 1) ? 0.25 : 0;
    const int kind = between(r, 0, 4), k = between(r, 3, 7), turns = between(r, 1, 9);
    maps_list l;
    switch (kind) {
    case 0:
        return random_torus(r, jitter);
    case 1:
        l = maps_cylinder(k, between(r, 3, 9), between(r, 1, 9), jitter, r);
        return l;
    case 2:
        l = maps_fan(turns, turns > 2 && between(r, 0, 1), k, between(r, 1, 6), jitter, r);
        return l;
    case 3:
        l = maps_plane(k, between(r, 1, 9), between(r, 1, 9), jitter, 0, 0, 0, r);
        return l;
    default:
        return random_polycube(r, jitter);
    }
}

/* In random charts; NULL when the surface is no manifold. */
static qc_corner_map *random_map(qc_ctx *ctx, maps_rng *r) {
    maps_list l = random_list(r);
    qc_mesh *mesh = NULL;
    qc_corner_map *map = NULL;
    if (between(r, 0, 3) == 0) /* lattice points at vertices, isolines along edges */
        for (int32_t i = 0; i < 6 * l.n_faces; i++) l.uv[i] = round(2 * l.uv[i]) / 2;
    maps_gauge(&l, r);
    if (qc_mesh_create(ctx, l.n_vertices, l.position, l.n_faces, l.face, &mesh) == QC_OK)
        maps_ok(ctx, qc_corner_map_create(ctx, mesh, l.uv, 0, NULL, &map));
    qc_object_release(mesh);
    maps_list_free(&l);
    return map;
}

static int32_t defects(const qc_polygon_topology *t) {
    return t->non_quads + t->non_manifold_edges + t->non_manifold_vertices + t->inconsistent_edges +
           t->duplicate_faces + t->degenerate_faces;
}

/* The quads in terms of the reference's vertices. */
static void assert_equal_quads(const qc_grid_map *g, const qc_polygon_mesh *q,
                               const reference_quads *ref) {
    int32_t *vertex = malloc(sizeof *vertex * (size_t)q->n_vertices);
    int32_t *quad = malloc(4 * sizeof *quad * (size_t)q->n_faces);
    assert_int_equal(q->n_faces, ref->n_quads);
    assert_int_equal(q->n_vertices, ref->n_vertices);
    for (int32_t v = 0; v < q->n_vertices; v++) {
        double uv[2] = {0, 0};
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++)
                uv[i] += q->source_barycentric[3 * v + k] *
                         ldexp(g->uv[6 * q->source_face[v] + 2 * k + i], -g->bits);
        for (int i = 0; i < 2; i++) assert_true(fabs(uv[i] - round(uv[i])) < 1e-9);
        vertex[v] = reference_vertex(ref, q->source_face[v], llround(uv[0]), llround(uv[1]));
        assert_true(vertex[v] >= 0);
    }
    for (int32_t i = 0; i < 4 * q->n_faces; i++) quad[i] = vertex[q->face_vertex[i]];
    reference_sort(quad, q->n_faces);
    assert_memory_equal(quad, ref->quad, 4 * sizeof *quad * (size_t)q->n_faces);
    free(vertex);
    free(quad);
}

/* A refusal is right when the quads of the reference are no copy of the surface. */
static void assert_no_copy(qc_ctx *ctx, const qc_grid_map *g, const reference_quads *ref) {
    qc_polygon_mesh *q = NULL;
    qc_polygon_topology t;
    maps_ok(ctx, qc_polygon_mesh_create(ctx, ref->n_vertices, ref->n_quads, 4 * ref->n_quads, 0, 0,
                                        0, &q));
    for (int32_t f = 0; f <= ref->n_quads; f++) q->face_offset[f] = 4 * f;
    memcpy(q->face_vertex, ref->quad, 4 * sizeof *ref->quad * (size_t)ref->n_quads);
    maps_ok(ctx, qc_polygon_mesh_topology(ctx, q, &t));
    assert_true(defects(&t) > 0 || t.components != g->mesh->n_components ||
                t.boundary_loops != g->mesh->n_boundary_loops || t.euler != g->mesh->euler);
    qc_object_release(q);
}

/* The result, if there is one, is a copy of the surface; else the error says something. */
static qc_polygon_mesh *quads_or_error(qc_ctx *ctx, const qc_grid_map *g) {
    qc_polygon_mesh *q = NULL;
    qc_polygon_topology t;
    if (qc_map_extract(ctx, g, &q) != QC_OK) {
        assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_FAILED);
        assert_true(strlen(qc_ctx_error(ctx)->text) > 20);
        return NULL;
    }
    maps_ok(ctx, qc_polygon_mesh_topology(ctx, q, &t));
    assert_int_equal(defects(&t), 0);
    assert_int_equal(t.components, g->mesh->n_components);
    assert_int_equal(t.boundary_loops, g->mesh->n_boundary_loops);
    assert_int_equal(t.euler, g->mesh->euler);
    return q;
}

/* Boundaries which do not follow isolines need choices which the reference does not make. */
static bool has_open_boundary(const qc_grid_map *g) {
    for (int32_t e = 0; e < g->mesh->n_edges; e++)
        if (g->mesh->edge_halfedge[2 * e + 1] < 0 && (!g->axis || g->axis[e] < 0)) return true;
    return false;
}

typedef struct counts {
    int agree, refused, folded, unfolded, broken, open;
} counts;

static void compare_with_reference(qc_ctx *ctx, const qc_grid_map *g, const qc_polygon_mesh *q,
                                   counts *n) {
    reference_quads ref;
    if (has_open_boundary(g)) {
        n->open++;
        return;
    }
    assert_true(reference_extract(g, &ref));
    if (q)
        assert_equal_quads(g, q, &ref);
    else
        assert_no_copy(ctx, g, &ref);
    n->agree += q != NULL;
    n->refused += q == NULL;
    reference_free(&ref);
}

/* The same map without its fold-overs, when they can be removed. */
static void try_untangled(qc_ctx *ctx, const qc_corner_map *map, counts *n) {
    qc_corner_map *flat = NULL;
    qc_grid_map *g = NULL;
    maps_ok(ctx, qc_map_untangle(ctx, map, NULL, &flat));
    maps_ok(ctx, qc_grid_map_create(ctx, flat, 0, &g));
    if (g->n_flipped + g->n_degenerate == 0) {
        qc_polygon_mesh *q = quads_or_error(ctx, g);
        compare_with_reference(ctx, g, q, n);
        qc_object_release(q);
        n->unfolded++;
    }
    qc_object_release(g);
    qc_object_release(flat);
}

static void try_map(qc_ctx *ctx, const qc_corner_map *map, counts *n) {
    qc_grid_map *g = NULL;
    if (qc_grid_map_create(ctx, map, 0, &g) != QC_OK) {
        assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_FAILED);
        assert_true(qc_ctx_error(ctx)->where >= 0);
        n->broken++;
        return;
    }
    qc_polygon_mesh *q = quads_or_error(ctx, g);
    if (g->n_flipped + g->n_degenerate > 0) {
        assert_null(q);
        assert_true(qc_ctx_error(ctx)->where == g->first_flipped);
        n->folded++;
        try_untangled(ctx, map, n);
    } else {
        compare_with_reference(ctx, g, q, n);
    }
    qc_object_release(q);
    qc_object_release(g);
}

/* One corner is moved by whole units, so that the face does not fit its neighbours. */
static qc_corner_map *with_broken_seam(qc_ctx *ctx, const qc_corner_map *map, maps_rng *r) {
    const size_t n = 6 * (size_t)map->mesh->n_faces;
    double *uv = malloc(n * sizeof *uv);
    qc_corner_map *out = NULL;
    memcpy(uv, map->uv, n * sizeof *uv);
    uv[maps_random(r) % n] += between(r, 0, 1) ? 1 : 0.3;
    maps_ok(ctx, qc_corner_map_create(ctx, map->mesh, uv, 0, NULL, &out));
    free(uv);
    return out;
}

static void random_maps(void **state) {
    qc_ctx *ctx = *state;
    counts n = {0};
    maps_rng r = {2026};
    for (int i = 0; i < N_MAPS;) {
        qc_corner_map *map = random_map(ctx, &r);
        qc_grid_map *g = NULL;
        if (!map) continue;
        i++;
        if (qc_grid_map_create(ctx, map, 0, &g) == QC_OK) {
            qc_object_release(g);
            const int kind = between(&r, 0, 5);
            static const double far[6] = {0, 0.02, 0.1, 0.5, 1.5, 0};
            qc_corner_map *other =
                kind == 5 ? with_broken_seam(ctx, map, &r) : maps_thrown(ctx, map, far[kind], &r);
            try_map(ctx, other, &n);
            qc_object_release(other);
        } else {
            try_map(ctx, map, &n);
        }
        qc_object_release(map);
    }
    assert_int_equal(n.agree + n.refused + n.open + n.folded - n.unfolded + n.broken, N_MAPS);
    assert_true(n.agree > N_MAPS / 2 && n.unfolded > N_MAPS / 10 && n.broken > N_MAPS / 20);
    print_message("%d agree, %d refused, %d of %d unfolded, %d broken, %d open\n", n.agree,
                  n.refused, n.unfolded, n.folded, n.broken, n.open);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_maps),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
