/* Fill-reducing order: minimum degree, nested dissection, given, or natural. */
#include "sdk/sparse/order/internal.h"

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
    const int32_t ordering = options ? options->ordering : QC_ORDER_AUTO;
    switch (ordering) {
    case QC_ORDER_GIVEN:
        return order_given(ctx, A.n, options->permutation, perm);
    case QC_ORDER_NATURAL:
        for (int32_t k = 0; k < A.n; k++) perm[k] = k;
        return QC_OK;
    case QC_ORDER_AUTO:
    case QC_ORDER_AMD:
        return qc__amd(ctx, A, perm);
    case QC_ORDER_DISSECTION:
        return qc__order_dissection(ctx, A, options, perm);
    default:
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "unknown ordering %d", (int)ordering);
    }
}
