/* Boundary loops. The boundary halfedge after h starts at the end of h, where the clockwise-most
 * corner of the fan lies: no search is needed. */
#include "sdk/mesh/internal.h"

static int32_t next_boundary(const qc_mesh *m, int32_t h) {
    return qc_prev(m->vertex_corner[qc_halfedge_end(m, h)]);
}

qc_status qc__mesh_walk_boundary(qc_ctx *ctx, const qc_mesh *m, int32_t *n_loops,
                                 int32_t *loop_offset, int32_t *loop_vertex) {
    uint8_t *seen = QC__ZERO(ctx, uint8_t, m->n_edges);
    if (!seen) return QC_ERR_NOMEM;
    int32_t loops = 0, n = 0;
    for (int32_t first = 0; first < 3 * m->n_faces; first++) {
        if (m->twin[first] >= 0 || seen[m->halfedge_edge[first]]) continue;
        if (loop_offset) loop_offset[loops] = n;
        loops++;
        int32_t h = first;
        do {
            seen[m->halfedge_edge[h]] = 1;
            if (loop_vertex) loop_vertex[n] = qc_halfedge_start(m, h);
            n++;
            h = next_boundary(m, h);
        } while (h != first);
    }
    if (loop_offset) loop_offset[loops] = n;
    *n_loops = loops;
    qc__free(seen);
    return QC_OK;
}

qc_status qc_mesh_boundary_loops(qc_ctx *ctx, const qc_mesh *m, int32_t *loop_offset,
                                 int32_t *loop_vertex) {
    int32_t n_loops;
    return qc__mesh_walk_boundary(ctx, m, &n_loops, loop_offset, loop_vertex);
}
