/* The columns of a factor before an update touched them, for restoring it bit for bit. A record is
 * the column from its diagonal on, then its pivot. */
#include "sdk/sparse/internal.h"
#include <string.h>

qc_status qc__journal_open(qc_ctx *ctx, qc_factor *F, int32_t s) {
    const qc_symbolic *S = F->S;
    int64_t size = 0, columns = 0;
    for (; s != -1; s = S->parent[s]) {
        const int64_t w = S->super[s + 1] - S->super[s], r = S->rowptr[s + 1] - S->rowptr[s];
        size += F->components * (r * w - w * (w - 1) / 2) + w;
        columns += w;
    }
    F->journal_used = 0;
    F->journal_count = 0;
    if (!qc__reserve(ctx, (void **)&F->journal, &F->journal_size, size, sizeof(double)) ||
        !qc__reserve(ctx, (void **)&F->journal_column, &F->journal_columns, columns,
                     sizeof(int32_t)))
        return QC_ERR_NOMEM;
    return QC_OK;
}

void qc__journal_record(qc_factor *F, int32_t column, const double *x, int64_t count) {
    memcpy(F->journal + F->journal_used, x, (size_t)count * sizeof *x);
    F->journal[F->journal_used + count] = F->D[column];
    F->journal_column[F->journal_count++] = column;
    F->journal_used += count + 1;
}

void qc__journal_roll_back(qc_factor *F) {
    const qc_symbolic *S = F->S;
    const int64_t nc = F->components;
    while (F->journal_count > 0) {
        const int32_t column = F->journal_column[--F->journal_count], s = S->super_of[column];
        const int64_t k = column - S->super[s], r = S->rowptr[s + 1] - S->rowptr[s];
        const int64_t count = nc * (r - k);
        F->journal_used -= count + 1;
        memcpy(F->values + nc * (S->panel[s] + k * r + k), F->journal + F->journal_used,
               (size_t)count * sizeof(double));
        F->D[column] = F->journal[F->journal_used + count];
    }
}
