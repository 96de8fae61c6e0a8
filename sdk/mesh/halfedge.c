/* Connectivity of a triangle list: twins, edges and vertex fans (conventions in qc/mesh.h). */
#include "sdk/mesh/internal.h"

static qc_status edge_error(qc_ctx *ctx, const qc_mesh *m, int32_t h, const char *what) {
    return qc__fail(ctx, QC_ERR_NON_MANIFOLD, h / 3,
                    "edge (%d, %d) of face %d %s; run the repair stage first",
                    (int)qc_halfedge_start(m, h), (int)qc_halfedge_end(m, h), (int)(h / 3), what);
}

/* order[]: halfedges sorted by end points. Runs of one or two opposite halfedges are legal. */
static qc_status pair_sorted(qc_ctx *ctx, const qc_mesh *m, const int32_t *lo, const int32_t *hi,
                             const int32_t *order, int32_t *twin) {
    int32_t n = 3 * m->n_faces;
    for (int32_t i = 0; i < n;) {
        int32_t h = order[i], end = i + 1;
        while (end < n && lo[order[end]] == lo[h] && hi[order[end]] == hi[h]) end++;
        if (end - i > 2) return edge_error(ctx, m, order[i + 2], "has three or more faces");
        twin[h] = -1;
        if (end - i == 2) {
            int32_t k = order[i + 1];
            if (qc_halfedge_start(m, h) == qc_halfedge_start(m, k))
                return edge_error(ctx, m, k,
                                  "is run through in the same direction by another face");
            twin[h] = k;
            twin[k] = h;
        }
        i = end;
    }
    return QC_OK;
}

qc_status qc__mesh_pair(qc_ctx *ctx, qc_mesh *m) {
    int32_t n = 3 * m->n_faces;
    int32_t *twin = QC__NEW(ctx, int32_t, n);
    m->twin = twin;
    int32_t *lo = QC__NEW(ctx, int32_t, n), *hi = QC__NEW(ctx, int32_t, n);
    int32_t *order = QC__NEW(ctx, int32_t, n);
    qc_status status = twin && lo && hi && order ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t h = 0; h < n; h++) {
            int32_t a = qc_halfedge_start(m, h), b = qc_halfedge_end(m, h);
            lo[h] = a < b ? a : b;
            hi[h] = a < b ? b : a;
        }
        status = qc__sort_pairs(ctx, m->n_vertices, n, lo, hi, order);
    }
    if (status == QC_OK) status = pair_sorted(ctx, m, lo, hi, order, twin);
    qc__free(lo);
    qc__free(hi);
    qc__free(order);
    return status;
}

/* Edges are numbered by their lower halfedge, so edge_halfedge[2e] is in the lower face. */
qc_status qc__mesh_edges(qc_ctx *ctx, qc_mesh *m) {
    int32_t n = 3 * m->n_faces, e = 0;
    m->n_boundary_edges = 0;
    for (int32_t h = 0; h < n; h++) m->n_boundary_edges += m->twin[h] < 0;
    m->n_edges = (n - m->n_boundary_edges) / 2 + m->n_boundary_edges;
    int32_t *edge = QC__NEW(ctx, int32_t, n);
    m->halfedge_edge = edge;
    int32_t *halfedge = QC__NEW(ctx, int32_t, 2 * (size_t)m->n_edges);
    m->edge_halfedge = halfedge;
    int32_t *vertex = QC__NEW(ctx, int32_t, 2 * (size_t)m->n_edges);
    m->edge_vertex = vertex;
    if (!edge || !halfedge || !vertex) return QC_ERR_NOMEM;
    for (int32_t h = 0; h < n; h++) {
        if (m->twin[h] >= 0 && m->twin[h] < h) {
            edge[h] = edge[m->twin[h]];
            continue;
        }
        edge[h] = e;
        halfedge[2 * e] = h;
        halfedge[2 * e + 1] = m->twin[h];
        vertex[2 * e] = qc_halfedge_start(m, h);
        vertex[2 * e + 1] = qc_halfedge_end(m, h);
        e++;
    }
    return QC_OK;
}

/* The first corner of each vertex, or the one which starts the fan on the boundary. */
static qc_status first_corners(qc_ctx *ctx, const qc_mesh *m, int32_t *corner, int32_t *count) {
    for (int32_t v = 0; v < m->n_vertices; v++) corner[v] = -1;
    for (int32_t c = 0; c < 3 * m->n_faces; c++) {
        int32_t v = m->face_vertex[c];
        count[v]++;
        if (corner[v] < 0 || m->twin[qc_prev(c)] < 0) corner[v] = c;
    }
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (corner[v] < 0)
            return qc__fail(ctx, QC_ERR_ARGUMENT, v,
                            "vertex %d belongs to no face; drop it or run the repair stage",
                            (int)v);
    return QC_OK;
}

qc_status qc__mesh_fans(qc_ctx *ctx, qc_mesh *m) {
    int32_t *corner = QC__NEW(ctx, int32_t, m->n_vertices);
    m->vertex_corner = corner;
    int32_t *count = QC__ZERO(ctx, int32_t, m->n_vertices);
    qc_status status = corner && count ? first_corners(ctx, m, corner, count) : QC_ERR_NOMEM;
    for (int32_t v = 0; status == QC_OK && v < m->n_vertices; v++) {
        int32_t visited = 0, c = corner[v];
        do {
            visited++;
            c = qc_corner_ccw(m, c);
        } while (c >= 0 && c != corner[v]);
        if (visited != count[v])
            status = qc__fail(
                ctx, QC_ERR_NON_MANIFOLD, v,
                "the faces at vertex %d form more than one fan; run the repair stage first",
                (int)v);
    }
    qc__free(count);
    return status;
}
