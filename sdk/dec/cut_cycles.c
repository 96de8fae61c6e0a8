/* Generators of the homology of a surface (relative to its boundary) from its cut graph (Kaelberer
 * 2013, sections 1.2.6 and 1.3). */
#include "sdk/dec/cut_cycles.h"

#include "sdk/mesh/internal.h"

/* Boundary vertices share the node of the first one in their component. */
static qc_status number_nodes(qc_ctx *ctx, const qc_mesh *m, int32_t *node) {
    int32_t *boundary = QC__NEW(ctx, int32_t, m->n_components);
    if (!boundary) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < m->n_components; i++) boundary[i] = -1;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        node[v] = v;
        if (!qc_vertex_on_boundary(m, v)) continue;
        const int32_t i = m->face_component[m->vertex_corner[v] / 3];
        if (boundary[i] < 0) boundary[i] = v;
        node[v] = boundary[i];
    }
    qc__free(boundary);
    return QC_OK;
}

static int32_t other_end(const qc__cut_cycles *c, int32_t e, int32_t node) {
    const int32_t a = c->node[c->mesh->edge_vertex[2 * e]];
    return a == node ? c->node[c->mesh->edge_vertex[2 * e + 1]] : a;
}

/* adjacent[start[n] .. start[n + 1]): tree edges at node n. */
static void list_edges(const qc__cut_cycles *c, const uint8_t *tree, int32_t *start,
                       int32_t *adjacent) {
    const qc_mesh *m = c->mesh;
    for (int32_t v = 0; v <= m->n_vertices; v++) start[v] = 0;
    for (int32_t e = 0; e < m->n_edges; e++)
        for (int k = 0; tree[e] && k < 2; k++) start[c->node[m->edge_vertex[2 * e + k]]]++;
    for (int32_t v = 0; v < m->n_vertices; v++) start[v + 1] += start[v];
    for (int32_t e = m->n_edges - 1; e >= 0; e--)
        for (int k = 0; tree[e] && k < 2; k++)
            adjacent[--start[c->node[m->edge_vertex[2 * e + k]]]] = e;
}

/* Orients the forest: parent_edge of every node, roots are the lowest nodes. */
static void root_forest(qc__cut_cycles *c, const int32_t *start, const int32_t *adjacent,
                        int32_t *stack) {
    const int32_t n = c->mesh->n_vertices;
    for (int32_t v = 0; v < n; v++) c->parent_edge[v] = -2;
    for (int32_t root = 0; root < n; root++) {
        if (c->parent_edge[root] != -2) continue;
        int32_t top = 0;
        c->parent_edge[root] = -1;
        stack[top++] = root;
        while (top > 0) {
            const int32_t v = stack[--top];
            for (int32_t p = start[v]; p < start[v + 1]; p++) {
                const int32_t w = other_end(c, adjacent[p], v);
                if (c->parent_edge[w] != -2) continue;
                c->parent_edge[w] = adjacent[p];
                stack[top++] = w;
            }
        }
    }
}

/* tree: 1 on edges of a spanning forest; the other cut edges become generators. */
static void split_edges(qc__cut_cycles *c, const uint8_t *cut, int32_t *sets, uint8_t *tree) {
    const qc_mesh *m = c->mesh;
    qc__sets_init(sets, m->n_vertices);
    for (int32_t e = 0; e < m->n_edges; e++) {
        tree[e] = cut[e] && qc__sets_unite(sets, c->node[m->edge_vertex[2 * e]],
                                           c->node[m->edge_vertex[2 * e + 1]]);
        if (cut[e] && !tree[e]) c->generator[c->count++] = e;
    }
}

qc_status qc__cut_cycles_create(qc_ctx *ctx, const qc_mesh *m, qc__cut_cycles *out) {
    qc__cut_cycles c = {m, NULL, NULL, 0, NULL};
    uint8_t *cut = QC__NEW(ctx, uint8_t, m->n_edges), *tree = QC__NEW(ctx, uint8_t, m->n_edges);
    int32_t *start = QC__NEW(ctx, int32_t, (size_t)m->n_vertices + 1);
    int32_t *adjacent = QC__NEW(ctx, int32_t, 2 * (size_t)m->n_edges);
    int32_t *work = QC__NEW(ctx, int32_t, m->n_vertices);
    c.node = QC__NEW(ctx, int32_t, m->n_vertices);
    c.parent_edge = QC__NEW(ctx, int32_t, m->n_vertices);
    c.generator = QC__NEW(ctx, int32_t, m->n_edges);
    const bool room =
        cut && tree && start && adjacent && work && c.node && c.parent_edge && c.generator;
    qc_status status = room ? number_nodes(ctx, m, c.node) : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_mesh_cut_graph(ctx, m, NULL, NULL, cut);
    if (status == QC_OK) {
        split_edges(&c, cut, work, tree);
        list_edges(&c, tree, start, adjacent);
        root_forest(&c, start, adjacent, work);
    }
    qc__free(cut);
    qc__free(tree);
    qc__free(start);
    qc__free(adjacent);
    qc__free(work);
    if (status != QC_OK)
        qc__cut_cycles_free(&c);
    else
        *out = c;
    return status;
}

void qc__cut_cycles_free(qc__cut_cycles *c) {
    qc__free(c->node);
    qc__free(c->parent_edge);
    qc__free(c->generator);
}

/* Sends `amount` from node v along the forest to its root. */
static void drain(const qc__cut_cycles *c, int32_t v, int32_t amount, int32_t *flow) {
    for (int32_t e; (e = c->parent_edge[v]) >= 0; v = other_end(c, e, v))
        flow[e] += c->node[c->mesh->edge_vertex[2 * e]] == v ? amount : -amount;
}

void qc__cut_cycles_add(const qc__cut_cycles *c, int32_t i, int32_t amount, int32_t *flow) {
    const int32_t e = c->generator[i];
    flow[e] += amount;
    drain(c, c->node[c->mesh->edge_vertex[2 * e + 1]], amount, flow);
    drain(c, c->node[c->mesh->edge_vertex[2 * e]], -amount, flow);
}
