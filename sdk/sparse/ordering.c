/* Fill-reducing order: approximate minimum degree (Amestoy, Davis, Duff 1996), given, or natural.
 * AMD takes its work space from the C library: SuiteSparse has only a process-wide hook for it. */
#include "sdk/sparse/internal.h"
#include <amd.h>
#include <limits.h>
#include <string.h>

static qc_status amd_status(qc_ctx *ctx, int64_t status) {
    if (status == AMD_OUT_OF_MEMORY) return qc__nomem(ctx);
    if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "ordering: AMD rejected the pattern (status %d)",
                        (int)status);
    return QC_OK;
}

static qc_status order_amd_int(qc_ctx *ctx, qc__pattern A, int32_t *perm) {
    int *colptr = QC__NEW(ctx, int, A.n + 1);
    if (!colptr) return QC_ERR_NOMEM;
    for (int32_t j = 0; j <= A.n; j++) colptr[j] = (int)A.colptr[j];
    const qc_status status = amd_status(ctx, amd_order(A.n, colptr, A.row, perm, NULL, NULL));
    qc__free(colptr);
    return status;
}

static qc_status order_amd_long(qc_ctx *ctx, qc__pattern A, int32_t *perm) {
    const int64_t nnz = A.colptr[A.n];
    SuiteSparse_long *colptr = QC__NEW(ctx, SuiteSparse_long, A.n + 1);
    SuiteSparse_long *row = QC__NEW(ctx, SuiteSparse_long, nnz);
    SuiteSparse_long *out = QC__NEW(ctx, SuiteSparse_long, A.n);
    qc_status status = QC_ERR_NOMEM;
    if (colptr && row && out) {
        for (int32_t j = 0; j <= A.n; j++) colptr[j] = A.colptr[j];
        for (int64_t p = 0; p < nnz; p++) row[p] = A.row[p];
        status = amd_status(ctx, amd_l_order(A.n, colptr, row, out, NULL, NULL));
        for (int32_t k = 0; k < A.n && status == QC_OK; k++) perm[k] = (int32_t)out[k];
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(out);
    return status;
}

static qc_status order_given(qc_ctx *ctx, int32_t n, const int32_t *given, int32_t *perm) {
    if (!given && n > 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "QC_ORDER_GIVEN needs a permutation");
    bool *seen = QC__ZERO(ctx, bool, n);
    if (!seen) return QC_ERR_NOMEM;
    qc_status status = QC_OK;
    for (int32_t k = 0; k < n && status == QC_OK; k++) {
        if (given[k] < 0 || given[k] >= n || seen[given[k]])
            status = qc__fail(ctx, QC_ERR_ARGUMENT, k,
                              "permutation[%d] = %d is out of range or occurs twice", (int)k,
                              (int)given[k]);
        else
            seen[perm[k] = given[k]] = true;
    }
    qc__free(seen);
    return status;
}

qc_status qc__order(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options, int32_t *perm) {
    const int32_t ordering = options ? options->ordering : QC_ORDER_AMD;
    switch (ordering) {
    case QC_ORDER_GIVEN:
        return order_given(ctx, A.n, options->permutation, perm);
    case QC_ORDER_NATURAL:
        for (int32_t k = 0; k < A.n; k++) perm[k] = k;
        return QC_OK;
    case QC_ORDER_AMD:
        if (A.n == 0) return QC_OK;
        return A.colptr[A.n] < INT_MAX / 2 ? order_amd_int(ctx, A, perm)
                                           : order_amd_long(ctx, A, perm);
    default:
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "unknown ordering %d", (int)ordering);
    }
}
