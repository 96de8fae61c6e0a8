/* Segments of the cut graph: paths between its nodes (see seams.h). */
#include "sdk/map/seams/seam_builder.h"
#include <string.h>

/* What a segment that ends at vertex v is incident with. */
static int32_t node_of(const qc__seam_builder *b, int32_t v) {
    return b->hole[v] < 0 ? v : qc__pole_tip(b->cover->mesh, b->hole[v]);
}

/* The cut halfedge leaving the end of h along the graph, at a vertex of degree 2: walk about the
 * vertex from the left side of h until the next cut edge. */
static int32_t next_on_segment(const qc__seam_builder *b, int32_t h) {
    const qc_mesh *mesh = b->cover->mesh;
    int32_t out = qc_next(h); /* leaves the end of h, in the face on the left of h */
    while (!qc__is_cut(b, out)) out = qc_next(mesh->twin[out]);
    return out;
}

/* Traces the segment which starts with halfedge h; its left faces lie on the left of h. */
static void trace_segment(qc__seam_builder *b, int32_t h, int32_t k) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    const int32_t first = h;
    s->segment_node[2 * k] = node_of(b, qc_halfedge_start(mesh, h));
    s->segment_turn[k] = (int8_t)qc__combed_rotation(b->cover, b->face_turn, h);
    for (;;) {
        s->edge_segment[mesh->halfedge_edge[h]] = k;
        s->edge_left[mesh->halfedge_edge[h]] = h;
        const int32_t v = qc_halfedge_end(mesh, h);
        s->segment_node[2 * k + 1] = node_of(b, v);
        if (qc__is_node(b, v)) return;
        h = next_on_segment(b, h);
        if (h == first) return;
    }
}

qc_status qc__seams_segments(qc__seam_builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    int64_t turn_capacity = 0, node_capacity = 0;
    s->edge_segment = QC__NEW(b->ctx, int32_t, mesh->n_edges);
    s->edge_left = QC__NEW(b->ctx, int32_t, mesh->n_edges);
    if (!s->edge_segment || !s->edge_left) return QC_ERR_NOMEM;
    memset(s->edge_segment, -1, sizeof(int32_t) * (size_t)mesh->n_edges);
    memset(s->edge_left, -1, sizeof(int32_t) * (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int32_t side = 0; side < 2; side++) {
            const int32_t h = mesh->edge_halfedge[2 * e + side];
            if (h < 0 || !qc__is_cut(b, h) || s->edge_segment[e] >= 0) continue;
            if (!qc__is_node(b, qc_halfedge_start(mesh, h))) continue;
            const int32_t k = s->n_segments;
            if (!qc__reserve(b->ctx, (void **)&s->segment_turn, &turn_capacity, k + 1,
                             sizeof(int8_t)) ||
                !qc__reserve(b->ctx, (void **)&s->segment_node, &node_capacity, 2 * k + 2,
                             sizeof(int32_t)))
                return QC_ERR_NOMEM;
            trace_segment(b, h, k);
            s->n_segments++;
        }
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (qc__is_cut(b, mesh->edge_halfedge[2 * e]) && s->edge_segment[e] < 0)
            return qc__fail(b->ctx, QC_ERR_FAILED, e, "edge %d lies on a cut cycle without a node",
                            (int)e);
    return QC_OK;
}
