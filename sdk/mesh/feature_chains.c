/* Chains of feature edges: they run between vertices of feature degree other than 2, or round
 * (docs/theory/features.md). */
#include "sdk/mesh/feature_chains.h"

typedef qc__feature_network network;
typedef qc__chain chain;

void qc__feature_network_free(network *w) {
    void *arrays[] = {w->edge, w->crease, w->length, w->angle, w->degree,
                      w->node, w->of,     w->list,   w->chain};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
}

qc_status qc__feature_network_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                     network *w) {
    const size_t E = (size_t)mesh->n_edges;
    *w = (network){.mesh = mesh};
    w->edge = QC__NEW(ctx, uint8_t, E);
    w->crease = QC__NEW(ctx, double, E);
    w->length = QC__NEW(ctx, double, E);
    w->angle = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    w->degree = QC__NEW(ctx, int32_t, mesh->n_vertices);
    w->node = QC__NEW(ctx, uint8_t, mesh->n_vertices);
    w->of = QC__NEW(ctx, int32_t, E);
    w->list = QC__NEW(ctx, int32_t, E);
    w->chain = QC__NEW(ctx, chain, E);
    if (!w->edge || !w->crease || !w->length || !w->angle || !w->degree || !w->node || !w->of ||
        !w->list || !w->chain)
        return QC_ERR_NOMEM;
    for (size_t e = 0; e < E; e++) w->edge[e] = edge[e];
    qc_status status = qc__poll(ctx);
    if (!status) status = qc__crease_angles(ctx, mesh, w->crease);
    if (!status) status = qc__poll(ctx);
    return status ? status
                  : qc_mesh_geometry(ctx, mesh, w->length, NULL, NULL, w->angle, NULL, NULL);
}

int32_t qc__next_edge(const qc_mesh *mesh, int32_t v, int32_t *c) {
    const int32_t first = mesh->vertex_corner[v];
    if (*c == -2) return -1;
    if (*c == -1) {
        *c = first;
        if (mesh->twin[qc_prev(first)] < 0) return mesh->halfedge_edge[qc_prev(first)];
    }
    const int32_t e = mesh->halfedge_edge[qc_next(*c)];
    *c = qc_corner_ccw(mesh, *c);
    if (*c < 0 || *c == first) *c = -2;
    return e;
}

void qc__count_feature_degrees(network *w) {
    for (int32_t v = 0; v < w->mesh->n_vertices; v++) w->degree[v] = 0;
    for (int32_t e = 0; e < w->mesh->n_edges; e++)
        for (int i = 0; i < 2; i++) w->degree[w->mesh->edge_vertex[2 * e + i]] += w->edge[e] != 0;
}

void qc__edge_direction(const qc_mesh *mesh, int32_t e, int32_t from, double out[3]) {
    const double *p = mesh->position + 3 * (size_t)from;
    const double *q = mesh->position + 3 * (size_t)qc__other_end(mesh, e, from);
    for (int i = 0; i < 3; i++) out[i] = q[i] - p[i];
}

/* Of degree other than 2, or where a feature turns back by more than 120 degrees. */
static bool is_node(const network *w, int32_t v) {
    double d[2][3];
    int n = 0;
    if (w->degree[v] != 2) return true;
    for (int32_t k = -1, e; (e = qc__next_edge(w->mesh, v, &k)) >= 0;)
        if (w->edge[e]) qc__edge_direction(w->mesh, e, v, d[n++]);
    const double product = d[0][0] * d[1][0] + d[0][1] * d[1][1] + d[0][2] * d[1][2];
    return product > 0.5 * qc__norm3(d[0]) * qc__norm3(d[1]);
}

static double strength_of(const network *w, int32_t e) {
    if (w->edge[e] & QC_FEATURE_BOUNDARY) return QC__STRENGTH_BOUNDARY;
    return w->edge[e] & (QC_FEATURE_LINE | QC_FEATURE_GROUP) ? QC__STRENGTH_DRAWN : w->crease[e];
}

/* The chain which leaves v over edge e. */
static void walk(network *w, int32_t v, int32_t e) {
    chain *c = &w->chain[w->n];
    *c = (chain){{v, v}, w->n_list, 0, 0, 0, false, false, false};
    while (e >= 0) {
        w->of[e] = w->n;
        w->list[w->n_list++] = e;
        c->n++;
        c->length += w->length[e];
        c->strength += w->length[e] * strength_of(w, e);
        c->end[1] = v = qc__other_end(w->mesh, e, v);
        e = -1;
        if (!w->node[v])
            for (int32_t k = -1, f; (f = qc__next_edge(w->mesh, v, &k)) >= 0;)
                if (w->edge[f] && w->of[f] < 0) e = f;
    }
    if (c->length > 0) c->strength /= c->length;
    w->n++;
}

void qc__find_chains(network *w) {
    const qc_mesh *mesh = w->mesh;
    qc__count_feature_degrees(w);
    for (int32_t v = 0; v < mesh->n_vertices; v++) w->node[v] = is_node(w, v);
    w->n = w->n_list = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) w->of[e] = -1;
    for (int closed = 0; closed < 2; closed++)
        for (int32_t e = 0; e < mesh->n_edges; e++)
            for (int i = 0; i < 2; i++) {
                const int32_t v = mesh->edge_vertex[2 * e + i];
                if (w->edge[e] && w->of[e] < 0 && (closed || w->node[v])) walk(w, v, e);
            }
}

qc_status qc_features_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge, int32_t *of,
                             int32_t *n) {
    network w;
    qc_status status = qc__feature_network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) {
        qc__find_chains(&w);
        for (int32_t e = 0; e < mesh->n_edges; e++) of[e] = w.of[e];
        *n = w.n;
    }
    qc__feature_network_free(&w);
    return status;
}

qc_status qc_features_measure_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                     qc_feature_chain *out) {
    network w;
    qc_status status = qc__feature_network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) qc__find_chains(&w);
    for (int32_t i = 0; status == QC_OK && i < w.n; i++) {
        const chain *c = &w.chain[i];
        qc_feature_chain o = {{c->end[0], c->end[1]}, c->n, 0, c->length, 0};
        for (int32_t j = c->first; j < c->first + c->n; j++) {
            o.kinds |= edge[w.list[j]];
            o.angle += w.length[w.list[j]] * w.crease[w.list[j]];
        }
        if (c->length > 0) o.angle /= c->length;
        out[i] = o;
    }
    qc__feature_network_free(&w);
    return status;
}
