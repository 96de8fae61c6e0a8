/* Paths of faces lifted to the covering, symmetric loops (Kaelberer 2013, section 4.2) and the deck
 * transformations. */
#include <qc/cover.h>

#include "sdk/base/internal.h"

qc_status qc_cover_deck(qc_ctx *ctx, const qc_cover *cover, int32_t k, int32_t *deck) {
    const int32_t n = cover->mesh->n_faces;
    if (n > INT32_MAX / 12)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the covering of %d faces does not fit 32-bit numbers", (int)n);
    for (int32_t i = 0; i < 4 * n; i++) deck[i] = (i & ~3) | ((i + (k & 3)) & 3);
    return QC_OK;
}

/* The lowest halfedge of a whose twin is in b; -1 when there is none. */
static int32_t shared_halfedge(const qc_mesh *m, int32_t a, int32_t b) {
    for (int32_t h = 3 * a; h < 3 * a + 3; h++)
        if (m->twin[h] >= 0 && m->twin[h] / 3 == b) return h;
    return -1;
}

static qc_status check_path(qc_ctx *ctx, const qc_mesh *m, int32_t n, const int32_t *path) {
    for (int32_t i = 0; i < n; i++)
        if (path[i] < 0 || path[i] >= m->n_faces)
            return qc__fail(ctx, QC_ERR_ARGUMENT, i,
                            "entry %d of the path is face %d, valid are 0 to %d", (int)i,
                            (int)path[i], (int)m->n_faces - 1);
    for (int32_t i = 0; i + 1 < n; i++)
        if (shared_halfedge(m, path[i], path[i + 1]) < 0)
            return qc__fail(ctx, QC_ERR_ARGUMENT, i,
                            "entries %d and %d of the path, faces %d and %d, share no edge", (int)i,
                            (int)i + 1, (int)path[i], (int)path[i + 1]);
    return QC_OK;
}

qc_status qc_cover_lift(qc_ctx *ctx, const qc_cover *cover, int32_t n, const int32_t *face_path,
                        int32_t layer, int8_t *layers) {
    const qc_status status = check_path(ctx, cover->mesh, n, face_path);
    if (status != QC_OK) return status;
    int32_t l = layer & 3;
    for (int32_t i = 0; i < n; i++) {
        layers[i] = (int8_t)l;
        if (i + 1 < n)
            l = qc_cover_layer(cover, shared_halfedge(cover->mesh, face_path[i], face_path[i + 1]),
                               l);
    }
    return QC_OK;
}

qc_status qc_cover_symmetric_loop(qc_ctx *ctx, const qc_cover *cover, int32_t n,
                                  const int32_t *face_path, int32_t layer, int32_t *faces,
                                  int8_t *layers) {
    const qc_status status = qc_cover_lift(ctx, cover, n, face_path, layer, layers);
    if (status != QC_OK) return status;
    for (int32_t i = 0; i < n; i++) {
        faces[i] = faces[2 * n - 1 - i] = face_path[i];
        layers[2 * n - 1 - i] = (int8_t)((layers[i] + 2) & 3);
    }
    return QC_OK;
}
