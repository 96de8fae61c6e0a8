/* Four lanes: AVX2 and FMA. Included by vector.h alone; remarks are in vector_avx512.h. */
#ifndef QC_SPARSE_VECTOR_AVX2_H
#define QC_SPARSE_VECTOR_AVX2_H

#include <immintrin.h>
#include <stdint.h>

enum { LANES = 4 };
typedef __m256d vec;
static inline vec v_zero(void) {
    return _mm256_setzero_pd();
}
static inline vec v_set(double x) {
    return _mm256_set1_pd(x);
}
static inline vec v_load(const double *p) {
    return _mm256_loadu_pd(p);
}
static inline void v_store(double *p, vec x) {
    _mm256_storeu_pd(p, x);
}
static inline __m256i v_mask(int64_t n) {
    return _mm256_cmpgt_epi64(_mm256_set1_epi64x(n), _mm256_set_epi64x(3, 2, 1, 0));
}
static inline vec v_load_part(const double *p, int64_t n) {
    return _mm256_maskload_pd(p, v_mask(n));
}
static inline void v_store_part(double *p, vec x, int64_t n) {
    _mm256_maskstore_pd(p, v_mask(n), x);
}
static inline vec v_add(vec a, vec b) {
    return _mm256_add_pd(a, b);
}
static inline vec v_mul(vec a, vec b) {
    return _mm256_mul_pd(a, b);
}
static inline vec v_fma(vec a, vec b, vec c) {
    return _mm256_fmadd_pd(a, b, c);
}
static inline vec v_fnma(vec a, vec b, vec c) {
    return _mm256_fnmadd_pd(a, b, c);
}
static inline vec v_swap(vec x) {
    return _mm256_permute_pd(x, 0x5);
}
static inline vec v_alternate(double x) {
    return _mm256_xor_pd(_mm256_set1_pd(x), _mm256_set_pd(0, -0.0, 0, -0.0));
}
static inline vec v_pair(const double *p) {
    return _mm256_broadcast_pd((const __m128d *)(const void *)p);
}
static inline vec v_flush(vec x, vec tiny) {
    const vec size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
    return _mm256_and_pd(_mm256_cmp_pd(size, tiny, _CMP_NLE_UQ), x);
}
static inline vec v_join(vec first, vec rest, int64_t n) {
    return _mm256_blendv_pd(rest, first, _mm256_castsi256_pd(v_mask(n)));
}
static inline vec v_spread(vec x, int lane) {
    const __m256i index =
        _mm256_add_epi32(_mm256_set1_epi32(2 * lane), _mm256_set_epi32(1, 0, 1, 0, 1, 0, 1, 0));
    return _mm256_castsi256_pd(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(x), index));
}
static inline vec v_times_i(vec x) {
    return _mm256_xor_pd(v_swap(x), _mm256_set_pd(0, -0.0, 0, -0.0));
}
static inline double v_first(vec x) {
    return _mm256_cvtsd_f64(x);
}
static inline double v_if_equal(double a, double b, double yes, double no) {
    return _mm_cvtsd_f64(
        _mm_blendv_pd(_mm_set_sd(no), _mm_set_sd(yes), _mm_cmpeq_sd(_mm_set_sd(a), _mm_set_sd(b))));
}

static inline void v_sum_four(vec a, vec b, vec c, vec d, double *out) {
    const vec ab = _mm256_hadd_pd(a, b), cd = _mm256_hadd_pd(c, d);
    _mm256_storeu_pd(out, _mm256_add_pd(_mm256_permute2f128_pd(ab, cd, 0x20),
                                        _mm256_permute2f128_pd(ab, cd, 0x31)));
}
static inline vec v_inverse_root(vec x) {
    return _mm256_div_pd(_mm256_set1_pd(1), _mm256_sqrt_pd(x));
}
static inline vec v_gather_pairs(const double *p, const int32_t *i) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p + 2 * (int64_t)i[0])),
                                _mm_loadu_pd(p + 2 * (int64_t)i[1]), 1);
}
static inline void v_interleave(vec a, vec b, vec *lo, vec *hi) {
    *lo = _mm256_unpacklo_pd(a, b);
    *hi = _mm256_unpackhi_pd(a, b);
}
static inline void v_transpose_pairs(vec *x) {
    const vec a = x[0], b = x[1];
    x[0] = _mm256_permute2f128_pd(a, b, 0x20);
    x[1] = _mm256_permute2f128_pd(a, b, 0x31);
}
static inline vec v_gather(const double *p, const int32_t *i) {
    return _mm256_set_pd(p[i[3]], p[i[2]], p[i[1]], p[i[0]]);
}

#endif
