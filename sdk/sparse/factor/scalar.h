/* The scalar type of a source which is compiled twice: x.c as it is for complex numbers, x_real.c
 * (`#define QC__REAL` + `#include "x.c"`) for real ones. NC = doubles per entry. */
#ifndef QC_SPARSE_SCALAR_H
#define QC_SPARSE_SCALAR_H

#include "sdk/sparse/internal.h"

#ifdef __GNUC__
#define QC__PREFETCH(p) __builtin_prefetch(p)
#else
#define QC__PREFETCH(p) ((void)0)
#endif

#ifdef QC__REAL
#define NC      1
#define NAME(x) x##_real
typedef double scalar;
typedef qc_symmetric matrix;
#else
#define NC      2
#define NAME(x) x
typedef qc_complex scalar;
typedef qc_hermitian matrix;
#endif

#endif
