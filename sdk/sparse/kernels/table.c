/* The table of one variant. Against OpenBLAS the vector kernels were ahead for every front
 * measured, 60 to 2000 rows; the portable ones only while fronts are narrow (docs/performance.md).
 */
#include "sdk/sparse/kernels/kernels.h"

#if defined(QC__ISA_AVX512) || defined(QC__ISA_AVX2)
enum { BLAS_WIDTH = INT32_MAX };
#else
enum { BLAS_WIDTH = 24 };
#endif

extern const qc__kernels KERNEL(qc__kernels);
const qc__kernels KERNEL(qc__kernels) = {
    .components = NC,
    .blas_width = BLAS_WIDTH,
    .extend_add = KERNEL(qc__extend_add),
    .front_factor_block = KERNEL(qc__front_factor_block),
    .front_pack = KERNEL(qc__front_pack),
    .front_tiles = KERNEL(qc__front_tiles),
    .front_subtract = KERNEL(qc__front_subtract),
    .update_front = KERNEL(qc__update_front),
    .restore_front = KERNEL(qc__restore_front),
    .solve = {{KERNEL(qc__load_single), KERNEL(qc__forward_single), KERNEL(qc__backward_single),
               KERNEL(qc__store_single), KERNEL(qc__store_scaled_single)},
              {KERNEL(qc__load_block), KERNEL(qc__forward_block), KERNEL(qc__backward_block),
               KERNEL(qc__store_block), KERNEL(qc__store_scaled_block)}},
    .forward_panel = KERNEL(qc__forward_panel),
    .backward_panel = KERNEL(qc__backward_panel),
};
