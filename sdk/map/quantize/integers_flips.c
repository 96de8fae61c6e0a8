/* Flips of the complex during the search of its integer vectors (see integers.h). Any triangulation
 * which is positive in the real vectors and in the integer ones gives a homeomorphism, so that it
 * may follow the integers: triangles which are needles in them hinder every move across. */
#include "sdk/map/quantize/integers.h"

enum { MOST_FLIPS = 30 /* per edge */ };

static int64_t missing(int64_t area) {
    return area > 0 ? 0 : 1 - area;
}

/* Cotangent of the angle between two vectors which span a positive area. */
static double cotangent(qc__point a, qc__point b) {
    return (double)(a.u * b.u + a.v * b.v) / (double)qc__cross(a, b);
}

static bool wants_flip(const qc__integers *q, int32_t h) {
    if (!qc__can_flip(&q->T, h, false)) return false;
    const qc__flap f = qc__flap_at(&q->T, q->x, h);
    const int64_t left = qc__cross(f.q, f.r), right = qc__cross(f.w, f.q);
    const int64_t near = qc__cross(f.w, f.r);
    const int64_t far = qc__cross(qc__minus(f.q, f.w), qc__minus(f.r, f.q));
    const int64_t before = missing(left) + missing(right), after = missing(near) + missing(far);
    if (after != before || after > 0) return after < before;
    const double opposite = cotangent(qc__turn_point(f.r, 2), qc__minus(f.q, f.r)) +
                            cotangent(qc__minus(f.q, f.w), qc__turn_point(f.w, 2));
    return opposite < -1e-9;
}

static bool log_flip(qc__integers *q, int32_t h) {
    qc__flips *f = &q->flips;
    if (!qc__reserve(q->ctx, (void **)&f->halfedge, &f->capacity, f->n + 1, sizeof *f->halfedge))
        return false;
    f->halfedge[f->n++] = h;
    return true;
}

qc_status qc__integers_flip_all(qc__integers *q, bool *flipped) {
    const qc__triangulation *T = &q->T;
    const int32_t n = 3 * T->n_triangles;
    int32_t *stack = QC__NEW(q->ctx, int32_t, n), size = 0;
    uint8_t *waits = QC__ZERO(q->ctx, uint8_t, n);
    qc_status status = stack && waits ? QC_OK : QC_ERR_NOMEM;
    int64_t budget = 0;
    *flipped = false;
    for (int32_t h = n - 1; h >= 0 && status == QC_OK; h--)
        if (T->twin[h] > h) {
            stack[size++] = h;
            waits[h] = 1;
            budget += MOST_FLIPS;
        }
    while (size > 0 && budget > 0 && status == QC_OK) {
        const int32_t h = stack[--size], g = T->twin[h];
        waits[h] = 0;
        if (g < 0 || !wants_flip(q, h)) continue;
        if (!log_flip(q, h)) status = QC_ERR_NOMEM;
        qc__integers_flip(q, h);
        *flipped = true;
        budget--;
        for (int i = 0; i < 6; i++) {
            const int32_t e = 3 * ((i < 3 ? h : g) / 3) + i % 3;
            if (!waits[e]) stack[size++] = e;
            waits[e] = 1;
        }
    }
    qc__free(stack);
    qc__free(waits);
    if (*flipped) qc__integers_measure(q);
    return status;
}
