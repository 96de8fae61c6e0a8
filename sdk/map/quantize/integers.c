/* Integer vectors of a coarse complex which span only positive areas (docs/theory/quantization.md;
 * after Coudert-Osmont, Desobry, Heistermann, Bommes, Ray, Sokolov 2024).
 *
 * Closed vectors are found at the wanted scale, or, where they cannot be made feasible there, at a
 * finer one. From the feasible side the search then walks back towards the wanted scale, along
 * closed paths which lower the energy sum w |x - wanted|^2 and keep every area positive. */
#include <math.h>
#include <string.h>

#include "sdk/map/quantize/integers.h"

enum {
    MOST_REFINEMENTS = 40, /* by sqrt(2): 2^20 */
    DENSITY_ROUNDS = 8,
    SCANS = 10,
    PATIENCE = 2 /* sweeps */
};
static const double stuck = 0.9;                        /* of the violation, left by a sweep */
static const double good_miss = 0.02, fair_miss = 0.05; /* of the number of quads */
static const double scan_step = 0.02;                   /* of the scale */
/* Of a path which mends a violation; of others it is what they gain. */
static const double mending_limit = 50;

/* --- one move --------------------------------------------------------------------------------- */

static bool is_violated(const qc__integers *q, int32_t h) {
    const int32_t g = q->coarse->twin[h];
    if (q->violation == 0) return false;
    if (qc__integers_area(q, h / 3) <= 0 || (g >= 0 && qc__integers_area(q, g / 3) <= 0))
        return true;
    const int32_t a = q->coarse->origin[h], b = q->coarse->origin[qc_next(h)];
    return (q->expected[a] >= 0 && q->turns[a] != q->expected[a]) ||
           (q->expected[b] >= 0 && q->turns[b] != q->expected[b]);
}

/* The cheapest closed path which crosses h with a unit i^k, or path between boundaries, becomes
 * q->path. *found: whether there is one below the limit. */
static qc_status find_path(qc__integers *q, int32_t h, int32_t k, double limit, bool *found) {
    const qc__coarse *c = q->coarse;
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
        if (!qc__may_cross(q->coarse, h, k)) continue;
        const double gain = -qc__integers_change(q, h, k);
        const double limit = is_violated(q, h) ? mending_limit : gain;
        if (!(limit > 0)) continue;
        bool found;
        const qc_status status = find_path(q, h, k, limit, &found);
        if (status != QC_OK) return status;
        if (found && improve(q)) *improved = true;
    }
    return QC_OK;
}

/* Moves until none helps, or until a sweep over the edges mends next to nothing of what is
 * violated: then a finer scale is the better way. */
static qc_status descend(qc__integers *q) {
    const qc__coarse *c = q->coarse;
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
        if (sweep >= PATIENCE && (double)q->violation > stuck * (double)before) break;
    }
    return QC_OK;
}

/* --- scales ----------------------------------------------------------------------------------- */

static double finer(double scale, int32_t times) {
    return scale * pow(2, 0.5 * times);
}

/* Feasible vectors at the first scale where the moves find some; *times counts the refinements. */
static qc_status find_feasible(qc__integers *q, double scale, int32_t *times) {
    for (*times = 0; *times <= MOST_REFINEMENTS; ++*times) {
        bool closed;
        qc__integers_aim(q, finer(scale, *times));
        qc_status status = qc__integers_start(q, &closed);
        if (status != QC_OK) return status;
        if (!closed) continue;
        qc__integers_measure(q);
        status = descend(q);
        if (status != QC_OK || q->violation == 0) return status;
    }
    return qc__fail(q->ctx, QC_ERR_FAILED, -1,
                    "no integers keep the %d triangles between singularities and features "
                    "positive",
                    (int)q->coarse->n_triangles);
}

/* Unit squares which the vectors span: quads. */
static double count_quads(const qc__integers *q) {
    double area = 0;
    for (int32_t t = 0; t < q->coarse->n_triangles; t++)
        area += 0.5 * (double)qc__integers_area(q, t);
    return area;
}

static qc_status move_towards(qc__integers *q, double scale) {
    qc__integers_aim(q, scale);
    qc__integers_measure(q);
    return descend(q);
}

/* How far the number of quads is off. */
static double miss(const qc__integers *q, double quads) {
    return fabs(log(count_quads(q) / quads));
}

/* q->best becomes x where that is nearer to the number of quads. */
static void keep_best(qc__integers *q, double quads, double *best) {
    const double here = miss(q, quads);
    if (q->violation > 0 || here >= *best) return;
    memcpy(q->best, q->x, sizeof *q->x * 3 * (size_t)q->coarse->n_triangles);
    *best = here;
}

/* Where few vectors jump together, from a scale to the next: starts anew at scales about this one.
 */
static qc_status scan_scales(qc__integers *q, double scale, double quads, double *best) {
    for (int32_t k = 0; k<SCANS && * best> fair_miss; k++) {
        bool closed;
        qc__integers_aim(q, scale * (1 + scan_step * (k / 2 + 1) * (k % 2 ? -1 : 1)));
        qc_status status = qc__integers_start(q, &closed);
        if (status != QC_OK) return status;
        if (!closed) continue;
        qc__integers_measure(q);
        status = descend(q);
        if (status != QC_OK) return status;
        keep_best(q, quads, best);
    }
    return QC_OK;
}

/* Changes the scale until the number of quads is right; scan: as well as may be. */
static qc_status meet_quads(qc__integers *q, double scale, double quads, bool scan) {
    double best = INFINITY, at = scale;
    keep_best(q, quads, &best);
    for (int32_t i = 0; i < DENSITY_ROUNDS && best > good_miss; i++) {
        at *= fmin(fmax(sqrt(quads / count_quads(q)), 0.5), 2);
        const qc_status status = move_towards(q, at);
        if (status != QC_OK) return status;
        keep_best(q, quads, &best);
    }
    const qc_status status = scan ? scan_scales(q, scale, quads, &best) : QC_OK;
    memcpy(q->x, q->best, sizeof *q->x * 3 * (size_t)q->coarse->n_triangles);
    return status;
}

static qc_status search(qc__integers *q, double scale, double quads) {
    int32_t times;
    qc__integers_aim(q, scale);
    qc_status status = qc__integers_weigh(q);
    if (status == QC_OK) status = find_feasible(q, scale, &times);
    if (status != QC_OK) return status;
    const bool at_once = times == 0; /* the wanted scale is not too coarse */
    while (status == QC_OK && times-- > 0) status = move_towards(q, finer(scale, times));
    return status == QC_OK && quads > 0 ? meet_quads(q, scale, quads, at_once) : status;
}

static qc_status allocate(qc__integers *q) {
    const qc__coarse *c = q->coarse;
    const int32_t n = 3 * c->n_triangles;
    for (int32_t h = 0; h < n; h++) {
        if (c->origin[h] >= q->n_origins) q->n_origins = c->origin[h] + 1;
        q->has_boundary |= c->twin[h] < 0;
    }
    q->best = QC__NEW(q->ctx, qc__point, n);
    q->wanted = QC__NEW(q->ctx, double, 2 * (int64_t)n);
    q->weight = QC__NEW(q->ctx, double, n);
    q->turns = QC__ZERO(q->ctx, int32_t, q->n_origins);
    q->expected = QC__NEW(q->ctx, int32_t, q->n_origins);
    q->distance = QC__NEW(q->ctx, double, 4 * (int64_t)n);
    q->parent = QC__NEW(q->ctx, int32_t, 4 * (int64_t)n);
    q->touched = QC__NEW(q->ctx, int32_t, 4 * (int64_t)n);
    if (!q->best || !q->wanted || !q->weight || !q->turns || !q->expected || !q->distance ||
        !q->parent || !q->touched)
        return QC_ERR_NOMEM;
    for (int32_t s = 0; s < 4 * n; s++) q->distance[s] = INFINITY;
    return qc__heap_create(q->ctx, 4 * n, q->distance, &q->heap);
}

qc_status qc__coarse_integers(qc_ctx *ctx, const qc__coarse *coarse, double scale, double quads,
                              qc__point *x, double *made) {
    qc__integers q = {.ctx = ctx, .coarse = coarse};
    q.x = QC__NEW(ctx, qc__point, 3 * (int64_t)coarse->n_triangles);
    qc_status status = q.x ? allocate(&q) : QC_ERR_NOMEM;
    if (status == QC_OK) status = search(&q, scale, quads);
    for (int32_t h = 0; h < 3 * coarse->n_triangles && status == QC_OK; h++) x[h] = q.x[h];
    if (status == QC_OK) *made = count_quads(&q);
    qc__heap_free(&q.heap);
    void *const blocks[] = {q.x,        q.best,     q.wanted, q.weight,  q.turns,
                            q.expected, q.distance, q.parent, q.touched, q.path};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
