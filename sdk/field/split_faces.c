/* Bisection of flagged edges: each face becomes 1, 2, 3 or 4 faces in its plane, by the number of
 * its edges which are split (red-green refinement; Bank, Sherman, Weiser 1983). */
#include "refine.h"

/* Points of a face: corner k is k, the midpoint of halfedge k is 3 + k. */
typedef struct children {
    int n;
    int point[4][3];
} children;

static void add(children *c, int p, int q, int r) {
    int *child = c->point[c->n++];
    child[0] = p;
    child[1] = q;
    child[2] = r;
}

static double distance2(qc__cplx a, qc__cplx b) {
    const double x = creal(a - b), y = cimag(a - b);
    return x * x + y * y;
}

/* mask: bit k = halfedge k is split. z: the 6 points in the frame of the face. */
static children subdivide(int mask, const qc__cplx *z) {
    children c = {0, {{0}}};
    const int n = (mask & 1) + (mask >> 1 & 1) + (mask >> 2 & 1);
    if (n == 0) add(&c, 0, 1, 2);
    for (int k = 0; n == 1 && k < 3; k++) {
        if (!(mask >> k & 1)) continue;
        add(&c, k, (k + 1) % 3, 3 + k);
        add(&c, k, 3 + k, (k + 2) % 3);
    }
    for (int k = 0; n == 2 && k < 3; k++) {
        if (mask >> k & 1) continue;
        const int a = (k + 1) % 3, b = (k + 2) % 3, p = 3 + b, q = 3 + a;
        const bool from_p = distance2(z[p], z[b]) <= distance2(z[q], z[a]);
        add(&c, k, p, q);
        add(&c, p, a, from_p ? b : q);
        add(&c, from_p ? p : a, b, q);
    }
    if (n == 3) {
        for (int k = 0; k < 3; k++) add(&c, k, 3 + (k + 2) % 3, 3 + (k + 1) % 3);
        add(&c, 3, 4, 5);
    }
    return c;
}

/* Halfedge of the face which the segment from point p to q lies on, -1 = inside. */
static int side(int p, int q) {
    if (p < 3 && q < 3) return 3 - p - q;
    if (p >= 3 && q >= 3) return -1;
    const int corner = p < 3 ? p : q, halfedge = (p < 3 ? q : p) - 3;
    return corner == halfedge ? -1 : halfedge;
}

static int split_mask(const qc_mesh *mesh, const int32_t *midpoint, int32_t t) {
    int mask = 0;
    for (int k = 0; k < 3; k++) mask |= (midpoint[mesh->halfedge_edge[3 * t + k]] >= 0) << k;
    return mask;
}

/* midpoint: n_edges, the vertex there or -1; edge: of qc_tangent_edges. */
static void add_children(qc__refiner *r, const int32_t *midpoint, const qc_complex *edge,
                         int32_t t) {
    const qc_mesh *old = r->old;
    const qc__cplx e0 = qc__c(edge[3 * t]), e1 = qc__c(edge[3 * t + 1]);
    const qc__cplx z[6] = {e0 + e1, 0, e0, e0 / 2, e0 + e1 / 2, (e0 + e1) / 2};
    const children c = subdivide(split_mask(old, midpoint, t), z);
    for (int i = 0; i < c.n; i++) {
        const int *p = c.point[i];
        int32_t vertex[3], halfedge[3];
        for (int k = 0; k < 3; k++) {
            const int on = side(p[(k + 1) % 3], p[(k + 2) % 3]);
            vertex[k] = p[k] < 3 ? old->face_vertex[3 * t + p[k]]
                                 : midpoint[old->halfedge_edge[3 * t + p[k] - 3]];
            halfedge[k] = on < 0 ? -1 : 3 * t + on;
        }
        qc__refiner_add(r, t, vertex, halfedge, c.n == 1 ? 0 : z[p[2]] - z[p[1]]);
    }
}

static void place_midpoints(qc__refiner *r, const int32_t *midpoint) {
    const qc_mesh *old = r->old;
    for (int32_t e = 0; e < old->n_edges; e++) {
        if (midpoint[e] < 0) continue;
        const double *p = old->position + 3 * (size_t)old->edge_vertex[2 * e];
        const double *q = old->position + 3 * (size_t)old->edge_vertex[2 * e + 1];
        for (size_t i = 0; i < 3; i++)
            r->position[3 * (size_t)midpoint[e] + i] = p[i] / 2 + q[i] / 2;
        r->source_vertex[midpoint[e]] = -1;
    }
}

static qc_status build(qc_ctx *ctx, const qc_mesh *old, const int32_t *midpoint, int32_t n_vertices,
                       int32_t n_faces, qc__refinement *out) {
    qc__refiner r = {0};
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)old->n_faces);
    qc_status status = edge ? qc_tangent_edges(ctx, old, edge) : QC_ERR_NOMEM;
    if (!status) status = qc__refiner_create(ctx, old, n_vertices, n_faces, &r);
    if (!status) {
        place_midpoints(&r, midpoint);
        for (int32_t t = 0; t < old->n_faces; t++) add_children(&r, midpoint, edge, t);
        status = qc__refiner_finish(ctx, &r, out);
    }
    qc__refiner_free(&r);
    qc__free(edge);
    return status;
}

qc_status qc__bisect_edges(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *split,
                           qc__refinement *out) {
    int32_t *midpoint = QC__NEW(ctx, int32_t, mesh->n_edges);
    if (!midpoint) return QC_ERR_NOMEM;
    int32_t n_vertices = mesh->n_vertices, n_faces = mesh->n_faces;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        midpoint[e] = split[e] ? n_vertices++ : -1;
        if (split[e]) n_faces += mesh->edge_halfedge[2 * e + 1] < 0 ? 1 : 2;
    }
    const qc_status status = build(ctx, mesh, midpoint, n_vertices, n_faces, out);
    qc__free(midpoint);
    return status;
}
