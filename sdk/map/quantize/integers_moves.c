/* Moves of integer vectors: closed paths of units which lower the energy or mend what is violated
 * (see integers.h). */
#include <math.h>

#include "sdk/map/quantize/integers.h"

enum { PATIENCE = 2 /* sweeps */, FLIP_ROUNDS = 10 };
static const double stuck = 0.9; /* of the violation, left by a sweep */
/* Of a path which mends a violation; of others it is what they gain. */
static const double mending_limit = 50;

/* --- one move --------------------------------------------------------------------------------- */

static bool is_violated(const qc__integers *q, int32_t h) {
    const int32_t g = q->T.twin[h];
    if (q->violation == 0) return false;
    if (qc__integers_area(q, h / 3) <= 0 || (g >= 0 && qc__integers_area(q, g / 3) <= 0))
        return true;
    const int32_t a = q->T.origin[h], b = q->T.origin[qc_next(h)];
    return (q->expected[a] >= 0 && q->turns[a] != q->expected[a]) ||
           (q->expected[b] >= 0 && q->turns[b] != q->expected[b]);
}

/* The cheapest closed path which crosses h with a unit i^k, or path between boundaries, becomes
 * q->path. *found: whether there is one below the limit. */
static qc_status find_path(qc__integers *q, int32_t h, int32_t k, double limit, bool *found) {
    const qc__triangulation *c = &q->T;
    const int32_t g = c->twin[h];
    const qc__goal around = {h, k, NULL, true, limit}, out = {-1, 0, NULL, true, limit};
    qc__found loop = {INFINITY, -1, -1}, there = loop, back = loop, none;
    bool room = true;
    q->n_path = 0;
    if (g >= 0) {
        qc__integers_search(q, &g, 1, k + c->rotation[h], &around, &loop,
                            q->has_boundary ? &there : NULL);
        if (loop.length <= there.length)
            room = isinf(loop.length) || qc__integers_append(q, &loop);
        else
            room = qc__integers_append(q, &there);
    }
    if (q->has_boundary && room && (g < 0 || there.length < loop.length)) {
        qc__integers_search(q, &h, 1, k + 2, &out, &none, &back);
        const double length = back.length + (g < 0 ? 0 : there.length);
        if (length < limit && length < loop.length) {
            room = qc__integers_append(q, &back);
            loop.length = length;
        } else { /* the way there alone leads nowhere */
            q->n_path = 0;
            loop.length = INFINITY;
        }
    }
    *found = loop.length < limit;
    if (*found && room) room = qc__integers_cross(q, h, k);
    return room ? QC_OK : QC_ERR_NOMEM;
}

/* Applies the path as often as it helps. */
static bool improve(qc__integers *q) {
    bool improved = false;
    for (int64_t times = 1;; times *= 2) {
        const int64_t violation = q->violation;
        const double energy = q->energy;
        qc__integers_apply(q, times);
        if (q->violation < violation ||
            (q->violation == violation && q->energy < energy - 1e-9 * (1 + energy))) {
            improved = true;
            continue;
        }
        qc__integers_apply(q, -times);
        return improved;
    }
}

static qc_status try_edge(qc__integers *q, int32_t h, bool *improved) {
    for (int32_t k = 0; k < 4; k++) {
        if (!qc__may_cross(&q->T, h, k)) continue;
        const double gain = -qc__integers_change(q, h, k);
        const double limit = is_violated(q, h) ? mending_limit : gain * q->reach;
        if (!(limit > 0)) continue;
        bool found;
        const qc_status status = find_path(q, h, k, limit, &found);
        if (status != QC_OK) return status;
        if (found && improve(q)) *improved = true;
    }
    return QC_OK;
}

/* Moves until none helps, or until a sweep over the edges mends next to nothing of what is
 * violated. */
static qc_status sweep_edges(qc__integers *q, bool *stuck_here) {
    const qc__triangulation *c = &q->T;
    bool improved = true;
    for (int32_t sweep = 0; improved; sweep++) {
        const int64_t before = q->violation;
        improved = false;
        for (int32_t h = 0; h < 3 * c->n_triangles; h++) {
            if (c->twin[h] >= 0 && c->twin[h] < h) continue;
            if (h % 64 == 0 && !qc__progress(q->ctx, 0)) return QC_ERR_CANCELLED;
            const qc_status status = try_edge(q, h, &improved);
            if (status != QC_OK) return status;
        }
        *stuck_here = sweep >= PATIENCE && (double)q->violation > stuck * (double)before;
        if (*stuck_here) break;
    }
    return QC_OK;
}

qc_status qc__integers_descend(qc__integers *q) {
    bool flipped = true, stuck_here = false;
    qc_status status = qc__integers_flip_all(q, &flipped);
    for (int32_t i = 0; i < FLIP_ROUNDS && status == QC_OK && (i == 0 || flipped); i++) {
        status = sweep_edges(q, &stuck_here);
        if (stuck_here) break;
        if (status == QC_OK) status = qc__integers_flip_all(q, &flipped);
    }
    return status;
}
