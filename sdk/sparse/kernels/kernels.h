/* The inner loops of the factorisation, of updates and of solves, behind one table of functions per
 * instruction set and scalar type. Every source of this folder is compiled for each of them:
 * NC = doubles per entry, KERNEL(f) = the name of f in this variant. */
#ifndef QC_SPARSE_KERNELS_H
#define QC_SPARSE_KERNELS_H

#include "sdk/base/internal.h"

/* One front of a modification (theory S.7, S.10, S.11). Arrays count entries of NC doubles, except
 * D, diagonal, a, journal, multipliers (doubles). */
typedef struct qc__update_front {
    int64_t r, w, k0;       /* rows, columns, first column which changes (w: none) */
    double *panel;          /* r x w */
    double *D;              /* w */
    const double *diagonal; /* w: the scale of each pivot */
    double floor;           /* pivots above floor * diagonal are accepted */
    int32_t vectors;
    double *const *vector; /* r each: leave as the vectors on the rows below the diagonal block */
    double *const *a;      /* one coefficient each, sigma at first, changes */
    double negligible;     /* entries of vectors up to this become zero */
    double *solution;      /* r or NULL: right-hand side -> L11^{-1} f1 and f2 - L21 L11^{-1} f1 */
    double *journal;       /* advances past the old entries written there */
    double *multipliers;   /* QC__UPDATE_MULTIPLIERS for each vector */
} qc__update_front;

enum { QC__UPDATE_BLOCK = 32, QC__UPDATE_MULTIPLIERS = 6 * QC__UPDATE_BLOCK };

/* Doubles which a front needs at most in the journal. */
static inline int64_t qc__update_journal(int32_t components, int64_t r, int64_t w) {
    return w * (components * r + 16);
}

/* Steps of the partial LDL^H of one front (front_kernel.c): a panel of r rows and w columns and the
 * m x m update matrix U, m = r - w, both column-major; only lower triangles count. Columns [k0, k1)
 * are a block of at most QC__FRONT_BLOCK whose earlier blocks are subtracted. */
enum { QC__FRONT_BLOCK = 48, QC__TILE_LANES = 24 /* doubles of a row tile, at most */ };

/* A block of right-hand sides during a solve: one, or up to QC__BLOCK. */
enum { QC__BLOCK = 8, QC__SOLVE_PAD = 8 };
typedef struct qc__rhs_block {
    const struct qc_factor *F;
    double *x; /* n x columns, overwritten */
    int64_t columns;
    double *Y, *area; /* n rows of 1 or QC__BLOCK columns, permuted; update vectors */
} qc__rhs_block;

/* load: Y <- P x, store: x <- P^T Y, store_scaled: x <- D^{-1/2} Y, each for a range of rows (which
 * index x in load_block and in store, Y otherwise).
 * forward: Y <- L^{-1} Y, backward: Y <- L^{-H} D^{-1} Y for the supernodes [first, last].
 * work: 3 solve.work + solve.stack rows, the last ones zero before and after. */
typedef void qc__solve_rows(const qc__rhs_block *B, int64_t begin, int64_t end);
typedef void qc__solve_nodes(const qc__rhs_block *B, double *work, int32_t first, int32_t last);
typedef struct qc__solve_kernels {
    qc__solve_rows *load;
    qc__solve_nodes *forward, *backward;
    qc__solve_rows *store, *store_scaled;
} qc__solve_kernels;

typedef struct qc__kernels {
    int32_t components; /* 1 real, 2 complex */
    int32_t blas_width; /* BLAS is faster for fronts with this many columns */
    /* Adds the lower triangle of a child's m x m update matrix into a front (see extend_add.c). */
    void (*extend_add)(int64_t m, const int32_t *local, const double *child, int64_t r, int64_t w,
                       double *panel, double *U);
    /* Finishes the block. B: work of NC * 4 * QC__FRONT_BLOCK doubles. Returns the column whose
     * pivot is not above its floor, or -1. */
    int32_t (*front_factor_block)(int64_t r, int64_t k0, int64_t k1, double *panel, double *D,
                                  const double *floor, double *B);
    /* Multipliers of the block for all later rows: NC * (k1 - k0) * (r - k1 + 8) doubles. */
    void (*front_pack)(int64_t r, int64_t w, int64_t k0, int64_t k1, const double *panel,
                       const double *D, double *B);
    /* Number of row tiles below a block which ends at k1. They are independent of each other. */
    int64_t (*front_tiles)(int64_t r, int64_t w, int64_t k1);
    /* Subtracts the block from row tile t. fresh: U counts as zero. copy: work of QC__TILE_LANES *
     * QC__FRONT_BLOCK doubles. */
    void (*front_subtract)(int64_t r, int64_t w, int64_t k0, int64_t k1, double *panel, double *U,
                           const double *B, bool fresh, int64_t t, double *copy);
    /* Returns -1, or the local column whose pivot is not above its floor; then the entries changed
     * so far are those in the journal, and all of D. */
    int32_t (*update_front)(qc__update_front *front);
    /* Writes the journal of one front back: the doubles [journal, end). */
    void (*restore_front)(int64_t r, int64_t w, int64_t k0, double *panel, const double *journal,
                          const double *end);
    qc__solve_kernels solve[2]; /* forward_single.c and backward_single.c, solve_block.c */
    /* The same, one supernode with own values x and m rows below: x <- L11^{-1} x, then
     * u = -L21 x; and x <- L11^{-H} (x / D - L21^H t). x and u may be overwritten up to
     * QC__SOLVE_PAD rows past their end. */
    void (*forward_panel)(const struct qc_factor *F, int32_t s, double *x, double *u);
    void (*backward_panel)(const struct qc_factor *F, int32_t s, const double *t, double *x);
} qc__kernels;

/* The table for one instruction set; components: 1 real, 2 complex. */
const qc__kernels *qc__kernels_for(qc__isa isa, int32_t components);

#ifdef QC__VARIANT
#define QC__PASTE2(f, variant) f##_##variant
#define QC__PASTE(f, variant)  QC__PASTE2(f, variant)
#define KERNEL(f)              QC__PASTE(f, QC__VARIANT)
void KERNEL(qc__extend_add)(int64_t m, const int32_t *local, const double *child, int64_t r,
                            int64_t w, double *panel, double *U);
int32_t KERNEL(qc__front_factor_block)(int64_t r, int64_t k0, int64_t k1, double *panel, double *D,
                                       const double *floor, double *B);
void KERNEL(qc__front_pack)(int64_t r, int64_t w, int64_t k0, int64_t k1, const double *panel,
                            const double *D, double *B);
int64_t KERNEL(qc__front_tiles)(int64_t r, int64_t w, int64_t k1);
void KERNEL(qc__front_subtract)(int64_t r, int64_t w, int64_t k0, int64_t k1, double *panel,
                                double *U, const double *B, bool fresh, int64_t t, double *copy);
int32_t KERNEL(qc__update_front)(qc__update_front *front);
void KERNEL(qc__restore_front)(int64_t r, int64_t w, int64_t k0, double *panel,
                               const double *journal, const double *end);
#ifdef QC__REAL
#define NC 1
#else
#define NC 2
#endif
qc__solve_nodes KERNEL(qc__forward_single), KERNEL(qc__backward_single);
qc__solve_nodes KERNEL(qc__forward_block), KERNEL(qc__backward_block);
qc__solve_rows KERNEL(qc__load_single), KERNEL(qc__store_single), KERNEL(qc__store_scaled_single);
qc__solve_rows KERNEL(qc__load_block), KERNEL(qc__store_block), KERNEL(qc__store_scaled_block);
void KERNEL(qc__forward_panel)(const struct qc_factor *F, int32_t s, double *x, double *u);
void KERNEL(qc__backward_panel)(const struct qc_factor *F, int32_t s, const double *t, double *x);
#endif

#endif
