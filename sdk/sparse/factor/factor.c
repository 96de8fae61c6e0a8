/* The numeric factor as an object: create, check, free, scalar summaries. */
#include "sdk/sparse/internal.h"
#include <math.h>

qc_status qc__factor_create(qc_ctx *ctx, const qc_symbolic *S, int32_t components,
                            qc_factor **out) {
    qc_factor *F = QC__ZERO(ctx, qc_factor, 1);
    if (!F) return QC_ERR_NOMEM;
    F->S = qc__symbolic_retain(S);
    F->components = components;
    F->kernels = qc__kernels_for(qc__ctx_isa(ctx), components);
    F->values = QC__NEW(ctx, double, components *(S->panel[S->nsuper] + QC__SOLVE_PAD));
    F->D = QC__NEW(ctx, double, S->n);
    F->diagonal = QC__NEW(ctx, double, S->n);
    if (!F->values || !F->D || !F->diagonal) {
        qc_factor_free(F);
        return QC_ERR_NOMEM;
    }
    *out = F;
    return QC_OK;
}

void qc_factor_free(qc_factor *F) {
    if (!F) return;
    qc_symbolic_free(F->S);
    qc__workspace_free(F->workspace);
    qc__free(F->values);
    qc__free(F->D);
    qc__free(F->diagonal);
    qc__modify_free(F);
    qc__free(F);
}

qc_status qc__factor_check(qc_ctx *ctx, const qc_factor *F, int32_t components, bool values) {
    if (F->components != components)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "factor is %s: call the %s function",
                        F->components == 1 ? "real" : "complex",
                        F->components == 1 ? "_real" : "complex");
    if (values && !F->usable)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "factor has no values since its last refactorisation failed");
    return QC_OK;
}

double qc_factor_logdet(const qc_factor *F) {
    double sum = 0;
    for (int32_t k = 0; k < F->S->n; k++) sum += log(F->D[k]);
    return sum;
}

void qc_factor_pivots(const qc_factor *F, double *smallest, double *largest) {
    double lo = F->S->n > 0 ? F->D[0] : 1, hi = lo;
    for (int32_t k = 1; k < F->S->n; k++) {
        if (F->D[k] < lo) lo = F->D[k];
        if (F->D[k] > hi) hi = F->D[k];
    }
    if (smallest) *smallest = lo;
    if (largest) *largest = hi;
}
