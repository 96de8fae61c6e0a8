/* Shortest paths along edges from a set of sources (Dijkstra 1959). */
#include "sdk/mesh/internal.h"

static qc_status edge_weights(qc_ctx *ctx, const qc_mesh *m, const double *weight, double *out) {
    for (int32_t e = 0; e < m->n_edges; e++) {
        double d[3];
        if (weight) {
            if (!(weight[e] > 0) || !isfinite(weight[e]))
                return qc__fail(ctx, QC_ERR_ARGUMENT, e, "weight %g of edge %d is not positive",
                                weight[e], (int)e);
            out[e] = weight[e];
        } else {
            qc__halfedge_vector(m, m->edge_halfedge[2 * e], d);
            out[e] = qc__norm3(d);
        }
    }
    return QC_OK;
}

typedef struct search {
    const qc_mesh *mesh;
    const double *weight;
    double *distance;
    int32_t *predecessor;
    qc__heap heap;
} search;

/* Tries to reach the far end of edge e from v, whose distance is final. */
static void relax(search *s, int32_t v, int32_t e) {
    const int32_t *ends = s->mesh->edge_vertex + 2 * (size_t)e;
    int32_t w = ends[0] == v ? ends[1] : ends[0];
    double d = s->distance[v] + s->weight[e];
    if (d < s->distance[w]) {
        s->distance[w] = d;
        s->predecessor[w] = e;
        qc__heap_push(&s->heap, w);
    }
}

static void relax_star(search *s, int32_t v) {
    const qc_mesh *m = s->mesh;
    int32_t first = m->vertex_corner[v], c = first;
    if (m->twin[qc_prev(c)] < 0) relax(s, v, m->halfedge_edge[qc_prev(c)]);
    do {
        relax(s, v, m->halfedge_edge[qc_next(c)]);
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != first);
}

static qc_status run(qc_ctx *ctx, search *s, const uint8_t *source) {
    int32_t n = s->mesh->n_vertices, done = 0;
    for (int32_t v = 0; v < n; v++) {
        s->distance[v] = source[v] ? 0 : INFINITY;
        s->predecessor[v] = -1;
    }
    for (int32_t v = 0; v < n; v++)
        if (source[v]) qc__heap_push(&s->heap, v);
    while (s->heap.n > 0) {
        relax_star(s, qc__heap_pop(&s->heap));
        if ((++done & 0x3fff) == 0 && !qc__progress(ctx, (double)done / n)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

qc_status qc_mesh_shortest_paths(qc_ctx *ctx, const qc_mesh *m, const double *weight,
                                 const uint8_t *source, double *distance,
                                 int32_t *predecessor_edge) {
    double *w = QC__NEW(ctx, double, m->n_edges), *d = QC__NEW(ctx, double, m->n_vertices);
    int32_t *p = QC__NEW(ctx, int32_t, m->n_vertices);
    search s = {m, w, d, p, {0, NULL, NULL, NULL}};
    qc_status status = w && d && p ? edge_weights(ctx, m, weight, w) : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc__heap_create(ctx, m->n_vertices, d, &s.heap);
    if (status == QC_OK) status = run(ctx, &s, source);
    for (int32_t v = 0; status == QC_OK && v < m->n_vertices; v++) {
        if (distance) distance[v] = d[v];
        if (predecessor_edge) predecessor_edge[v] = p[v];
    }
    qc__heap_free(&s.heap);
    qc__free(w);
    qc__free(d);
    qc__free(p);
    return status;
}
