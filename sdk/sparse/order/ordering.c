/* Fill-reducing order: minimum degree, nested dissection, given, or natural. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

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

/* Mean position of the rows of each group. */
static void group_positions(int32_t n, const int32_t *group, int32_t count, const double *position,
                            double *mean) {
    for (int64_t k = 0; k < 4 * (int64_t)count; k++) mean[k] = 0;
    double *size = mean + 3 * (int64_t)count;
    for (int32_t i = 0; i < n; i++) {
        for (int d = 0; d < 3; d++) mean[3 * (int64_t)group[i] + d] += position[3 * (int64_t)i + d];
        size[group[i]] += 1;
    }
    for (int64_t k = 0; k < 3 * (int64_t)count; k++) mean[k] /= size[k / 3];
}

/* Orders the groups by the method and expands. */
static qc_status order_groups(qc_ctx *ctx, qc__pattern A, const int32_t *group, int32_t count,
                              const qc_analyze_options *o, int32_t leaf, int32_t *perm) {
    int64_t *colptr = NULL;
    int32_t *row = NULL, *order = QC__NEW(ctx, int32_t, count);
    double *position = o->position ? QC__NEW(ctx, double, 4 * (int64_t)count) : NULL;
    qc_status status = order && (position || !o->position) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc__quotient(ctx, A, group, count, &colptr, &row);
    if (status == QC_OK && !qc__progress(ctx, 0.1)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) {
        const qc__pattern Q = {count, colptr, row};
        if (position) group_positions(A.n, group, count, o->position, position);
        status = o->ordering == QC_ORDER_DISSECTION
                     ? qc__order_dissection(ctx, Q, position, leaf, order)
                     : qc__amd(ctx, Q, order);
    }
    if (status == QC_OK) status = qc__expand_groups(ctx, A.n, group, count, order, perm);
    qc__free(colptr);
    qc__free(row);
    qc__free(order);
    qc__free(position);
    return status;
}

/* Without a hint the groups are the indistinguishable rows; where these are few the rows remain. */
static qc_status order_quotient(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *o,
                                int32_t leaf, int32_t *perm) {
    int32_t count = 0, *group = QC__NEW(ctx, int32_t, A.n);
    qc_status status = group ? qc__find_groups(ctx, A, o->group, group, &count) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        if (!o->group && count > A.n / 10 * 9)
            status = qc__amd(ctx, A, perm);
        else
            status = order_groups(ctx, A, group, count, o, leaf, perm);
    }
    qc__free(group);
    return status;
}

static qc_status check_hints(qc_ctx *ctx, int32_t n, const qc_analyze_options *o) {
    const bool takes_groups = o->ordering == QC_ORDER_AUTO || o->ordering == QC_ORDER_QUOTIENT ||
                              o->ordering == QC_ORDER_DISSECTION;
    const bool takes_positions = o->ordering == QC_ORDER_AUTO || o->ordering == QC_ORDER_DISSECTION;
    if (o->group && !takes_groups)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "ordering %d takes no groups: use QC_ORDER_QUOTIENT or _DISSECTION",
                        (int)o->ordering);
    if (o->position && !takes_positions)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "ordering %d takes no positions: use QC_ORDER_DISSECTION",
                        (int)o->ordering);
    for (int64_t i = 0; o->position && i < 3 * (int64_t)n; i++)
        if (!isfinite(o->position[i]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, i / 3,
                            "position of row %d is not a finite number", (int)(i / 3));
    return QC_OK;
}

static qc_status order_dissection(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *o,
                                  int32_t leaf, int32_t *perm) {
    return o->group ? order_quotient(ctx, A, o, leaf, perm)
                    : qc__order_dissection(ctx, A, o->position, leaf, perm);
}

/* One factorisation repays dissection only above the first size, and only down to pieces of the
 * second (docs/theory/sparse-ordering.md). */
enum { SMALL = 250000, PIECE = 20000 };

qc_status qc__order(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options, int32_t *perm) {
    qc_analyze_options o = QC_ANALYZE_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    const qc_status status = check_hints(ctx, A.n, &o);
    if (status != QC_OK) return status;
    switch (o.ordering) {
    case QC_ORDER_GIVEN:
        return order_given(ctx, A.n, o.permutation, perm);
    case QC_ORDER_NATURAL:
        for (int32_t k = 0; k < A.n; k++) perm[k] = k;
        return QC_OK;
    case QC_ORDER_AUTO:
        return A.n < SMALL ? qc__amd(ctx, A, perm) : order_dissection(ctx, A, &o, PIECE, perm);
    case QC_ORDER_AMD:
        return qc__amd(ctx, A, perm);
    case QC_ORDER_QUOTIENT:
        return order_quotient(ctx, A, &o, 0, perm);
    case QC_ORDER_DISSECTION:
        return order_dissection(ctx, A, &o, 0, perm);
    default:
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "unknown ordering %d", (int)o.ordering);
    }
}
