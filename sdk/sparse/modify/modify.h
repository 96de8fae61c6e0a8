/* The data behind modifications of a factor: the journal, the forward solution which is carried
 * along, and the work space of the sweep. All of it is made with the first modification. */
#ifndef QC_SPARSE_MODIFY_H
#define QC_SPARSE_MODIFY_H

#include "sdk/sparse/internal.h"

/* What one entry of the journal holds, from data + begin on:
 * PANEL    the pivots of supernode `index` from local column k0 on, then its entries as the kernel
 *          wrote them
 * SOLUTION z, contribution and energy of supernode `index`
 * DIAGONAL the scale of the pivot of column `index`;  RHS entry `index` of the right-hand side;
 * k0 = 1: its supernode became pending by this
 * PENDING  nothing: supernode `index` was brought up to date */
typedef enum qc__record_kind {
    QC__PANEL,
    QC__SOLUTION,
    QC__DIAGONAL,
    QC__RHS,
    QC__PENDING
} qc__record_kind;

typedef struct qc__record {
    qc__record_kind kind;
    int32_t index, k0;
    int64_t begin;
} qc__record;

/* Last in, first out. Savepoints are numbers of records. */
typedef struct qc__journal {
    double *data;
    qc__record *record;
    int64_t *savepoint;
    int64_t size, records_size, savepoints_size; /* capacities */
    int64_t used, records, savepoints;
    bool undoable; /* outside transactions: the last modification can be rolled back */
} qc__journal;

/* z = L^{-1} P b by supernode, with what each hands to the rows below, so that a path is redone
 * from its neighbours without rounding errors piling up. */
typedef struct qc__forward {
    double *b, *z;        /* n entries, permuted */
    double *contribution; /* of supernode s at rowptr[s] - super[s] */
    double *energy;       /* nsuper: sum |z|^2 / D over the subtree */
    int32_t *root, roots;
    int32_t *pending, pendings; /* supernodes whose right-hand side has changed */
    bool *is_pending;           /* nsuper */
    bool stale;                 /* everything has to be redone */
    double *work;               /* one front */
} qc__forward;

enum { QC__OFF_PATH = -2 };

struct qc__modify {
    qc__journal journal;
    qc__forward *forward; /* NULL: none attached */
    int32_t *path; /* nsuper: its end is the union of the of paths to roots, children first */
    int32_t *head; /* nsuper: first vector waiting there, -1, or QC__OFF_PATH between calls */
    int32_t *item; /* grow with the number of vectors */
    double *work, **pointer;
    int64_t items, works, pointers; /* capacities */
};

/* A <- A + sum sigma_q w_q w_q^H; vector q has the entries start[q] .. start[q+1). `diagonal`: the
 * diagonal of A changes accordingly (a flip leaves it alone). */
typedef struct qc__change {
    int32_t vectors;
    const int *sigma;
    const int32_t *start, *row;
    const double *w;
    bool diagonal;
} qc__change;

/* modify.c */
qc_status qc__modify_open(qc_ctx *ctx, qc_factor *F); /* makes F->modify if there is none */

/* sweep.c: one modification with the pending changes of the right-hand side; all or nothing. */
qc_status qc__sweep(qc_ctx *ctx, qc_factor *F, const qc__change *change);

/* journal.c: begin before a modification, reserve before it writes, end after it. */
void qc__journal_begin(qc_factor *F);
qc_status qc__journal_reserve(qc_ctx *ctx, qc_factor *F, int64_t doubles, int64_t records);
double *qc__journal_record(qc_factor *F, qc__record_kind kind, int32_t index, int32_t k0);
void qc__journal_roll_back(qc_factor *F, int64_t records);

/* Where the entries of a panel record begin, after its pivots: whole cache lines. */
static inline int64_t qc__journal_panel(int64_t begin, int64_t pivots) {
    return (begin + pivots + 7) / 8 * 8;
}

/* forward.c: b + contributions of the children of s into f (r entries); returns their energy. */
double qc__forward_assemble(const qc_factor *F, int32_t s, double *f);
/* z, contribution and energy of s after the kernel. */
void qc__forward_store(const qc_factor *F, int32_t s, const double *f, double below);
/* Old z, contribution and energy of s into the journal. */
void qc__forward_save(qc_factor *F, int32_t s);
/* Nothing is pending any more. */
void qc__forward_settle(qc_factor *F);
void qc__forward_solve(qc_factor *F);
void qc__forward_free(qc__forward *forward);

#endif
