/* The dense period matrix as a sparse one of one supernode (see period_factor.h). */
#include "sdk/map/periods/period_factor.h"

/* P is only semidefinite where a variable moves nothing, and where P comes from another norm. */
static const double shift = 1e-9; /* of the largest diagonal entry */

void qc__period_factor_free(qc__period_factor *f) {
    qc_factor_free(f->factor);
    qc_symbolic_free(f->symbolic);
    *f = (qc__period_factor){NULL, NULL};
}

static void fill(int32_t n, const double *P, int64_t *colptr, int32_t *row, double *value) {
    const int64_t stride = n;
    int64_t at = 0;
    double largest = 0;
    for (int32_t j = 0; j < n; j++)
        if (P[j + j * stride] > largest) largest = P[j + j * stride];
    for (int32_t j = 0; j < n; j++) {
        colptr[j] = at;
        for (int32_t i = 0; i <= j; i++, at++) {
            row[at] = i;
            value[at] = P[i + j * stride] + (i == j ? shift * largest : 0);
        }
    }
    colptr[n] = at;
}

qc_status qc__period_factor_create(qc_ctx *ctx, int32_t n, const double *P,
                                   qc__period_factor *out) {
    const int64_t entries = (int64_t)n * (n + 1) / 2;
    int64_t *colptr = QC__NEW(ctx, int64_t, n + 1);
    int32_t *row = QC__NEW(ctx, int32_t, entries);
    double *value = QC__NEW(ctx, double, entries);
    qc__period_factor f = {NULL, NULL};
    qc_status status = colptr && row && value ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        fill(n, P, colptr, row, value);
        const qc_symmetric A = {n, colptr, row, value};
        status = qc_analyze_real(ctx, &A, NULL, &f.symbolic);
        if (status == QC_OK) status = qc_factorize_real(ctx, f.symbolic, &A, &f.factor);
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(value);
    if (status == QC_OK)
        *out = f;
    else
        qc__period_factor_free(&f);
    return status;
}
