/* Bisection of flagged edges: each face becomes 1, 2, 3 or 4 faces in its plane, by the number of
 * its edges which are split (red-green refinement; Bank, Sherman, Weiser 1983). */
#include "split.h"

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

typedef struct builder {
    const qc_mesh *old;
    const int32_t *midpoint; /* n_edges: its number, -1 = not split */
    int32_t n_faces;
    int32_t *face_vertex, *source_face;
    qc__bisection *out;
} builder;

static int split_mask(const qc_mesh *mesh, const int32_t *midpoint, int32_t t) {
    int mask = 0;
    for (int k = 0; k < 3; k++) mask |= (midpoint[mesh->halfedge_edge[3 * t + k]] >= 0) << k;
    return mask;
}

/* edge: of qc_tangent_edges. */
static void build_face(builder *b, const qc_complex *edge, int32_t t) {
    const qc_mesh *old = b->old;
    const qc__cplx e0 = qc__c(edge[3 * t]), e1 = qc__c(edge[3 * t + 1]);
    const qc__cplx z[6] = {e0 + e1, 0, e0, e0 / 2, e0 + e1 / 2, (e0 + e1) / 2};
    const children c = subdivide(split_mask(old, b->midpoint, t), z);
    for (int i = 0; i < c.n; i++) {
        const int32_t f = b->n_faces++;
        const int *p = c.point[i];
        for (int k = 0; k < 3; k++) {
            const int on = side(p[(k + 1) % 3], p[(k + 2) % 3]);
            b->face_vertex[3 * f + k] = p[k] < 3
                                            ? old->face_vertex[3 * t + p[k]]
                                            : b->midpoint[old->halfedge_edge[3 * t + p[k] - 3]];
            b->out->parent_halfedge[3 * f + k] = on < 0 ? -1 : 3 * t + on;
        }
        b->source_face[f] = old->source_face ? old->source_face[t] : t;
        b->out->parent[f] = t;
        b->out->turn[f] = qc__z(c.n == 1 ? 1 : conj(qc__unit(z[p[2]] - z[p[1]])));
    }
}

static void place_vertices(const qc_mesh *old, const int32_t *midpoint, double *position,
                           int32_t *source) {
    for (int32_t v = 0; v < old->n_vertices; v++) {
        for (size_t i = 0; i < 3; i++)
            position[3 * (size_t)v + i] = old->position[3 * (size_t)v + i];
        source[v] = old->source_vertex ? old->source_vertex[v] : v;
    }
    for (int32_t e = 0; e < old->n_edges; e++) {
        if (midpoint[e] < 0) continue;
        const double *p = old->position + 3 * (size_t)old->edge_vertex[2 * e];
        const double *q = old->position + 3 * (size_t)old->edge_vertex[2 * e + 1];
        for (size_t i = 0; i < 3; i++) position[3 * (size_t)midpoint[e] + i] = p[i] / 2 + q[i] / 2;
        source[midpoint[e]] = -1;
    }
}

static qc_status build(qc_ctx *ctx, builder *b, int32_t n_vertices, int32_t n_faces) {
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)b->old->n_faces);
    double *position = QC__NEW(ctx, double, 3 * (size_t)n_vertices);
    int32_t *source_vertex = QC__NEW(ctx, int32_t, n_vertices);
    b->face_vertex = QC__NEW(ctx, int32_t, 3 * (size_t)n_faces);
    b->source_face = QC__NEW(ctx, int32_t, n_faces);
    b->out->parent = QC__NEW(ctx, int32_t, n_faces);
    b->out->parent_halfedge = QC__NEW(ctx, int32_t, 3 * (size_t)n_faces);
    b->out->turn = QC__NEW(ctx, qc_complex, n_faces);
    const bool ok = edge && position && source_vertex && b->face_vertex && b->source_face &&
                    b->out->parent && b->out->parent_halfedge && b->out->turn;
    qc_status status = ok ? qc_tangent_edges(ctx, b->old, edge) : QC_ERR_NOMEM;
    if (!status) {
        place_vertices(b->old, b->midpoint, position, source_vertex);
        for (int32_t t = 0; t < b->old->n_faces; t++) build_face(b, edge, t);
        status = qc_mesh_create_from(ctx, n_vertices, position, n_faces, b->face_vertex,
                                     source_vertex, b->source_face, &b->out->mesh);
    }
    qc__free(edge);
    qc__free(position);
    qc__free(source_vertex);
    qc__free(b->face_vertex);
    qc__free(b->source_face);
    return status;
}

qc_status qc__bisect_edges(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *split,
                           qc__bisection *out) {
    qc__bisection made = {NULL, NULL, NULL, NULL};
    int32_t *midpoint = QC__NEW(ctx, int32_t, mesh->n_edges);
    if (!midpoint) return QC_ERR_NOMEM;
    int32_t n_vertices = mesh->n_vertices, n_faces = mesh->n_faces;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        midpoint[e] = split[e] ? n_vertices++ : -1;
        if (split[e]) n_faces += mesh->edge_halfedge[2 * e + 1] < 0 ? 1 : 2;
    }
    builder b = {mesh, midpoint, 0, NULL, NULL, &made};
    const qc_status status = build(ctx, &b, n_vertices, n_faces);
    qc__free(midpoint);
    if (status)
        qc__bisection_free(&made);
    else
        *out = made;
    return status;
}

void qc__bisection_flags(const qc__bisection *b, const qc_mesh *old_mesh, const uint8_t *old,
                         uint8_t *out) {
    for (int32_t e = 0; e < b->mesh->n_edges; e++) {
        const int32_t h = b->parent_halfedge[b->mesh->edge_halfedge[2 * e]];
        out[e] = h < 0 ? 0 : old[old_mesh->halfedge_edge[h]];
    }
}

qc_status qc__bisection_sizing(qc_ctx *ctx, const qc__bisection *b, const qc_sizing *old,
                               qc_sizing **out) {
    double *length = NULL;
    if (old->length) {
        length = QC__NEW(ctx, double, b->mesh->n_faces);
        if (!length) return QC_ERR_NOMEM;
        for (int32_t t = 0; t < b->mesh->n_faces; t++) length[t] = old->length[b->parent[t]];
    }
    const qc_status status =
        qc_sizing_create(ctx, b->mesh, old->edge_length, old->target_quads, length, out);
    qc__free(length);
    return status;
}

void qc__bisection_free(qc__bisection *bisection) {
    qc_object_release(bisection->mesh);
    qc__free(bisection->parent);
    qc__free(bisection->parent_halfedge);
    qc__free(bisection->turn);
    *bisection = (qc__bisection){NULL, NULL, NULL, NULL};
}
