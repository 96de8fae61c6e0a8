/* Features and aligned boundaries: exact levels, lattice points at corners, chains of quad edges.
 */
#include "unit/map/aligned.h"

/* Every quad mesh vertex which a line touches lies on a feature edge of the mesh. */
static void assert_lines_on_features(const qc_grid_map *g, const qc_polygon_mesh *q) {
    const qc_mesh *m = g->mesh;
    for (int32_t i = 0; i < q->n_lines; i++) {
        assert_in_range(q->source_edge[i], 0, m->n_edges - 1);
        assert_true(g->axis[q->source_edge[i]] >= 0);
        for (int end = 0; end < 2; end++) {
            const int32_t v = q->line[2 * i + end], t = q->source_face[v];
            const double *w = q->source_barycentric + 3 * v;
            bool on = false;
            for (int k = 0; k < 3; k++) {
                if (w[k] == 1)
                    for (int32_t e = 0; e < m->n_edges; e++)
                        for (int s = 0; s < 2; s++)
                            on |= g->axis[e] >= 0 &&
                                  m->edge_vertex[2 * e + s] == m->face_vertex[3 * t + k];
                on |= w[k] == 0 && g->axis[m->halfedge_edge[3 * t + k]] >= 0;
            }
            assert_true(on);
        }
    }
}

/* Length of all features in parameter units. */
static double feature_length(const qc_grid_map *g) {
    double sum = 0;
    for (int32_t e = 0; g->axis && e < g->mesh->n_edges; e++) {
        const int32_t h = g->mesh->edge_halfedge[2 * e];
        const int32_t *p = g->uv + 2 * qc_next(h), *q = g->uv + 2 * qc_prev(h);
        if (g->axis[e] < 0) continue;
        assert_true(p[0] == q[0] || p[1] == q[1]);
        sum += ldexp(fabs((double)q[0] - p[0]) + fabs((double)q[1] - p[1]), -g->bits);
    }
    return sum;
}

static double chain_distance(qc_ctx *ctx, const qc_grid_map *g, const qc_polygon_mesh *q) {
    qc_corner_map *map = NULL;
    qc_report *report = NULL;
    maps_ok(ctx, qc_grid_map_to_corner_map(ctx, g, NULL, &map));
    maps_ok(ctx, qc_report_create(ctx, &report));
    maps_ok(ctx, qc_report_measure(ctx, g->mesh, NULL, NULL, map, q, NULL, report));
    assert_int_equal(report->quads.feature_edges, q->n_lines);
    const double distance = report->quads.feature_distance / g->mesh->diagonal;
    qc_object_release(map);
    qc_object_release(report);
    return distance;
}

/* In the plane features are straight between the quad vertices: the polylines coincide, and a
 * vertex which leaves them is noticed. */
static void assert_chains_coincide(qc_ctx *ctx, const qc_grid_map *g, const qc_polygon_mesh *q) {
    for (int32_t v = 0; v < g->mesh->n_vertices; v++)
        if (g->mesh->position[3 * v + 2] != 0) return;
    assert_true(chain_distance(ctx, g, q) <= 1e-6);
    double *z = &q->position[3 * q->line[0] + 2];
    *z = 0.25 * g->mesh->diagonal;
    assert_true(fabs(chain_distance(ctx, g, q) - 0.25) < 1e-9);
    *z = 0;
}

static void assert_quads(qc_ctx *ctx, qc_corner_map *map, int32_t faces, int32_t irregular) {
    qc_grid_map *g = NULL;
    qc_polygon_mesh *q = NULL;
    qc_polygon_topology t;
    maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &g));
    maps_ok(ctx, qc_map_extract(ctx, g, &q));
    maps_ok(ctx, qc_polygon_mesh_topology(ctx, q, &t));
    assert_int_equal(q->n_faces, faces);
    assert_int_equal(t.euler, map->mesh->euler);
    assert_int_equal(t.boundary_loops, map->mesh->n_boundary_loops);
    if (irregular >= 0) assert_int_equal(t.irregular, irregular);
    assert_true((double)q->n_lines == feature_length(g));
    assert_lines_on_features(g, q);
    assert_chains_coincide(ctx, g, q);
    qc_object_release(q);
    qc_object_release(g);
    qc_object_release(map);
}

static void cylinders(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {31};
    for (int k = 3; k <= 9; k += 2)
        for (int n = 3; n <= 9; n++) {
            maps_list l = maps_cylinder(k, n, n + 3, 0.2, &r);
            maps_gauge(&l, &r);
            assert_quads(ctx, maps_finish(ctx, &l), n * (n + 3), 0);
        }
}

static void fans(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {32};
    for (int turns = 1; turns <= 9; turns++)
        for (int n = 1; n <= 7; n += 2)
            for (int closed = turns > 2; closed >= 0; closed--) {
                maps_list l = maps_fan(turns, closed, 4, n, 0.2, &r);
                maps_gauge(&l, &r);
                const int irregular = closed && turns != 4;
                assert_quads(ctx, maps_finish(ctx, &l), turns * n * n, irregular);
            }
}

/* All isolines of spacing 3 on cubes and polycubes, with cones on them. */
static void polycubes(void **state) {
    qc_ctx *ctx = *state;
    static const uint8_t shape[3][27] = {{1}, {1, 1, 0, 0, 1}, {1, 1, 1, 1, 0, 1, 1, 1, 1}};
    static const int32_t sides[3] = {6, 14, 32};
    for (int i = 0; i < 3; i++)
        for (int k = 2; k <= 5; k++) {
            maps_rng r = {33};
            maps_list l = maps_voxels(3, shape[i], k, 3, 0.2, &r);
            qc_corner_map *map = maps_finish_aligned(ctx, &l, 3, &r);
            assert_quads(ctx, map, 9 * sides[i], -1);
        }
}

/* A square with two lines which cross and one which ends inside. */
static void lines_inside(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {34};
    for (int n = 6; n <= 12; n += 3) {
        maps_list l = maps_plane(6, n, n, 0, 0, 0, 0, &r);
        qc_corner_map *map = maps_finish(ctx, &l);
        int8_t *axis = maps_isolines(map, n / 3.0);
        const qc_mesh *m = map->mesh;
        for (int32_t e = 0; e < m->n_edges; e++) { /* the second row ends at the first column */
            const double *p = m->position + 3 * m->edge_vertex[2 * e];
            const double *q = m->position + 3 * m->edge_vertex[2 * e + 1];
            if (m->edge_halfedge[2 * e + 1] >= 0 && axis[e] >= 0 && axis[e] % 2 == 0 &&
                p[0] + q[0] > 2 * n / 3.0 && p[1] > n / 2.0)
                axis[e] = -1;
        }
        maps_ok(ctx, qc_corner_map_set_axis(ctx, map, axis));
        free(axis);
        assert_quads(ctx, map, n * n, 0);
    }
}

/* Noise below the tolerance goes: the boundary is exactly that of the square. */
static void noise_on_the_boundary(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {35};
    for (int trial = 0; trial < 20; trial++) {
        const int n = 2 + trial % 7;
        maps_list l = maps_plane(5, n, n, 0.2, 0, 0, 0, &r);
        for (int32_t i = 0; i < 6 * l.n_faces; i++) l.uv[i] += 0.004 * maps_uniform(&r);
        qc_corner_map *map = maps_finish(ctx, &l);
        qc_grid_map *g = NULL;
        maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &g));
        assert_true(feature_length(g) == 4 * n);
        qc_object_release(g);
        assert_quads(ctx, map, n * n, 0);
    }
}

/* --- errors ----------------------------------------------------------------------------------- */

static qc_corner_map *square_with_line(qc_ctx *ctx, double shift, double slope, int32_t *edge) {
    maps_rng r = {36};
    maps_list l = maps_plane(4, 4, 4, 0, 0, 0, 0, &r);
    for (int32_t c = 0; c < 3 * l.n_faces; c++)
        if (l.uv[2 * c + 1] == 2) l.uv[2 * c + 1] += shift + slope * (l.uv[2 * c] - 2);
    qc_corner_map *map = maps_finish(ctx, &l);
    const qc_mesh *m = map->mesh;
    int8_t *axis = malloc((size_t)m->n_edges);
    *edge = -1;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const double *p = m->position + 3 * m->edge_vertex[2 * e];
        const double *q = m->position + 3 * m->edge_vertex[2 * e + 1];
        axis[e] = p[1] == 2 && q[1] == 2 ? (q[0] > p[0] ? 0 : 2) : -1;
        if (axis[e] >= 0 && *edge < 0) *edge = e;
    }
    maps_ok(ctx, qc_corner_map_set_axis(ctx, map, axis));
    free(axis);
    return map;
}

static void levels_off_the_grid_are_refused(void **state) {
    qc_ctx *ctx = *state;
    static const double shift[3] = {0.3, 0, 0.02}, slope[3] = {0, 0.1, 0.001};
    for (int i = 0; i < 3; i++) {
        qc_grid_map *g = NULL;
        int32_t edge;
        qc_corner_map *map = square_with_line(ctx, shift[i], slope[i], &edge);
        const qc_status status = qc_grid_map_create(ctx, map, 0, &g);
        assert_int_equal(status, i == 2 ? QC_OK : QC_ERR_FAILED);
        if (i == 0) assert_int_equal(qc_ctx_error(ctx)->where, edge);
        if (i < 2) assert_non_null(strstr(qc_ctx_error(ctx)->text, "feature"));
        if (i == 0) assert_non_null(strstr(qc_ctx_error(ctx)->text, "0.3"));
        if (i == 2) assert_true(feature_length(g) == 4);
        qc_object_release(g);
        qc_object_release(map);
    }
}

/* The features survive the way to doubles and back. */
static void conversions_keep_features(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {37};
    static const uint8_t cube[27] = {1};
    maps_list l = maps_voxels(3, cube, 4, 3, 0.2, &r);
    qc_corner_map *map = maps_finish_aligned(ctx, &l, 3, &r), *again = NULL;
    qc_grid_map *g = NULL;
    maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &g));
    maps_ok(ctx, qc_grid_map_to_corner_map(ctx, g, map, &again));
    assert_memory_equal(again->axis, map->axis, (size_t)map->mesh->n_edges);
    qc_object_release(again);
    qc_object_release(g);
    qc_object_release(map);
}

/* A small hole near an isoline and a slanted side are no features. */
static void unaligned_boundaries_stay(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {38};
    for (int i = 0; i < 2; i++) {
        maps_list l = i == 0 ? maps_plane(6, 0.03, 0.03, 0, 0, 0, 0, &r)
                             : maps_plane(6, 7, 7, 0, 0.1, 0, 0, &r);
        qc_corner_map *map = maps_finish(ctx, &l);
        qc_grid_map *g = NULL;
        maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &g));
        assert_null(g->axis);
        qc_object_release(g);
        qc_object_release(map);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cylinders),
        cmocka_unit_test(fans),
        cmocka_unit_test(polycubes),
        cmocka_unit_test(lines_inside),
        cmocka_unit_test(noise_on_the_boundary),
        cmocka_unit_test(levels_off_the_grid_are_refused),
        cmocka_unit_test(conversions_keep_features),
        cmocka_unit_test(unaligned_boundaries_stay),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
