/* Vertices on the rim of the quads. Those outside the surface go to the nearest point of its
 * boundary, measured in parameters, among the boundary edges in their cells, but never onto another
 * vertex of these cells. Lattice vertices inside follow as far as their quads stay well shaped. */
#include <math.h>

#include "sdk/map/extract/internal.h"
#include "sdk/map/extract/rim.h"
#include "sdk/mesh/internal.h"

/* A point of a boundary halfedge, s from its start to its end. */
typedef struct candidate {
    int32_t halfedge, corner;  /* the cell corner from whose square it was seen */
    double s, distance, apart; /* from the lattice point; from other vertices, in edge lengths */
    double offset[2];          /* from the lattice point, in the frame of the square */
} candidate;

static void point_of(const qc__rim *p, const candidate *c, double x[3]) {
    const qc_mesh *m = p->g->mesh;
    const double *a = m->position + 3 * (int64_t)qc_halfedge_start(m, c->halfedge);
    const double *b = m->position + 3 * (int64_t)qc_halfedge_end(m, c->halfedge);
    for (int i = 0; i < 3; i++) x[i] = a[i] + c->s * (b[i] - a[i]);
}

/* Distance in space to the nearest placed vertex of the cells around, over the length which a
 * parameter unit has along the halfedge; at most 1. */
static double spacing(const qc__rim *p, int32_t v, const candidate *c, double unit_length) {
    double x[3], least = 1;
    point_of(p, c, x);
    for (int32_t i = p->open_first[v]; i < p->open_first[v + 1]; i++)
        for (int k = 0; k < 4; k++) {
            const int32_t w = p->vertex[(p->open[i] & ~3) | k];
            if (w == v || w < 0 || !p->placed[w]) continue;
            least = fmin(least, qc__distance3(x, p->q->position + 3 * (int64_t)w) / unit_length);
        }
    return least;
}

static void put(const qc__rim *p, int32_t v, int32_t face, const double weight[3]) {
    const qc_mesh *m = p->g->mesh;
    p->q->source_face[v] = face;
    for (int i = 0; i < 3; i++) {
        p->q->source_barycentric[3 * (int64_t)v + i] = weight[i];
        p->q->position[3 * (int64_t)v + i] = 0;
    }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            p->q->position[3 * (int64_t)v + i] +=
                weight[k] * m->position[3 * (int64_t)m->face_vertex[3 * face + k] + i];
}

static void put_on_boundary(const qc__rim *p, int32_t v, const candidate *c) {
    double weight[3] = {0};
    weight[qc_next(c->halfedge) % 3] = 1 - c->s;
    weight[qc_prev(c->halfedge) % 3] = c->s;
    put(p, v, c->halfedge / 3, weight);
}

/* Least scaled Jacobian of the quads around v. */
static double quality(const qc__rim *p, int32_t v) {
    double least = 1;
    for (int32_t i = p->kept_first[v]; i < p->kept_first[v + 1]; i++)
        least = fmin(least, qc__scaled_jacobian(p->q->position, p->vertex + (p->kept[i] & ~3), 4));
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

static void try_halfedge(const qc__rim *p, int32_t v, const qc__visit *visit, int32_t h,
                         int32_t corner, candidate *best) {
    const double unit = (double)((int64_t)1 << p->g->bits);
    const qc_mesh *m = p->g->mesh;
    const qc__point start = qc__in_square(visit, qc__grid_corner(p->g, qc_next(h)));
    const qc__point end = qc__in_square(visit, qc__grid_corner(p->g, qc_prev(h)));
    const double a[2] = {(double)start.u / unit, (double)start.v / unit};
    const double b[2] = {(double)end.u / unit, (double)end.v / unit};
    const double at[2] = {(corner & 3) == 1 || (corner & 3) == 2, (corner & 3) >= 2};
    const double d[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(d[0], d[1]);
    double range[2];
    if (length == 0 || !clip(a, b, range)) return;
    const double nearest = ((at[0] - a[0]) * d[0] + (at[1] - a[1]) * d[1]) / (length * length);
    const double unit_length = qc__distance3(m->position + 3 * (int64_t)qc_halfedge_start(m, h),
                                             m->position + 3 * (int64_t)qc_halfedge_end(m, h)) /
                               length;
    for (int i = 0; i < 4; i++) {
        candidate c = {.halfedge = h, .corner = corner};
        c.s = i == 0 ? fmin(fmax(nearest, range[0]), range[1])
                     : range[0] + (i - 1) / 2.0 * (range[1] - range[0]);
        for (int k = 0; k < 2; k++) c.offset[k] = a[k] + c.s * d[k] - at[k];
        c.distance = hypot(c.offset[0], c.offset[1]);
        if (p->by_shape) put_on_boundary(p, v, &c);
        c.apart = p->by_shape ? quality(p, v) : spacing(p, v, &c, unit_length);
        if (better(&c, best)) *best = c;
    }
}

static candidate nearest_boundary(const qc__rim *p, int32_t v) {
    const qc__pieces *pieces = &p->cells->pieces;
    candidate best = {.halfedge = -1};
    for (int32_t i = p->open_first[v]; i < p->open_first[v + 1]; i++) {
        const int32_t piece = p->open[i] / 4 - p->cells->n_complete;
        for (int64_t j = pieces->piece[piece].first; j < qc__piece_end(pieces, piece); j++)
            for (int k = 0; k < 3; k++) {
                const int32_t h = 3 * pieces->visit[j].face + k;
                if (p->g->mesh->twin[h] < 0)
                    try_halfedge(p, v, &pieces->visit[j], h, p->open[i], &best);
            }
    }
    return best;
}

/* The part t < 1 of the way to the boundary: in the face of the square which holds it best. */
static void put_between(const qc__rim *p, int32_t v, const candidate *c, double t) {
    const qc__pieces *pieces = &p->cells->pieces;
    const int32_t piece = c->corner / 4 - p->cells->n_complete, k = c->corner & 3;
    const double unit = (double)((int64_t)1 << p->g->bits);
    const double x[2] = {(k == 1 || k == 2) + t * c->offset[0], (k >= 2) + t * c->offset[1]};
    double best[3] = {0, 0, 0}, least = -INFINITY;
    int32_t face = -1;
    for (int64_t j = pieces->piece[piece].first; j < qc__piece_end(pieces, piece); j++) {
        const qc__visit *visit = &pieces->visit[j];
        double q[3][2], weight[3];
        for (int i = 0; i < 3; i++) {
            const qc__point at = qc__in_square(visit, qc__grid_corner(p->g, 3 * visit->face + i));
            q[i][0] = (double)at.u / unit - x[0];
            q[i][1] = (double)at.v / unit - x[1];
        }
        for (int i = 0; i < 3; i++) {
            const double *a = q[(i + 1) % 3], *b = q[(i + 2) % 3];
            weight[i] = a[0] * b[1] - a[1] * b[0];
        }
        const double sum = weight[0] + weight[1] + weight[2];
        const double low = fmin(fmin(weight[0], weight[1]), weight[2]) / sum;
        if (!(low > least)) continue;
        least = low;
        face = visit->face;
        for (int i = 0; i < 3; i++) best[i] = weight[i] / sum;
    }
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += best[i] = fmax(best[i], 0);
    for (int i = 0; i < 3; i++) best[i] /= sum;
    put(p, v, face, best);
}

/* A lattice vertex goes to the boundary, or half the way or a quarter where three cells or more
 * meet or its quads would be bent. */
static void follow(const qc__rim *p, int32_t v) {
    static const double good = 0.3, apart = 0.25, farthest = 0.75;
    const candidate c = nearest_boundary(p, v);
    if (c.halfedge < 0 || c.distance > farthest || c.apart < apart) return;
    double *weight = p->q->source_barycentric + 3 * (int64_t)v;
    const double old[3] = {weight[0], weight[1], weight[2]}, before = quality(p, v);
    const int32_t face = p->q->source_face[v];
    for (double t = p->kept_first[v + 1] - p->kept_first[v] < 3 ? 1 : 0.5; t > 0.2; t *= 0.5) {
        if (t == 1)
            put_on_boundary(p, v, &c);
        else
            put_between(p, v, &c, t);
        const double after = quality(p, v);
        if (after >= good || after >= before) return;
    }
    put(p, v, face, old);
}

/* A vertex outside the surface whose quads are bent over: where they are best. */
static void straighten(qc__rim *p, int32_t v) {
    static const double bad = 0.05;
    if (quality(p, v) >= bad) return;
    p->by_shape = true;
    const candidate best = nearest_boundary(p, v);
    p->by_shape = false;
    if (best.halfedge >= 0) put_on_boundary(p, v, &best);
}

static void place(const qc__rim *p, int32_t v) {
    const qc__pieces *pieces = &p->cells->pieces;
    candidate best = nearest_boundary(p, v);
    if (best.halfedge < 0) { /* all of the boundary in the square is shorter than rounding errors */
        const int32_t piece = p->open[p->open_first[v]] / 4 - p->cells->n_complete;
        best.halfedge = 3 * pieces->visit[pieces->piece[piece].first].face;
    }
    put_on_boundary(p, v, &best);
    p->placed[v] = 1;
}

qc_status qc__place_rim(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                        int32_t n_lattice, qc_polygon_mesh *q) {
    qc__rim rim;
    const qc_status status = qc__rim_create(ctx, cells, vertex, n_lattice, q, &rim);
    if (status != QC_OK) return status;
    for (int32_t v = n_lattice; v < q->n_vertices; v++) place(&rim, v);
    for (int32_t v = 0; v < n_lattice; v++)
        if (rim.kept_first[v] < rim.kept_first[v + 1]) follow(&rim, v);
    for (int32_t v = n_lattice; v < q->n_vertices; v++) straighten(&rim, v);
    qc__rim_free(&rim);
    return QC_OK;
}
