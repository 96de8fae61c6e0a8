/* The part of the tree which a sparse right-hand side touches: all supernodes on the paths from
 * some rows to their roots, found at the cost of those paths (Gilbert, Peierls 1988; for a Cholesky
 * factor the graph of L may be replaced by its tree). */
#ifndef QC_SPARSE_REACH_H
#define QC_SPARSE_REACH_H

#include "sdk/sparse/internal.h"

typedef struct qc__reached {
    int32_t super, parent, child, sibling; /* positions in the list, -1 = none; children ascend */
    int64_t own, below;                    /* columns and rows below of all supernodes before it */
} qc__reached;

typedef struct qc__reach {
    int32_t count;
    int64_t capacity, own, below; /* own, below: of the whole list */
    qc__reached *node;            /* ascending supernodes */
} qc__reach;

/* From na + nb rows, the caller's numbering. ARGUMENT: a row out of range. */
qc_status qc__reach_create(qc_ctx *ctx, const qc_symbolic *S, int32_t na, const int32_t *a,
                           int32_t nb, const int32_t *b, qc__reach *out);
void qc__reach_free(qc__reach *reach);
/* Position in the list of a supernode which is on it. */
int32_t qc__reach_find(const qc__reach *reach, int32_t super);

#endif
