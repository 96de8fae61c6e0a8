/* Iterative refinement in working precision: x <- x + A^{-1} (b - A x). It makes the componentwise
 * backward error small (Skeel 1980),
 *     omega = max_i |b - A x|_i / (|A| |x| + |b|)_i        (Oettli, Prager 1964),
 * the least relative change of every entry of A and b which makes x exact. */
#include "sdk/sparse/internal.h"
#include <math.h>
#include <string.h>

typedef struct run {
    qc__view A;
    const double *b, *x; /* n x nrhs */
    double *r, *scale;   /* n x nrhs; n for each worker */
    double *omega;       /* by right-hand side */
} run;

/* |z| = |re| + |im| is within sqrt(2) and needs no root. */
static double size_of(int32_t nc, const double *z) {
    return fabs(z[0]) + (nc == 2 ? fabs(z[1]) : 0);
}

/* y -= a x, or conj(a) x */
static void subtract(int32_t nc, const double *a, bool conjugate, const double *x, double *y) {
    if (nc == 1) {
        y[0] -= a[0] * x[0];
    } else {
        const double im = conjugate ? -a[1] : a[1];
        y[0] -= a[0] * x[0] - im * x[1];
        y[1] -= a[0] * x[1] + im * x[0];
    }
}

/* r <- b - A x, scale <- |A| |x| + |b| */
static void residual(qc__view A, const double *b, const double *x, double *r, double *scale) {
    const int32_t nc = A.components;
    memcpy(r, b, (size_t)nc * (size_t)A.n * sizeof *r);
    for (int32_t i = 0; i < A.n; i++) scale[i] = size_of(nc, b + nc * (int64_t)i);
    for (int64_t j = 0; j < A.n; j++)
        for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++) {
            const int64_t i = A.row[p];
            const double *a = A.val + nc * p, real[2] = {a[0], 0};
            const double size = size_of(nc, i == j ? real : a);
            subtract(nc, i == j ? real : a, false, x + nc * j, r + nc * i);
            scale[i] += size * size_of(nc, x + nc * j);
            if (i == j) continue;
            subtract(nc, a, true, x + nc * i, r + nc * j);
            scale[j] += size * size_of(nc, x + nc * i);
        }
}

static void run_columns(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    const int64_t n = R->A.n, nc = R->A.components;
    double *scale = R->scale + n * worker;
    for (int64_t q = begin; q < end; q++) {
        double *r = R->r + nc * n * q;
        residual(R->A, R->b + nc * n * q, R->x + nc * n * q, r, scale);
        double *omega = &R->omega[q];
        *omega = 0;
        for (int64_t i = 0; i < n; i++) {
            const double size = size_of(R->A.components, r + nc * i);
            const double ratio = size == 0 ? 0 : size / scale[i];
            if (ratio > *omega || isnan(ratio)) *omega = ratio;
        }
    }
}

static double backward_error(qc_ctx *ctx, run *R, int32_t nrhs) {
    double omega = 0;
    qc__parallel_for(ctx, nrhs, 1, run_columns, R);
    for (int32_t q = 0; q < nrhs; q++)
        if (R->omega[q] > omega || isnan(R->omega[q])) omega = R->omega[q];
    return omega;
}

static qc_status refine(qc_ctx *ctx, run *R, int32_t nrhs, int32_t steps, qc__solve_any *solve,
                        void *arg, double *x, double *error) {
    const int64_t count = R->A.components * (int64_t)R->A.n * nrhs;
    qc_status status = solve(ctx, arg, nrhs, x);
    R->x = x;
    for (int32_t k = 0; status == QC_OK && (k < steps || error); k++) {
        const double omega = backward_error(ctx, R, nrhs);
        if (error) *error = omega;
        if (k == steps || omega <= QC__EPS) break;
        status = solve(ctx, arg, nrhs, R->r);
        for (int64_t i = 0; status == QC_OK && i < count; i++) x[i] += R->r[i];
        if (status == QC_OK && !qc__progress(ctx, (k + 1.0) / steps)) status = QC_ERR_CANCELLED;
    }
    return status;
}

qc_status qc__refine(qc_ctx *ctx, qc__view A, int32_t nrhs, int32_t steps, qc__solve_any *solve,
                     void *arg, double *x, double *error) {
    if (nrhs < 0 || steps < 0 || (nrhs > 0 && A.n > 0 && !x))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "refinement needs nrhs >= 0, steps >= 0 and an array");
    const int64_t count = A.components * (int64_t)A.n * nrhs;
    double *solution = QC__NEW(ctx, double, count), omega = 0;
    run R = {A,
             x,
             NULL,
             QC__NEW(ctx, double, count),
             QC__NEW(ctx, double, (int64_t)A.n *qc_ctx_threads(ctx)),
             QC__NEW(ctx, double, nrhs)};
    qc_status status = QC_ERR_NOMEM;
    if (solution && R.r && R.scale && R.omega) {
        if (count > 0) memcpy(solution, x, (size_t)count * sizeof *x);
        status = refine(ctx, &R, nrhs, steps, solve, arg, solution, error ? &omega : NULL);
        if (status == QC_OK && count > 0) memcpy(x, solution, (size_t)count * sizeof *x);
        if (status == QC_OK && error) *error = omega;
    }
    qc__free(solution);
    qc__free(R.r);
    qc__free(R.scale);
    qc__free(R.omega);
    return status;
}

static qc_status solve_with(qc_ctx *ctx, void *arg, int32_t nrhs, double *x) {
    const qc_factor *F = *(const qc_factor **)arg;
    return F->components == 2 ? qc_solve(ctx, F, nrhs, (qc_complex *)x)
                              : qc_solve_real(ctx, F, nrhs, x);
}

static qc_status solve_refined(qc_ctx *ctx, const qc_factor *F, qc__view A, int32_t nrhs,
                               int32_t steps, double *x, double *error) {
    const qc_status status = qc__factor_check(ctx, F, A.components, true);
    if (status != QC_OK) return status;
    if (A.n != F->S->n)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the matrix has %d rows, the factor %d", (int)A.n,
                        (int)F->S->n);
    return qc__refine(ctx, A, nrhs, steps, solve_with, &F, x, error);
}

qc_status qc_solve_refined(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A, int32_t nrhs,
                           int32_t steps, qc_complex *x, double *error) {
    return solve_refined(ctx, F, qc__view_complex(A), nrhs, steps, (double *)x, error);
}
qc_status qc_solve_refined_real(qc_ctx *ctx, const qc_factor *F, const qc_symmetric *A,
                                int32_t nrhs, int32_t steps, double *x, double *error) {
    return solve_refined(ctx, F, qc__view_real(A), nrhs, steps, x, error);
}
