/* The coarse complex of an exact map: closed, positive, of the same area and Euler characteristic,
 * with points and features only; every face of the mesh is found in it, and integers which are
 * those of the map itself give the map back. */
#include "tests/unit/map/exact_maps.h"

#include "unit/mesh/failing_allocator.h"

enum { N_MAPS = 150 };

static int between(maps_rng *r, int low, int high) {
    return low + (int)(maps_random(r) % (uint32_t)(high - low + 1));
}

static maps_list random_list(maps_rng *r) {
    const double jitter = between(r, 0, 2) ? 0.25 : 0;
    uint8_t voxel[27] = {0};
    const int size = between(r, 1, 3), kind = between(r, 0, 3), k = between(r, 3, 9);
    if (kind == 0) {
        const double a[2] = {between(r, 2, 7), between(r, -1, 1)}, b[2] = {between(r, -1, 1), 3};
        return maps_torus(k, a, b, jitter, r);
    }
    if (kind == 1) return maps_cylinder(k, between(r, 3, 9), between(r, 1, 9), jitter, r);
    if (kind == 2) return maps_plane(k, between(r, 1, 9), between(r, 1, 9), jitter, 0, 0, 0, r);
    for (int i = 0; i < size * size * size; i++) voxel[i] = between(r, 0, 3) < 3;
    voxel[0] = 1;
    return maps_voxels(size, voxel, between(r, 2, 5), between(r, 1, 4), jitter, r);
}

/* In random charts; false when the surface is no manifold or the map is not positive. */
static bool random_case(qc_ctx *ctx, maps_rng *r, exact_case *out) {
    maps_list l = random_list(r);
    qc_mesh *mesh = NULL;
    qc_corner_map *map = NULL;
    qc_grid_map *grid = NULL;
    maps_gauge(&l, r);
    if (qc_mesh_create(ctx, l.n_vertices, l.position, l.n_faces, l.face, &mesh) == QC_OK) {
        maps_ok(ctx, qc_corner_map_create(ctx, mesh, l.uv, 0, NULL, &map));
        maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &grid));
    }
    qc_object_release(map);
    qc_object_release(mesh);
    maps_list_free(&l);
    if (!grid || grid->n_flipped + grid->n_degenerate > 0) {
        qc_object_release(grid);
        return false;
    }
    *out = exact_from_grid(grid);
    return true;
}

static double doubled_area(const qc_grid_map *g) {
    double area = 0;
    for (int32_t t = 0; t < g->mesh->n_faces; t++)
        area += ldexp((double)qc_grid_map_orientation(g, t), -2 * g->bits);
    return area;
}

static void assert_complex(const exact_case *e, const qc__coarse *c) {
    double area = 0;
    int32_t edges = 0, vertices = 0;
    uint8_t *seen = calloc((size_t)e->map.mesh->n_vertices, 1);
    for (int32_t h = 0; h < 3 * c->n_triangles; h++) {
        const int32_t g = c->twin[h];
        const qc__point x = c->vector[h];
        vertices += !seen[c->origin[h]];
        seen[c->origin[h]] = 1;
        edges += g < h;
        if (c->axis[h] >= 0) {
            const qc__point along = qc__turn_point(x, 4 - c->axis[h]);
            assert_true(along.u > 0 && along.v == 0);
        }
        if (g < 0) continue;
        assert_int_equal(c->twin[g], h);
        const qc__point sum = qc__plus(qc__turn_point(x, c->rotation[h]), c->vector[g]);
        assert_true(sum.u == 0 && sum.v == 0);
        assert_int_equal((c->rotation[h] + c->rotation[g]) & 3, 0);
        assert_int_equal(c->axis[g] >= 0, c->axis[h] >= 0);
    }
    for (int32_t t = 0; t < c->n_triangles; t++) {
        const qc__point *x = c->vector + 3 * t, sum = qc__plus(qc__plus(x[0], x[1]), x[2]);
        assert_true(sum.u == 0 && sum.v == 0);
        assert_true(qc__area_sign(x[0], x[1]) > 0);
        area += qc__area_of(x[0], x[1]) * ldexp(1, -2 * c->bits);
    }
    const double wanted = doubled_area(e->grid);
    assert_true(fabs(area - wanted) < 1e-12 * wanted);
    assert_int_equal(vertices - edges + c->n_triangles, e->map.mesh->euler);
    for (int32_t v = 0; v < e->map.mesh->n_vertices; v++) assert_true(seen[v] || !e->point[v]);
    free(seen);
}

static void assert_markers(const qc__coarse_map *m) {
    const qc__coarse *c = &m->coarse;
    for (int32_t f = 0; f < m->mesh->n_faces; f++)
        for (int32_t h = 3 * m->triangle[f]; h < 3 * m->triangle[f] + 3; h++) {
            const qc__point p = qc__minus(m->place[f], qc__corner_place(c->vector, h));
            assert_true(qc__area_sign(c->vector[h], p) >= 0);
        }
}

/* Vertices which are neither points nor on features nor on the boundary. */
static int32_t count_needless(const exact_case *e, const qc__coarse *c) {
    uint8_t *free_vertex = calloc((size_t)e->map.mesh->n_vertices, 1);
    int32_t n = 0;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++) free_vertex[c->origin[h]] = 1;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++)
        if (c->axis[h] >= 0 || c->twin[h] < 0)
            free_vertex[c->origin[h]] = free_vertex[c->origin[qc_next(h)]] = 0;
    for (int32_t v = 0; v < e->map.mesh->n_vertices; v++) n += free_vertex[v] && !e->point[v];
    free(free_vertex);
    return n;
}

/* The vectors of the map itself, where points are on the lattice and no anchor is. */
static bool own_integers(const qc__coarse *c, qc__point *x) {
    const int64_t unit = (int64_t)1 << c->bits;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++) {
        if (c->vector[h].u % unit || c->vector[h].v % unit) return false;
        x[h] = (qc__point){c->vector[h].u / unit, c->vector[h].v / unit};
    }
    return true;
}

static bool assert_same_map(const exact_case *e, const qc__coarse_map *m) {
    qc__point *x = malloc(sizeof *x * 3 * (size_t)m->coarse.n_triangles);
    double *uv = malloc(sizeof *uv * 6 * (size_t)m->mesh->n_faces);
    const bool own = own_integers(&m->coarse, x);
    if (own) qc__quantized_values(&e->map, m, x, uv);
    for (int64_t i = 0; i < 6 * (int64_t)m->mesh->n_faces && own; i++) {
        const int64_t first = i / 6 * 6 + i % 2;
        const double moved =
            uv[i] - uv[first] - ldexp((double)(e->uv[i] - e->uv[first]), -e->map.bits);
        assert_true(fabs(moved) < 1e-9);
    }
    free(x);
    free(uv);
    return own;
}

static void complexes_of_random_maps(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {5};
    int32_t cases = 0, own = 0;
    for (int i = 0; i < N_MAPS; i++) {
        exact_case e;
        qc__coarse_map *m = NULL;
        if (!random_case(ctx, &r, &e)) continue;
        maps_ok(ctx, qc__coarse_map_create(ctx, &e.map, &m));
        assert_complex(&e, &m->coarse);
        assert_markers(m);
        assert_true(count_needless(&e, &m->coarse) <= (e.n_points == 0));
        own += assert_same_map(&e, m);
        cases++;
        qc__coarse_map_free(m);
        exact_free(&e);
    }
    assert_true(cases > N_MAPS / 2 && own > cases / 2);
}

/* The refined map is positive everywhere and has the quads which were promised. */
static void assert_imprint(qc_ctx *ctx, const exact_case *e, qc__imprint *p, double made) {
    const qc_mesh *mesh = e->map.mesh;
    qc_corner_map *map = NULL;
    qc_grid_map *grid = NULL;
    qc_polygon_mesh *quads = NULL;
    qc_polygon_topology t;
    assert_int_equal(p->mesh->euler, mesh->euler);
    assert_int_equal(p->mesh->n_boundary_loops, mesh->n_boundary_loops);
    assert_true(fabs(p->mesh->area - mesh->area) < 1e-9 * mesh->area);
    maps_ok(ctx, qc_corner_map_create(ctx, p->mesh, p->uv, 0, NULL, &map));
    maps_ok(ctx, qc_corner_map_set_rotation(ctx, map, p->rotation));
    if (p->axis) maps_ok(ctx, qc_corner_map_set_axis(ctx, map, p->axis));
    maps_ok(ctx, qc_grid_map_create(ctx, map, 1e-6, &grid));
    assert_int_equal(grid->n_flipped + grid->n_degenerate, 0);
    assert_true(fabs(0.5 * doubled_area(grid) - made) < 1e-6 * made);
    if (qc_map_extract(ctx, grid, &quads) == QC_OK) {
        maps_ok(ctx, qc_polygon_mesh_topology(ctx, quads, &t));
        assert_int_equal(t.non_quads + t.non_manifold_edges + t.non_manifold_vertices, 0);
        assert_int_equal(t.boundary_loops, mesh->n_boundary_loops);
        if (mesh->n_boundary_loops == 0) assert_int_equal(t.euler, mesh->euler);
        if (mesh->n_boundary_loops == 0) assert_int_equal(quads->n_faces, lround(made));
    } else { /* so few quads that they meet themselves, as one around a torus does */
        assert_non_null(strstr(qc_ctx_error(ctx)->text, "the grid is too coarse"));
        assert_true(made < 100);
    }
    qc_object_release(quads);
    qc_object_release(grid);
    qc_object_release(map);
    qc__imprint_free(p);
}

/* Integers at any scale make the map integer-seamless, with the same rotations and features. */
static void values_are_integer_seamless(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {6};
    for (int i = 0; i < N_MAPS / 3; i++) {
        exact_case e;
        if (!random_case(ctx, &r, &e)) continue;
        for (double scale = 3.7; scale > 0.1; scale *= 0.3) {
            const qc_mesh *mesh = e.map.mesh;
            double *uv = malloc(sizeof *uv * 6 * (size_t)mesh->n_faces), made;
            qc_corner_map *map = NULL;
            qc_grid_map *grid = NULL;
            qc__imprint imprint;
            maps_ok(ctx, qc__quantize(ctx, &e.map, scale, 0, uv, &made, &imprint));
            maps_ok(ctx, qc_corner_map_create(ctx, mesh, uv, 0, NULL, &map));
            maps_ok(ctx, qc_corner_map_set_rotation(ctx, map, e.map.rotation));
            if (e.map.axis) maps_ok(ctx, qc_corner_map_set_axis(ctx, map, e.map.axis));
            maps_ok(ctx, qc_grid_map_create(ctx, map, 1e-6, &grid));
            assert_memory_equal(grid->holonomy, e.grid->holonomy, (size_t)mesh->n_vertices);
            assert_true(made > 0);
            assert_imprint(ctx, &e, &imprint, made);
            free(uv);
            qc_object_release(map);
            qc_object_release(grid);
        }
        exact_free(&e);
    }
}

static qc_status quantize_and_free(qc_ctx *ctx, const void *data) {
    const exact_case *e = data;
    double made, *uv = malloc(sizeof *uv * 6 * (size_t)e->map.mesh->n_faces);
    qc__imprint imprint = {0};
    const qc_status status = qc__quantize(ctx, &e->map, 0.7, 0, uv, &made, &imprint);
    assert_true((status == QC_OK) == (imprint.mesh != NULL));
    qc__imprint_free(&imprint);
    free(uv);
    return status;
}

static void allocations_may_fail(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {11};
    for (int cases = 0; cases < 3;) {
        exact_case e;
        if (!random_case(ctx, &r, &e)) continue;
        fail_every_allocation(quantize_and_free, &e);
        exact_free(&e);
        cases++;
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(complexes_of_random_maps),
        cmocka_unit_test(values_are_integer_seamless),
        cmocka_unit_test(allocations_may_fail),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
