/* Eight lanes: AVX-512 F and DQ. Included by vector.h alone. */
#ifndef QC_SPARSE_VECTOR_AVX512_H
#define QC_SPARSE_VECTOR_AVX512_H

#include <immintrin.h>
#include <stdint.h>

enum { LANES = 8 };
typedef __m512d vec;
static inline vec v_zero(void) {
    return _mm512_setzero_pd();
}
static inline vec v_set(double x) {
    return _mm512_set1_pd(x);
}
static inline vec v_load(const double *p) {
    return _mm512_loadu_pd(p);
}
static inline void v_store(double *p, vec x) {
    _mm512_storeu_pd(p, x);
}
static inline __mmask8 v_mask(int64_t n) {
    return (__mmask8)((1u << n) - 1);
}
static inline vec v_load_part(const double *p, int64_t n) {
    return _mm512_maskz_loadu_pd(v_mask(n), p);
}
static inline void v_store_part(double *p, vec x, int64_t n) {
    _mm512_mask_storeu_pd(p, v_mask(n), x);
}
static inline vec v_add(vec a, vec b) {
    return _mm512_add_pd(a, b);
}
static inline vec v_mul(vec a, vec b) {
    return _mm512_mul_pd(a, b);
}
static inline vec v_fma(vec a, vec b, vec c) {
    return _mm512_fmadd_pd(a, b, c);
}
static inline vec v_fnma(vec a, vec b, vec c) {
    return _mm512_fnmadd_pd(a, b, c);
}
static inline vec v_swap(vec x) {
    return _mm512_permute_pd(x, 0x55);
}
static inline vec v_alternate(double x) {
    return _mm512_xor_pd(_mm512_set1_pd(x), _mm512_set_pd(0, -0.0, 0, -0.0, 0, -0.0, 0, -0.0));
}
static inline vec v_pair(const double *p) { /* p[0], p[1], p[0], p[1], ... */
    return _mm512_broadcast_f64x2(_mm_loadu_pd(p));
}
static inline vec v_flush(vec x, vec tiny) { /* |x| <= tiny becomes 0 */
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(_mm512_abs_pd(x), tiny, _CMP_NLE_UQ), x);
}
static inline vec v_join(vec first, vec rest, int64_t n) { /* n lanes of `first`, then `rest` */
    return _mm512_mask_mov_pd(rest, v_mask(n), first);
}
static inline vec v_spread(vec x, int lane) { /* one lane to all */
    return _mm512_permutexvar_pd(_mm512_set1_epi64(lane), x);
}
static inline vec v_times_i(vec x) {
    return _mm512_xor_pd(v_swap(x), _mm512_set_pd(0, -0.0, 0, -0.0, 0, -0.0, 0, -0.0));
}
static inline double v_first(vec x) {
    return _mm512_cvtsd_f64(x);
}
static inline double v_if_equal(double a, double b, double yes, double no) { /* without a jump */
    return _mm_cvtsd_f64(
        _mm_blendv_pd(_mm_set_sd(no), _mm_set_sd(yes), _mm_cmpeq_sd(_mm_set_sd(a), _mm_set_sd(b))));
}

/* out[0..3] = sums of the lanes of a, b, c, d */
static inline void v_sum_four(vec a, vec b, vec c, vec d, double *out) {
    const vec ab = _mm512_add_pd(_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
    const vec cd = _mm512_add_pd(_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
    const __m256d x = _mm256_add_pd(_mm512_castpd512_pd256(ab), _mm512_extractf64x4_pd(ab, 1));
    const __m256d y = _mm256_add_pd(_mm512_castpd512_pd256(cd), _mm512_extractf64x4_pd(cd, 1));
    _mm256_storeu_pd(
        out, _mm256_add_pd(_mm256_permute2f128_pd(x, y, 0x20), _mm256_permute2f128_pd(x, y, 0x31)));
}
static inline vec v_inverse_root(vec x) { /* x^{-1/2} */
    return _mm512_div_pd(_mm512_set1_pd(1), _mm512_sqrt_pd(x));
}
/* The pairs p[2 i[0]], p[2 i[1]], ... which fill a vector */
static inline vec v_gather_pairs(const double *p, const int32_t *i) {
    const __m256d lo =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p + 2 * (int64_t)i[0])),
                             _mm_loadu_pd(p + 2 * (int64_t)i[1]), 1);
    const __m256d hi =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p + 2 * (int64_t)i[2])),
                             _mm_loadu_pd(p + 2 * (int64_t)i[3]), 1);
    return _mm512_insertf64x4(_mm512_castpd256_pd512(lo), hi, 1);
}
/* lo = a0 b0 a2 b2 ..., hi = a1 b1 a3 b3 ...; applied to lo, hi it gives a, b */
static inline void v_interleave(vec a, vec b, vec *lo, vec *hi) {
    *lo = _mm512_unpacklo_pd(a, b);
    *hi = _mm512_unpackhi_pd(a, b);
}
/* Transposes LANES / 2 vectors of as many pairs. */
static inline void v_transpose_pairs(vec *x) {
    const vec a = _mm512_shuffle_f64x2(x[0], x[1], 0x44),
              b = _mm512_shuffle_f64x2(x[0], x[1], 0xee);
    const vec c = _mm512_shuffle_f64x2(x[2], x[3], 0x44),
              d = _mm512_shuffle_f64x2(x[2], x[3], 0xee);
    x[0] = _mm512_shuffle_f64x2(a, c, 0x88);
    x[1] = _mm512_shuffle_f64x2(a, c, 0xdd);
    x[2] = _mm512_shuffle_f64x2(b, d, 0x88);
    x[3] = _mm512_shuffle_f64x2(b, d, 0xdd);
}
static inline vec v_gather(const double *p, const int32_t *i) {
    return _mm512_set_pd(p[i[7]], p[i[6]], p[i[5]], p[i[4]], p[i[3]], p[i[2]], p[i[1]], p[i[0]]);
}

#endif
