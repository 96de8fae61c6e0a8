/* A spanning forest of the graph of nodes and segments (see seam_solve.h). */
#include <string.h>
#include "sdk/map/seams/seam_solve.h"

typedef struct forester {
    const qc__seams *s;
    int64_t *incident_start; /* segments at each vertex that ends one */
    int32_t *incident;
    uint8_t *visited;
    qc__seam_forest *out;
} forester;

static qc_status collect_incidence(qc_ctx *ctx, forester *q) {
    const qc__seams *s = q->s;
    const int32_t nv = s->mesh->n_vertices;
    q->out->vertex_node = QC__NEW(ctx, int32_t, nv);
    q->incident_start = QC__ZERO(ctx, int64_t, nv + 2);
    q->incident = QC__NEW(ctx, int32_t, 2 * (int64_t)s->n_segments);
    q->out->order = QC__NEW(ctx, int32_t, nv);
    q->out->parent_segment = QC__NEW(ctx, int32_t, nv);
    q->visited = QC__ZERO(ctx, uint8_t, nv);
    if (!q->out->vertex_node || !q->incident_start || !q->incident || !q->out->order ||
        !q->out->parent_segment || !q->visited)
        return QC_ERR_NOMEM;
    memset(q->out->vertex_node, -1, sizeof(int32_t) * (size_t)nv);
    memset(q->out->parent_segment, -1, sizeof(int32_t) * (size_t)nv);
    for (int32_t n = 0; n < s->n_nodes; n++) q->out->vertex_node[s->node_vertex[n]] = n;
    for (int32_t i = 0; i < 2 * s->n_segments; i++) q->incident_start[s->segment_node[i] + 2]++;
    for (int32_t v = 0; v < nv; v++) q->incident_start[v + 2] += q->incident_start[v + 1];
    for (int32_t i = 0; i < 2 * s->n_segments; i++)
        q->incident[q->incident_start[s->segment_node[i] + 1]++] = i / 2;
    return QC_OK;
}

static void grow_tree(forester *q, int32_t from) {
    const qc__seams *s = q->s;
    for (int32_t at = from; at < q->out->n_order; at++) {
        const int32_t v = q->out->order[at];
        for (int64_t i = q->incident_start[v]; i < q->incident_start[v + 1]; i++) {
            const int32_t k = q->incident[i];
            const int32_t a = s->segment_node[2 * k], b = s->segment_node[2 * k + 1];
            const int32_t w = a == v ? b : a;
            if (q->visited[w]) continue;
            q->visited[w] = 1;
            q->out->parent_segment[w] = k;
            q->out->order[q->out->n_order++] = w;
        }
    }
}

static void plant(forester *q, int32_t v) {
    q->visited[v] = 1;
    q->out->order[q->out->n_order++] = v;
}

/* Roots: all boundary nodes; then, in components without, a cone of odd turning, else any node. */
static void grow_forest(forester *q) {
    const qc__seams *s = q->s;
    for (int32_t i = 0; i < 2 * s->n_segments; i++) {
        const int32_t v = s->segment_node[i];
        if (q->out->vertex_node[v] < 0 && !q->visited[v]) plant(q, v);
    }
    grow_tree(q, 0);
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t n = 0; n < s->n_nodes; n++) {
            const int32_t v = s->node_vertex[n], cone = s->node_cone[n];
            if (q->visited[v]) continue;
            if (pass == 0 && (cone < 0 || s->cone_turn[cone] % 2 == 0)) continue;
            const int32_t from = q->out->n_order;
            plant(q, v);
            grow_tree(q, from);
        }
}

void qc__seam_forest_free(qc__seam_forest *forest) {
    qc__free(forest->vertex_node);
    qc__free(forest->order);
    qc__free(forest->parent_segment);
}

qc_status qc__seam_forest_create(qc_ctx *ctx, const qc__seams *s, qc__seam_forest *out) {
    forester q = {.s = s, .out = out};
    const qc_status status = collect_incidence(ctx, &q);
    if (status == QC_OK) grow_forest(&q);
    qc__free(q.incident_start);
    qc__free(q.incident);
    qc__free(q.visited);
    return status;
}
