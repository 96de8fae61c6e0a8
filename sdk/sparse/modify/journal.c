/* The journal of modifications: old values, which a roll back restores bit for bit, last first.
 * Outside a transaction it holds the last modification, inside all since its begin. */
#include <string.h>
#include "sdk/sparse/modify/modify.h"

void qc__journal_begin(qc_factor *F) {
    qc__journal *J = &F->modify->journal;
    if (J->savepoints > 0) return;
    J->used = J->records = 0;
    J->undoable = false;
}

qc_status qc__journal_reserve(qc_ctx *ctx, qc_factor *F, int64_t doubles, int64_t records) {
    qc__journal *J = &F->modify->journal;
    if (!qc__reserve(ctx, (void **)&J->data, &J->size, J->used + doubles, sizeof *J->data) ||
        !qc__reserve(ctx, (void **)&J->record, &J->records_size, J->records + records,
                     sizeof *J->record))
        return QC_ERR_NOMEM;
    return QC_OK;
}

double *qc__journal_record(qc_factor *F, qc__record_kind kind, int32_t index, int32_t k0) {
    qc__journal *J = &F->modify->journal;
    J->record[J->records++] = (qc__record){kind, index, k0, J->used};
    return J->data + J->used;
}

static void restore_solution(qc_factor *F, int32_t s, const double *old) {
    const qc_symbolic *S = F->S;
    const qc__forward *forward = F->modify->forward;
    const int64_t nc = F->components, first = S->super[s], w = S->super[s + 1] - first;
    const int64_t m = S->rowptr[s + 1] - S->rowptr[s] - w;
    memcpy(forward->z + nc * first, old, (size_t)(nc * w) * sizeof *old);
    memcpy(forward->contribution + nc * (S->rowptr[s] - first), old + nc * w,
           (size_t)(nc * m) * sizeof *old);
    forward->energy[s] = old[nc * (w + m)];
}

static void restore_panel(qc_factor *F, const qc__record *R) {
    const qc_symbolic *S = F->S;
    const qc__journal *J = &F->modify->journal;
    const int32_t s = R->index;
    const int64_t k0 = R->k0;
    const int64_t first = S->super[s], w = S->super[s + 1] - first;
    memcpy(F->D + first + k0, J->data + R->begin, (size_t)(w - k0) * sizeof *J->data);
    F->kernels->restore_front(S->rowptr[s + 1] - S->rowptr[s], w, k0,
                              F->values + F->components * S->panel[s],
                              J->data + qc__journal_panel(R->begin, w - k0), J->data + J->used);
}

void qc__journal_roll_back(qc_factor *F, int64_t records) {
    qc__journal *J = &F->modify->journal;
    qc__forward *forward = F->modify->forward;
    const size_t entry = (size_t)F->components * sizeof(double);
    while (J->records > records) {
        const qc__record *R = &J->record[--J->records];
        const double *old = J->data + R->begin;
        switch (R->kind) {
        case QC__PANEL:
            restore_panel(F, R);
            break;
        case QC__SOLUTION:
            restore_solution(F, R->index, old);
            break;
        case QC__DIAGONAL:
            F->diagonal[R->index] = *old;
            break;
        case QC__RHS:
            memcpy(forward->b + F->components * (int64_t)R->index, old, entry);
            if (R->k0) forward->is_pending[forward->pending[--forward->pendings]] = false;
            break;
        case QC__PENDING:
            if (!forward->is_pending[R->index]) forward->pending[forward->pendings++] = R->index;
            forward->is_pending[R->index] = true;
            break;
        }
        J->used = R->begin;
    }
}

qc_status qc_factor_begin(qc_ctx *ctx, qc_factor *F) {
    qc_status status = qc__factor_check(ctx, F, F->components, true);
    if (status == QC_OK) status = qc__modify_open(ctx, F);
    if (status != QC_OK) return status;
    qc__journal *J = &F->modify->journal;
    if (!qc__reserve(ctx, (void **)&J->savepoint, &J->savepoints_size, J->savepoints + 1,
                     sizeof *J->savepoint))
        return QC_ERR_NOMEM;
    qc__journal_begin(F);
    J->savepoint[J->savepoints++] = J->records;
    return QC_OK;
}

qc_status qc_factor_commit(qc_ctx *ctx, qc_factor *F) {
    if (!F->modify || F->modify->journal.savepoints == 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no transaction to commit: begin one");
    F->modify->journal.savepoints--;
    qc__journal_begin(F);
    return QC_OK;
}

qc_status qc_factor_rollback(qc_ctx *ctx, qc_factor *F) {
    qc__journal *J = F->modify ? &F->modify->journal : NULL;
    if (!J || (J->savepoints == 0 && !J->undoable))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no modification to roll back");
    qc__journal_roll_back(F, J->savepoints > 0 ? J->savepoint[--J->savepoints] : 0);
    J->undoable = false;
    return QC_OK;
}
