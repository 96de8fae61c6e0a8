/* Two lanes in plain C. Included by vector.h alone; remarks are in vector_avx512.h. */
#ifndef QC_SPARSE_VECTOR_PORTABLE_H
#define QC_SPARSE_VECTOR_PORTABLE_H

#include <math.h>
#include <stdint.h>

enum { LANES = 2 };
typedef struct vec {
    double a, b;
} vec;
static inline vec v_zero(void) {
    return (vec){0, 0};
}
static inline vec v_set(double x) {
    return (vec){x, x};
}
static inline vec v_load(const double *p) {
    return (vec){p[0], p[1]};
}
static inline void v_store(double *p, vec x) {
    p[0] = x.a;
    p[1] = x.b;
}
static inline vec v_load_part(const double *p, int64_t n) {
    return (vec){n > 0 ? p[0] : 0, n > 1 ? p[1] : 0};
}
static inline void v_store_part(double *p, vec x, int64_t n) {
    if (n > 0) p[0] = x.a;
    if (n > 1) p[1] = x.b;
}
static inline vec v_add(vec x, vec y) {
    return (vec){x.a + y.a, x.b + y.b};
}
static inline vec v_mul(vec x, vec y) {
    return (vec){x.a * y.a, x.b * y.b};
}
static inline vec v_fma(vec x, vec y, vec z) {
    return (vec){x.a * y.a + z.a, x.b * y.b + z.b};
}
static inline vec v_fnma(vec x, vec y, vec z) {
    return (vec){z.a - x.a * y.a, z.b - x.b * y.b};
}
static inline vec v_swap(vec x) {
    return (vec){x.b, x.a};
}
static inline vec v_alternate(double x) {
    return (vec){-x, x};
}
static inline vec v_pair(const double *p) {
    return (vec){p[0], p[1]};
}
static inline vec v_flush(vec x, vec tiny) {
    return (vec){fabs(x.a) <= tiny.a ? 0 : x.a, fabs(x.b) <= tiny.b ? 0 : x.b};
}
static inline vec v_join(vec first, vec rest, int64_t n) {
    return (vec){n > 0 ? first.a : rest.a, n > 1 ? first.b : rest.b};
}
static inline vec v_spread(vec x, int lane) {
    return v_set(lane == 0 ? x.a : x.b);
}
static inline vec v_times_i(vec x) {
    return (vec){-x.b, x.a};
}
static inline double v_first(vec x) {
    return x.a;
}
static inline double v_if_equal(double a, double b, double yes, double no) {
    return a == b ? yes : no;
}
static inline double v_sum(vec x) {
    return x.a + x.b;
}
static inline void v_sum_four(vec a, vec b, vec c, vec d, double *out) {
    out[0] = v_sum(a);
    out[1] = v_sum(b);
    out[2] = v_sum(c);
    out[3] = v_sum(d);
}
static inline vec v_inverse_root(vec x) {
    return (vec){1 / sqrt(x.a), 1 / sqrt(x.b)};
}
static inline vec v_gather_pairs(const double *p, const int32_t *i) {
    return v_load(p + 2 * (int64_t)i[0]);
}
static inline void v_interleave(vec a, vec b, vec *lo, vec *hi) {
    *lo = (vec){a.a, b.a};
    *hi = (vec){a.b, b.b};
}
static inline void v_transpose_pairs(vec *x) {
    (void)x;
}
static inline vec v_gather(const double *p, const int32_t *i) {
    return (vec){p[i[0]], p[i[1]]};
}

#endif
