/* Closed integer vectors: the wanted ones rounded, and what is left over in the triangles pushed
 * along shortest paths to where it is missing (see integers.h). */
#include <math.h>

#include "sdk/map/quantize/integers.h"

/* Features get at least one unit along their axis. */
static qc__point rounded(const qc__integers *q, int32_t h) {
    const double *w = q->wanted + 2 * (int64_t)h;
    const int32_t axis = q->T.axis[h];
    if (axis < 0) return (qc__point){(int64_t)rint(w[0]), (int64_t)rint(w[1])};
    const double along = axis & 1 ? fabs(w[1]) : fabs(w[0]);
    return qc__turn_point((qc__point){(int64_t)fmax(1, rint(along)), 0}, axis);
}

static void round_all(qc__integers *q) {
    const qc__triangulation *c = &q->T;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++) {
        const int32_t g = c->twin[h];
        if (g >= 0 && g < h) continue;
        q->x[h] = rounded(q, h);
        if (g >= 0) q->x[g] = qc__turn_point(q->x[h], c->rotation[h] + 2);
    }
}

static int32_t any_direction(qc__point d) {
    return d.u > 0 ? 0 : d.v > 0 ? 1 : d.u < 0 ? 2 : 3;
}

/* Moves one unit of the defect of t to where it is missing. */
static qc_status settle_unit(qc__integers *q, qc__point *defect, int32_t t, bool *closed) {
    const int32_t k = any_direction(defect[t]), seed[3] = {3 * t, 3 * t + 1, 3 * t + 2};
    const qc__goal goal = {-1, 0, defect, false, INFINITY};
    qc__found inside, outside;
    defect[t] = qc__minus(defect[t], qc__turn_point((qc__point){1, 0}, k));
    qc__integers_search(q, seed, 3, k, &goal, &inside, q->has_boundary ? &outside : NULL);
    const bool leaves = q->has_boundary && outside.length < inside.length;
    const qc__found *found = leaves ? &outside : &inside;
    if (isinf(found->length)) {
        *closed = false;
        return QC_OK;
    }
    q->n_path = 0;
    if (!qc__integers_append(q, found)) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < q->n_path; i++) {
        const int32_t h = q->path[i].halfedge, g = q->T.twin[h];
        const qc__point d = qc__turn_point((qc__point){1, 0}, q->path[i].k);
        q->x[h] = qc__minus(q->x[h], d);
        if (g >= 0) q->x[g] = qc__plus(q->x[g], qc__turn_point(d, q->T.rotation[h]));
    }
    if (!leaves) {
        qc__point *end = &defect[found->state / 12];
        *end = qc__plus(*end, qc__turn_point((qc__point){1, 0}, found->state % 4));
    }
    return QC_OK;
}

qc_status qc__integers_start(qc__integers *q, bool *closed) {
    const int32_t n = q->T.n_triangles;
    qc__point *defect = QC__NEW(q->ctx, qc__point, n);
    if (!defect) return QC_ERR_NOMEM;
    round_all(q);
    for (int32_t t = 0; t < n; t++) {
        const qc__point *x = q->x + 3 * (int64_t)t;
        defect[t] = qc__plus(qc__plus(x[0], x[1]), x[2]);
    }
    qc_status status = QC_OK;
    *closed = true;
    for (int32_t t = 0; t < n && status == QC_OK && *closed; t++) {
        if (!qc__progress(q->ctx, 0)) status = QC_ERR_CANCELLED;
        while (status == QC_OK && *closed && (defect[t].u != 0 || defect[t].v != 0))
            status = settle_unit(q, defect, t, closed);
    }
    qc__free(defect);
    return status;
}
