/* Walking straight through the coarse complex (see walk.h). */
#include "sdk/map/quantize/walk.h"

static qc__point across(qc__point p, qc__point from, int r, qc__point to) {
    return qc__plus(qc__turn_point(qc__minus(p, from), r), to);
}

void qc__cursor_cross(qc__cursor *k, int32_t h) {
    const int32_t g = k->coarse->twin[h], entry = qc_next(g); /* starts where h does */
    const int r = k->coarse->rotation[h];
    k->shift = across(k->shift, qc__corner_place(k->coarse->vector, h), r,
                      qc__corner_place(k->coarse->vector, entry));
    k->integer_shift =
        across(k->integer_shift, qc__corner_place(k->x, h), r, qc__corner_place(k->x, entry));
    k->turn = (k->turn + r) & 3;
    k->triangle = g / 3;
}

void qc__cursor_face(qc__cursor *k, qc__point z, qc__point d) {
    const qc__point p = qc__cursor_place(k, z), ahead = qc__turn_point(d, k->turn);
    for (int32_t h = 3 * k->triangle; h < 3 * k->triangle + 3; h++) {
        const qc__point e = k->coarse->vector[h];
        if (qc__area_sign(e, qc__minus(p, qc__corner_place(k->coarse->vector, h))) != 0) continue;
        const int side = qc__area_sign(e, ahead);
        if (side > 0 || (side == 0 && qc__dot_sign(e, ahead) > 0)) continue;
        qc__cursor_cross(k, h);
        return;
    }
}

/* The line enters where vertices change from left to right and leaves where they change from right
 * to left; those on it count as right. */
int32_t qc__cursor_exit(const qc__cursor *k, qc__point a, qc__point b) {
    const qc__point from = qc__cursor_place(k, a), to = qc__cursor_place(k, b);
    const qc__point d = qc__minus(to, from);
    const qc__point *vector = k->coarse->vector;
    for (int32_t h = 3 * k->triangle; h < 3 * k->triangle + 3; h++) {
        const qc__point p = qc__corner_place(vector, h), q = qc__corner_place(vector, qc_next(h));
        if (qc__area_sign(d, qc__minus(p, from)) > 0 || qc__area_sign(d, qc__minus(q, from)) <= 0)
            continue;
        return qc__area_sign(vector[h], qc__minus(to, p)) < 0 ? h : -1;
    }
    return -1;
}

int32_t qc__cursor_turn(const qc__cursor *k, qc__point a, qc__point d) {
    const qc__point p = qc__cursor_place(k, a), end = qc__turn_point(d, k->turn);
    const qc__point *vector = k->coarse->vector;
    for (int32_t h = 3 * k->triangle; h < 3 * k->triangle + 3; h++) {
        const qc__point e = vector[h], before = qc__minus(p, qc__corner_place(vector, h));
        if (qc__area_sign(e, before) != 0 || qc__dot_sign(e, before) < 0) continue;
        if (qc__dot_sign(e, qc__minus(before, e)) >= 0) continue;
        return qc__area_sign(end, e) > 0 ? h : -1;
    }
    return -1;
}

/* From the integer chart of the triangle to that of the start. */
static void back(const qc__cursor *k, double u, double v, double uv[2]) {
    const qc_complex z = {u - (double)k->integer_shift.u, v - (double)k->integer_shift.v};
    const qc_complex w = qc_quarter_turn(z, -k->turn);
    uv[0] = w.re;
    uv[1] = w.im;
}

void qc__cursor_on_edge(const qc__cursor *k, int32_t h, double share, double uv[2]) {
    const qc__point p = qc__corner_place(k->x, h), e = k->x[h];
    back(k, (double)p.u + share * (double)e.u, (double)p.v + share * (double)e.v, uv);
}

void qc__cursor_value(const qc__cursor *k, qc__point z, double uv[2]) {
    const int32_t h = 3 * k->triangle;
    const qc__point p = qc__cursor_place(k, z);
    const qc__point e = k->coarse->vector[h], f = qc__corner_place(k->coarse->vector, h + 2);
    const qc__point xe = k->x[h], xf = qc__corner_place(k->x, h + 2);
    const double area = qc__area_of(e, f);
    const double a = qc__area_of(p, f) / area, b = qc__area_of(e, p) / area;
    back(k, a * (double)xe.u + b * (double)xf.u, a * (double)xe.v + b * (double)xf.v, uv);
}
