/* One number of a matrix or vector in a register, real or complex. Whoever stores entry by entry
 * and loads the same way is not held up by stores which are still under way. */
#ifndef QC_SPARSE_ENTRY_H
#define QC_SPARSE_ENTRY_H

#include "sdk/sparse/kernels/kernels.h"
#include "sdk/sparse/kernels/vector.h"

#ifdef QC__REAL
typedef double entry;
static inline entry e_load(const double *p) {
    return *p;
}
static inline void e_store(double *p, entry x) {
    *p = x;
}
static inline entry e_pair(const double *p, int stride) { /* p[0] + i p[stride] */
    (void)stride;
    return *p;
}
static inline entry e_add(entry x, entry y) {
    return x + y;
}
static inline entry e_scale_subtract(double s, entry x, entry y) { /* s x - y */
    return s_fma(s, x, -y);
}
static inline entry e_subtract(entry l, entry x, entry y) { /* y - l x */
    return s_fnma(x, l, y);
}
static inline entry e_subtract_conjugate(entry l, entry x, entry y) { /* y - conj(l) x */
    return s_fnma(l, x, y);
}
static inline double e_re(entry x) {
    return x;
}
static inline double e_im(entry x) {
    (void)x;
    return 0;
}

#elif defined(QC__ISA_AVX512) || defined(QC__ISA_AVX2)
typedef __m128d entry;
static inline entry e_load(const double *p) {
    return _mm_loadu_pd(p);
}
static inline void e_store(double *p, entry x) {
    _mm_storeu_pd(p, x);
}
static inline entry e_pair(const double *p, int stride) {
    return _mm_set_pd(p[stride], p[0]);
}
static inline entry e_add(entry x, entry y) {
    return _mm_add_pd(x, y);
}
static inline entry e_scale_subtract(double s, entry x, entry y) {
    return _mm_fmsub_pd(_mm_set1_pd(s), x, y);
}
static inline entry e_swap(entry x) {
    return _mm_permute_pd(x, 1);
}
/* Terms with the imaginary part of x come first, as in every kernel: all agree bit for bit. */
static inline entry e_subtract(entry l, entry x, entry y) {
    const entry im = _mm_xor_pd(_mm_permute_pd(x, 3), _mm_set_pd(0, -0.0));
    return _mm_fnmadd_pd(_mm_movedup_pd(x), l, _mm_fnmadd_pd(im, e_swap(l), y));
}
static inline entry e_subtract_conjugate(entry l, entry x, entry y) {
    const entry im = _mm_xor_pd(_mm_permute_pd(l, 3), _mm_set_pd(-0.0, 0));
    return _mm_fnmadd_pd(_mm_movedup_pd(l), x, _mm_fnmadd_pd(im, e_swap(x), y));
}
static inline double e_re(entry x) {
    return _mm_cvtsd_f64(x);
}
static inline double e_im(entry x) {
    return _mm_cvtsd_f64(_mm_permute_pd(x, 3));
}

#else
typedef struct entry {
    double re, im;
} entry;
static inline entry e_load(const double *p) {
    return (entry){p[0], p[1]};
}
static inline void e_store(double *p, entry x) {
    p[0] = x.re;
    p[1] = x.im;
}
static inline entry e_pair(const double *p, int stride) {
    return (entry){p[0], p[stride]};
}
static inline entry e_add(entry x, entry y) {
    return (entry){x.re + y.re, x.im + y.im};
}
static inline entry e_scale_subtract(double s, entry x, entry y) {
    return (entry){s * x.re - y.re, s * x.im - y.im};
}
static inline entry e_subtract(entry l, entry x, entry y) {
    return (entry){y.re + x.im * l.im - x.re * l.re, y.im - x.im * l.re - x.re * l.im};
}
static inline entry e_subtract_conjugate(entry l, entry x, entry y) {
    return (entry){y.re - l.im * x.im - l.re * x.re, y.im + l.im * x.re - l.re * x.im};
}
static inline double e_re(entry x) {
    return x.re;
}
static inline double e_im(entry x) {
    return x.im;
}
#endif

#endif
