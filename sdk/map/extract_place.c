/* Vertices of the quads outside the surface go to the nearest point of its boundary, measured in
 * parameters, among the boundary edges in their cells; never onto another vertex of these cells. */
#include <math.h>

#include "sdk/map/extract_internal.h"

typedef struct placing {
    const qc__cells *cells;
    const qc_grid_map *g;
    const int32_t *vertex;
    const int32_t *first, *corner; /* corners of each vertex outside: first - n_lattice */
    int32_t n_lattice;
    qc_polygon_mesh *q;
    uint8_t *placed; /* vertices */
} placing;

/* A point of a boundary halfedge, s from its start to its end. */
typedef struct candidate {
    int32_t halfedge;
    double s, distance, apart; /* from the lattice point; from other vertices, in edge lengths */
} candidate;

static void point_of(const placing *p, const candidate *c, double x[3]) {
    const qc_mesh *m = p->g->mesh;
    const double *a = m->position + 3 * (int64_t)qc_halfedge_start(m, c->halfedge);
    const double *b = m->position + 3 * (int64_t)qc_halfedge_end(m, c->halfedge);
    for (int i = 0; i < 3; i++) x[i] = a[i] + c->s * (b[i] - a[i]);
}

/* Distance in space to the nearest placed vertex of the cells around, over the length which a
 * parameter unit has along the halfedge; at most 1. */
static double spacing(const placing *p, int32_t v, const candidate *c, double unit_length) {
    double x[3], least = 1;
    point_of(p, c, x);
    for (int32_t i = p->first[v - p->n_lattice]; i < p->first[v - p->n_lattice + 1]; i++)
        for (int k = 0; k < 4; k++) {
            const int32_t w = p->vertex[(p->corner[i] & ~3) | k];
            if (w == v || !p->placed[w]) continue;
            const double *y = p->q->position + 3 * (int64_t)w;
            const double d = hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]) / unit_length;
            least = fmin(least, d);
        }
    return least;
}

/* Range of s in the closed unit square; false = empty. */
static bool clip(const double a[2], const double b[2], double range[2]) {
    range[0] = 0;
    range[1] = 1;
    for (int axis = 0; axis < 2; axis++) {
        const double d = b[axis] - a[axis];
        if (d == 0) {
            if (a[axis] < 0 || a[axis] > 1) return false;
            continue;
        }
        const double s0 = -a[axis] / d, s1 = (1 - a[axis]) / d;
        range[0] = fmax(range[0], fmin(s0, s1));
        range[1] = fmin(range[1], fmax(s0, s1));
    }
    return range[0] <= range[1];
}

/* Far enough from the other vertices beats nearer to the lattice point. */
static bool better(const candidate *a, const candidate *b) {
    static const double apart = 0.15;
    if (b->halfedge < 0) return true;
    const double x = fmin(a->apart, apart), y = fmin(b->apart, apart);
    return x != y ? x > y : a->distance < b->distance;
}

static void try_halfedge(const placing *p, int32_t v, const qc__visit *visit, int32_t h, int corner,
                         candidate *best) {
    const double unit = (double)((int64_t)1 << p->g->bits);
    const qc_mesh *m = p->g->mesh;
    const qc__point start = qc__in_square(visit, qc__grid_corner(p->g, qc_next(h)));
    const qc__point end = qc__in_square(visit, qc__grid_corner(p->g, qc_prev(h)));
    const double a[2] = {(double)start.u / unit, (double)start.v / unit};
    const double b[2] = {(double)end.u / unit, (double)end.v / unit};
    const double at[2] = {corner == 1 || corner == 2, corner >= 2};
    const double d[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(d[0], d[1]);
    double range[2];
    if (length == 0 || !clip(a, b, range)) return;
    const double nearest =
        ((at[0] - a[0]) * d[0] + (at[1] - a[1]) * d[1]) / (length * length);
    const double *x = m->position + 3 * (int64_t)qc_halfedge_start(m, h);
    const double *y = m->position + 3 * (int64_t)qc_halfedge_end(m, h);
    const double unit_length =
        hypot(hypot(y[0] - x[0], y[1] - x[1]), y[2] - x[2]) / length;
    for (int i = 0; i < 4; i++) {
        candidate c = {.halfedge = h};
        c.s = i == 0 ? fmin(fmax(nearest, range[0]), range[1])
                     : range[0] + (i - 1) / 2.0 * (range[1] - range[0]);
        c.distance = hypot(a[0] + c.s * d[0] - at[0], a[1] + c.s * d[1] - at[1]);
        c.apart = spacing(p, v, &c, unit_length);
        if (better(&c, best)) *best = c;
    }
}

static void place(const placing *p, int32_t v) {
    const qc__pieces *pieces = &p->cells->pieces;
    candidate best = {.halfedge = -1};
    for (int32_t i = p->first[v - p->n_lattice]; i < p->first[v - p->n_lattice + 1]; i++) {
        const int32_t piece = p->corner[i] / 4 - p->cells->n_complete;
        for (int64_t j = pieces->piece[piece].first; j < qc__piece_end(pieces, piece); j++)
            for (int k = 0; k < 3; k++) {
                const int32_t h = 3 * pieces->visit[j].face + k;
                if (p->g->mesh->twin[h] < 0)
                    try_halfedge(p, v, &pieces->visit[j], h, p->corner[i] & 3, &best);
            }
    }
    if (best.halfedge < 0) /* all of the boundary in the square is shorter than rounding errors */
        best.halfedge = 3 * pieces->visit[pieces->piece[p->corner[p->first[v - p->n_lattice]] / 4 -
                                                         p->cells->n_complete]
                                              .first]
                                .face;
    double *weight = p->q->source_barycentric + 3 * (int64_t)v;
    p->q->source_face[v] = best.halfedge / 3;
    weight[best.halfedge % 3] = 0;
    weight[qc_next(best.halfedge) % 3] = 1 - best.s;
    weight[qc_prev(best.halfedge) % 3] = best.s;
    point_of(p, &best, p->q->position + 3 * (int64_t)v);
    p->placed[v] = 1;
}

qc_status qc__place_outside(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                            int32_t n_lattice, qc_polygon_mesh *q) {
    const int32_t n = q->n_vertices - n_lattice;
    int32_t *first = QC__ZERO(ctx, int32_t, (int64_t)n + 2), *corner = NULL;
    uint8_t *placed = QC__NEW(ctx, uint8_t, q->n_vertices);
    qc_status status = first && placed ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t a = 4 * cells->n_complete; a < 4 * cells->n; a++)
            if (vertex[a] >= n_lattice) first[vertex[a] - n_lattice + 2]++;
        for (int32_t i = 0; i <= n; i++) first[i + 1] += first[i];
        corner = QC__NEW(ctx, int32_t, first[n + 1]);
        if (!corner) status = QC_ERR_NOMEM;
    }
    if (status == QC_OK) {
        for (int32_t a = 4 * cells->n_complete; a < 4 * cells->n; a++)
            if (vertex[a] >= n_lattice) corner[first[vertex[a] - n_lattice + 1]++] = a;
        for (int32_t v = 0; v < q->n_vertices; v++) placed[v] = v < n_lattice;
        const placing p = {.cells = cells,
                           .g = cells->pieces.ports->lattice->g,
                           .vertex = vertex,
                           .first = first,
                           .corner = corner,
                           .n_lattice = n_lattice,
                           .q = q,
                           .placed = placed};
        for (int32_t v = n_lattice; v < q->n_vertices; v++) place(&p, v);
    }
    qc__free(first);
    qc__free(corner);
    qc__free(placed);
    return status;
}
