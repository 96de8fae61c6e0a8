/* Solving with a stiffness matrix: scaling, factor, one step of refinement. */
#include <math.h>

#include "sdk/dec/internal.h"

/* 2^-round(log2(a) / 2), so that a d^2 is in [1/2, 2]. */
static double half_scale(double a) {
    int exponent;
    if (!(a > 0) || !isfinite(a)) return 1;
    frexp(a, &exponent);
    return ldexp(1, -(exponent >= 0 ? exponent / 2 : -((1 - exponent) / 2)));
}

static void scale_matrix(const qc_hermitian *A, double *scale, qc_complex *val) {
    for (int32_t j = 0; j < A->n; j++) scale[j] = half_scale(A->val[A->colptr[j + 1] - 1].re);
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            val[p] = qc__scale(scale[A->row[p]] * scale[j], A->val[p]);
}

static qc_status name_pivot(qc_ctx *ctx, const qc__system *s, const char *element) {
    const int64_t pivot = qc_ctx_error(ctx)->where;
    for (int32_t i = 0; i < s->n_elements; i++)
        if (s->stiffness->unknown[i] >= 0 && s->stiffness->unknown[i] == pivot)
            return qc__fail(
                ctx, QC_ERR_NOT_POSDEF, i,
                "the stiffness matrix is singular at %s %d; repair the mesh (faces without area)",
                element, (int)i);
    return QC_ERR_NOT_POSDEF;
}

static qc_status factorise(qc_ctx *ctx, qc__system *s, const char *element) {
    qc_hermitian A = s->stiffness->A;
    scale_matrix(&A, s->scale, s->val);
    A.val = s->val;
    const qc_status status = s->solver->factorize(ctx, s->factor, &A);
    return status == QC_ERR_NOT_POSDEF ? name_pivot(ctx, s, element) : status;
}

qc_status qc__system_create(qc_ctx *ctx, const qc_solver *solver, const qc_stiffness *stiffness,
                            int32_t n_elements, const char *element, qc__system *out) {
    const qc_hermitian *A = &stiffness->A;
    qc__system s = {stiffness, solver ? solver : &qc_solver_builtin, n_elements, NULL, NULL, NULL};
    qc_status status = qc_solver_check(ctx, s.solver);
    if (status == QC_OK && A->n > 0) {
        s.scale = QC__NEW(ctx, double, A->n);
        s.val = QC__NEW(ctx, qc_complex, A->colptr[A->n]);
        status = s.scale && s.val ? QC_OK : QC_ERR_NOMEM;
        if (status == QC_OK) status = s.solver->analyze(s.solver, ctx, A, NULL, &s.factor);
        if (status == QC_OK) status = factorise(ctx, &s, element);
    }
    if (status != QC_OK)
        qc__system_free(&s);
    else
        *out = s;
    return status;
}

qc_status qc__system_update(qc_ctx *ctx, qc__system *s, const qc_stiffness *stiffness,
                            const char *element) {
    s->stiffness = stiffness;
    return stiffness->A.n > 0 ? factorise(ctx, s, element) : QC_OK;
}

void qc__system_free(qc__system *s) {
    qc__free(s->scale);
    qc__free(s->val);
    if (s->factor) s->solver->destroy(s->factor);
}

qc_status qc__system_solve(qc_ctx *ctx, const qc__system *s, qc_complex *x) {
    qc_hermitian A = s->stiffness->A;
    A.val = s->val;
    const int32_t *unknown = s->stiffness->unknown;
    qc_complex *b = QC__NEW(ctx, qc_complex, A.n);
    if (!b) return QC_ERR_NOMEM;
    qc_status status = QC_OK;
    if (A.n > 0) {
        for (int32_t i = 0; i < s->n_elements; i++)
            if (unknown[i] >= 0) b[unknown[i]] = qc__scale(s->scale[unknown[i]], x[i]);
        status = qc_solver_solve_refined(ctx, s->solver, s->factor, &A, 1, b, NULL);
    }
    for (int32_t i = 0; status == QC_OK && i < s->n_elements; i++) {
        const qc_complex zero = {0, 0};
        x[i] = unknown[i] < 0 ? zero : qc__scale(s->scale[unknown[i]], b[unknown[i]]);
    }
    qc__free(b);
    return status;
}
