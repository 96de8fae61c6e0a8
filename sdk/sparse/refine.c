/* Solve with iterative refinement: x <- x + A^{-1} (b - A x). */
#include "sdk/sparse/internal.h"
#include <math.h>
#include <string.h>

static double modulus(qc_complex z) {
    return hypot(z.re, z.im);
}

static void subtract(qc_complex *y, qc_complex a, qc_complex x, double sign) {
    const double im = sign * a.im;
    y->re -= a.re * x.re - im * x.im;
    y->im -= a.re * x.im + im * x.re;
}

void qc__residual(const qc_hermitian *A, const qc_complex *b, const qc_complex *x, qc_complex *r) {
    memcpy(r, b, (size_t)A->n * sizeof *r);
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = A->row[p];
            if (i == j) {
                subtract(&r[j], (qc_complex){A->val[p].re, 0}, x[j], 1);
            } else {
                subtract(&r[i], A->val[p], x[j], 1);
                subtract(&r[j], A->val[p], x[i], -1);
            }
        }
}

static double largest(const qc_complex *x, int64_t n) {
    double max = 0;
    for (int64_t i = 0; i < n; i++) max = fmax(max, modulus(x[i]));
    return max;
}

double qc__residual_size(const qc_hermitian *A, const qc_complex *b, const qc_complex *x,
                         qc_complex *r) {
    qc__residual(A, b, x, r);
    const int32_t n = A->n;
    const double scale = largest(A->val, A->colptr[n]) * largest(x, n) + largest(b, n);
    return scale > 0 ? largest(r, n) / scale : 0;
}

qc_status qc_solve_refined(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A, int32_t steps,
                           qc_complex *x, double *residual) {
    const int32_t n = A->n;
    qc_status status = qc__factor_check(ctx, F, 2, true);
    if (status != QC_OK) return status;
    if (n != F->S->n || steps < 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "refinement needs the matrix of the factor and steps >= 0");
    qc_complex *r = QC__NEW(ctx, qc_complex, n), *solution = QC__NEW(ctx, qc_complex, n);
    if (!r || !solution) {
        status = QC_ERR_NOMEM;
        goto done;
    }
    if (n > 0) memcpy(solution, x, (size_t)n * sizeof *x);
    status = qc_solve(ctx, F, 1, solution);
    for (int32_t k = 0; k < steps && status == QC_OK; k++) {
        qc__residual(A, x, solution, r);
        status = qc_solve(ctx, F, 1, r);
        for (int32_t i = 0; i < n && status == QC_OK; i++) {
            solution[i].re += r[i].re;
            solution[i].im += r[i].im;
        }
        if (status == QC_OK && !qc__progress(ctx, (k + 1.0) / steps)) status = QC_ERR_CANCELLED;
    }
    if (status != QC_OK) goto done;
    if (residual) *residual = qc__residual_size(A, x, solution, r);
    if (n > 0) memcpy(x, solution, (size_t)n * sizeof *x);
done:
    qc__free(r);
    qc__free(solution);
    return status;
}
