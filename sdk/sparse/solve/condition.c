/* Condition number in the 1-norm: |A|_1 exactly, |A^{-1}|_1 from below by maximising |A^{-1} x|_1
 * over the unit ball (Hager 1984), with the safeguards of Higham 1988 (algorithm 4.1, in LAPACK
 * ?lacn2). A^{-1} is Hermitian, so its transpose costs no other kind of solve. */
#include "sdk/sparse/internal.h"
#include <math.h>
#include <string.h>

enum { ROUNDS = 5 };

static double modulus(int32_t nc, const double *z) {
    return nc == 2 ? hypot(z[0], z[1]) : fabs(z[0]);
}

static qc_status norm_of_matrix(qc_ctx *ctx, qc__view A, double *norm) {
    double *sum = QC__ZERO(ctx, double, A.n);
    if (!sum) return QC_ERR_NOMEM;
    for (int32_t j = 0; j < A.n; j++)
        for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++) {
            const int32_t i = A.row[p];
            const double a = modulus(i == j ? 1 : A.components, A.val + A.components * p);
            sum[j] += a;
            if (i != j) sum[i] += a;
        }
    *norm = 0;
    for (int32_t j = 0; j < A.n; j++) *norm = fmax(*norm, sum[j]);
    qc__free(sum);
    return QC_OK;
}

typedef struct run {
    qc_ctx *ctx;
    const qc_factor *F;
    int32_t n, nc;
    double *x; /* n */
} run;

static qc_status solve(const run *R) {
    return R->nc == 2 ? qc_solve(R->ctx, R->F, 1, (qc_complex *)R->x)
                      : qc_solve_real(R->ctx, R->F, 1, R->x);
}

static double norm_of_vector(const run *R) {
    double sum = 0;
    for (int64_t i = 0; i < R->n; i++) sum += modulus(R->nc, R->x + R->nc * i);
    return sum;
}

/* x <- x / |x| entry by entry: the subgradient of the norm */
static void take_signs(const run *R) {
    for (int64_t i = 0; i < R->n; i++) {
        double *x = R->x + R->nc * i;
        const double size = modulus(R->nc, x);
        for (int32_t c = 0; c < R->nc; c++) x[c] = size > 0 ? x[c] / size : c == 0;
    }
}

static int64_t largest_entry(const run *R) {
    int64_t j = 0;
    for (int64_t i = 1; i < R->n; i++)
        if (modulus(R->nc, R->x + R->nc * i) > modulus(R->nc, R->x + R->nc * j)) j = i;
    return j;
}

/* From one vertex of the ball to the next while the norm grows. x enters as A^{-1} e / n. */
static qc_status climb(const run *R, double *estimate) {
    int64_t at = -1;
    *estimate = norm_of_vector(R);
    for (int k = 0; k < ROUNDS; k++) {
        take_signs(R);
        qc_status status = solve(R);
        if (status != QC_OK) return status;
        const int64_t next = largest_entry(R);
        const double gain = modulus(R->nc, R->x + R->nc * next);
        if (at >= 0 && gain <= modulus(R->nc, R->x + R->nc * at)) return QC_OK;
        at = next;
        memset(R->x, 0, (size_t)R->nc * (size_t)R->n * sizeof *R->x);
        R->x[R->nc * at] = 1;
        status = solve(R);
        if (status != QC_OK) return status;
        const double norm = norm_of_vector(R);
        if (norm <= *estimate) return QC_OK;
        *estimate = norm;
    }
    return QC_OK;
}

static qc_status norm_of_inverse(const run *R, double *estimate) {
    double other = 0;
    for (int64_t i = 0; i < R->n; i++)
        for (int32_t c = 0; c < R->nc; c++) R->x[R->nc * i + c] = c == 0 ? 1.0 / R->n : 0;
    qc_status status = solve(R);
    if (status == QC_OK) status = climb(R, estimate);
    if (status != QC_OK) return status;
    /* A vector which no cancellation of the climb can fool. */
    for (int64_t i = 0; i < R->n; i++)
        for (int32_t c = 0; c < R->nc; c++) {
            const double size = 1 + (R->n > 1 ? (double)i / (R->n - 1) : 0);
            R->x[R->nc * i + c] = c > 0 ? 0 : i % 2 ? -size : size;
        }
    status = solve(R);
    if (status == QC_OK) other = 2 * norm_of_vector(R) / (3.0 * R->n);
    *estimate = fmax(*estimate, other);
    return status;
}

static qc_status condition(qc_ctx *ctx, const qc_factor *F, qc__view A, double *out) {
    double norm = 0, inverse = 0;
    qc_status status = qc__factor_check(ctx, F, A.components, true);
    if (status != QC_OK) return status;
    if (A.n != F->S->n)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the matrix has %d rows, the factor %d", (int)A.n,
                        (int)F->S->n);
    if (A.n == 0) {
        *out = 1;
        return QC_OK;
    }
    run R = {ctx, F, A.n, A.components, QC__NEW(ctx, double, A.components *(int64_t)A.n)};
    if (!R.x) return QC_ERR_NOMEM;
    status = norm_of_matrix(ctx, A, &norm);
    if (status == QC_OK) status = norm_of_inverse(&R, &inverse);
    if (status == QC_OK) *out = norm * inverse;
    qc__free(R.x);
    return status;
}

qc_status qc_condition(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A, double *out) {
    return condition(ctx, F, qc__view_complex(A), out);
}
qc_status qc_condition_real(qc_ctx *ctx, const qc_factor *F, const qc_symmetric *A, double *out) {
    return condition(ctx, F, qc__view_real(A), out);
}
