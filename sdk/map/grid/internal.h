/* Exact arithmetic on grid maps (docs/theory/exact-grid.md): points in grid units and the
 * transitions between charts. */
#ifndef QC_MAP_GRID_INTERNAL_H
#define QC_MAP_GRID_INTERNAL_H

#include <qc/map.h>

#include "sdk/base/internal.h"

typedef struct qc__point {
    int64_t u, v; /* grid units; also used for vectors and for integer translations */
} qc__point;

/* i^r p */
static inline qc__point qc__turn_point(qc__point p, int r) {
    switch (r & 3) {
    case 1:
        return (qc__point){-p.v, p.u};
    case 2:
        return (qc__point){-p.u, -p.v};
    case 3:
        return (qc__point){p.v, -p.u};
    default:
        return p;
    }
}

static inline qc__point qc__minus(qc__point p, qc__point q) {
    return (qc__point){p.u - q.u, p.v - q.v};
}

static inline qc__point qc__plus(qc__point p, qc__point q) {
    return (qc__point){p.u + q.u, p.v + q.v};
}

/* Twice the signed area spanned by two vectors; exact for |components| < 2^31. */
static inline int64_t qc__cross(qc__point a, qc__point b) {
    return a.u * b.v - a.v * b.u;
}

static inline qc__point qc__grid_corner(const qc_grid_map *g, int32_t c) {
    const int32_t *p = g->uv + 2 * (int64_t)c;
    return (qc__point){p[0], p[1]};
}

/* Quarter turns from the chart of the face of halfedge h to that of its twin (twin >= 0). */
static inline int qc__grid_rotation(const qc_grid_map *g, int32_t h) {
    const int32_t e = g->mesh->halfedge_edge[h];
    return g->mesh->edge_halfedge[2 * (int64_t)e] == h ? g->rotation[e] : (4 - g->rotation[e]) & 3;
}

/* The point p of the chart left of h in the chart of its twin: i^r p + tau, or the inverse. */
static inline qc__point qc__grid_transition(const qc_grid_map *g, int32_t h, qc__point p) {
    const int32_t e = g->mesh->halfedge_edge[h];
    const int64_t unit = (int64_t)1 << g->bits;
    const qc__point tau = {g->translation[2 * (int64_t)e] * unit,
                           g->translation[2 * (int64_t)e + 1] * unit};
    if (g->mesh->edge_halfedge[2 * (int64_t)e] == h)
        return qc__plus(qc__turn_point(p, g->rotation[e]), tau);
    return qc__turn_point(qc__minus(p, tau), 4 - g->rotation[e]);
}

/* Whether axis direction d (0 = +u, 1 = +v, ...) is in the half-open sector [a, b) of less than
 * half a turn, or in [a, b] when closed. */
static inline bool qc__in_sector(qc__point a, qc__point b, bool closed, int d) {
    const qc__point axis = qc__turn_point((qc__point){1, 0}, d);
    const int64_t from_a = qc__cross(a, axis), to_b = qc__cross(axis, b);
    return (from_a >= 0 && to_b > 0) || (closed && to_b == 0 && from_a > 0);
}

/* The same for the sector of corner c; on the boundary the last sector of the fan is closed. */
static inline bool qc__in_corner(const qc_grid_map *g, int32_t c, int d) {
    const qc__point p = qc__grid_corner(g, c);
    return qc__in_sector(qc__minus(qc__grid_corner(g, qc_next(c)), p),
                         qc__minus(qc__grid_corner(g, qc_prev(c)), p),
                         g->mesh->twin[qc_next(c)] < 0, d);
}

/* --- features (features.c) -------------------------------------------------------------------- */

/* Direction k in 0..3 of the image of halfedge h in the chart of its face; -1 = no feature. */
static inline int qc__feature_direction(const qc_mesh *m, const int8_t *rotation,
                                        const int8_t *axis, int32_t h) {
    const int32_t e = m->halfedge_edge[h];
    if (!axis || axis[e] < 0) return -1;
    if (m->edge_halfedge[2 * (int64_t)e] == h) return axis[e];
    return (axis[e] + rotation[e] + 2) & 3;
}

/* Coordinates of vertex v which are integers by the features at it, in the chart of vertex_corner:
 * bit 0 = u, bit 1 = v. Both where a feature turns, branches or ends. */
uint8_t qc__feature_levels(const qc_mesh *m, const int8_t *rotation, const int8_t *axis, int32_t v);

/* What qc_grid_map_create works on; the arrays end up in the grid map. */
typedef struct qc__grid_build {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    const double *uv; /* 6 n_faces, shifted so that every component is near the origin */
    const int8_t *known_rotation; /* of the corner map, or NULL */
    const int8_t *known_axis;     /* of the corner map, or NULL */
    double tolerance;             /* parameter units */
    int32_t bits;
    int32_t *grid_uv;
    int8_t *rotation, *holonomy;
    int32_t *translation;
    int8_t *axis; /* NULL = no features */
} qc__grid_build;

/* rotation and translation of every edge (seams.c). */
qc_status qc__grid_seams(qc__grid_build *b);
/* axis: the given features, or boundary loops which lie on isolines (features.c). */
qc_status qc__grid_features(qc__grid_build *b);
/* After the rounding: the level of every feature edge is one integer, the same at both ends. */
qc_status qc__grid_check_features(const qc__grid_build *b);
/* grid_uv and holonomy, from one representative a vertex (vertices.c). */
qc_status qc__grid_vertices(qc__grid_build *b);
/* Undoes orientations which rounding spoiled: moves regular vertices by a few grid units
 * (repair.c); coordinates which are integers stay. */
qc_status qc__grid_repair(qc_ctx *ctx, qc_grid_map *g, int32_t *uv);
/* Writes all corners of vertex v from the value p at its first corner. */
void qc__grid_spread(const qc_grid_map *g, int32_t v, qc__point p, int32_t *uv);

#endif
