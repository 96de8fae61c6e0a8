/* What the solve kernels share. A block of right-hand sides travels up the tree (forward) and down
 * again (backward). Forward, a supernode with own columns 1, rows 2 below them, and the sum t of
 * its children's updates computes x1 <- L11^{-1} (b1 + t1),    u = t2 - L21 x1 and adds u to the t
 * of its parent, so that no two subtrees write to the same place. */
#ifndef QC_SPARSE_KERNELS_SOLVE_H
#define QC_SPARSE_KERNELS_SOLVE_H

#include "sdk/sparse/internal.h"
#include "sdk/sparse/kernels/vector.h"

typedef struct panel {
    const double *L;
    int64_t ld;   /* doubles from one column of L to the next */
    int64_t w, m; /* own columns, rows below */
} panel;

static inline panel panel_of(const qc_factor *F, const qc__solve_node *N) {
    return (panel){F->values + NC * N->panel, NC * (int64_t)(N->w + N->m), N->w, N->m};
}

/* y -= l x: two fused operations in this order in every kernel, so that all of them agree bit for
 * bit. */
static inline void subtract_entry(const double *l, const double *x, double *y) {
    if (NC == 1) {
        y[0] = s_fnma(l[0], x[0], y[0]);
    } else {
        const double re = s_fma(x[NC - 1], l[NC - 1], y[0]);
        const double im = s_fnma(x[NC - 1], l[0], y[NC - 1]);
        y[0] = s_fnma(x[0], l[0], re);
        y[NC - 1] = s_fnma(x[0], l[NC - 1], im);
    }
}

/* y -= conj(l) x */
static inline void subtract_conjugate(const double *l, const double *x, double *y) {
    if (NC == 1) {
        y[0] = s_fnma(l[0], x[0], y[0]);
    } else {
        const double re = s_fnma(l[NC - 1], x[NC - 1], y[0]);
        const double im = s_fma(l[NC - 1], x[0], y[NC - 1]);
        y[0] = s_fnma(l[0], x[0], re);
        y[NC - 1] = s_fnma(l[0], x[NC - 1], im);
    }
}

/* y_i = x_i^{-1/2} for n <= LANES numbers */
static inline void inverse_roots(int64_t n, const double *x, double *y) {
    v_store_part(y, v_inverse_root(v_load_part(x, n)), n);
}

#endif
