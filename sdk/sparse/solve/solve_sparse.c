/* Solves with sparse right-hand sides and few wanted entries: the supernodes on the paths from the
 * rows of b to the roots give L^{-1} b, those on the paths from the wanted rows give these rows of
 * L^{-H} D^{-1} y (rows of x depend on ancestors only). Values are kept by path, not by matrix. */
#include <math.h>
#include <string.h>
#include "sdk/sparse/solve/reach.h"

typedef struct run {
    const qc_factor *F;
    int32_t nc; /* doubles per entry */
    qc__reach reach;
    double *y, *u, *sum;    /* reach.own, reach.below entries; two supernodes */
    bool *nonzero, *wanted; /* by node */
} run;

static void add_entries(int32_t nc, const double *x, double *y) {
    for (int32_t c = 0; c < nc; c++) y[c] += x[c];
}

static double *value_of(const run *R, int32_t row) {
    const qc_symbolic *S = R->F->S;
    const int32_t k = S->inverse[row], s = S->super_of[k];
    const qc__reached *node = &R->reach.node[qc__reach_find(&R->reach, s)];
    return R->y + R->nc * (node->own + k - S->super[s]);
}

static void mark_paths(const run *R, int32_t n, const int32_t *row, bool *mark) {
    const qc_symbolic *S = R->F->S;
    memset(mark, 0, (size_t)R->reach.count * sizeof *mark);
    for (int32_t p = 0; p < n; p++)
        mark[qc__reach_find(&R->reach, S->super_of[S->inverse[row[p]]])] = true;
    for (int32_t k = 0; k < R->reach.count; k++)
        if (mark[k] && R->reach.node[k].parent >= 0) mark[R->reach.node[k].parent] = true;
}

/* sum: the update vectors of the children, in the order of operations of the dense solve */
static void collect(const run *R, const qc__reached *node, double *sum) {
    const qc_symbolic *S = R->F->S;
    const int64_t r = S->rowptr[node->super + 1] - S->rowptr[node->super];
    memset(sum, 0, (size_t)(R->nc * r) * sizeof *sum);
    for (int32_t k = node->child; k >= 0; k = R->reach.node[k].sibling) {
        const qc__reached *child = &R->reach.node[k];
        const qc__solve_node *N = &S->solve.node[child->super];
        const int32_t *local = S->relative + N->below;
        for (int64_t i = 0; R->nonzero[k] && i < N->m; i++)
            add_entries(R->nc, R->u + R->nc * (child->below + i), sum + R->nc * local[i]);
    }
}

static void forward(const run *R) {
    for (int32_t k = 0; k < R->reach.count; k++) {
        const qc__reached *node = &R->reach.node[k];
        const qc__solve_node *N = &R->F->S->solve.node[node->super];
        double *x = R->y + R->nc * node->own, *u = R->u + R->nc * node->below;
        double *own = R->sum + R->nc * R->F->S->solve.work;
        if (!R->nonzero[k]) continue;
        collect(R, node, R->sum);
        for (int64_t i = 0; i < R->nc * N->w; i++) own[i] = x[i] + R->sum[i];
        R->F->kernels->forward_panel(R->F, node->super, own, u);
        memcpy(x, own, (size_t)(R->nc * N->w) * sizeof *x);
        for (int64_t i = 0; i < R->nc * N->m; i++) u[i] += R->sum[R->nc * N->w + i];
    }
}

/* Here u of a node becomes the solution at the rows below it, taken from its parent. */
static void backward(const run *R) {
    const qc_symbolic *S = R->F->S;
    const int32_t nc = R->nc;
    for (int32_t k = R->reach.count; k-- > 0;) {
        const qc__reached *node = &R->reach.node[k];
        double *t = R->u + nc * node->below;
        if (!R->wanted[k]) continue;
        if (node->parent >= 0) {
            const qc__reached *up = &R->reach.node[node->parent];
            const int64_t m = qc__rows_below(S, node->super);
            const int32_t w = S->super[up->super + 1] - S->super[up->super];
            const int32_t *local = S->relative + S->rowptr[node->super + 1] - m;
            for (int64_t i = 0; i < m; i++)
                memcpy(t + nc * i,
                       local[i] < w ? R->y + nc * (up->own + local[i])
                                    : R->u + nc * (up->below + local[i] - w),
                       (size_t)nc * sizeof *t);
        }
        R->F->kernels->backward_panel(R->F, node->super, t, R->y + nc * node->own);
    }
}

static qc_status start(qc_ctx *ctx, run *R, int32_t nb, const int32_t *row, const double *b,
                       int32_t nx, const int32_t *want) {
    const int64_t own = R->nc * R->reach.own, count = R->reach.count;
    R->y = QC__ZERO(ctx, double, own);
    R->sum = QC__NEW(ctx, double, 2 * R->nc * R->F->S->solve.work);
    R->u = QC__NEW(ctx, double, R->nc *(R->reach.below + QC__SOLVE_PAD));
    R->nonzero = QC__NEW(ctx, bool, 2 * count);
    if (!R->y || !R->u || !R->sum || !R->nonzero) return QC_ERR_NOMEM;
    R->wanted = R->nonzero + count;
    mark_paths(R, nb, row, R->nonzero);
    mark_paths(R, nx, want, R->wanted);
    for (int32_t p = 0; p < nb; p++) add_entries(R->nc, b + R->nc * p, value_of(R, row[p]));
    return QC_OK;
}

static void finish(run *R) {
    qc__reach_free(&R->reach);
    qc__free(R->y);
    qc__free(R->u);
    qc__free(R->sum);
    qc__free(R->nonzero);
}

static qc_status solve_forward(qc_ctx *ctx, const qc_factor *F, int32_t nc, int32_t nb,
                               const int32_t *row, const double *b, int32_t capacity,
                               int32_t *index, double *y, int32_t *count) {
    const qc_symbolic *S = F->S;
    qc_status status = qc__factor_check(ctx, F, nc, true);
    if (status != QC_OK) return status;
    run R = {F, nc, {0, 0, 0, 0, NULL}, NULL, NULL, NULL, NULL, NULL};
    status = qc__reach_create(ctx, S, nb, row, 0, NULL, &R.reach);
    if (status != QC_OK) return status;
    *count = (int32_t)R.reach.own;
    if (capacity > 0 && capacity < *count)
        status = qc__fail(ctx, QC_ERR_ARGUMENT, *count, "reach has %d rows, the arrays %d",
                          (int)*count, (int)capacity);
    else if (capacity > 0)
        status = start(ctx, &R, nb, row, b, 0, NULL);
    if (status == QC_OK && capacity > 0) {
        forward(&R);
        for (int32_t k = 0; k < R.reach.count; k++) {
            const qc__reached *node = &R.reach.node[k];
            const int32_t first = S->super[node->super], end = S->super[node->super + 1];
            for (int32_t j = first; j < end; j++) {
                const int64_t p = node->own + j - first;
                const double scale = 1 / sqrt(F->D[j]);
                index[p] = j;
                for (int32_t c = 0; c < nc; c++) y[nc * p + c] = scale * R.y[nc * p + c];
            }
        }
    }
    finish(&R);
    return status;
}

static qc_status solve_entries(qc_ctx *ctx, const qc_factor *F, int32_t nc, int32_t nb,
                               const int32_t *row, const double *b, int32_t nx, const int32_t *want,
                               double *x) {
    qc_status status = qc__factor_check(ctx, F, nc, true);
    if (status != QC_OK) return status;
    run R = {F, nc, {0, 0, 0, 0, NULL}, NULL, NULL, NULL, NULL, NULL};
    status = qc__reach_create(ctx, F->S, nb, row, nx, want, &R.reach);
    if (status == QC_OK) status = start(ctx, &R, nb, row, b, nx, want);
    if (status == QC_OK) {
        forward(&R);
        backward(&R);
        for (int32_t p = 0; p < nx; p++)
            memcpy(x + nc * p, value_of(&R, want[p]), (size_t)nc * sizeof *x);
    }
    finish(&R);
    return status;
}

qc_status qc_solve_forward_sparse(qc_ctx *ctx, const qc_factor *F, int32_t nb, const int32_t *row,
                                  const qc_complex *b, int32_t capacity, int32_t *index,
                                  qc_complex *y, int32_t *count) {
    return solve_forward(ctx, F, 2, nb, row, (const double *)b, capacity, index, (double *)y,
                         count);
}
qc_status qc_solve_forward_sparse_real(qc_ctx *ctx, const qc_factor *F, int32_t nb,
                                       const int32_t *row, const double *b, int32_t capacity,
                                       int32_t *index, double *y, int32_t *count) {
    return solve_forward(ctx, F, 1, nb, row, b, capacity, index, y, count);
}
qc_status qc_solve_entries(qc_ctx *ctx, const qc_factor *F, int32_t nb, const int32_t *row,
                           const qc_complex *b, int32_t nx, const int32_t *want, qc_complex *x) {
    return solve_entries(ctx, F, 2, nb, row, (const double *)b, nx, want, (double *)x);
}
qc_status qc_solve_entries_real(qc_ctx *ctx, const qc_factor *F, int32_t nb, const int32_t *row,
                                const double *b, int32_t nx, const int32_t *want, double *x) {
    return solve_entries(ctx, F, 1, nb, row, b, nx, want, x);
}
