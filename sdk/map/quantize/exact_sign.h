/* Exact signs of 2 x 2 determinants of 64-bit integers. Internal to sdk/map/quantize. */
#ifndef QC_MAP_QUANTIZE_EXACT_SIGN_H
#define QC_MAP_QUANTIZE_EXACT_SIGN_H

#include <math.h>

#include "sdk/map/grid/internal.h"

/* a b as 2^64 high + low, by halves of 32 bits. */
typedef struct qc__product {
    int64_t high;
    uint64_t low;
} qc__product;

static inline qc__product qc__multiply(int64_t a, int64_t b) {
    const uint64_t half = 0xffffffffu;
    const uint64_t p = a < 0 ? 0 - (uint64_t)a : (uint64_t)a;
    const uint64_t q = b < 0 ? 0 - (uint64_t)b : (uint64_t)b;
    const uint64_t ll = (p & half) * (q & half), lh = (p & half) * (q >> 32);
    const uint64_t hl = (p >> 32) * (q & half), hh = (p >> 32) * (q >> 32);
    const uint64_t middle = (ll >> 32) + (lh & half) + (hl & half);
    qc__product r = {(int64_t)(hh + (lh >> 32) + (hl >> 32) + (middle >> 32)),
                     (ll & half) | middle << 32};
    if ((a < 0) != (b < 0)) {
        r.low = 0 - r.low;
        r.high = -r.high - (r.low != 0);
    }
    return r;
}

/* The area spanned by two vectors, rounded. */
static inline double qc__area_of(qc__point a, qc__point b) {
    return (double)a.u * (double)b.v - (double)a.v * (double)b.u;
}

/* Sign of the area spanned by two vectors, components below 2^62. Six roundings of the products and
 * one of their difference are below 2^-50 of the sum of the former. */
static inline int qc__area_sign(qc__point a, qc__point b) {
    const double x = (double)a.u * (double)b.v, y = (double)a.v * (double)b.u;
    if (fabs(x - y) > 8.9e-16 * (fabs(x) + fabs(y))) return x > y ? 1 : -1;
    const qc__product p = qc__multiply(a.u, b.v), q = qc__multiply(a.v, b.u);
    if (p.high != q.high) return p.high > q.high ? 1 : -1;
    return p.low == q.low ? 0 : p.low > q.low ? 1 : -1;
}

/* Sign of the scalar product. */
static inline int qc__dot_sign(qc__point a, qc__point b) {
    return qc__area_sign(a, qc__turn_point(b, 1));
}

#endif
