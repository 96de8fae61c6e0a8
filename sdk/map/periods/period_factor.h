/* The Cholesky factor of a period matrix. Internal to sdk/map. */
#ifndef QC_MAP_PERIOD_FACTOR_H
#define QC_MAP_PERIOD_FACTOR_H

#include "sdk/map/periods/period_matrix.h"

typedef struct qc__period_factor {
    qc_symbolic *symbolic;
    qc_factor *factor;
} qc__period_factor;

/* Of P (n^2) and a little more on its diagonal, since P is only semidefinite where a variable moves
 * nothing. Errors: NOMEM, those of the factorisation. */
qc_status qc__period_factor_create(qc_ctx *ctx, int32_t n, const double *P, qc__period_factor *out);
void qc__period_factor_free(qc__period_factor *factor);

#endif
