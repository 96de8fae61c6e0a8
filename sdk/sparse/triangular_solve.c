/* Triangular solves with the supernodal factor. Right-hand sides travel in blocks of one or eight;
 * inside a block, row i holds the real parts and then the imaginary parts of all its columns, so
 * that every entry of L is read once per block. Compiled twice, see scalar.h. */
#include "sdk/sparse/scalar.h"
#include <math.h>
#include <string.h>

enum { BLOCK = 8 };

/* y -= l x, with l conjugated for sign = -1 */
static inline void subtract(const int nb, const double *l, double sign, const double *restrict x,
                            double *restrict y) {
    const double re = l[0], im = NC == 2 ? sign * l[NC - 1] : 0;
    for (int q = 0; q < nb; q++) {
        if (NC == 1) {
            y[q] -= re * x[q];
        } else {
            y[q] -= re * x[q] - im * x[nb + q];
            y[nb + q] -= re * x[nb + q] + im * x[q];
        }
    }
}

static inline void copy_row(int64_t row, const double *restrict x, double *restrict y) {
    for (int64_t q = 0; q < row; q++) y[q] = x[q];
}

static inline void add_row(int64_t row, const double *restrict x, double *restrict y) {
    for (int64_t q = 0; q < row; q++) y[q] += x[q];
}

/* Y <- L^{-1} Y within one supernode; t: rows below the diagonal block. */
static inline void forward_supernode(const int nb, const qc_factor *F, int32_t s, double *Y,
                                     double *t) {
    const qc_symbolic *S = F->S;
    const int64_t row = NC * nb, first = S->super[s], w = S->super[s + 1] - first;
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s], m = r - w;
    const int32_t *below = S->rows + S->rowptr[s] + w;
    const double *L = F->values + NC * S->panel[s];
    double *x = Y + row * first;
    memset(t, 0, (size_t)(row * m) * sizeof *t);
    for (int64_t k = 0; k < w; k++, L += NC * r) {
        for (int64_t i = k + 1; i < w; i++) subtract(nb, L + NC * i, 1, x + row * k, x + row * i);
        for (int64_t i = 0; i < m; i++) subtract(nb, L + NC * (w + i), 1, x + row * k, t + row * i);
    }
    for (int64_t i = 0; i < m; i++) add_row(row, t + row * i, Y + row * below[i]);
}

/* y -= sum_i conj(l_i) x_i over n rows. Backward, as the supernodes go: one stream from memory. */
static inline void subtract_dot(const int nb, int64_t n, const double *l, const double *x,
                                double *y) {
    double sum[NC * BLOCK] = {0};
    for (int64_t i = n; i-- > 0;) subtract(nb, l + NC * i, -1, x + NC * nb * i, sum);
    for (int c = 0; c < NC * nb; c++) y[c] += sum[c];
}

/* The same for four columns of L and one right-hand side: the sums do not wait for each other. */
static void subtract_four_dots(int64_t n, const double *L, int64_t ld, const double *x, double *y) {
    const double *l0 = L, *l1 = l0 + NC * ld, *l2 = l1 + NC * ld, *l3 = l2 + NC * ld;
    double a0[2] = {0, 0}, a1[2] = {0, 0}, a2[2] = {0, 0}, a3[2] = {0, 0};
    for (int64_t i = NC * (n - 1); i >= 0; i -= NC) {
        subtract(1, l0 + i, -1, x + i, a0);
        subtract(1, l1 + i, -1, x + i, a1);
        subtract(1, l2 + i, -1, x + i, a2);
        subtract(1, l3 + i, -1, x + i, a3);
    }
    for (int c = 0; c < NC; c++) {
        y[c] += a0[c];
        y[NC + c] += a1[c];
        y[2 * NC + c] += a2[c];
        y[3 * NC + c] += a3[c];
    }
}

/* Y <- L^{-H} Y within one supernode, by groups of up to four columns: first all rows below the
 * group, then its own triangle. t: all rows of the supernode. */
static inline void backward_supernode(const int nb, const qc_factor *F, int32_t s, double *Y,
                                      double *t) {
    const qc_symbolic *S = F->S;
    const int64_t row = NC * nb, first = S->super[s], w = S->super[s + 1] - first;
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s];
    const int32_t *rows = S->rows + S->rowptr[s];
    const double *L = F->values + NC * S->panel[s];
    for (int64_t i = 0; i < r; i++) copy_row(row, Y + row * rows[i], t + row * i);
    for (int64_t end = w; end > 0;) {
        const int64_t begin = end >= 4 ? end - 4 : 0;
        if (nb == 1 && end - begin == 4) {
            subtract_four_dots(r - end, L + NC * (end + begin * r), r, t + row * end,
                               t + row * begin);
        } else {
            for (int64_t k = end; k-- > begin;)
                subtract_dot(nb, r - end, L + NC * (end + k * r), t + row * end, t + row * k);
        }
        for (int64_t k = end - 1; k-- > begin;)
            for (int64_t i = k + 1; i < end; i++)
                subtract(nb, L + NC * (i + k * r), -1, t + row * i, t + row * k);
        end = begin;
    }
    for (int64_t k = 0; k < w; k++) copy_row(row, t + row * k, Y + row * (first + k));
}

typedef struct run {
    const qc_factor *F;
    bool forward_only;
    int64_t nrhs, first_block;
    double *x;
    double **work; /* by block of one call: Y, then t */
} run;

static inline void solve_block(const int nb, const run *R, int64_t column, int64_t columns,
                               double *Y, double *t) {
    const qc_symbolic *S = R->F->S;
    const int64_t n = S->n, row = NC * nb;
    const double *D = R->F->D;
    if (columns < nb) memset(Y, 0, (size_t)(row * n) * sizeof *Y);
    for (int64_t k = 0; k < n; k++)
        for (int64_t q = 0; q < columns; q++)
            for (int c = 0; c < NC; c++)
                Y[row * k + c * nb + q] = R->x[NC * ((column + q) * n + S->perm[k]) + c];
    for (int32_t s = 0; s < S->nsuper; s++) forward_supernode(nb, R->F, s, Y, t);
    for (int64_t k = 0; k < n; k++) {
        const double scale = R->forward_only ? 1 / sqrt(D[k]) : 1 / D[k];
        for (int64_t q = 0; q < row; q++) Y[row * k + q] *= scale;
    }
    for (int32_t s = S->nsuper; !R->forward_only && s-- > 0;) backward_supernode(nb, R->F, s, Y, t);
    for (int64_t k = 0; k < n; k++) {
        const int64_t to = R->forward_only ? k : S->perm[k];
        for (int64_t q = 0; q < columns; q++)
            for (int c = 0; c < NC; c++)
                R->x[NC * ((column + q) * n + to) + c] = Y[row * k + c * nb + q];
    }
}

static void run_blocks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    (void)worker; /* may be any of the pool, also one beyond the blocks of this call */
    for (int64_t b = R->first_block + begin; b < R->first_block + end; b++) {
        const int64_t column = b * BLOCK, left = R->nrhs - column;
        const int64_t columns = left < BLOCK ? left : BLOCK;
        const int64_t nb = columns == 1 ? 1 : BLOCK;
        double *Y = R->work[b - R->first_block], *t = Y + NC * nb * R->F->S->n;
        if (nb == 1)
            solve_block(1, R, column, columns, Y, t);
        else
            solve_block(BLOCK, R, column, columns, Y, t);
    }
}

static qc_status solve(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, scalar *x,
                       bool forward_only) {
    qc_status status = qc__factor_check(ctx, F, NC, true);
    if (status != QC_OK) return status;
    if (nrhs < 0 || (nrhs > 0 && F->S->n > 0 && !x))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "solve needs nrhs >= 0 and an array");
    if (nrhs == 0 || F->S->n == 0) return QC_OK;
    const int64_t blocks = (nrhs + BLOCK - 1) / BLOCK, nb = nrhs == 1 ? 1 : BLOCK;
    const int64_t threads = qc_ctx_threads(ctx), workers = blocks < threads ? blocks : threads;
    run R = {F, forward_only, nrhs, 0, (double *)x, QC__ZERO(ctx, double *, threads)};
    if (!R.work) return QC_ERR_NOMEM;
    for (int64_t t = 0; t < workers && status == QC_OK; t++) {
        R.work[t] = QC__NEW(ctx, double, NC *nb *((int64_t)F->S->n + F->S->plan.largest_front));
        if (!R.work[t]) status = QC_ERR_NOMEM;
    }
    for (; R.first_block < blocks && status == QC_OK; R.first_block += workers) {
        const int64_t left = blocks - R.first_block;
        qc__parallel_for(ctx, left < workers ? left : workers, 1, run_blocks, &R);
        if (blocks > workers && !qc__progress(ctx, (double)R.first_block / (double)blocks))
            status = QC_ERR_CANCELLED;
    }
    for (int64_t t = 0; t < workers; t++) qc__free(R.work[t]);
    qc__free(R.work);
    return status;
}

qc_status NAME(qc_solve)(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, scalar *x) {
    return solve(ctx, F, nrhs, x, false);
}

qc_status NAME(qc_solve_forward)(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, scalar *x) {
    return solve(ctx, F, nrhs, x, true);
}

#ifndef QC__REAL
/* L^{-1} e_k is non-zero only on the path from the supernode of k to its root. */
qc_status qc_solve_forward_sparse(qc_ctx *ctx, const qc_factor *F, int32_t nb, const int32_t *row,
                                  const qc_complex *b, qc_complex *y) {
    const qc_status status = qc__factor_check(ctx, F, NC, true);
    if (status != QC_OK) return status;
    const qc_symbolic *S = F->S;
    for (int32_t p = 0; p < nb; p++)
        if (row[p] < 0 || row[p] >= S->n)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row[p], "right-hand side has row %d of %d",
                            (int)row[p], (int)S->n);
    bool *reached = QC__ZERO(ctx, bool, S->nsuper);
    double *t = QC__NEW(ctx, double, NC *(int64_t)S->plan.largest_front);
    if (!reached || !t) {
        qc__free(reached);
        qc__free(t);
        return QC_ERR_NOMEM;
    }
    double *Y = (double *)y;
    memset(Y, 0, NC * (size_t)S->n * sizeof *Y);
    int32_t lowest = S->nsuper;
    for (int32_t p = 0; p < nb; p++) {
        const int32_t k = S->inverse[row[p]];
        Y[2 * (int64_t)k] += b[p].re;
        Y[2 * (int64_t)k + 1] += b[p].im;
        if (S->super_of[k] < lowest) lowest = S->super_of[k];
        for (int32_t s = S->super_of[k]; s != -1 && !reached[s]; s = S->parent[s])
            reached[s] = true;
    }
    for (int32_t s = lowest; s < S->nsuper; s++) {
        if (!reached[s]) continue;
        forward_supernode(1, F, s, Y, t);
        for (int64_t k = S->super[s]; k < S->super[s + 1]; k++) {
            const double scale = 1 / sqrt(F->D[k]);
            Y[2 * k] *= scale;
            Y[2 * k + 1] *= scale;
        }
    }
    qc__free(reached);
    qc__free(t);
    return QC_OK;
}
#endif
