/* What a factor needs once it is modified. */
#include "sdk/sparse/modify/modify.h"

static void modify_free(struct qc__modify *M) {
    if (!M) return;
    qc__forward_free(M->forward);
    qc__free(M->journal.data);
    qc__free(M->journal.record);
    qc__free(M->journal.savepoint);
    qc__free(M->path);
    qc__free(M->head);
    qc__free(M->item);
    qc__free(M->work);
    qc__free(M->pointer);
    qc__free(M);
}

qc_status qc__modify_open(qc_ctx *ctx, qc_factor *F) {
    if (F->modify) return QC_OK;
    const int64_t ns = F->S->nsuper;
    struct qc__modify *M = QC__ZERO(ctx, struct qc__modify, 1);
    if (!M) return QC_ERR_NOMEM;
    M->path = QC__NEW(ctx, int32_t, ns);
    M->head = QC__NEW(ctx, int32_t, ns);
    if (!M->path || !M->head) {
        modify_free(M);
        return QC_ERR_NOMEM;
    }
    for (int64_t s = 0; s < ns; s++) M->head[s] = QC__OFF_PATH;
    F->modify = M;
    return QC_OK;
}

void qc__modify_free(qc_factor *F) {
    modify_free(F->modify);
    F->modify = NULL;
}

void qc__modify_reset(qc_factor *F) {
    if (!F->modify) return;
    F->modify->journal.savepoints = 0;
    qc__journal_begin(F);
    if (F->modify->forward) F->modify->forward->stale = true;
}
