/* Extraction: counts are exact on closed surfaces and on planar pieces with any boundary. */
#include "unit/map/maps.h"

static void assert_quads(qc_ctx *ctx, const qc_polygon_mesh *q, int32_t faces, int32_t euler,
                         int32_t loops, int32_t irregular) {
    qc_polygon_topology t;
    maps_ok(ctx, qc_polygon_mesh_topology(ctx, q, &t));
    assert_int_equal(q->n_faces, faces);
    assert_int_equal(t.euler, euler);
    assert_int_equal(t.boundary_loops, loops);
    assert_int_equal(t.components, 1);
    assert_int_equal(t.non_quads + t.non_manifold_edges + t.non_manifold_vertices +
                         t.duplicate_faces + t.degenerate_faces + t.inconsistent_edges,
                     0);
    if (irregular >= 0) assert_int_equal(t.irregular, irregular);
}

static int32_t extract_count(qc_ctx *ctx, maps_list *l, int32_t faces, int32_t euler, int32_t loops,
                             int32_t irregular) {
    qc_polygon_mesh *q = maps_extract(ctx, maps_finish(ctx, l));
    assert_quads(ctx, q, faces, euler, loops, irregular);
    const int32_t n = q->n_vertices;
    qc_object_release(q);
    return n;
}

/* Aligned square: lattice points on corners, edges and inside, by the ratio of n to k. */
static void aligned_squares(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {11};
    for (int k = 1; k <= 8; k++)
        for (int n = 1; n <= 9; n++)
            for (int jitter = 0; jitter < 2; jitter++) {
                maps_list l = maps_plane(k, n, n, 0.2 * jitter, 0, 0, 0, &r);
                maps_gauge(&l, &r);
                assert_int_equal(extract_count(ctx, &l, n * n, 1, 1, 0), (n + 1) * (n + 1));
            }
}

/* All mesh vertices at integers or halves: lattice points on vertices and edges, isolines along
 * edges. */
static void coincidences(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {18};
    for (int trial = 0; trial < 60; trial++) {
        const int k = 2 + trial % 5, halves = 1 + trial % 2;
        maps_list l = maps_plane(k, 6 * k, 6 * k, 1.0 / 6, 0, 0, 0, &r);
        for (int32_t i = 0; i < 6 * l.n_faces; i++) l.uv[i] = round(halves * l.uv[i]) / halves;
        maps_gauge(&l, &r);
        extract_count(ctx, &l, 36 * k * k, 1, 1, 0);
    }
}

static void coarse_triangles_hold_many_quads(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {12};
    maps_list l = maps_plane(4, 100, 100, 0.2, 0, 0, 0, &r);
    assert_int_equal(l.n_faces, 32);
    maps_gauge(&l, &r);
    extract_count(ctx, &l, 10000, 1, 1, 0);
}

/* The reference for a convex piece: the unit squares of which it covers half or more, or the centre
 * and a quarter. */
static int32_t squares_covered(const double *polygon, int n) {
    int32_t count = 0;
    for (int x = -40; x < 40; x++)
        for (int y = -40; y < 40; y++) {
            double p[2][64] = {{x, y, x + 1, y, x + 1, y + 1, x, y + 1}};
            int m = 4, now = 0;
            for (int i = 0; i < n; i++, now = !now) { /* clipped by one side of the piece */
                const double *a = polygon + 2 * i, *b = polygon + 2 * ((i + 1) % n);
                int kept = 0;
                for (int j = 0; j < m; j++) {
                    const double *c = p[now] + 2 * j, *d = p[now] + 2 * ((j + 1) % m);
                    const double sc = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                    const double sd = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
                    if (sc >= 0) memcpy(p[!now] + 2 * kept++, c, 2 * sizeof *c);
                    if ((sc >= 0) == (sd >= 0)) continue;
                    for (int k = 0; k < 2; k++)
                        p[!now][2 * kept + k] = c[k] + sc / (sc - sd) * (d[k] - c[k]);
                    kept++;
                }
                m = kept;
            }
            double twice = 0;
            for (int j = 0; j < m; j++) {
                const double *c = p[now] + 2 * j, *d = p[now] + 2 * ((j + 1) % m);
                twice += (c[0] - x) * (d[1] - y) - (c[1] - y) * (d[0] - x);
            }
            bool centre = true;
            for (int i = 0; i < n; i++) {
                const double *a = polygon + 2 * i, *b = polygon + 2 * ((i + 1) % n);
                centre &= (b[0] - a[0]) * (y + 0.5 - a[1]) > (b[1] - a[1]) * (x + 0.5 - a[0]);
            }
            count += twice >= 1 - 1e-6 || (centre && twice >= 0.5);
        }
    return count;
}

static void turned_rectangles_match_the_reference(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {13};
    for (int trial = 0; trial < 60; trial++) {
        const double angle = 3 * maps_uniform(&r), w = 12 + 5 * maps_uniform(&r),
                     h = 9 + 3 * maps_uniform(&r), u = maps_uniform(&r), v = maps_uniform(&r);
        double polygon[8];
        for (int i = 0; i < 4; i++) {
            const double x = i == 1 || i == 2 ? w : 0, y = i >= 2 ? h : 0;
            polygon[2 * i] = cos(angle) * x - sin(angle) * y + u;
            polygon[2 * i + 1] = sin(angle) * x + cos(angle) * y + v;
        }
        maps_list l = maps_plane(3 + trial % 20, w, h, 0.25, angle, u, v, &r);
        maps_gauge(&l, &r);
        extract_count(ctx, &l, squares_covered(polygon, 4), 1, 1, 0);
    }
}

static void tori(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {14};
    static const double basis[][4] = {
        {5, 0, 0, 4}, {6, 2, -1, 7}, {0, 5, -8, 1}, {3, 3, -4, 4}, {12, 0, 5, 3}};
    for (size_t i = 0; i < sizeof basis / sizeof *basis; i++)
        for (int k = 3; k < 12; k += 2) {
            const double *a = basis[i], *b = basis[i] + 2;
            maps_list l = maps_torus(k, a, b, k % 3 ? 0.2 : 0, &r);
            maps_gauge(&l, &r);
            const int32_t area = (int32_t)(a[0] * b[1] - a[1] * b[0]);
            assert_int_equal(extract_count(ctx, &l, area, 0, 0, 0), area);
        }
}

static void cube_and_polycubes(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {15};
    static const uint8_t one[1] = {1};
    /* an L, a corner of four, a ring of eight (genus 1) */
    static const uint8_t ell[27] = {1, 1, 0, 1}, corner[27] = {1, 1, 0, 1, 0, 0, 0, 0, 0, 1};
    static const uint8_t ring[27] = {1, 1, 1, 1, 0, 1, 1, 1, 1};
    for (int n = 1; n <= 5; n++)
        for (int k = 1; k <= 6; k++) {
            maps_list l = maps_voxels(1, one, k, n, 0.2, &r);
            maps_gauge(&l, &r);
            assert_int_equal(extract_count(ctx, &l, 6 * n * n, 2, 0, 8), 6 * n * n + 2);
            l = maps_voxels(3, ell, k, n, 0.2, &r);
            maps_gauge(&l, &r);
            extract_count(ctx, &l, 14 * n * n, 2, 0, 12);
            l = maps_voxels(3, corner, k, n, 0.2, &r);
            maps_gauge(&l, &r);
            extract_count(ctx, &l, 18 * n * n, 2, 0, -1);
            l = maps_voxels(3, ring, k, n, 0.2, &r);
            maps_gauge(&l, &r);
            extract_count(ctx, &l, 32 * n * n, 0, 0, 16);
        }
}

static void cones_of_many_turns(void **state) {
    qc_ctx *ctx = *state;
    for (int turns = 1; turns <= 13; turns++) {
        maps_list l = maps_cone(turns, 5, 4.3, 1, -2);
        /* squares of a quarter covered by a 16-gon of radius 4.3 (inradius 4.22) */
        double polygon[32];
        for (int i = 0; i < 16; i++) {
            polygon[2 * i] = 4.3 * cos(3.14159265358979 * i / 8);
            polygon[2 * i + 1] = 4.3 * sin(3.14159265358979 * i / 8);
        }
        const int32_t quarter = squares_covered(polygon, 16) / 4;
        if (turns == 1) { /* a vertex with one quad would have that quad meet itself */
            qc_corner_map *map = maps_finish(ctx, &l);
            qc_grid_map *grid = NULL;
            qc_polygon_mesh *quads = NULL;
            maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &grid));
            assert_int_equal(qc_map_extract(ctx, grid, &quads), QC_ERR_FAILED);
            assert_non_null(strstr(qc_ctx_error(ctx)->text, "degenerate"));
            qc_object_release(grid);
            qc_object_release(map);
            continue;
        }
        extract_count(ctx, &l, turns * quarter, 1, 1, turns == 4 ? 0 : 1);
    }
}

/* --- the same quads from any charts
 * ------------------------------------------------------------------ */

static int compare_quads(const void *a, const void *b) {
    return memcmp(a, b, 4 * sizeof(int32_t));
}
/* Quads in terms of the vertices of `like` (nearest), rotated to their smallest vertex, sorted. */
static int32_t *canonical(const qc_polygon_mesh *q, const qc_polygon_mesh *like) {
    int32_t *quad = malloc(4 * sizeof *quad * (size_t)q->n_faces);
    for (int32_t f = 0; f < q->n_faces; f++) {
        int32_t w[4];
        int least = 0;
        for (int k = 0; k < 4; k++) {
            const double *p = q->position + 3 * q->face_vertex[4 * f + k];
            double best = INFINITY;
            for (int32_t v = 0; v < like->n_vertices; v++) {
                const double *s = like->position + 3 * v;
                const double d = (p[0] - s[0]) * (p[0] - s[0]) + (p[1] - s[1]) * (p[1] - s[1]) +
                                 (p[2] - s[2]) * (p[2] - s[2]);
                if (d < best) {
                    best = d;
                    w[k] = v;
                }
            }
            assert_true(best < 1e-8);
            if (w[k] < w[least]) least = k;
        }
        for (int k = 0; k < 4; k++) quad[4 * f + k] = w[(least + k) % 4];
    }
    qsort(quad, (size_t)q->n_faces, 4 * sizeof *quad, compare_quads);
    return quad;
}

static void charts_do_not_matter(void **state) {
    qc_ctx *ctx = *state;
    static const uint8_t ring[27] = {1, 1, 1, 1, 0, 1, 1, 1, 1};
    qc_polygon_mesh *first = NULL;
    int32_t *expected = NULL;
    for (uint64_t gauge = 0; gauge < 6; gauge++) {
        maps_rng r = {16}, g = {gauge};
        maps_list l = maps_voxels(3, ring, 4, 3, 0.2, &r);
        if (gauge) maps_gauge(&l, &g);
        qc_polygon_mesh *q = maps_extract(ctx, maps_finish(ctx, &l));
        if (!first) {
            first = q;
            expected = canonical(q, q);
            continue;
        }
        assert_int_equal(q->n_faces, first->n_faces);
        int32_t *quads = canonical(q, first);
        assert_memory_equal(quads, expected, 4 * sizeof *quads * (size_t)q->n_faces);
        free(quads);
        qc_object_release(q);
    }
    free(expected);
    qc_object_release(first);
}

static void sources_give_the_positions(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {17};
    maps_list l = maps_plane(7, 9, 9, 0.25, 0, 0, 0, &r);
    qc_corner_map *map = maps_finish(ctx, &l);
    const qc_mesh *m = qc_object_retain(map->mesh);
    qc_polygon_mesh *q = maps_extract(ctx, map);
    for (int32_t v = 0; v < q->n_vertices; v++) {
        const double *w = q->source_barycentric + 3 * v;
        assert_true(fabs(w[0] + w[1] + w[2] - 1) < 1e-15 * 4);
        for (int i = 0; i < 2; i++) {
            double x = 0;
            for (int k = 0; k < 3; k++) {
                assert_true(w[k] >= 0 && w[k] <= 1);
                x += w[k] * m->position[3 * m->face_vertex[3 * q->source_face[v] + k] + i];
            }
            assert_true(fabs(x - round(x)) < 1e-5); /* here parameters are positions */
            assert_true(fabs(q->position[3 * v + i] - x) < 1e-12);
        }
    }
    qc_object_release(q);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aligned_squares),
        cmocka_unit_test(coincidences),
        cmocka_unit_test(coarse_triangles_hold_many_quads),
        cmocka_unit_test(turned_rectangles_match_the_reference),
        cmocka_unit_test(tori),
        cmocka_unit_test(cube_and_polycubes),
        cmocka_unit_test(cones_of_many_turns),
        cmocka_unit_test(charts_do_not_matter),
        cmocka_unit_test(sources_give_the_positions),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
