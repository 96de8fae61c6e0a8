/* Approximate minimum degree (Amestoy, Davis, Duff 1996) on a pattern or on some of its rows. AMD
 * takes its work space from the C library: SuiteSparse has only a process-wide hook for it. */
#include "sdk/sparse/order/internal.h"
#include <amd.h>
#include <limits.h>

static qc_status amd_status(qc_ctx *ctx, int64_t status) {
    if (status == AMD_OUT_OF_MEMORY) return qc__nomem(ctx);
    if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "ordering: AMD rejected the pattern (status %d)",
                        (int)status);
    return QC_OK;
}

static qc_status amd_int(qc_ctx *ctx, qc__pattern A, int32_t *perm) {
    int *colptr = QC__NEW(ctx, int, A.n + 1);
    if (!colptr) return QC_ERR_NOMEM;
    for (int32_t j = 0; j <= A.n; j++) colptr[j] = (int)A.colptr[j];
    const qc_status status = amd_status(ctx, amd_order(A.n, colptr, A.row, perm, NULL, NULL));
    qc__free(colptr);
    return status;
}

static qc_status amd_long(qc_ctx *ctx, qc__pattern A, int32_t *perm) {
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

qc_status qc__amd(qc_ctx *ctx, qc__pattern A, int32_t *perm) {
    if (A.n == 0) return QC_OK;
    return A.colptr[A.n] < INT_MAX / 2 ? amd_int(ctx, A, perm) : amd_long(ctx, A, perm);
}

qc_status qc__amd_rows(qc_ctx *ctx, qc__pattern A, int32_t n, int32_t *perm, int32_t *place) {
    int64_t most = 0;
    for (int32_t k = 0; k < n; k++) most += A.colptr[perm[k] + 1] - A.colptr[perm[k]];
    int64_t *colptr = QC__NEW(ctx, int64_t, n + 1);
    int32_t *row = QC__NEW(ctx, int32_t, most), *order = QC__NEW(ctx, int32_t, n);
    qc_status status = colptr && row && order ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int64_t count = 0;
        for (int32_t k = 0; k < n; k++) place[perm[k]] = k;
        for (int32_t k = 0; k < n; k++) {
            colptr[k] = count;
            for (int64_t p = A.colptr[perm[k]]; p < A.colptr[perm[k] + 1]; p++)
                if (place[A.row[p]] != -1) row[count++] = place[A.row[p]];
        }
        colptr[n] = count;
        status = qc__amd(ctx, (qc__pattern){n, colptr, row}, order);
        for (int32_t k = 0; k < n; k++) place[perm[k]] = -1;
        for (int32_t k = 0; k < n && status == QC_OK; k++) order[k] = perm[order[k]];
        for (int32_t k = 0; k < n && status == QC_OK; k++) perm[k] = order[k];
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(order);
    return status;
}
