/* Shortest cut graph through base vertices: Algorithm 1.16 of Kaelberer's thesis (Erickson and
 * Whittlesey 2005) with all base and boundary vertices identified to one point.
 *
 * T is the shortest-path forest from the base vertices. The dual of G \ T is connected, since every
 * tree of T meets the base set in its root only. T* is its maximum spanning tree for |sigma(e)| =
 * dist(a) + dist(b) + |e|. The faces glued along T* are a disk; the edges in neither tree, with
 * their paths in T to the roots, are what the boundary of that disk keeps when the dangling
 * branches of T are pruned. Closed component of genus g with k base vertices: 2g + k - 1 such
 * edges; with b boundary loops and k interior base vertices: 2g + b - 1 + k. The identified graph
 * is connected, so for two or more base vertices (or a handle) each of them is on it, and as roots
 * have no predecessor no path runs through one.
 *
 * A sphere with one base vertex (or none) has an empty graph: it stays a closed sphere, a disk only
 * in the sense that the sphere without the base point is an open one. Callers who need a disk there
 * give a second base vertex. */
#include <string.h>

#include "sdk/mesh/internal.h"

typedef struct work {
    uint8_t *root, *used; /* by vertex: root of the forest; by edge: in T or T* */
    double *distance;
    int32_t *predecessor, *face_set, *order;
    uint64_t *key;
} work;

static bool work_create(qc_ctx *ctx, const qc_mesh *m, work *w) {
    w->root = QC__ZERO(ctx, uint8_t, m->n_vertices);
    w->used = QC__ZERO(ctx, uint8_t, m->n_edges);
    w->distance = QC__NEW(ctx, double, m->n_vertices);
    w->predecessor = QC__NEW(ctx, int32_t, m->n_vertices);
    w->face_set = QC__NEW(ctx, int32_t, m->n_faces);
    w->order = QC__NEW(ctx, int32_t, m->n_edges);
    w->key = QC__NEW(ctx, uint64_t, m->n_edges);
    return w->root && w->used && w->distance && w->predecessor && w->face_set && w->order && w->key;
}

static void work_free(work *w) {
    qc__free(w->root);
    qc__free(w->used);
    qc__free(w->distance);
    qc__free(w->predecessor);
    qc__free(w->face_set);
    qc__free(w->order);
    qc__free(w->key);
}

/* Base and boundary vertices, and the lowest vertex of a component which has neither. */
static qc_status find_roots(qc_ctx *ctx, const qc_mesh *m, const uint8_t *base, uint8_t *root) {
    uint8_t *rooted = QC__ZERO(ctx, uint8_t, m->n_components);
    if (!rooted) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        root[v] = (base && base[v]) || qc_vertex_on_boundary(m, v);
        if (root[v]) rooted[m->face_component[m->vertex_corner[v] / 3]] = 1;
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        int32_t c = m->face_component[m->vertex_corner[v] / 3];
        if (!rooted[c]) root[v] = rooted[c] = 1;
    }
    qc__free(rooted);
    return QC_OK;
}

/* Kruskal on the dual of G \ T, longest loop first; equal loops by edge number. */
static qc_status dual_tree(qc_ctx *ctx, const qc_mesh *m, const double *weight, work *w) {
    int32_t n = 0;
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (w->predecessor[v] >= 0) w->used[w->predecessor[v]] = 1;
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (w->used[e] || m->edge_halfedge[2 * e + 1] < 0) continue;
        const int32_t *ends = m->edge_vertex + 2 * (size_t)e;
        w->key[n] = ~qc__sort_key(w->distance[ends[0]] + w->distance[ends[1]] + weight[e]);
        w->order[n++] = e;
    }
    qc_status status = qc__sort_keys(ctx, n, w->key, w->order);
    if (status != QC_OK) return status;
    if (!qc__progress(ctx, 0.8)) return QC_ERR_CANCELLED;
    qc__sets_init(w->face_set, m->n_faces);
    for (int32_t i = 0; i < n; i++) {
        const int32_t *h = m->edge_halfedge + 2 * (size_t)w->order[i];
        if (qc__sets_unite(w->face_set, h[0] / 3, h[1] / 3)) w->used[w->order[i]] = 1;
    }
    return QC_OK;
}

/* Marks the path of T from v to its root. It ends early on a marked edge: the rest is marked too.
 */
static void mark_path(const qc_mesh *m, const int32_t *predecessor, int32_t v, uint8_t *cut) {
    while (predecessor[v] >= 0 && !cut[predecessor[v]]) {
        int32_t e = predecessor[v];
        cut[e] = 1;
        v = m->edge_vertex[2 * e] == v ? m->edge_vertex[2 * e + 1] : m->edge_vertex[2 * e];
    }
}

static void mark_cut(const qc_mesh *m, const work *w, uint8_t *cut) {
    memset(cut, 0, (size_t)m->n_edges);
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (w->used[e] || m->edge_halfedge[2 * e + 1] < 0) continue;
        cut[e] = 1;
        mark_path(m, w->predecessor, m->edge_vertex[2 * e], cut);
        mark_path(m, w->predecessor, m->edge_vertex[2 * e + 1], cut);
    }
}

static qc_status build(qc_ctx *ctx, const qc_mesh *m, const double *weight, const uint8_t *base,
                       work *w) {
    qc_status status = find_roots(ctx, m, base, w->root);
    if (status != QC_OK) return status;
    qc__range outer = qc__range_begin(ctx, NULL, 0.0, 0.6);
    status = qc_mesh_shortest_paths(ctx, m, weight, w->root, w->distance, w->predecessor);
    qc__range_end(ctx, outer);
    return status == QC_OK ? dual_tree(ctx, m, weight, w) : status;
}

qc_status qc_mesh_cut_graph(qc_ctx *ctx, const qc_mesh *m, const double *weight,
                            const uint8_t *base, uint8_t *cut) {
    work w = {0};
    double *length = weight ? NULL : QC__NEW(ctx, double, m->n_edges);
    qc_status status = (weight || length) && work_create(ctx, m, &w) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && length)
        status = qc_mesh_geometry(ctx, m, length, NULL, NULL, NULL, NULL, NULL);
    if (status == QC_OK) status = build(ctx, m, weight ? weight : length, base, &w);
    if (status == QC_OK) mark_cut(m, &w, cut);
    qc__free(length);
    work_free(&w);
    return status;
}
