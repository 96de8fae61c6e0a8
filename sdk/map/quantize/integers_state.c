/* Energy, areas and windings of integer vectors (see integers.h). */
#include <math.h>
#include <stdlib.h>

#include "sdk/map/quantize/integers.h"

/* Cotangents tell how stiff an edge is; thin triangles about close points tell too much. */
static const double least_weight = 0.1, most_weight = 2;

static double wanted_dot(const qc__integers *q, int32_t a, int32_t b) {
    const double *p = q->wanted + 2 * (int64_t)a, *r = q->wanted + 2 * (int64_t)b;
    return p[0] * r[0] + p[1] * r[1];
}

static double wanted_cross(const qc__integers *q, int32_t a, int32_t b) {
    const double *p = q->wanted + 2 * (int64_t)a, *r = q->wanted + 2 * (int64_t)b;
    return p[0] * r[1] - p[1] * r[0];
}

/* Cotangent of the angle opposite to h. */
static double cotangent(const qc__integers *q, int32_t h) {
    const int32_t n = qc_next(h), p = qc_prev(h);
    return -wanted_dot(q, n, p) / wanted_cross(q, n, p);
}

static int32_t canonical(const qc__triangulation *c, int32_t h) {
    return c->twin[h] >= 0 && c->twin[h] < h ? c->twin[h] : h;
}

/* Axis directions in the sector of x at the start of h. */
static int32_t directions(const qc__triangulation *c, const qc__point *x, int32_t h) {
    const int32_t p = qc_prev(h);
    const qc__point back = {-x[p].u, -x[p].v};
    int32_t n = 0;
    for (int d = 0; d < 4; d++) n += qc__in_sector(x[h], back, c->twin[p] < 0, d);
    return n;
}

/* Where the boundary does not follow isolines its angles may change. */
static void expect_windings(qc__integers *q) {
    const qc__triangulation *c = &q->T;
    for (int32_t v = 0; v < q->n_origins; v++) q->expected[v] = 0;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++)
        q->expected[c->origin[h]] += directions(c, c->vector, h);
    for (int32_t h = 0; h < 3 * c->n_triangles; h++)
        if (c->twin[h] < 0 && c->axis[h] < 0)
            q->expected[c->origin[h]] = q->expected[c->origin[qc_next(h)]] = -1;
}

static void weigh(qc__integers *q, int32_t h) {
    const int32_t g = q->T.twin[h];
    const double w = 0.5 * (cotangent(q, h) + (g >= 0 ? cotangent(q, g) : 0));
    q->weight[h] = !(w > least_weight) ? least_weight : fmin(w, most_weight);
}

qc_status qc__integers_weigh(qc__integers *q) {
    const qc__triangulation *c = &q->T;
    for (int32_t h = 0; h < 3 * c->n_triangles; h += 3)
        if (!(wanted_cross(q, h, h + 1) > 0))
            return qc__fail(q->ctx, QC_ERR_FAILED, c->origin[h],
                            "the map before rounding folds over at vertex %d", (int)c->origin[h]);
    for (int32_t h = 0; h < 3 * c->n_triangles; h++) weigh(q, h);
    expect_windings(q);
    return QC_OK;
}

static double edge_energy(const qc__integers *q, int32_t h) {
    const double du = (double)q->x[h].u - q->wanted[2 * (int64_t)h];
    const double dv = (double)q->x[h].v - q->wanted[2 * (int64_t)h + 1];
    return q->weight[h] * (du * du + dv * dv);
}

double qc__integers_change(const qc__integers *q, int32_t h, int32_t k) {
    const qc__point d = qc__turn_point((qc__point){1, 0}, k);
    const double along = ((double)q->x[h].u - q->wanted[2 * (int64_t)h]) * (double)d.u +
                         ((double)q->x[h].v - q->wanted[2 * (int64_t)h + 1]) * (double)d.v;
    return q->weight[h] * (1 - 2 * along);
}

int64_t qc__integers_area(const qc__integers *q, int32_t t) {
    return qc__cross(q->x[3 * (int64_t)t], q->x[3 * (int64_t)t + 1]);
}

int64_t qc__integers_area_after(const qc__integers *q, int32_t a, int32_t b, int32_t k) {
    const qc__point d = qc__turn_point((qc__point){1, 0}, k);
    const qc__point p = qc__plus(q->x[a], d), r = qc__minus(q->x[b], d);
    return qc_next(a) == b ? qc__cross(p, r) : qc__cross(r, p);
}

/* --- what violates, by triangle --------------------------------------------------------------- */

static int64_t missing_area(const qc__integers *q, int32_t t) {
    const int64_t area = qc__integers_area(q, t);
    return area > 0 ? 0 : 1 - area;
}

static int64_t wrong_winding(const qc__integers *q, int32_t v) {
    return q->expected[v] < 0 ? 0 : abs(q->turns[v] - q->expected[v]);
}

/* Adds (sign 1) or takes away (sign -1) what triangle t contributes. */
static void count_triangle(qc__integers *q, int32_t t, int32_t sign) {
    const int64_t missing = missing_area(q, t);
    q->violation += sign * missing;
    for (int32_t h = 3 * t; h < 3 * t + 3 && missing == 0; h++) {
        const int32_t v = q->T.origin[h];
        q->violation -= wrong_winding(q, v);
        q->turns[v] += sign * directions(&q->T, q->x, h);
        q->violation += wrong_winding(q, v);
    }
}

void qc__integers_measure(qc__integers *q) {
    const qc__triangulation *c = &q->T;
    q->violation = 0;
    q->energy = 0;
    for (int32_t v = 0; v < q->n_origins; v++) q->turns[v] = 0;
    for (int32_t v = 0; v < q->n_origins; v++) q->violation += wrong_winding(q, v);
    for (int32_t t = 0; t < c->n_triangles; t++) count_triangle(q, t, 1);
    for (int32_t h = 0; h < 3 * c->n_triangles; h++)
        if (canonical(c, h) == h) q->energy += edge_energy(q, h);
}

static void aim_at(qc__integers *q, int32_t h) {
    q->wanted[2 * (int64_t)h] = q->scale * (double)q->T.vector[h].u;
    q->wanted[2 * (int64_t)h + 1] = q->scale * (double)q->T.vector[h].v;
}

void qc__integers_aim(qc__integers *q, double scale) {
    q->scale = ldexp(scale, -q->bits);
    for (int32_t h = 0; h < 3 * q->T.n_triangles; h++) aim_at(q, h);
}

void qc__integers_flip(qc__integers *q, int32_t h) {
    const int32_t pair[2] = {h / 3, q->T.twin[h] / 3};
    for (int i = 0; i < 2; i++) count_triangle(q, pair[i], -1);
    qc__flip(&q->T, h);
    for (int i = 0; i < 2; i++) {
        count_triangle(q, pair[i], 1);
        for (int32_t e = 3 * pair[i]; e < 3 * pair[i] + 3; e++) aim_at(q, e);
    }
    for (int i = 0; i < 2; i++)
        for (int32_t e = 3 * pair[i]; e < 3 * pair[i] + 3; e++) {
            weigh(q, e);
            if (q->T.twin[e] >= 0) weigh(q, q->T.twin[e]);
        }
}

static void add(qc__integers *q, qc__crossing step, int64_t times) {
    const qc__triangulation *c = &q->T;
    const int32_t h = step.halfedge, g = c->twin[h];
    const qc__point d = qc__turn_point((qc__point){times, 0}, step.k);
    const int32_t t = h / 3, s = g < 0 ? t : g / 3;
    q->energy -= edge_energy(q, h);
    count_triangle(q, t, -1);
    if (s != t) count_triangle(q, s, -1);
    q->x[h] = qc__minus(q->x[h], d);
    if (g >= 0) q->x[g] = qc__plus(q->x[g], qc__turn_point(d, c->rotation[h]));
    count_triangle(q, t, 1);
    if (s != t) count_triangle(q, s, 1);
    q->energy += edge_energy(q, h);
}

void qc__integers_apply(qc__integers *q, int64_t times) {
    for (int32_t i = 0; i < q->n_path; i++) add(q, q->path[i], times);
}
