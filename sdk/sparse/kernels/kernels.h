/* The inner loops of the factorisation, of updates and of solves, behind one table of functions per
 * instruction set and scalar type. Every source of this folder is compiled for each of them:
 * NC = doubles per entry, KERNEL(f) = the name of f in this variant. */
#ifndef QC_SPARSE_KERNELS_H
#define QC_SPARSE_KERNELS_H

#include "sdk/base/internal.h"

typedef struct qc__kernels {
    int32_t components; /* 1 real, 2 complex */
} qc__kernels;

/* The table for one instruction set; components: 1 real, 2 complex. */
const qc__kernels *qc__kernels_for(qc__isa isa, int32_t components);

#ifdef QC__VARIANT
#define QC__PASTE2(f, variant) f##_##variant
#define QC__PASTE(f, variant)  QC__PASTE2(f, variant)
#define KERNEL(f)              QC__PASTE(f, QC__VARIANT)
#ifdef QC__REAL
#define NC 1
#else
#define NC 2
#endif
#endif

#endif
