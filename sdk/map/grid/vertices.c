/* Rounding of an integer-seamless map to the grid (docs/theory/exact-grid.md): one representative a
 * vertex is rounded, or set to the fixed point of the transitions around it; the other corners
 * follow exactly. */
#include <math.h>

#include "sdk/map/grid/internal.h"
#include "sdk/mesh/names.h"

/* z -> i^r z + t with integer t (parameter units). */
typedef struct transform {
    int r;
    qc__point t;
} transform;

static transform across(const qc__grid_build *b, transform g, int32_t h) {
    const int32_t e = b->mesh->halfedge_edge[h];
    const int r = b->rotation[e];
    const qc__point tau = {b->translation[2 * (int64_t)e], b->translation[2 * (int64_t)e + 1]};
    if (b->mesh->edge_halfedge[2 * (int64_t)e] == h)
        return (transform){(g.r + r) & 3, qc__plus(qc__turn_point(g.t, r), tau)};
    return (transform){(g.r - r) & 3, qc__turn_point(qc__minus(g.t, tau), 4 - r)};
}

/* Once around vertex v, counter-clockwise from its first corner; the identity on the boundary. */
static transform around(const qc__grid_build *b, int32_t v) {
    const qc_mesh *m = b->mesh;
    const int32_t first = m->vertex_corner[v];
    transform g = {0, {0, 0}};
    int32_t c = first;
    do {
        if (m->twin[qc_next(c)] < 0) return (transform){0, {0, 0}};
        g = across(b, g, qc_next(c));
        c = qc_corner_ccw(m, c);
    } while (c != first);
    return g;
}

/* Twice the fixed point of z -> i^r z + t, r != 0: 2 t / (1 - i^r). */
static qc__point twice_fixed_point(transform g) {
    switch (g.r) {
    case 1:
        return (qc__point){g.t.u - g.t.v, g.t.u + g.t.v};
    case 2:
        return g.t;
    default:
        return (qc__point){g.t.u + g.t.v, g.t.v - g.t.u};
    }
}

/* x rounded to grid units, or to an integer. */
static int64_t rounded(double x, int32_t bits, bool integer) {
    return (int64_t)(integer ? ldexp(rint(x), bits) : rint(ldexp(x, bits)));
}

static qc_status representative(qc__grid_build *b, int32_t v, qc__point *out) {
    const transform g = around(b, v);
    const double *f = b->uv + 2 * (int64_t)b->mesh->vertex_corner[v];
    const int64_t unit = (int64_t)1 << b->bits;
    b->holonomy[v] = (int8_t)g.r;
    if (g.r == 0) {
        if (g.t.u != 0 || g.t.v != 0)
            return qc__fail(b->ctx, QC_ERR_FAILED, v,
                            "the transitions around vertex %d do not close: a translation (%d, %d) "
                            "is left over",
                            (int)v, (int)g.t.u, (int)g.t.v);
        const uint8_t levels = qc__feature_levels(b->mesh, b->rotation, b->axis, v);
        *out = (qc__point){rounded(f[0], b->bits, levels & 1), rounded(f[1], b->bits, levels & 2)};
        return QC_OK;
    }
    const qc__point p = twice_fixed_point(g);
    if ((p.u | p.v) & 1)
        return qc__fail(b->ctx, QC_ERR_FAILED, v,
                        "the cone at vertex %d lies at (%g, %g), not on a lattice point; its "
                        "integers need the parity of a quad grid",
                        (int)v, 0.5 * (double)p.u, 0.5 * (double)p.v);
    *out = (qc__point){p.u / 2 * unit, p.v / 2 * unit};
    return QC_OK;
}

/* All corners of v from p at its first one. Fails when a corner moves by more than the tolerance
 * allows. */
static qc_status spread(qc__grid_build *b, int32_t v, qc__point p) {
    const qc_mesh *m = b->mesh;
    const int32_t first = m->vertex_corner[v];
    const int64_t unit = (int64_t)1 << b->bits;
    const double scale = 1.0 / (double)unit, limit = 2 * b->tolerance + scale;
    transform g = {0, {0, 0}};
    int32_t c = first;
    do {
        const qc__point q = qc__turn_point(p, g.r);
        const int64_t u = q.u + g.t.u * unit, w = q.v + g.t.v * unit;
        const double moved = fmax(fabs((double)u * scale - b->uv[2 * (int64_t)c]),
                                  fabs((double)w * scale - b->uv[2 * (int64_t)c + 1]));
        if (!(moved <= limit))
            return qc__fail(b->ctx, QC_ERR_FAILED, v,
                            "the map is inconsistent around vertex %d: face %d is off by %.3g "
                            "parameter units",
                            (int)v, (int)(c / 3), moved);
        b->grid_uv[2 * (int64_t)c] = (int32_t)u;
        b->grid_uv[2 * (int64_t)c + 1] = (int32_t)w;
        if (m->twin[qc_next(c)] < 0) break;
        g = across(b, g, qc_next(c));
        c = qc_corner_ccw(m, c);
    } while (c != first);
    return QC_OK;
}

/* Axis directions in the sectors around a vertex; -1 when a face there is not positive. */
static int count_directions(const qc_grid_map *g, int32_t v) {
    const int32_t first = g->mesh->vertex_corner[v];
    int32_t c = first;
    int n = 0;
    do {
        if (qc_grid_map_orientation(g, c / 3) <= 0) return -1;
        for (int d = 0; d < 4; d++) n += qc__in_corner(g, c, d);
        c = qc_corner_ccw(g->mesh, c);
    } while (c >= 0 && c != first);
    return n;
}

/* Axis directions about a vertex which is no cone: 4, or those of half a turn on the side of an
 * aligned boundary; -1 = any number. */
static int regular_directions(const qc__grid_build *b, int32_t v) {
    if (!qc_vertex_on_boundary(b->mesh, v)) return 4;
    const int32_t h = qc_prev(b->mesh->vertex_corner[v]);
    const bool aligned = qc__feature_direction(b->mesh, b->rotation, b->axis, h) >= 0;
    const uint8_t levels = qc__feature_levels(b->mesh, b->rotation, b->axis, v);
    return aligned && (levels == 1 || levels == 2) ? 3 : -1;
}

/* A cone whose angle is 4 pi, 6 pi, ... has no holonomy, so nothing pinned it
 * (docs/theory/exact-grid.md): put it on its lattice point. The same for 3 pi and so on on an
 * aligned boundary. */
static qc_status pin_full_turns(qc__grid_build *b) {
    const qc_mesh *m = b->mesh;
    const qc_grid_map view = {.mesh = m,
                              .bits = b->bits,
                              .uv = b->grid_uv,
                              .rotation = b->rotation,
                              .translation = b->translation};
    const double unit = (double)((int64_t)1 << b->bits);
    bool folded = false; /* next to a fold-over the angle of a regular vertex may be any multiple */
    for (int32_t t = 0; t < m->n_faces && !folded; t++)
        folded = qc_grid_map_orientation(&view, t) <= 0;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        if (v % 8192 == 0 && !qc__progress(b->ctx, 0.7 + 0.2 * v / m->n_vertices))
            return QC_ERR_CANCELLED;
        const int regular = b->holonomy[v] != 0 ? -1 : regular_directions(b, v);
        if (regular < 0) continue;
        const int n = count_directions(&view, v);
        if (n < 0 || n == regular) continue;
        const qc__point p = qc__grid_corner(&view, m->vertex_corner[v]);
        const double u = round((double)p.u / unit), w = round((double)p.v / unit);
        char name[QC__ELEMENT_NAME];
        const double off = fmax(fabs((double)p.u / unit - u), fabs((double)p.v / unit - w));
        if (off > b->tolerance && folded) continue;
        if (off > b->tolerance)
            return qc__fail(b->ctx, QC_ERR_FAILED, v,
                            "the map makes %d quarter turns around %s, which is %.3g parameter "
                            "units off the lattice: a cone there or next to it is folded in; try a "
                            "finer density or other integers",
                            n - (regular == 3), qc__vertex_name(m, v, name), off);
        const qc_status status =
            spread(b, v, (qc__point){(int64_t)(u * unit), (int64_t)(w * unit)});
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

qc_status qc__grid_vertices(qc__grid_build *b) {
    const int32_t n = b->mesh->n_vertices;
    for (int32_t v = 0; v < n; v++) {
        if (v % 8192 == 0 && !qc__progress(b->ctx, 0.4 + 0.3 * v / n)) return QC_ERR_CANCELLED;
        qc__point p;
        qc_status status = representative(b, v, &p);
        if (status == QC_OK) status = spread(b, v, p);
        if (status != QC_OK) return status;
    }
    return pin_full_turns(b);
}
