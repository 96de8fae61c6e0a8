/* Vectors of doubles for the kernels of this folder, which are compiled once per instruction set:
 * QC__ISA_AVX512 (8 lanes), QC__ISA_AVX2 (4 lanes), or neither (2 lanes, plain C). A complex number
 * takes two lanes: real, imaginary. */
#ifndef QC_SPARSE_VECTOR_H
#define QC_SPARSE_VECTOR_H

#include <math.h>
#include <stdint.h>

/* Small loops with constant bounds must vanish: what they run over has to stay in registers. */
#if defined(__GNUC__)
#define QC__INLINE            static inline __attribute__((always_inline))
#define QC__UNROLL            _Pragma("GCC unroll 16")
#define QC__FETCH(p)          __builtin_prefetch(p) /* may point anywhere */
#define QC__FETCH_TO_WRITE(p) __builtin_prefetch((p), 1)
#else
#define QC__FETCH(p)          ((void)(p))
#define QC__FETCH_TO_WRITE(p) ((void)(p))
#define QC__INLINE            static inline
#define QC__UNROLL
#endif

#if defined(QC__ISA_AVX512)
#include <immintrin.h>
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
static inline double v_sum(vec x) {
    return _mm512_reduce_add_pd(x);
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

#elif defined(QC__ISA_AVX2)
#include <immintrin.h>
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
static inline double v_sum(vec x) {
    const __m128d half = _mm_add_pd(_mm256_castpd256_pd128(x), _mm256_extractf128_pd(x, 1));
    return _mm_cvtsd_f64(_mm_add_sd(half, _mm_unpackhi_pd(half, half)));
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

#else
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

/* Asks for the cache line of p[offset], which may lie outside of any array. */
static inline void v_prefetch(const double *p, int64_t offset) {
#if defined(__GNUC__)
    __builtin_prefetch((const void *)((uintptr_t)p + (uintptr_t)(offset * (int64_t)sizeof *p)));
#else
    (void)p;
    (void)offset;
#endif
}

/* The same operations on single numbers, fused exactly where those on vectors are. */
static inline double s_fma(double x, double y, double z) {
#if defined(QC__ISA_AVX512) || defined(QC__ISA_AVX2)
    return fma(x, y, z);
#else
    return x * y + z;
#endif
}
static inline double s_fnma(double x, double y, double z) {
    return s_fma(-x, y, z);
}

#endif
