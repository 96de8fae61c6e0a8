/* What the solve kernels share. A block of right-hand sides travels up the tree (forward) and down
 * again (backward). Forward, a supernode with own columns 1, rows 2 below them, and the sum t of
 * its children's updates computes x1 <- L11^{-1} (b1 + t1),    u = t2 - L21 x1 and adds u to the t
 * of its parent, so that no two subtrees write to the same place. */
#ifndef QC_SPARSE_KERNELS_SOLVE_H
#define QC_SPARSE_KERNELS_SOLVE_H

#include "sdk/sparse/internal.h"
#include "sdk/sparse/kernels/entry.h"

typedef struct panel {
    const double *L;
    int64_t ld;   /* doubles from one column of L to the next */
    int64_t w, m; /* own columns, rows below */
} panel;

static inline panel panel_of(const qc_factor *F, const qc__solve_node *N) {
    return (panel){F->values + NC * N->panel, NC * (int64_t)(N->w + N->m), N->w, N->m};
}

/* One right-hand side goes by GROUP columns; what is needed next is asked for at least AHEAD
 * doubles before. */
enum { GROUP = 4, AHEAD = 512 };
static inline int64_t ahead_of(int64_t ld) {
    return GROUP * ld > AHEAD ? GROUP * ld : AHEAD;
}

/* y_i = x_i^{-1/2} for n <= LANES numbers */
static inline void inverse_roots(int64_t n, const double *x, double *y) {
    v_store_part(y, v_inverse_root(v_load_part(x, n)), n);
}

#endif
