/* Exact maps for the tests of quantization: the grids of integer-grid maps. */
#ifndef QC_TESTS_EXACT_MAPS_H
#define QC_TESTS_EXACT_MAPS_H

#include "unit/map/aligned.h"

#include "sdk/map/quantize/values.h"

typedef struct exact_case {
    qc_grid_map *grid; /* owned */
    int64_t *uv;
    uint8_t *point;
    int32_t n_points;
    qc__exact_map map;
} exact_case;

/* Axis directions about an inner vertex. */
static inline int exact_directions(const qc_grid_map *g, int32_t v) {
    const int32_t first = g->mesh->vertex_corner[v];
    int32_t c = first;
    int n = 0;
    do {
        for (int d = 0; d < 4; d++) n += qc__in_corner(g, c, d);
        c = qc_corner_ccw(g->mesh, c);
    } while (c >= 0 && c != first);
    return n;
}

/* Takes the grid. */
static inline exact_case exact_from_grid(qc_grid_map *grid) {
    const qc_mesh *m = grid->mesh;
    exact_case e = {.grid = grid,
                    .uv = malloc(sizeof(int64_t) * 6 * (size_t)m->n_faces),
                    .point = calloc((size_t)m->n_vertices, 1)};
    for (int64_t i = 0; i < 6 * (int64_t)m->n_faces; i++) e.uv[i] = grid->uv[i];
    for (int32_t v = 0; v < m->n_vertices; v++) {
        e.point[v] = !qc_vertex_on_boundary(m, v) && exact_directions(grid, v) != 4;
        e.n_points += e.point[v];
    }
    e.map = (qc__exact_map){m, e.uv, grid->bits, grid->rotation, grid->axis, e.point};
    return e;
}

static inline void exact_free(exact_case *e) {
    qc_object_release(e->grid);
    free(e->uv);
    free(e->point);
}

#endif
