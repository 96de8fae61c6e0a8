/* Combing: a gauge of the faces in which the matching vanishes on a spanning tree of the dual
 * graph. What is left on the other edges generates the holonomy group. */
#include <qc/cover.h>

#include "sdk/base/internal.h"

/* Breadth first from `root` over uncut edges; f_t = i^{-m} f_s and f' = i^{turn} f agree when
 * turn_t = turn_s + m. */
static void comb_patch(const qc_cover *cover, const uint8_t *cut, int32_t root, int8_t *turn,
                       int32_t *queue) {
    const qc_mesh *m = cover->mesh;
    int32_t head = 0, tail = 0;
    turn[root] = 0;
    queue[tail++] = root;
    while (head < tail) {
        const int32_t t = queue[head++];
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            if (m->twin[h] < 0 || (cut && cut[m->halfedge_edge[h]])) continue;
            const int32_t other = m->twin[h] / 3;
            if (turn[other] >= 0) continue;
            turn[other] = (int8_t)((turn[t] + qc_cover_turn(cover, h)) & 3);
            queue[tail++] = other;
        }
    }
}

qc_status qc_cover_comb(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut, int8_t *face_turn,
                        int8_t *residual, uint8_t *trivial) {
    const qc_mesh *m = cover->mesh;
    int32_t *queue = QC__NEW(ctx, int32_t, m->n_faces);
    if (!queue) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < m->n_faces; t++) face_turn[t] = -1;
    for (int32_t t = 0; t < m->n_faces; t++)
        if (face_turn[t] < 0) comb_patch(cover, cut, t, face_turn, queue);
    qc__free(queue);
    for (int32_t i = 0; trivial && i < m->n_components; i++) trivial[i] = 1;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t s = m->edge_halfedge[2 * e], t = m->edge_halfedge[2 * e + 1];
        const int32_t r =
            t < 0 ? 0 : (qc_cover_turn(cover, s) + face_turn[s / 3] - face_turn[t / 3]) & 3;
        if (residual) residual[e] = (int8_t)r;
        if (trivial && r != 0 && !(cut && cut[e])) trivial[m->face_component[s / 3]] = 0;
    }
    return QC_OK;
}
