/* Multifrontal factorisation P A P^T = L D L^H (Duff, Reid 1983; Liu 1992) along the schedule of
 * plan.c. The front of a supernode is its panel of L and its update matrix; the children's update
 * matrices are added into both. Compiled twice, see scalar.h. */
#include "sdk/sparse/factor/scalar.h"
#include <string.h>

typedef struct run {
    const qc_symbolic *S;
    qc_factor *F;
    const double *val; /* in the order of the analysed pattern */
    const qc__workspace *space;
    int32_t task; /* first task of the present step */
} run;

/* Panel <- entries of A. */
static void load(const run *R, int32_t s, double *panel, double *floor) {
    const qc_symbolic *S = R->S;
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s], first = S->super[s];
    const int64_t w = S->super[s + 1] - first;
    memset(panel, 0, (size_t)(NC * r * w) * sizeof *panel);
    const int64_t end = S->entry[s + 1];
    for (int64_t q = S->entry[s]; q < end; q++) {
        QC__PREFETCH(R->val + NC * (int64_t)S->from[q + QC__AHEAD]);
        const bool conjugate = S->to[q] < 0;
        const double *a = R->val + NC * (int64_t)S->from[q];
        double *x = panel + NC * (conjugate ? ~S->to[q] : S->to[q]);
        x[0] = a[0];
        if (NC == 2) x[1] = conjugate ? -a[1] : a[1];
    }
    for (int64_t k = 0; k < w; k++) {
        double *x = panel + NC * (k + k * r);
        if (NC == 2) x[1] = 0;
        R->F->diagonal[first + k] = x[0];
        floor[k] = qc__pivot_floor(S->n, x[0]);
        if (!(floor[k] >= 0)) floor[k] = 0; /* a diagonal <= 0 or NaN fails as a pivot */
    }
}

static void extend_add(const run *R, int32_t c, const double *child, const qc__front *front) {
    const qc_symbolic *S = R->S;
    const int64_t w = S->super[c + 1] - S->super[c], begin = S->rowptr[c] + w;
    R->F->kernels->extend_add(S->rowptr[c + 1] - begin, S->relative + begin, child, front->r,
                              front->w, front->panel, front->U);
}

static double *update_of(const run *R, int32_t s, uint32_t worker) {
    const qc__plan *plan = &R->S->plan;
    return (plan->shared[s] ? R->space->area : R->space->stack[worker]) + NC * plan->update[s];
}

/* ctx: see qc__front_factor. Returns the permuted column of a failed pivot, QC__DONE or
 * QC__CANCELLED. */
static int32_t factor_supernode(const run *R, qc_ctx *ctx, int32_t s, uint32_t worker) {
    const qc_symbolic *S = R->S;
    const int32_t first = S->super[s], w = S->super[s + 1] - first;
    const int32_t r = (int32_t)(S->rowptr[s + 1] - S->rowptr[s]), m = r - w;
    const qc__front front = {r,
                             w,
                             R->F->values + NC * S->panel[s],
                             update_of(R, s, worker),
                             S->child[s] == -1,
                             R->F->D + first,
                             R->space->floor[worker],
                             R->space->work[worker]};
    load(R, s, front.panel, R->space->floor[worker]);
    if (!front.fresh && m > 0) memset(front.U, 0, (size_t)(NC * m * m) * sizeof *front.U);
    for (int32_t c = S->child[s]; c != -1; c = S->sibling[c])
        extend_add(R, c, update_of(R, c, worker), &front);
    const int32_t bad = NAME(qc__front_factor)(ctx, R->F->kernels, &front);
    return bad < 0 ? bad : first + bad;
}

static void run_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    for (int64_t t = R->task + begin; t < R->task + end; t++) {
        const qc__task task = R->S->plan.task[t];
        R->space->failed[t] = QC__DONE;
        for (int32_t s = task.first; s <= task.last && R->space->failed[t] < 0; s++)
            R->space->failed[t] = factor_supernode(R, NULL, s, worker);
    }
}

static qc_status not_posdef(qc_ctx *ctx, const qc_symbolic *S, int32_t column) {
    const int32_t row = S->perm[column];
    return qc__fail(ctx, QC_ERR_NOT_POSDEF, row,
                    "matrix is not positive definite: pivot of row %d is not positive; fix a value "
                    "in each component or add a small multiple of the mass matrix",
                    (int)row);
}

/* done: cost before this step */
static qc_status run_step(qc_ctx *ctx, run *R, const qc__step *step, double done) {
    const qc__plan *plan = &R->S->plan;
    const int32_t tops = step->top_end - step->top;
    if (!qc__progress(ctx, done / plan->cost)) return QC_ERR_CANCELLED;
    R->task = step->task;
    qc__parallel_for(ctx, step->task_end - step->task, 1, run_tasks, R);
    for (int32_t t = step->task; t < step->task_end; t++)
        if (R->space->failed[t] >= 0) return not_posdef(ctx, R->S, R->space->failed[t]);
    for (int32_t k = 0; k < tops; k++) {
        const double begin = done + step->cost * k / tops, end = done + step->cost * (k + 1) / tops;
        const qc__range outer = qc__range_begin(ctx, NULL, begin / plan->cost, end / plan->cost);
        const int32_t bad = factor_supernode(R, ctx, plan->top[step->top + k], 0);
        qc__range_end(ctx, outer);
        if (bad == QC__CANCELLED) return QC_ERR_CANCELLED;
        if (bad >= 0) return not_posdef(ctx, R->S, bad);
    }
    return QC_OK;
}

static qc_status run_plan(qc_ctx *ctx, run *R) {
    const qc__plan *plan = &R->S->plan;
    double done = 0;
    for (int32_t i = 0; i < plan->nstep; i++) {
        const qc_status status = run_step(ctx, R, &plan->step[i], done);
        if (status != QC_OK) return status;
        done += plan->step[i].cost;
    }
    return qc__progress(ctx, 1.0) ? QC_OK : QC_ERR_CANCELLED;
}

/* val: in the order of the analysed pattern. keep: the workspace stays for the next time. */
static qc_status factor_values(qc_ctx *ctx, qc_factor *F, const double *val, bool keep) {
    const qc__plan *plan = &F->S->plan;
    const bool uses_blas = plan->largest_width >= F->kernels->blas_width;
    const uint32_t workers = plan->ntask > 1 ? qc_ctx_threads(ctx) : 1;
    qc__workspace *space = F->workspace;
    if (!space || space->workers < workers) {
        space = qc__workspace_create(ctx, plan, NC, workers);
        if (!space) return QC_ERR_NOMEM;
    }
    run R = {F->S, F, val, space, 0};
    if (uses_blas) qc__blas_begin();
    const qc_status status = run_plan(ctx, &R);
    if (uses_blas) qc__blas_end();
    if (space != F->workspace) {
        qc__workspace_free(keep ? F->workspace : space);
        if (keep) F->workspace = space;
    }
    F->usable = status == QC_OK;
    return status;
}

static bool same_pattern(const qc_symbolic *S, const matrix *A) {
    const int64_t nnz = S->a_colptr[S->n];
    return A->colptr[S->n] == nnz &&
           memcmp(A->colptr, S->a_colptr, ((size_t)S->n + 1) * sizeof *A->colptr) == 0 &&
           (nnz == 0 || memcmp(A->row, S->a_row, (size_t)nnz * sizeof *A->row) == 0);
}

/* Values of a matrix with fewer entries in the order of the analysed pattern. */
static qc_status expand(qc_ctx *ctx, const qc_symbolic *S, const matrix *A, double *val) {
    const qc_status status = qc__check_pattern(ctx, (qc__pattern){A->n, A->colptr, A->row});
    if (status != QC_OK) return status;
    memset(val, 0, (size_t)(NC * S->a_colptr[S->n]) * sizeof *val);
    for (int32_t j = 0; j < S->n; j++) {
        int64_t q = S->a_colptr[j];
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            while (q < S->a_colptr[j + 1] && S->a_row[q] < A->row[p]) q++;
            if (q == S->a_colptr[j + 1] || S->a_row[q] != A->row[p])
                return qc__fail(ctx, QC_ERR_ARGUMENT, j,
                                "entry (%d, %d) is not in the analysed pattern: analyse again",
                                (int)A->row[p], (int)j);
            memcpy(val + NC * q, (const double *)A->val + NC * p, NC * sizeof *val);
        }
    }
    return QC_OK;
}

static qc_status factor_matrix(qc_ctx *ctx, qc_factor *F, const matrix *A, bool keep) {
    const qc_symbolic *S = F->S;
    if (A->n != S->n)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "matrix has %d rows, the analysed one %d",
                        (int)A->n, (int)S->n);
    if (!A->colptr || (A->n > 0 && (!A->row || !A->val)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "matrix to factorise has no entries");
    if (same_pattern(S, A)) return factor_values(ctx, F, (const double *)A->val, keep);
    double *val = QC__NEW(ctx, double, NC * S->a_colptr[S->n]);
    if (!val) return QC_ERR_NOMEM;
    qc_status status = expand(ctx, S, A, val);
    if (status == QC_OK) status = factor_values(ctx, F, val, keep);
    qc__free(val);
    return status;
}

qc_status NAME(qc_factorize)(qc_ctx *ctx, const qc_symbolic *S, const matrix *A, qc_factor **out) {
    qc_factor *F;
    qc_status status = qc__factor_create(ctx, S, NC, &F);
    if (status != QC_OK) return status;
    status = factor_matrix(ctx, F, A, false);
    if (status == QC_OK)
        *out = F;
    else
        qc_factor_free(F);
    return status;
}

qc_status NAME(qc_refactorize)(qc_ctx *ctx, qc_factor *F, const matrix *A) {
    qc_status status = qc__factor_check(ctx, F, NC, false);
    if (status != QC_OK) return status;
    F->usable = false;
    qc__modify_reset(F);
    return factor_matrix(ctx, F, A, true);
}
