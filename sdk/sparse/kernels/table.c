/* The table of one variant. */
#include "sdk/sparse/kernels/kernels.h"

extern const qc__kernels KERNEL(qc__kernels);
const qc__kernels KERNEL(qc__kernels) = {NC};
