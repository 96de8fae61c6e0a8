/* Instruction set and scalar type -> table of kernels. */
#include "sdk/sparse/kernels/kernels.h"

extern const qc__kernels qc__kernels_portable, qc__kernels_portable_real;
#ifdef __x86_64__
extern const qc__kernels qc__kernels_avx2, qc__kernels_avx2_real;
extern const qc__kernels qc__kernels_avx512, qc__kernels_avx512_real;
#endif

const qc__kernels *qc__kernels_for(qc__isa isa, int32_t components) {
#ifdef __x86_64__
    static const qc__kernels *const tables[QC__ISAS][2] = {
        {&qc__kernels_portable_real, &qc__kernels_portable},
        {&qc__kernels_avx2_real, &qc__kernels_avx2},
        {&qc__kernels_avx512_real, &qc__kernels_avx512}};
    return tables[isa][components - 1];
#else
    (void)isa; /* QC__PORTABLE is the only one a context can have here */
    return components == 1 ? &qc__kernels_portable_real : &qc__kernels_portable;
#endif
}
