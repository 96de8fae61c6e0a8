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
    SCANS = 10
};
static const double good_miss = 0.02, fair_miss = 0.05; /* of the number of quads */
static const double scan_step = 0.02;                   /* of the scale */
static const double promising = 0.2; /* violation a triangle from which moves are tried */
/* Paths may raise the energy by so many times what their first crossing gains: what they gain
 * farther on tells. */
static const double near_reach = 1, far_reach = 4;

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
        if ((double)q->violation > promising * q->T.n_triangles) continue;
        status = qc__integers_descend(q);
        if (status != QC_OK || q->violation == 0) return status;
    }
    return qc__fail(q->ctx, QC_ERR_FAILED, -1,
                    "no integers keep the %d triangles between singularities and features "
                    "positive",
                    (int)q->T.n_triangles);
}

/* Unit squares which the vectors span: quads. */
static double count_quads(const qc__integers *q) {
    double area = 0;
    for (int32_t t = 0; t < q->T.n_triangles; t++) area += 0.5 * (double)qc__integers_area(q, t);
    return area;
}

static qc_status move_towards(qc__integers *q, double scale) {
    qc__integers_aim(q, scale);
    qc__integers_measure(q);
    return qc__integers_descend(q);
}

/* --- the best so far -------------------------------------------------------------------------- */

static void copy(const qc__triangulation *from, qc__triangulation *to) {
    const size_t n = 3 * (size_t)from->n_triangles;
    memcpy(to->vector, from->vector, sizeof *to->vector * n);
    memcpy(to->image, from->image, sizeof *to->image * n);
    memcpy(to->twin, from->twin, sizeof *to->twin * n);
    memcpy(to->origin, from->origin, sizeof *to->origin * n);
    memcpy(to->rotation, from->rotation, n);
    memcpy(to->axis, from->axis, n);
}

static void save(qc__integers *q) {
    copy(&q->T, &q->best);
    q->best_flips = q->flips.n;
}

static void restore(qc__integers *q) {
    copy(&q->best, &q->T);
    q->flips.n = q->best_flips;
}

/* How far the number of quads is off. */
static double miss(const qc__integers *q, double quads) {
    return fabs(log(count_quads(q) / quads));
}

/* q->best becomes x where that is nearer to the number of quads. */
static void keep_best(qc__integers *q, double quads, double *best) {
    const double here = miss(q, quads);
    if (q->violation > 0 || here >= *best) return;
    save(q);
    *best = here;
}

/* Where few vectors jump together, from a scale to the next: starts anew at scales about this one.
 */
static qc_status scan_scales(qc__integers *q, double scale, double quads, double *best) {
    for (int32_t k = 0; k < SCANS && fair_miss < *best; k++) {
        bool closed;
        qc__integers_aim(q, scale * (1 + scan_step * (k / 2 + 1) * (k % 2 ? -1 : 1)));
        qc_status status = qc__integers_start(q, &closed);
        if (status != QC_OK) return status;
        if (!closed) continue;
        qc__integers_measure(q);
        status = qc__integers_descend(q);
        if (status != QC_OK) return status;
        keep_best(q, quads, best);
    }
    return QC_OK;
}

/* Changes the scale until the number of quads is right; scan: as well as may be. */
static qc_status meet_quads(qc__integers *q, double scale, double quads, bool scan) {
    double best = INFINITY, at = scale;
    keep_best(q, quads, &best);
    q->reach = far_reach;
    for (int32_t i = 0; i < DENSITY_ROUNDS && best > good_miss; i++) {
        at *= fmin(fmax(sqrt(quads / count_quads(q)), 0.5), 2);
        const qc_status status = move_towards(q, at);
        if (status != QC_OK) return status;
        keep_best(q, quads, &best);
    }
    const qc_status status = scan ? scan_scales(q, scale, quads, &best) : QC_OK;
    restore(q);
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

/* Room for the complex and its integer vectors. */
static bool allocate_triangulation(qc_ctx *ctx, int32_t n_triangles, int32_t n_origins,
                                   qc__triangulation *T) {
    const int64_t n = 3 * (int64_t)n_triangles;
    T->n_triangles = n_triangles;
    T->vector = QC__NEW(ctx, qc__point, n);
    T->image = QC__ZERO(ctx, qc__point, n);
    T->twin = QC__NEW(ctx, int32_t, n);
    T->origin = QC__NEW(ctx, int32_t, n);
    T->rotation = QC__NEW(ctx, int8_t, n);
    T->axis = QC__NEW(ctx, int8_t, n);
    T->spoke = QC__ZERO(ctx, int32_t, n_origins);
    T->first_marker = QC__NEW(ctx, int32_t, n_triangles);
    if (!T->vector || !T->image || !T->twin || !T->origin || !T->rotation || !T->axis ||
        !T->spoke || !T->first_marker)
        return false;
    for (int32_t t = 0; t < n_triangles; t++) T->first_marker[t] = -1;
    return true;
}

static qc_status allocate(qc__integers *q, const qc__coarse *c) {
    const int32_t n = 3 * c->n_triangles;
    q->n_origins = qc__coarse_origins(c);
    for (int32_t h = 0; h < n; h++) q->has_boundary |= c->twin[h] < 0;
    q->wanted = QC__NEW(q->ctx, double, 2 * (int64_t)n);
    q->weight = QC__NEW(q->ctx, double, n);
    q->turns = QC__ZERO(q->ctx, int32_t, q->n_origins);
    q->expected = QC__NEW(q->ctx, int32_t, q->n_origins);
    q->distance = QC__NEW(q->ctx, double, 4 * (int64_t)n);
    q->parent = QC__NEW(q->ctx, int32_t, 4 * (int64_t)n);
    q->touched = QC__NEW(q->ctx, int32_t, 4 * (int64_t)n);
    if (!allocate_triangulation(q->ctx, c->n_triangles, q->n_origins, &q->T) ||
        !allocate_triangulation(q->ctx, c->n_triangles, q->n_origins, &q->best) || !q->wanted ||
        !q->weight || !q->turns || !q->expected || !q->distance || !q->parent || !q->touched)
        return QC_ERR_NOMEM;
    q->x = q->T.image;
    for (int32_t s = 0; s < 4 * n; s++) q->distance[s] = INFINITY;
    const qc__triangulation given = {.n_triangles = c->n_triangles,
                                     .vector = c->vector,
                                     .image = q->x,
                                     .twin = c->twin,
                                     .origin = c->origin,
                                     .rotation = c->rotation,
                                     .axis = c->axis};
    copy(&given, &q->T);
    return qc__heap_create(q->ctx, 4 * n, q->distance, &q->heap);
}

qc_status qc__coarse_integers(qc_ctx *ctx, const qc__coarse *coarse, double scale, double quads,
                              qc__point *x, double *made, qc__flips *flips) {
    qc__integers q = {.ctx = ctx, .bits = coarse->bits, .reach = near_reach};
    qc_status status = allocate(&q, coarse);
    if (status == QC_OK) status = search(&q, scale, quads);
    for (int32_t h = 0; h < 3 * coarse->n_triangles && status == QC_OK; h++) x[h] = q.x[h];
    if (status == QC_OK) {
        *made = count_quads(&q);
        *flips = q.flips;
        q.flips.halfedge = NULL;
    }
    qc__heap_free(&q.heap);
    qc__triangulation_clear(&q.T);
    qc__triangulation_clear(&q.best);
    void *const blocks[] = {q.wanted, q.weight,  q.turns, q.expected,      q.distance,
                            q.parent, q.touched, q.path,  q.flips.halfedge};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
