/* Flips towards the intrinsic Delaunay triangulation (Bobenko, Springborn 2007): keeps triangles
 * round, so that few flips bring a vertex down to degree three and integers have room. */
#include "sdk/map/quantize/decimate.h"

enum { MOST_FLIPS = 30 /* per edge */ };

/* Cotangent of the angle opposite to h. */
static double cotangent(const qc__triangulation *T, int32_t h) {
    const qc__point a = qc__turn_point(T->vector[qc_next(h)], 2), b = T->vector[qc_prev(h)];
    const double area = fabs(qc__area_of(a, b));
    return ((double)a.u * (double)b.u + (double)a.v * (double)b.v) / (area > 0 ? area : 1);
}

static bool wants_flip(const qc__triangulation *T, int32_t h) {
    const double a = cotangent(T, h), b = cotangent(T, T->twin[h]);
    return a + b < -1e-9 * (fabs(a) + fabs(b));
}

qc_status qc__flip_to_delaunay(qc__triangulation *T) {
    const int32_t n = 3 * T->n_triangles;
    int32_t *stack = QC__NEW(T->ctx, int32_t, n), size = 0;
    uint8_t *waits = QC__ZERO(T->ctx, uint8_t, n);
    int64_t budget = 0;
    if (!stack || !waits) {
        qc__free(stack);
        qc__free(waits);
        return QC_ERR_NOMEM;
    }
    for (int32_t h = n - 1; h >= 0; h--)
        if (!T->dead[h / 3] && T->twin[h] > h) {
            stack[size++] = h;
            waits[h] = 1;
            budget += MOST_FLIPS;
        }
    while (size > 0 && budget > 0) {
        const int32_t h = stack[--size];
        waits[h] = 0;
        if (T->twin[h] < 0 || !qc__can_flip(T, h, false) || !wants_flip(T, h)) continue;
        const int32_t g = T->twin[h];
        qc__flip(T, h);
        budget--;
        const int32_t edge[6] = {3 * (h / 3), 3 * (h / 3) + 1, 3 * (h / 3) + 2,
                                 3 * (g / 3), 3 * (g / 3) + 1, 3 * (g / 3) + 2};
        for (int i = 0; i < 6; i++)
            if (!waits[edge[i]]) {
                waits[edge[i]] = 1;
                stack[size++] = edge[i];
            }
    }
    qc__free(stack);
    qc__free(waits);
    return QC_OK;
}
