/* Vectors of doubles for the kernels of this folder, which are compiled once per instruction set:
 * QC__ISA_AVX512 (8 lanes), QC__ISA_AVX2 (4 lanes), or neither (2 lanes, plain C). A complex number
 * takes two lanes: real, imaginary. */
#ifndef QC_SPARSE_VECTOR_H
#define QC_SPARSE_VECTOR_H

#include <math.h>
#include <stdint.h>

/* Small loops with constant bounds must vanish: what they run over has to stay in registers. */
#if defined(__GNUC__)
#define QC__INLINE static inline __attribute__((always_inline))
#define QC__UNROLL _Pragma("GCC unroll 16")
#else
#define QC__INLINE static inline
#define QC__UNROLL
#endif

#if defined(QC__ISA_AVX512)
#include "sdk/sparse/kernels/vector_avx512.h"
#elif defined(QC__ISA_AVX2)
#include "sdk/sparse/kernels/vector_avx2.h"
#else
#include "sdk/sparse/kernels/vector_portable.h"
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
static inline void v_prefetch_to_write(const double *p, int64_t offset) {
#if defined(__GNUC__)
    __builtin_prefetch((const void *)((uintptr_t)p + (uintptr_t)(offset * (int64_t)sizeof *p)), 1);
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
