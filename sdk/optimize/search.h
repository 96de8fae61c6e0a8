/* The search for flips which lower E_D: its state, and the pool of candidates. */
#ifndef QC_OPTIMIZE_SEARCH_H
#define QC_OPTIMIZE_SEARCH_H

#include "sdk/optimize/internal.h"

/* Candidates of largest share, of which those with the best prediction are tried; flips made at
 * once on the strength of their predictions, at most. */
enum { POOL = 512, SOME = 4 * QC__TRIALS, BULK = 32 };

typedef struct qc__candidate {
    qc_flip_step flip;
    double rank; /* larger is better: share, then predicted or measured gain */
    qc__prediction expected;
} qc__candidate;

typedef struct qc__search {
    qc_distortion *d;
    qc_reduce_options options;
    qc__rules rules;
    double *share, *theta; /* n_edges */
    uint8_t *tried;        /* n_edges: 1 = step +1, 2 = step -1 failed since the last change near */
    qc__candidate *pool;   /* POOL */
    qc_complex *v;         /* n: copotential */
    double *slope;         /* n_faces */
    double weight[2];      /* sums of (change - first) self and of self^2 over the trials */
    int32_t bulk;
    int64_t first;       /* evaluations at the start */
    double start, shown; /* times: of the start, of the last progress shown */
    int64_t failures;    /* in a row */
} qc__search;

/* Order of qsort: the larger rank first, then by edge and step. */
int qc__by_rank(const void *a, const void *b);
static inline uint8_t qc__tried_mark(int32_t step) {
    return step > 0 ? 1 : 2;
}
/* The pool with the best prediction first; *n candidates. */
qc_status qc__fill_pool(qc_ctx *ctx, qc__search *s, int32_t *n);
/* What a trial says about the weight of the second term of the predictions. */
void qc__learn(qc__search *s, const qc__prediction *p, double change);

#endif
