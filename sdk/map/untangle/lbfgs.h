/* Limited-memory BFGS with a caller's preconditioner. Internal to sdk/map. */
#ifndef QC_MAP_LBFGS_H
#define QC_MAP_LBFGS_H

#include "sdk/base/internal.h"

typedef struct qc__lbfgs_problem {
    int64_t n;
    void *user;
    /* Energy and gradient at x. */
    double (*evaluate)(void *user, const double *x, double *gradient);
    /* p := H0 p, a symmetric positive definite guess of the inverse Hessian; NULL = identity. */
    qc_status (*precondition)(qc_ctx *ctx, void *user, double *p);
    /* Steps along p from x are at most this long in units of p; NULL = any length. */
    double (*limit)(void *user, const double *x, const double *p);
} qc__lbfgs_problem;

/* Minimises from x in place, at most max_iterations steps; stops when a step lowers the energy by
 * less than `relative` of it. *iterations (may be NULL) counts steps. */
qc_status qc__lbfgs(qc_ctx *ctx, const qc__lbfgs_problem *problem, int32_t max_iterations,
                    double relative, double *x, double *energy, int32_t *iterations);

#endif
