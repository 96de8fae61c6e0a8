/* Poles of a mesh: vertices of the surface whose star is cut open (Fig. 8 of the second paper). */
#include "sdk/mesh/internal.h"

static qc_status no_loop(qc_ctx *ctx, int32_t c) {
    return qc__fail(ctx, QC_ERR_ARGUMENT, c,
                    "corner %d of face %d is not the tip of a star which is cut open", (int)(c % 3),
                    (int)(c / 3));
}

static bool is_tip(const qc_mesh *m, int32_t c) {
    return m->twin[qc_next(c)] < 0 && m->twin[qc_prev(c)] < 0;
}

/* Tips grouped by pole; seen: 3 n_faces, zero. *n_poles loops. */
static qc_status group(qc_ctx *ctx, const qc_mesh *m, const uint8_t *tip, uint8_t *seen,
                       int32_t *start, int32_t *corner, int32_t *n_poles) {
    int32_t n = 0;
    *n_poles = 0;
    for (int32_t first = 0; first < 3 * m->n_faces; first++) {
        if (!tip[first] || seen[first]) continue;
        start[(*n_poles)++] = n;
        int32_t c = first;
        do {
            if (!tip[c] || seen[c] || !is_tip(m, c)) return no_loop(ctx, c);
            seen[c] = 1;
            corner[n++] = c;
            c = qc_next_tip(m, c);
        } while (c != first);
    }
    start[*n_poles] = n;
    return QC_OK;
}

qc_status qc_mesh_set_poles(qc_ctx *ctx, qc_mesh *mesh, const uint8_t *tip) {
    int32_t n_tips = 0, n_poles = 0;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) n_tips += tip[c] != 0;
    if (n_tips == 0) return QC_OK;
    uint8_t *seen = QC__ZERO(ctx, uint8_t, 3 * (int64_t)mesh->n_faces);
    int32_t *start = QC__NEW(ctx, int32_t, n_tips + 1), *corner = QC__NEW(ctx, int32_t, n_tips);
    qc_status status = seen && start && corner ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = group(ctx, mesh, tip, seen, start, corner, &n_poles);
    qc__free(seen);
    if (status != QC_OK) {
        qc__free(start);
        qc__free(corner);
        return status;
    }
    mesh->n_poles = n_poles;
    mesh->pole_start = start;
    mesh->pole_corner = corner;
    return QC_OK;
}
