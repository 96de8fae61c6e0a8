/* What a factorisation needs beside the factor: the shared area of update matrices and, per worker,
 * a stack of update matrices, the work of a front and its pivot floors, in one block each. */
#include "sdk/sparse/internal.h"

void qc__workspace_free(qc__workspace *space) {
    if (!space) return;
    for (uint32_t t = 0; space->stack && t < space->workers; t++) qc__free(space->stack[t]);
    qc__free(space->stack);
    qc__free(space->area);
    qc__free(space->failed);
    qc__free(space);
}

qc__workspace *qc__workspace_create(qc_ctx *ctx, const qc__plan *plan, int32_t components,
                                    uint32_t workers) {
    qc__workspace *space = QC__ZERO(ctx, qc__workspace, 1);
    if (!space) return NULL;
    const int64_t stack = components * plan->stack;
    space->workers = workers;
    space->area = QC__NEW(ctx, double, components * plan->area);
    space->failed = QC__NEW(ctx, int32_t, plan->ntask);
    space->stack = QC__ZERO(ctx, double *, 3 * (size_t)workers);
    bool ok = space->area && space->failed && space->stack;
    for (uint32_t t = 0; ok && t < workers; t++) {
        double *block = QC__NEW(ctx, double, stack + plan->work + plan->largest_width);
        ok = block != NULL;
        space->stack[t] = block;
        if (!ok) break;
        space->work = space->stack + workers;
        space->floor = space->work + workers;
        space->work[t] = block + stack;
        space->floor[t] = space->work[t] + plan->work;
    }
    if (ok) return space;
    qc__workspace_free(space);
    return NULL;
}
