/* Maps whose boundary lies on isolines, and the marking of features: cylinders, fans of squares;
 * and maps with their vertices thrown about. */
#ifndef QC_TESTS_ALIGNED_H
#define QC_TESTS_ALIGNED_H

#include "sdk/map/untangle/reduced_map.h"
#include "unit/map/maps.h"

/* k x k squares on a cylinder of circumference and height given in quads. */
static inline maps_list maps_cylinder(int k, double around, double height, double jitter,
                                      maps_rng *r) {
    maps_list l = maps_list_create(k * (k + 1), 2 * k * k);
    l.n_vertices = k * (k + 1);
    double *at = calloc(2 * (size_t)l.n_vertices, sizeof *at);
    for (int j = 0; j <= k; j++)
        for (int i = 0; i < k; i++) {
            const int v = j * k + i;
            const double angle = 6.283185307179586 * i / k;
            l.position[3 * v] = cos(angle);
            l.position[3 * v + 1] = sin(angle);
            l.position[3 * v + 2] = 3.0 * j / k;
            at[2 * v] = i + jitter * maps_uniform(r);
            at[2 * v + 1] = j + (j > 0 && j < k ? jitter * maps_uniform(r) : 0);
        }
    for (int j = 0; j < k; j++)
        for (int i = 0; i < k; i++) {
            int32_t w[4];
            double uv[8];
            for (int c = 0; c < 4; c++) {
                const int x = i + (c == 1 || c == 2), y = j + (c >= 2);
                w[c] = y * k + x % k;
                uv[2 * c] = (at[2 * w[c]] + (x == k ? k : 0)) * around / k;
                uv[2 * c + 1] = at[2 * w[c] + 1] * height / k;
            }
            maps_square(&l, w, uv, maps_random(r) & 1);
        }
    free(at);
    return l;
}

/* Squares of n x n quads, k x k squares of triangles each, around a vertex: closed, a cone of
 * `turns` quarter turns inside a disk; open, a corner of the boundary. */
static inline maps_list maps_fan(int turns, bool closed, int k, double n, double jitter,
                                 maps_rng *r) {
    const int rays = closed ? turns : turns + 1, inner = 1 + rays * k;
    maps_list l = maps_list_create(inner + turns * k * k, 2 * turns * k * k);
    l.n_vertices = inner + turns * k * k;
    for (int s = 0; s < turns; s++) {
        const double step = 6.283185307179586 / (closed ? turns : turns + 2);
        const double a = step * s, b = step * (s + 1);
        double *uv = malloc(2 * sizeof *uv * (size_t)((k + 1) * (k + 1)));
        int32_t *id = malloc(sizeof *id * (size_t)((k + 1) * (k + 1)));
        for (int j = 0; j <= k; j++)
            for (int i = 0; i <= k; i++) {
                const int at = j * (k + 1) + i;
                int v = inner + s * k * k + (j - 1) * k + i - 1;
                if (i == 0 && j == 0) v = 0;
                if (i > 0 && j == 0) v = 1 + s * k + i - 1;
                if (i == 0 && j > 0) v = 1 + (s + 1) % rays * k + j - 1;
                const bool moves = i > 0 && i < k && j > 0 && j < k;
                id[at] = v;
                uv[2 * at] = n / k * (i + (moves ? jitter * maps_uniform(r) : 0));
                uv[2 * at + 1] = n / k * (j + (moves ? jitter * maps_uniform(r) : 0));
                l.position[3 * v] = i * cos(a) + j * cos(b);
                l.position[3 * v + 1] = i * sin(a) + j * sin(b);
                l.position[3 * v + 2] = 0.2 * i * j / k;
            }
        for (int j = 0; j < k; j++)
            for (int i = 0; i < k; i++) {
                /* a triangle with one corner at each end of a side of the fan folds easily */
                maps_block_square(&l, id, uv, k, i, j,
                                  (i == k - 1 && j == 0) || (i == 0 && j == k - 1));
            }
        free(uv);
        free(id);
    }
    return l;
}

/* Marks the edges on isolines u, v in `spacing` Z (in the chart of their first face) as features;
 * before the charts are changed. Returns n_edges entries. */
static inline int8_t *maps_isolines(const qc_corner_map *map, double spacing) {
    const qc_mesh *m = map->mesh;
    int8_t *axis = malloc((size_t)m->n_edges);
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * e];
        const double *p = map->uv + 2 * qc_next(h), *q = map->uv + 2 * qc_prev(h);
        axis[e] = -1;
        for (int i = 0; i < 2; i++) {
            const double level = p[i] / spacing;
            if (fabs(p[i] - q[i]) > 1e-9 || fabs(level - round(level)) > 1e-9) continue;
            if (i == 1) axis[e] = q[0] > p[0] ? 0 : 2;
            if (i == 0) axis[e] = q[1] > p[1] ? 1 : 3;
        }
    }
    return axis;
}

/* The map with its features, in random charts. */
static inline qc_corner_map *maps_finish_aligned(qc_ctx *ctx, maps_list *l, double spacing,
                                                 maps_rng *r) {
    qc_mesh *mesh = NULL;
    qc_corner_map *plain = NULL, *map = NULL;
    maps_ok(ctx, qc_mesh_create(ctx, l->n_vertices, l->position, l->n_faces, l->face, &mesh));
    maps_ok(ctx, qc_corner_map_create(ctx, mesh, l->uv, 0, NULL, &plain));
    int8_t *axis = maps_isolines(plain, spacing);
    double *before = malloc(6 * sizeof(double) * (size_t)l->n_faces);
    memcpy(before, l->uv, 6 * sizeof(double) * (size_t)l->n_faces);
    if (r) maps_gauge(l, r);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (axis[e] < 0) continue;
        const int32_t h = mesh->edge_halfedge[2 * e];
        const double *p = before + 2 * qc_next(h), *q = before + 2 * qc_prev(h);
        const double *a = l->uv + 2 * qc_next(h), *b = l->uv + 2 * qc_prev(h);
        const double angle = atan2(b[1] - a[1], b[0] - a[0]) - atan2(q[1] - p[1], q[0] - p[0]);
        axis[e] = (int8_t)((axis[e] + (int)lround(angle / 1.5707963267948966)) & 3);
    }
    maps_ok(ctx, qc_corner_map_create(ctx, mesh, l->uv, 0, NULL, &map));
    maps_ok(ctx, qc_corner_map_set_axis(ctx, map, axis));
    free(axis);
    free(before);
    qc_object_release(plain);
    qc_object_release(mesh);
    maps_list_free(l);
    return map;
}

/* Every vertex thrown by up to `far` in the coordinates which its features leave free. */
static inline qc_corner_map *maps_thrown(qc_ctx *ctx, const qc_corner_map *map, double far,
                                         maps_rng *r) {
    qc_grid_map *g = NULL;
    qc__reduced_map *m = NULL;
    qc_corner_map *out = NULL;
    double *uv = malloc(6 * sizeof *uv * (size_t)map->mesh->n_faces);
    maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &g));
    maps_ok(ctx, qc__reduced_map_create(ctx, g, map->uv, true, &m));
    for (int32_t v = 0; v < map->mesh->n_vertices; v++) {
        const qc_complex to = {m->value[v].re + far * maps_uniform(r),
                               m->value[v].im + far * maps_uniform(r)};
        m->value[v] = qc__keep_fixed(m, v, to);
    }
    for (int64_t c = 0; c < 3 * (int64_t)map->mesh->n_faces; c++) {
        const qc_complex f = qc__reduced_map_corner(m, m->value[map->mesh->face_vertex[c]], c);
        uv[2 * c] = f.re;
        uv[2 * c + 1] = f.im;
    }
    maps_ok(ctx, qc_corner_map_create(ctx, map->mesh, uv, map->edge_length, NULL, &out));
    maps_ok(ctx, qc_corner_map_set_rotation(ctx, out, g->rotation));
    if (g->axis) maps_ok(ctx, qc_corner_map_set_axis(ctx, out, g->axis));
    qc__reduced_map_free(m);
    qc_object_release(g);
    free(uv);
    return out;
}

#endif
