/* The data behind qc/sparse.h and the steps of the analysis. Not installed.
 *
 * Three numberings of rows occur: the caller's, `permuted` (elimination order) and `local`
 * (position in the row list of one supernode). Values are doubles with `components` = 1 (real) or 2
 * (complex, interleaved) numbers per entry; offsets count entries. */
#ifndef QC_SPARSE_INTERNAL_H
#define QC_SPARSE_INTERNAL_H

#include <math.h>
#include <qc/sparse.h>
#include <stdatomic.h>
#include "sdk/base/internal.h"
#include "sdk/sparse/kernels/kernels.h"

/* Compressed columns without values. */
typedef struct qc__pattern {
    int32_t n;
    const int64_t *colptr;
    const int32_t *row;
} qc__pattern;

/* Supernodes [first, last] form complete subtrees: independent work for one thread. */
typedef struct qc__task {
    int32_t first, last;
} qc__task;

/* First the tasks [task, task_end) in parallel, then the supernodes top[top..top_end) in order. */
typedef struct qc__step {
    int32_t task, task_end, top, top_end;
    double cost; /* real flops, or work which takes as long (complex: four times) */
} qc__step;

/* Schedule of the multifrontal factorisation. Update matrices of supernodes inside a task live on
 * the stack of the worker; those which cross a task boundary or belong to the top in one shared
 * area. Both layouts are fixed here, so that nothing depends on the number of threads. */
typedef struct qc__plan {
    int32_t ntask, nstep;
    qc__task *task;
    qc__step *step;
    int32_t *top;
    int64_t *update; /* nsuper: offset of the update matrix in its area */
    bool *shared; /* nsuper: which area                                                          */
    int64_t stack, area; /* entries of one worker's stack and of the shared area */
    int64_t work;        /* doubles which qc__front_factor needs at most        */
    int32_t largest_front, largest_width;
    double cost; /* of all */
} qc__plan;

/* factor/workspace.c */
typedef struct qc__workspace {
    uint32_t workers;
    double *area;                    /* shared update matrices */
    double **stack, **work, **floor; /* by worker */
    int32_t *failed;                 /* by task: permuted column, or -1 */
} qc__workspace;
qc__workspace *qc__workspace_create(qc_ctx *ctx, const qc__plan *plan, int32_t components,
                                    uint32_t workers);
void qc__workspace_free(qc__workspace *space); /* NULL is fine */

/* One supernode in a solve: w own columns from `first` on, m rows below. In a forward solve the
 * updates of its children add up to r = w + m rows at `sum` on the stack of the worker; its own
 * update goes into the sum of its parent, or, where it leaves its task, to a slot of m rows. A sum
 * has one spare row. */
typedef struct qc__solve_node {
    int64_t panel, below; /* offsets in values; in rows and relative of the rows below */
    int64_t push;         /* offset in target */
    int64_t sum, to;      /* rows; to: sum of the parent, or slot in the area */
    int32_t first, w, m;
    bool leaves, top; /* the task of its parent differs; is above all tasks: children have slots */
} qc__solve_node;

/* In rows: stack of a worker, zero between supernodes; area of a block; one vector of a supernode.
 */
typedef struct qc__solve_plan {
    qc__solve_node *node; /* nsuper */
    int32_t
        *target; /* rows in the sum of the parent, each list up to a multiple of QC__SOLVE_PAD */
    int64_t stack, area, work;
    const int32_t *top; /* supernodes above all tasks, ascending: borrowed from qc__plan */
    int32_t ntop;
} qc__solve_plan;

struct qc_symbolic {
    atomic_int references;
    int32_t n, nsuper;
    int32_t *perm, *inverse; /* perm[k] = caller's row eliminated k-th */
    int32_t *super;    /* nsuper + 1: first column                                            */
    int32_t *super_of; /* n: supernode of a column                                            */
    int32_t *parent;   /* nsuper: -1 for roots; children come before parents                  */
    int32_t *child, *sibling; /* nsuper: first child, next sibling, ascending; -1 ends */
    int64_t *rowptr;   /* nsuper + 1 into rows                                                */
    int32_t *rows;     /* permuted rows of a supernode, ascending, its own columns first      */
    int32_t *relative; /* parallel to rows: local row in the parent's list (own columns: -1)  */
    int64_t *panel;    /* nsuper + 1: offset of the r x w column-major panel                  */
    int64_t *a_colptr; /* the analysed pattern of A, the caller's numbering                   */
    int32_t *a_row;
    int64_t *entry; /* nsuper + 1 into from / to: entries of A by supernode                */
    uint32_t *from; /* position in A                                                      */
    int32_t *to;    /* offset in the panel, ~offset when conjugated */
    qc__plan plan;
    qc__solve_plan solve;
    int64_t nnz_l;
    double flops;
};

struct qc_factor {
    qc_symbolic *S;
    int32_t components; /* 1 real, 2 complex */
    const qc__kernels *kernels;
    bool usable;
    double *values; /* panels: unit lower triangle, the strict upper part is undefined */
    double *D; /* n pivots, permuted                                                           */
    double *diagonal;          /* n: diagonal of A, permuted: the scale of each pivot */
    qc__workspace *workspace;  /* NULL until the first refactorisation, which keeps it */
    struct qc__modify *modify; /* journal, forward solution, work space; NULL until modified */
};

/* Values of A are fetched this many entries before their use; `from` has as many more elements. */
enum { QC__AHEAD = 24 };

#define QC__EPS 2.220446049250313e-16

/* A pivot below this is rounding error: in backward-stable elimination the error of D(j) is at most
 * of order n eps A(j,j). The bound is invariant under diagonal scaling. */
static inline double qc__pivot_floor(int32_t n, double diagonal) {
    return (double)n * QC__EPS * diagonal;
}

/* csc.c */
qc_status qc__check_pattern(qc_ctx *ctx, qc__pattern A);
/* Strictly upper triangle of P A P^T by columns (unsorted); *colptr, *row belong to the caller. */
qc_status qc__permute_upper(qc_ctx *ctx, qc__pattern A, const int32_t *inverse, int64_t **colptr,
                            int32_t **row);
/* The same, and where each entry comes from: p, or ~p if A(p) lies above the diagonal of P A P^T.
 */
qc_status qc__permute_upper_from(qc_ctx *ctx, qc__pattern A, const int32_t *inverse,
                                 int64_t **colptr, int32_t **row, int64_t **source);
/* The transpose after a change of numbers; order[number[k]] = k. Rows ascend in each column. */
qc_status qc__transpose_renumbered(qc_ctx *ctx, qc__pattern A, const int32_t *order,
                                   const int32_t *number, int64_t **colptr, int32_t **row);
/* Rows become columns and ascend within each. */
qc_status qc__transpose(qc_ctx *ctx, qc__pattern A, int64_t **colptr, int32_t **row);

/* order/ordering.c: perm: n */
qc_status qc__order(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options, int32_t *perm);

/* analyze/etree.c; upper: strictly upper triangle by columns; work: n */
void qc__etree(qc__pattern upper, int32_t *parent, int32_t *work);
/* post[k] = node visited k-th, children in ascending order; work: 3 n */
void qc__postorder(int32_t n, const int32_t *parent, int32_t *post, int32_t *work);

/* analyze/column_counts.c; lower: strictly lower triangle by columns, postordered; work: 4 n */
void qc__column_counts(qc__pattern lower, const int32_t *parent, int32_t *count, int32_t *work);

/* analyze/supernodes.c: fills nsuper, super, super_of, parent, child, sibling, rowptr, panel of S
 * and changes S->perm, S->inverse to the final order. parent, count: of the columns, postordered.
 */
qc_status qc__supernodes(qc_ctx *ctx, qc_symbolic *S, const int32_t *parent, const int32_t *count);

/* analyze/plan.c */
qc_status qc__plan_create(qc_ctx *ctx, qc_symbolic *S);
void qc__plan_free(qc__plan *plan);

/* solve/solve_plan.c, after plan.c */
qc_status qc__solve_plan_create(qc_ctx *ctx, qc_symbolic *S);
static inline int64_t qc__rows_below(const qc_symbolic *S, int32_t s) {
    return S->rowptr[s + 1] - S->rowptr[s] - (S->super[s + 1] - S->super[s]);
}

/* analyze/analyze.c */
qc_symbolic *qc__symbolic_retain(const qc_symbolic *S);

/* factor/factor.c */
qc_status qc__factor_create(qc_ctx *ctx, const qc_symbolic *S, int32_t components, qc_factor **out);
qc_status qc__factor_check(qc_ctx *ctx, const qc_factor *F, int32_t components, bool values);

/* modify/modify.c: frees F->modify; a new factorisation ends transactions and makes z stale. */
void qc__modify_free(qc_factor *F);
void qc__modify_reset(qc_factor *F);

/* factor/front.c, front_real.c: partial LDL^H of one front in place. */
typedef struct qc__front {
    int32_t r, w;
    double *panel, *U;   /* r x w; m x m with m = r - w, lower triangle updated */
    bool fresh;          /* U counts as zero */
    double *D;           /* w, out */
    const double *floor; /* w: pivots have to be larger */
    double *work;        /* qc__front_work doubles */
} qc__front;
int64_t qc__front_work(int32_t r, int32_t w);
/* ctx: of the calling thread when its pool may help and progress is wanted, else NULL. Returns the
 * local column whose pivot is not above its floor, or QC__DONE, or QC__CANCELLED. */
enum { QC__DONE = -1, QC__CANCELLED = -2 };
int32_t qc__front_factor(qc_ctx *ctx, const qc__kernels *kernels, const qc__front *front);
int32_t qc__front_factor_real(qc_ctx *ctx, const qc__kernels *kernels, const qc__front *front);

/* factor/blas_threads.c: between begin and end OpenBLAS computes in the calling thread. Any thread;
 * pairs may overlap, the host's setting comes back with the last end. */
void qc__blas_begin(void);
/* NOMEM where the first call of OpenBLAS would not find the memory it needs and hang. */
qc_status qc__blas_reserve(qc_ctx *ctx);
void qc__blas_end(void);

/* A borrowed matrix of either type. */
typedef struct qc__view {
    int32_t n, components;
    const int64_t *colptr;
    const int32_t *row;
    const double *val;
} qc__view;
static inline qc__view qc__view_complex(const qc_hermitian *A) {
    return (qc__view){A->n, 2, A->colptr, A->row, (const double *)A->val};
}
static inline qc__view qc__view_real(const qc_symmetric *A) {
    return (qc__view){A->n, 1, A->colptr, A->row, A->val};
}

/* solve/refine.c: solves with any solver and refines; x: n x nrhs, on error as it was. error: NULL,
 * or the largest componentwise backward error. */
typedef qc_status qc__solve_any(qc_ctx *ctx, void *arg, int32_t nrhs, double *x);
qc_status qc__refine(qc_ctx *ctx, qc__view A, int32_t nrhs, int32_t steps, qc__solve_any *solve,
                     void *arg, double *x, double *error);

#endif
