/* Layer shifts at vertices and the gauge of vertex functions (Kaelberer 2013, section 3.2.2: the
 * three cases of a cycle of faces around a vertex). */
#include <qc/cover.h>

#include "sdk/base/internal.h"

qc_status qc_cover_shifts(qc_ctx *ctx, const qc_cover *cover, int8_t *shift) {
    (void)ctx;
    const qc_mesh *m = cover->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++) shift[v] = 0;
    if (!cover->matching) return QC_OK;
    /* The halfedge before corner c counter-clockwise is qc_next(c): each is crossed once. */
    for (int32_t c = 0; c < 3 * m->n_faces; c++) {
        const int32_t v = m->face_vertex[c];
        shift[v] = (int8_t)((shift[v] + qc_cover_turn(cover, qc_next(c))) & 3);
    }
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (qc_vertex_on_boundary(m, v)) shift[v] = 0;
    return QC_OK;
}

qc_status qc_cover_corner_turns(qc_ctx *ctx, const qc_cover *cover, int8_t *corner_turn) {
    (void)ctx;
    const qc_mesh *m = cover->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const int32_t first = m->vertex_corner[v];
        int32_t c = first, turn = 0;
        do {
            corner_turn[c] = (int8_t)turn;
            turn = (turn - qc_cover_turn(cover, qc_next(c))) & 3;
            c = qc_corner_ccw(m, c);
        } while (c >= 0 && c != first);
    }
    return QC_OK;
}
