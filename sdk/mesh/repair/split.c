/* Repair step 7: one copy of a vertex for each fan of faces around it.
 *
 * Corners joined across paired halfedges are one fan. Where an edge was cut and both its ends still
 * are one fan, the copies would coincide again: the surplus faces there are detached altogether. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

/* fan[c]: number of the fan of corner c, numbered by lowest corner; returns how many. */
static int32_t number_fans(const qc__repair *r, int32_t *parent, int32_t *fan) {
    int32_t n = 3 * r->n_faces, m = 0;
    qc__sets_init(parent, n);
    for (int32_t h = 0; h < n; h++) {
        int32_t g = r->twin[h];
        if (g < h) continue;
        qc__sets_unite(parent, qc_next(h), qc_prev(g));
        qc__sets_unite(parent, qc_prev(h), qc_next(g));
    }
    for (int32_t c = 0; c < n; c++) {
        int32_t root = qc__sets_find(parent, c);
        fan[c] = root == c ? m++ : fan[root];
    }
    return m;
}

static void detach(qc__repair *r, int32_t face) {
    for (int32_t h = 3 * face; h < 3 * face + 3; h++) {
        if (r->twin[h] >= 0) r->twin[r->twin[h]] = -1;
        r->twin[h] = -1;
    }
}

/* Detaches what would fall together again at one edge; true when anything was. */
static bool separate(qc__repair *r, const int32_t *side, int32_t n) {
    if (n == 1 || (n == 2 && r->twin[side[0]] == side[1])) return false;
    int32_t keep = side[0], partner = -1;
    for (int32_t i = 0; i < n; i++)
        if (r->twin[side[i]] >= 0) {
            keep = side[i];
            partner = r->twin[keep];
            break;
        }
    for (int32_t i = 0; i < n; i++)
        if (side[i] != keep && side[i] != partner) detach(r, side[i] / 3);
    return true;
}

static qc_status separate_all(qc__repair *r, int32_t *parent, int32_t *fan) {
    for (bool again = true; again;) {
        qc__edge_groups edges;
        int32_t n_fans = number_fans(r, parent, fan);
        again = false;
        qc_status status = qc__edge_groups_create(r->ctx, n_fans, r->n_faces, fan, &edges);
        if (status != QC_OK) return status;
        for (int32_t i = 0; i < edges.n; i++)
            again |= separate(r, edges.order + edges.start[i], edges.start[i + 1] - edges.start[i]);
        qc__edge_groups_free(&edges);
        if (!qc__progress(r->ctx, 0.6)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* The first fan of a vertex keeps its number, the others become new vertices. */
static qc_status copy_vertices(qc__repair *r, int32_t n_fans, const int32_t *fan) {
    int32_t *vertex = QC__NEW(r->ctx, int32_t, n_fans); /* of each fan */
    int32_t *source = QC__NEW(r->ctx, int32_t, (size_t)r->n_vertices + (size_t)n_fans);
    uint8_t *taken = QC__ZERO(r->ctx, uint8_t, r->n_vertices);
    if (!vertex || !source || !taken) {
        qc__free(vertex);
        qc__free(source);
        qc__free(taken);
        return QC_ERR_NOMEM;
    }
    int32_t n = r->n_vertices, next_fan = 0;
    memcpy(source, r->source_vertex, (size_t)n * sizeof *source);
    for (int32_t c = 0; c < 3 * r->n_faces; c++) {
        int32_t v = r->triangle[c];
        if (fan[c] == next_fan) { /* the lowest corner of its fan */
            next_fan++;
            if (taken[v] == 1 && !r->cut[v]) qc__repair_note(r, QC_REPAIR_NON_MANIFOLD_VERTEX, v);
            vertex[fan[c]] = taken[v] ? n : v;
            if (taken[v]) source[n++] = r->source_vertex[v];
            taken[v] = taken[v] ? 2 : 1;
        }
        r->triangle[c] = vertex[fan[c]];
    }
    qc__free(vertex);
    qc__free(taken);
    qc__free(r->source_vertex);
    r->source_vertex = source;
    r->n_vertices = n;
    return QC_OK;
}

qc_status qc__repair_split(qc__repair *r) {
    int32_t *parent = QC__NEW(r->ctx, int32_t, 3 * (size_t)r->n_faces);
    int32_t *fan = QC__NEW(r->ctx, int32_t, 3 * (size_t)r->n_faces);
    qc_status status = parent && fan ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && r->report->count[QC_REPAIR_NON_MANIFOLD_EDGE] > 0)
        status = separate_all(r, parent, fan);
    if (status == QC_OK) status = copy_vertices(r, number_fans(r, parent, fan), fan);
    qc__free(parent);
    qc__free(fan);
    return status;
}
