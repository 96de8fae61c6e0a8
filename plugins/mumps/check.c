/* Whether an LU factor is that of a positive definite matrix, which LU itself does not ask.
 *
 * With the diagonal D of A, S = D^-1/2 A D^-1/2 has the diagonal 1. For a random vector b of
 * entries +-1 and S y = b,
 *     |b| / |y| >= smallest singular value of S,    and about sqrt(n) times it when that is small,
 * and y is then almost the vector to it. S counts as singular when |b| / |y| <= n eps, as a pivot
 * D(j) <= n eps A(j,j) does in qc_factorize; `where` is the row in which y is largest. A positive
 * definite S has b^H y > 0 and det A > 0: a determinant which is not positive means an odd number
 * of negative eigenvalues. An even number of them, none close to zero, goes unnoticed: then the
 * solutions are those of the indefinite system. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "solver.h"

/* Below this many rows n eps would be less than what rounding leaves of a zero. */
static const double FEWEST_ROWS = 100;

qc_status qm_check_diagonal(qc_ctx *ctx, qc_solver_state *s, const qc_hermitian *A) {
    for (int32_t j = 0; j < s->n; j++) {
        const double d = A->val[A->colptr[j + 1] - 1].re;
        if (!(d > 0) || !isfinite(d))
            return qc_ctx_fail(ctx, QC_ERR_NOT_POSDEF, j,
                               "solver mumps: a diagonal entry is not positive");
        s->scale[j] = sqrt(d);
    }
    return QC_OK;
}

/* D^1/2 b; the generator is Knuth's MMIX. */
static void random_signs(const qc_solver_state *s, qc_complex *x) {
    uint64_t seed = 1;
    for (int32_t i = 0; i < s->n; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (qc_complex){seed >> 63 ? s->scale[i] : -s->scale[i], 0};
    }
}

static qc_status judge(qc_ctx *ctx, const qc_solver_state *s, const qc_complex *b,
                       const qc_complex *x) {
    double square = 0, product = 0, largest = -1;
    int32_t where = -1;
    for (int32_t i = 0; i < s->n; i++) {
        const double re = s->scale[i] * x[i].re, im = s->scale[i] * x[i].im;
        const double y2 = re * re + im * im;
        product += b[i].re * x[i].re;
        square += y2;
        if (y2 > largest || isnan(y2)) largest = y2, where = i;
        if (isnan(y2)) break;
    }
    const double rows = fmax(s->n, FEWEST_ROWS), bound = rows * DBL_EPSILON * sqrt(square);
    if (!(bound < sqrt(s->n)))
        return qc_ctx_fail(ctx, QC_ERR_NOT_POSDEF, where, "solver mumps: the matrix is singular");
    if (!(product > 0) || s->id.rinfog[11] < 0) /* RINFOG(12): mantissa of the determinant */
        return qc_ctx_fail(ctx, QC_ERR_NOT_POSDEF, -1,
                           "solver mumps: the matrix has a negative eigenvalue");
    return QC_OK;
}

qc_status qm_check_definite(qc_ctx *ctx, qc_solver_state *s) {
    if (s->id.infog[27] > 0) /* INFOG(28): null pivots */
        return qc_ctx_fail(ctx, QC_ERR_NOT_POSDEF, s->id.pivnul_list[0] - 1,
                           "solver mumps: the matrix is singular");
    qc_complex *b = malloc(2 * (size_t)s->n * sizeof *b), *x = b ? b + s->n : NULL;
    if (!b) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    random_signs(s, b);
    for (int32_t i = 0; i < s->n; i++) x[i] = b[i];
    qc_status status = qm_solve(ctx, s, 1, x);
    if (status == QC_OK) status = judge(ctx, s, b, x);
    free(b);
    return status;
}
