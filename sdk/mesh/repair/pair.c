/* Repair step 5: pairs the halfedges of each edge; edges with three or more faces are cut open as
 * edge_fit.c decides. */
#include "sdk/mesh/repair/internal.h"

qc_status qc__repair_pair(qc__repair *r) {
    qc__edge_groups edges;
    r->twin = QC__NEW(r->ctx, int32_t, 3 * (size_t)r->n_faces);
    r->cut = QC__ZERO(r->ctx, uint8_t, r->n_vertices);
    if (!r->twin || !r->cut) return QC_ERR_NOMEM;
    qc_status status =
        qc__edge_groups_create(r->ctx, r->n_vertices, r->n_faces, r->triangle, &edges);
    if (status != QC_OK) return status;
    for (int32_t h = 0; h < 3 * r->n_faces; h++) r->twin[h] = -1;
    for (int32_t i = 0; i < edges.n; i++) {
        const int32_t *side = edges.order + edges.start[i];
        int32_t n = edges.start[i + 1] - edges.start[i];
        if (n == 2) {
            r->twin[side[0]] = side[1];
            r->twin[side[1]] = side[0];
        } else if (n > 2) {
            qc__repair_note(r, QC_REPAIR_NON_MANIFOLD_EDGE, r->source_face[side[0] / 3]);
            r->cut[r->triangle[qc_next(side[0])]] = 1;
            r->cut[r->triangle[qc_prev(side[0])]] = 1;
            qc__repair_pair_best(r, side, n);
        }
    }
    qc__edge_groups_free(&edges);
    return QC_OK;
}
