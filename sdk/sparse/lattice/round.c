/* Rounding to a lattice: integers z with small 1/2 (z - t)^T P (z - t) (thesis 6.3), from a start
 * of nearest integers or of greedy fixing, improved by local search. With a budget, start and large
 * neighbourhood search run in a reduced basis, and local search in the given one comes last. */
#include "sdk/sparse/lattice/internal.h"
#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { REDUCTION = 2000 }; /* times n^2: at most for the reduction, which needs some hundreds */

/* Near the optimum up to n = 500, then time becomes linear. */
static int64_t default_budget(int64_t n) {
    return 1000 * n * (n < 500 ? n : 500);
}

double qc__lattice_gradient(qc__lattice *Q) {
    const int64_t n = Q->n;
    double energy = 0;
    memset(Q->g, 0, (size_t)n * sizeof *Q->g);
    for (int64_t j = 0; j < n; j++) {
        const double d = Q->z[j] - Q->t[j];
        for (int64_t i = 0; i < n; i++) Q->g[i] += Q->P[i + j * n] * d;
    }
    for (int64_t i = 0; i < n; i++) energy += 0.5 * Q->g[i] * (Q->z[i] - Q->t[i]);
    return energy;
}

static qc_status check(qc_ctx *ctx, int32_t n, const double *P, const double *t,
                       const qc_lattice_options *options, const double *z) {
    if (n < 0 || (n > 0 && (!P || !t || !z)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "rounding needs n >= 0, P, t and z");
    if (options->radius < 0 || options->radius > 3)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "rounding radius %d is not in 0..3",
                        (int)options->radius);
    if (options->start != QC_ROUND_DIRECT && options->start != QC_ROUND_GREEDY)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "unknown rounding start %d", (int)options->start);
    for (int32_t i = 0; i < n; i++)
        if (!isfinite(t[i]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, i, "rounding target %d is not finite", (int)i);
    return QC_OK;
}

/* C <- Cholesky factor of P, then with `invert` P^{-1}; lower triangle. Returns the first row whose
 * pivot is too small, or -1. */
static int32_t decompose(int32_t n, const double *P, bool invert, double *C) {
    memcpy(C, P, (size_t)n * (size_t)n * sizeof *C);
    int32_t bad = -1;
    qc__blas_begin();
    const int32_t info = (int32_t)LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, C, n);
    if (info > 0) bad = info - 1;
    for (int64_t i = 0; i < n && bad < 0; i++)
        if (!(C[i + i * n] * C[i + i * n] > qc__pivot_floor(n, P[i + i * n]))) bad = (int32_t)i;
    if (bad < 0 && invert) LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', n, C, n);
    qc__blas_end();
    return bad;
}

/* The entries of z near t which the start in this basis finds. C: P^{-1}, destroyed. */
static qc_status begin(qc_ctx *ctx, qc__lattice *Q, int32_t start, double *C) {
    for (int32_t i = 0; i < Q->n; i++) Q->z[i] = qc__lattice_nearest(Q->t[i]);
    return start == QC_ROUND_GREEDY ? qc__lattice_greedy(ctx, Q, C) : QC_OK;
}

/* Writes t = z + U s and searches y near s in the basis U; z <- z + U y. z: nearest to t. */
static qc_status search_reduced(qc_ctx *ctx, qc__lattice *Q, const qc_lattice_options *options,
                                int64_t budget, double *C) {
    const int64_t n = Q->n;
    double *U = QC__NEW(ctx, double, 2 * n * n), *vectors = QC__NEW(ctx, double, 3 * n);
    qc_status status = U && vectors ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        double *s = vectors, *y = vectors + n;
        for (int64_t i = 0; i < n; i++) s[i] = Q->t[i] - Q->z[i];
        qc__lattice_basis B = {n, U, U + n * n, s, 0, REDUCTION * n * n};
        status = qc__lattice_reduce(ctx, &B, Q->P, C);
        qc__lattice L = {(int32_t)n, B.G, s, y, y + n, 0, 0, 0};
        const bool greedy = options->start == QC_ROUND_GREEDY;
        const bool regular = status == QC_OK && (!greedy || decompose(L.n, B.G, true, C) < 0);
        if (regular && greedy) status = begin(ctx, &L, options->start, C);
        if (regular && !greedy) memset(y, 0, (size_t)n * sizeof *y);
        if (regular && status == QC_OK)
            status = qc__lattice_neighbourhoods(ctx, &L, options->seed, budget);
        for (int64_t j = 0; j < n && regular && status == QC_OK; j++)
            for (int64_t i = 0; i < n; i++) Q->z[i] += U[i + j * n] * y[j];
        Q->moves += L.moves;
        Q->evaluations += L.evaluations;
    }
    qc__free(U);
    qc__free(vectors);
    return status;
}

/* Q has z and g; C: n x n space */
static qc_status round_lattice(qc_ctx *ctx, qc__lattice *Q, const qc_lattice_options *options,
                               double *C, qc_lattice_result *result) {
    const int64_t n = Q->n;
    const int64_t budget = options->budget < 0 ? default_budget(n) : options->budget;
    const bool large = budget > 0 && options->radius > 0;
    if (!qc__progress(ctx, 0.0)) return QC_ERR_CANCELLED;
    const int32_t bad = decompose(Q->n, Q->P, !large && options->start == QC_ROUND_GREEDY, C);
    if (bad >= 0)
        return qc__fail(ctx, QC_ERR_NOT_POSDEF, bad,
                        "rounding matrix is not positive definite at row %d", (int)bad);
    for (int32_t i = 0; i < Q->n; i++) Q->z[i] = qc__lattice_nearest(Q->t[i]);
    const double direct = qc__lattice_gradient(Q);
    qc__range outer = qc__range_begin(ctx, NULL, 0.0, 0.8);
    qc_status status =
        large ? search_reduced(ctx, Q, options, budget, C) : begin(ctx, Q, options->start, C);
    qc__range_end(ctx, outer);
    outer = qc__range_begin(ctx, NULL, 0.8, 1.0);
    if (status == QC_OK) status = qc__lattice_search(ctx, Q, options->radius);
    qc__range_end(ctx, outer);
    if (status == QC_OK)
        *result = (qc_lattice_result){qc__lattice_gradient(Q), direct, Q->moves, Q->evaluations};
    return status;
}

qc_status qc_lattice_round(qc_ctx *ctx, int32_t n, const double *P, const double *t,
                           const qc_lattice_options *given, double *z, qc_lattice_result *result) {
    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
    qc_lattice_result found = {0, 0, 0, 0};
    if (given)
        memcpy(&options, given,
               given->struct_size < sizeof options ? given->struct_size : sizeof options);
    qc_status status = check(ctx, n, P, t, &options, z);
    if (status == QC_OK && n > 0) status = qc__blas_reserve(ctx);
    if (status != QC_OK) return status;
    double *C = QC__NEW(ctx, double, (size_t)n *(size_t)n);
    double *vectors = QC__NEW(ctx, double, 2 * (size_t)n);
    if (!C || !vectors) {
        status = QC_ERR_NOMEM;
    } else if (n > 0) {
        qc__lattice Q = {n, P, t, vectors, vectors + n, 0, 0, 0};
        status = round_lattice(ctx, &Q, &options, C, &found);
        if (status == QC_OK) memcpy(z, Q.z, (size_t)n * sizeof *z);
    }
    if (status == QC_OK && result) *result = found;
    qc__free(C);
    qc__free(vectors);
    return status;
}
