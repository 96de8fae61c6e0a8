/* Repair steps 3 and 4: faces with a repeated vertex, and all but the first of the faces with the
 * same three vertices, are dropped. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

qc_status qc__repair_degenerate(qc__repair *r) {
    uint8_t *keep = QC__NEW(r->ctx, uint8_t, r->n_faces);
    if (!keep) return QC_ERR_NOMEM;
    for (int32_t f = 0; f < r->n_faces; f++) {
        const int32_t *t = r->triangle + 3 * (size_t)f;
        keep[f] = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        if (!keep[f]) qc__repair_note(r, QC_REPAIR_DEGENERATE, r->source_face[f]);
    }
    qc__repair_keep(r, keep);
    qc__free(keep);
    return QC_OK;
}

static void sorted(const int32_t *t, int32_t out[3]) {
    int32_t a = t[0] < t[1] ? t[0] : t[1], b = t[0] < t[1] ? t[1] : t[0], c = t[2];
    out[0] = c < a ? c : a;
    out[1] = c < a ? a : c < b ? c : b;
    out[2] = c < b ? b : c;
}

static size_t hash_triple(const int32_t v[3]) {
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        h = (h ^ (uint32_t)v[k]) * UINT64_C(0x9e3779b97f4a7c15);
        h ^= h >> 32;
    }
    return (size_t)h;
}

qc_status qc__repair_duplicate(qc__repair *r) {
    size_t size = 16;
    while (size < 2 * (size_t)r->n_faces) size *= 2;
    uint8_t *keep = QC__NEW(r->ctx, uint8_t, r->n_faces);
    int32_t *slot = QC__NEW(r->ctx, int32_t, size);
    if (!keep || !slot) {
        qc__free(keep);
        qc__free(slot);
        return QC_ERR_NOMEM;
    }
    memset(slot, 0xff, size * sizeof *slot);
    for (int32_t f = 0; f < r->n_faces; f++) {
        int32_t a[3], b[3];
        sorted(r->triangle + 3 * (size_t)f, a);
        size_t i = hash_triple(a) & (size - 1);
        for (; slot[i] >= 0; i = (i + 1) & (size - 1)) {
            sorted(r->triangle + 3 * (size_t)slot[i], b);
            if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) break;
        }
        keep[f] = slot[i] < 0;
        if (keep[f])
            slot[i] = f;
        else
            qc__repair_note(r, QC_REPAIR_DUPLICATE, r->source_face[f]);
    }
    qc__repair_keep(r, keep);
    qc__free(keep);
    qc__free(slot);
    return QC_OK;
}
