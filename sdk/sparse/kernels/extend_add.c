/* Extend-add of the multifrontal method (Duff, Reid 1983): the update matrix of a child, whose rows
 * lie at the ascending places `local` of its parent's rows, is added to the parent's front. Most of
 * these places follow each other, so the work goes by runs of consecutive places. */
#include "sdk/sparse/kernels/kernels.h"
#include "sdk/sparse/kernels/vector.h"

QC__INLINE void add(int64_t n, const double *x, double *y) {
    for (; n >= LANES; n -= LANES, x += LANES, y += LANES) v_store(y, v_add(v_load(y), v_load(x)));
    if (n > 0) v_store_part(y, v_add(v_load_part(y, n), v_load_part(x, n)), n);
}

static int64_t run_end(int64_t m, const int32_t *local, int64_t i) {
    do i++;
    while (i < m && local[i] == local[i - 1] + 1);
    return i;
}

void KERNEL(qc__extend_add)(int64_t m, const int32_t *local, const double *child, int64_t r,
                            int64_t w, double *panel, double *U) {
    for (int64_t begin = 0; begin < m;) { /* rows begin..end of the child are one run */
        const int64_t end = run_end(m, local, begin);
        for (int64_t j = 0; j < end; j++) {
            const int64_t column = local[j], i = j > begin ? j : begin;
            double *y =
                column < w ? panel + NC * column * r : U + NC * ((column - w) * (r - w) - w);
            add(NC * (end - i), child + NC * (i + j * m), y + NC * local[i]);
        }
        begin = end;
    }
}
