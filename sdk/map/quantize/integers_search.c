/* Shortest paths of units through the triangles and their four directions (see integers.h). */
#include <math.h>

#include "sdk/map/quantize/integers.h"

/* Crossings which lower the energy count as this much, so that lengths are positive. */
static const double least_length = 0.01;

/* Length of the crossing of h by a unit i^k; infinite where it may not. */
static double length(const qc__integers *q, int32_t h, int32_t k) {
    if (!qc__may_cross(&q->T, h, k)) return INFINITY;
    return fmax(qc__integers_change(q, h, k), least_length);
}

/* Whether a unit i^k may pass from a to b: the triangle keeps a positive area, or gains. */
static bool may_pass(const qc__integers *q, int32_t a, int32_t b, int32_t k) {
    const int64_t after = qc__integers_area_after(q, a, b, k);
    return after > 0 || after > qc__integers_area(q, a / 3);
}

static void reach(qc__integers *q, int32_t state, int32_t parent, double distance) {
    if (!(distance < q->distance[state])) return;
    if (isinf(q->distance[state])) q->touched[q->n_touched++] = state;
    q->distance[state] = distance;
    q->parent[state] = parent;
    qc__heap_push(&q->heap, state);
}

static void forget(qc__integers *q) {
    while (q->heap.n > 0) qc__heap_pop(&q->heap);
    for (int32_t i = 0; i < q->n_touched; i++) q->distance[q->touched[i]] = INFINITY;
    q->n_touched = 0;
}

static bool is_inside_goal(const qc__integers *q, const qc__goal *goal, int32_t state) {
    const int32_t h = state / 4, k = state % 4;
    if (goal->defect) {
        const qc__point d = qc__turn_point((qc__point){1, 0}, k), have = goal->defect[h / 3];
        return d.u * have.u + d.v * have.v < 0;
    }
    return goal->loop >= 0 && h != goal->loop && h / 3 == goal->loop / 3 && k == goal->k &&
           (!goal->keep_areas || may_pass(q, h, goal->loop, k));
}

/* The steps on from a state. */
static void expand(qc__integers *q, int32_t state, const qc__goal *goal, qc__found *outside) {
    const qc__triangulation *c = &q->T;
    const int32_t h = state / 4, k = state % 4;
    const int32_t out[2] = {qc_next(h), qc_prev(h)};
    for (int32_t i = 0; i < 2; i++) {
        const int32_t b = out[i], g = c->twin[b];
        const double far = q->distance[state] + length(q, b, k);
        if (!(far < goal->limit) || (goal->keep_areas && !may_pass(q, h, b, k))) continue;
        if (g >= 0)
            reach(q, 4 * g + ((k + c->rotation[b]) & 3), state, far);
        else if (outside && far < outside->length)
            *outside = (qc__found){far, state, b};
    }
}

void qc__integers_search(qc__integers *q, const int32_t *seed, int32_t n, int32_t k,
                         const qc__goal *goal, qc__found *inside, qc__found *outside) {
    *inside = (qc__found){INFINITY, -1, -1};
    if (outside) *outside = *inside;
    forget(q);
    for (int32_t i = 0; i < n; i++) reach(q, 4 * seed[i] + (k & 3), -1, 0);
    while (q->heap.n > 0) {
        const int32_t state = qc__heap_pop(&q->heap);
        if (isinf(inside->length) && is_inside_goal(q, goal, state))
            *inside = (qc__found){q->distance[state], state, -1};
        const bool out_is_near = !outside || outside->length <= q->distance[state];
        const bool in_is_near = !isinf(inside->length);
        if (goal->defect ? in_is_near || (outside && out_is_near) : in_is_near && out_is_near)
            return;
        expand(q, state, goal, outside);
    }
}

bool qc__integers_cross(qc__integers *q, int32_t h, int32_t k) {
    if (!qc__reserve(q->ctx, (void **)&q->path, &q->path_capacity, q->n_path + 1, sizeof *q->path))
        return false;
    q->path[q->n_path++] = (qc__crossing){h, k & 3};
    return true;
}

bool qc__integers_append(qc__integers *q, const qc__found *found) {
    const qc__triangulation *c = &q->T;
    if (found->outlet >= 0 && !qc__integers_cross(q, found->outlet, found->state)) return false;
    for (int32_t s = found->state; q->parent[s] >= 0; s = q->parent[s])
        if (!qc__integers_cross(q, c->twin[s / 4], q->parent[s])) return false;
    return true;
}
