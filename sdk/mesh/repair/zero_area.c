/* Repair step 8: faces of (relatively) zero area. Needles lose their shortest edge by a collapse, caps
 * their longest edge by a flip, or are removed at the boundary; a few rounds, since one can hide
 * another. What cannot be improved stays and is logged. */
#include "sdk/mesh/repair/edit.h"

enum { ROUNDS = 16 };
static const double LEAST = 1e-12; /* area over squared longest edge                               */

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
    bool needle = least <= 1e-4 * most; /* squares: a hundredth of the longest edge                   */
    if (needle && qc__edit_collapse(e, shortest, LEAST)) return true;
    if (e->r->twin[longest] < 0 && qc__edit_remove_boundary(e, f)) return true;
    return qc__edit_flip(e, longest, LEAST) || (!needle && qc__edit_collapse(e, shortest, LEAST));
}

qc_status qc__repair_zero_area(qc__repair *r) {
    qc__edit e;
    int32_t n = 0, left = 0;
    int32_t *bad = QC__NEW(r->ctx, int32_t, r->n_faces);
    qc_status status = bad ? qc__edit_begin(r, &e) : QC_ERR_NOMEM;
    if (status != QC_OK) {
        qc__free(bad);
        return status;
    }
    for (int32_t f = 0; f < r->n_faces; f++)
        if (face_quality(&e, f) < LEAST) bad[n++] = f;
    for (int round = 0; round < ROUNDS && n > 0; round++) {
        bool any = false;
        left = 0;
        for (int32_t i = 0; i < n && status == QC_OK; i++) {
            int32_t f = bad[i];
            if (r->triangle[3 * f] < 0 || face_quality(&e, f) >= LEAST) continue;
            int32_t source = r->source_face[f];
            if (improve(&e, f)) {
                any = true;
                qc__repair_note(r, QC_REPAIR_ZERO_AREA, source);
            }
            if (r->triangle[3 * f] >= 0 && face_quality(&e, f) < LEAST) bad[left++] = f;
            if (i % 256 == 0 && !qc__progress(r->ctx, 0.7)) status = QC_ERR_CANCELLED;
        }
        n = left;
        if (!any) break;
    }
    if (status == QC_OK && n > 0)
        qc__log(r->ctx, QC_LOG_WARNING, "repair: %d faces of zero area could not be removed (face %d%s)",
                (int)n, (int)r->source_face[bad[0]], n > 1 ? ", ..." : "");
    qc__edit_end(&e);
    qc__free(bad);
    return status;
}
