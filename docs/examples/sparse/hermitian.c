/* Complex Hermitian matrices: factor, solve, and the same with one coupling changed in place. */
#include <qc/sparse.h>
#include <stdio.h>

int main(void) {
    /* [ 4  i  1 ]                                              */
    /* [-i  4  0 ]   upper triangle by columns, rows sorted     */
    /* [ 1  0  4 ]                                              */
    const int64_t colptr[] = {0, 1, 3, 5};
    const int32_t row[] = {0, 0, 1, 0, 2};
    const qc_complex val[] = {{4, 0}, {0, 1}, {4, 0}, {1, 0}, {4, 0}};
    const qc_hermitian A = {3, colptr, row, val};
    qc_complex x[] = {{1, 0}, {0, 0}, {0, 0}}, y[] = {{1, 0}, {0, 0}, {0, 0}};
    qc_ctx *ctx = NULL;
    qc_symbolic *S = NULL;
    qc_factor *F = NULL;
    if (qc_ctx_create(NULL, &ctx) != QC_OK) return 1;
    qc_status status = qc_analyze(ctx, &A, NULL, &S);
    if (status == QC_OK) status = qc_factorize(ctx, S, &A, &F);
    if (status == QC_OK) status = qc_solve(ctx, F, 1, x);
    /* A01 += -i and A10 += i: rank 2, one positive and one negative eigenvalue, in one sweep. */
    const qc_complex change = {0, -1}, none = {0, 0};
    if (status == QC_OK) status = qc_flip(ctx, F, 0, 1, change, 2, none);
    if (status == QC_OK) status = qc_solve(ctx, F, 1, y);
    if (status == QC_OK) {
        printf("x0 = %.6f %+.6fi\n", x[0].re, x[0].im);                      /* 2/7          */
        printf("y0 = %.6f, log det = %.6f\n", y[0].re, qc_factor_logdet(F)); /* 4/15, log 60 */
    } else {
        fprintf(stderr, "hermitian: %s\n", qc_ctx_error(ctx)->text);
    }
    qc_factor_free(F);
    qc_symbolic_free(S);
    qc_ctx_free(ctx);
    return status == QC_OK ? 0 : 1;
}
