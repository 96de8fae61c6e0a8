/* Repair step 8: faces of (relatively) zero area. Needles lose their shortest edge by a collapse,
 * caps their longest edge by a flip, or are removed at the boundary; some rounds forwards and
 * backwards, since one can hide another. What cannot be improved stays and is logged. */
#include "sdk/mesh/repair/edit.h"

enum { ROUNDS = 32 };
/* Area over squared longest edge: cotangents are at most its inverse, and factors of matrices of
 * them keep half of the digits. */
static const double LEAST = 1e-7;

static double length2(const qc__repair *r, int32_t h) {
    const double *p = qc__repair_point(r, r->triangle[qc_next(h)]);
    const double *q = qc__repair_point(r, r->triangle[qc_prev(h)]);
    double d = 0;
    for (int k = 0; k < 3; k++) d += (p[k] - q[k]) * (p[k] - q[k]);
    return d;
}

static double face_quality(const qc__edit *e, int32_t f) {
    const int32_t *t = e->r->triangle + 3 * (size_t)f;
    return qc__edit_quality(e, t[0], t[1], t[2], NULL);
}

static bool improve(qc__edit *e, int32_t f) {
    int32_t shortest = 3 * f, longest = 3 * f;
    double least = length2(e->r, 3 * f), most = least;
    for (int32_t h = 3 * f + 1; h < 3 * f + 3; h++) {
        double d = length2(e->r, h);
        if (d < least) least = d, shortest = h;
        if (d > most) most = d, longest = h;
    }
    bool needle = least <= 1e-4 * most; /* squares: a hundredth of the longest edge */
    if (needle && qc__edit_collapse(e, shortest, LEAST)) return true;
    if (e->r->twin[longest] < 0 && qc__edit_remove_boundary(e, f)) return true;
    return qc__edit_flip(e, longest, LEAST) || (!needle && qc__edit_collapse(e, shortest, LEAST));
}

static bool is_bad(const qc__edit *e, int32_t f) {
    return e->r->triangle[3 * f] >= 0 && face_quality(e, f) < LEAST;
}

/* Tries every bad face once, forwards or backwards; false when nothing changed. */
static bool improve_all(qc__edit *e, const int32_t *bad, int32_t n, bool backwards) {
    bool any = false;
    for (int32_t i = 0; i < n; i++) {
        int32_t f = bad[backwards ? n - 1 - i : i];
        if (!is_bad(e, f) || !improve(e, f)) continue;
        any = true;
        qc__repair_note(e->r, QC_REPAIR_ZERO_AREA, e->r->source_face[f]);
    }
    return any;
}

qc_status qc__repair_zero_area(qc__repair *r) {
    qc__edit e;
    qc_status status = QC_OK;
    int32_t n = 0, *bad = QC__NEW(r->ctx, int32_t, r->n_faces);
    if (!bad) return QC_ERR_NOMEM;
    if (qc__edit_begin(r, &e) != QC_OK) {
        qc__free(bad);
        return QC_ERR_NOMEM;
    }
    for (int32_t f = 0; f < r->n_faces; f++)
        if (is_bad(&e, f)) bad[n++] = f;
    for (int round = 0; round < ROUNDS && n > 0; round++) {
        if (!improve_all(&e, bad, n, round % 2)) break;
        int32_t left = 0;
        for (int32_t i = 0; i < n; i++)
            if (is_bad(&e, bad[i])) bad[left++] = bad[i];
        n = left;
        if (!qc__progress(r->ctx, 0.7)) status = QC_ERR_CANCELLED;
        if (status != QC_OK) break;
    }
    if (status == QC_OK && n > 0)
        qc__log(r->ctx, QC_LOG_WARNING,
                "repair: %d faces of zero area could not be removed (face %d%s)", (int)n,
                (int)r->source_face[bad[0]], n > 1 ? ", ..." : "");
    qc__edit_end(&e);
    qc__free(bad);
    return status;
}
