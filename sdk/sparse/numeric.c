/* Multifrontal factorisation P A P^T = L D L^H (Duff, Reid 1983; Liu 1992) along the schedule of
 * plan.c. The front of a supernode is its panel of L and its update matrix; the children's update
 * matrices are added into both. Compiled twice, see scalar.h. */
#include "sdk/sparse/scalar.h"
#include <string.h>

typedef struct run {
    const qc_symbolic *S;
    qc_factor *F;
    const double *val;      /* in the order of the analysed pattern */
    double *area;           /* shared update matrices */
    double **stack, **work; /* by worker */
    double **floor;         /* by worker */
    int32_t *failed;        /* by task: permuted column, or -1 */
    int32_t task;           /* first task of the present step */
} run;

/* Panel <- entries of A, diagonal; the update matrix <- 0. */
static void load(const run *R, int32_t s, double *panel, double *U, double *floor) {
    const qc_symbolic *S = R->S;
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s], first = S->super[s];
    const int64_t w = S->super[s + 1] - first, m = r - w;
    memset(panel, 0, (size_t)(NC * r * w) * sizeof *panel);
    for (int64_t q = S->entry[s]; q < S->entry[s + 1]; q++) {
        const bool conjugate = S->to[q] < 0;
        const double *a = R->val + NC * S->from[q];
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
    if (m > 0) memset(U, 0, (size_t)(NC * m * m) * sizeof *U);
}

/* Lower triangle of the child's update matrix into the front; local rows ascend, so the lower
 * triangle goes to the lower triangle. */
static void extend_add(const qc_symbolic *S, int32_t c, const double *Uc, int64_t r, int64_t w,
                       double *panel, double *U) {
    const int64_t wc = S->super[c + 1] - S->super[c];
    const int64_t mc = S->rowptr[c + 1] - S->rowptr[c] - wc, m = r - w;
    const int32_t *local = S->relative + S->rowptr[c] + wc;
    for (int64_t j = 0; j < mc; j++) {
        const int64_t column = local[j];
        const double *x = Uc + NC * j * mc;
        double *y = column < w ? panel : U;
        const int64_t start = column < w ? column * r : (column - w) * m - w;
        for (int64_t i = j; i < mc; i++) {
            double *to = y + NC * (start + local[i]);
            to[0] += x[NC * i];
            if (NC == 2) to[1] += x[NC * i + 1];
        }
    }
}

static double *update_of(const run *R, int32_t s, uint32_t worker) {
    const qc__plan *plan = &R->S->plan;
    return (plan->shared[s] ? R->area : R->stack[worker]) + NC * plan->update[s];
}

/* Returns the permuted column of a failed pivot, or -1. */
static int32_t factor_supernode(const run *R, int32_t s, uint32_t worker) {
    const qc_symbolic *S = R->S;
    const int32_t first = S->super[s], w = S->super[s + 1] - first;
    const int32_t r = (int32_t)(S->rowptr[s + 1] - S->rowptr[s]);
    double *panel = R->F->values + NC * S->panel[s], *U = update_of(R, s, worker);
    load(R, s, panel, U, R->floor[worker]);
    for (int32_t c = S->child[s]; c != -1; c = S->sibling[c])
        extend_add(S, c, update_of(R, c, worker), r, w, panel, U);
    const int32_t bad =
        NAME(qc__front_factor)(r, w, panel, U, R->F->D + first, R->floor[worker], R->work[worker]);
    return bad < 0 ? -1 : first + bad;
}

static void run_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    for (int64_t t = R->task + begin; t < R->task + end; t++) {
        const qc__task task = R->S->plan.task[t];
        R->failed[t] = -1;
        for (int32_t s = task.first; s <= task.last && R->failed[t] < 0; s++)
            R->failed[t] = factor_supernode(R, s, worker);
    }
}

static qc_status not_posdef(qc_ctx *ctx, const qc_symbolic *S, int32_t column) {
    const int32_t row = S->perm[column];
    return qc__fail(ctx, QC_ERR_NOT_POSDEF, row,
                    "matrix is not positive definite: pivot of row %d is not positive; fix a value "
                    "in each component or add a small multiple of the mass matrix",
                    (int)row);
}

/* done: flops before this step */
static qc_status run_step(qc_ctx *ctx, run *R, const qc__step *step, double done) {
    const qc__plan *plan = &R->S->plan;
    const int32_t tops = step->top_end - step->top;
    if (!qc__progress(ctx, done / plan->flops)) return QC_ERR_CANCELLED;
    R->task = step->task;
    qc__parallel_for(ctx, step->task_end - step->task, 1, run_tasks, R);
    for (int32_t t = step->task; t < step->task_end; t++)
        if (R->failed[t] >= 0) return not_posdef(ctx, R->S, R->failed[t]);
    for (int32_t k = 0; k < tops; k++) {
        const double fraction = (done + step->flops * k / tops) / plan->flops;
        if (!qc__progress(ctx, fraction)) return QC_ERR_CANCELLED;
        const int32_t bad = factor_supernode(R, plan->top[step->top + k], 0);
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
        done += plan->step[i].flops;
    }
    return qc__progress(ctx, 1.0) ? QC_OK : QC_ERR_CANCELLED;
}

static void free_workers(run *R, uint32_t workers) {
    for (uint32_t t = 0; R->stack && t < workers; t++) qc__free(R->stack[t]);
    qc__free(R->stack);
    qc__free(R->area);
    qc__free(R->failed);
}

/* One block per worker: stack, then work, then floor. */
static bool allocate_workers(qc_ctx *ctx, run *R, double **pointers, uint32_t workers) {
    const qc__plan *plan = &R->S->plan;
    const int64_t work = plan->work;
    R->stack = pointers;
    R->work = pointers + workers;
    R->floor = pointers + 2 * (size_t)workers;
    R->area = QC__NEW(ctx, double, NC * plan->area);
    R->failed = QC__NEW(ctx, int32_t, plan->ntask);
    bool ok = R->area && R->failed;
    for (uint32_t t = 0; ok && t < workers; t++) {
        R->stack[t] = QC__NEW(ctx, double, NC * plan->stack + work + plan->largest_width);
        if (!R->stack[t]) return false;
        R->work[t] = R->stack[t] + NC * plan->stack;
        R->floor[t] = R->work[t] + work;
    }
    return ok;
}

/* val: in the order of the analysed pattern */
static qc_status factor_values(qc_ctx *ctx, qc_factor *F, const double *val) {
    const qc__plan *plan = &F->S->plan;
    const uint32_t threads = qc_ctx_threads(ctx);
    const uint32_t workers = plan->ntask > 1 ? threads : 1;
    run R = {F->S, F, val, NULL, NULL, NULL, NULL, NULL, 0};
    double **pointers = QC__ZERO(ctx, double *, 3 * (size_t)workers);
    if (!pointers) return QC_ERR_NOMEM;
    qc_status status = QC_ERR_NOMEM;
    if (allocate_workers(ctx, &R, pointers, workers)) {
        if (plan->uses_blas) qc__blas_begin();
        status = run_plan(ctx, &R);
        if (plan->uses_blas) qc__blas_end();
    }
    free_workers(&R, workers);
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

static qc_status factor_matrix(qc_ctx *ctx, qc_factor *F, const matrix *A) {
    const qc_symbolic *S = F->S;
    if (A->n != S->n)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "matrix has %d rows, the analysed one %d",
                        (int)A->n, (int)S->n);
    if (!A->colptr || (A->n > 0 && (!A->row || !A->val)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "matrix to factorise has no entries");
    if (same_pattern(S, A)) return factor_values(ctx, F, (const double *)A->val);
    double *val = QC__NEW(ctx, double, NC * S->a_colptr[S->n]);
    if (!val) return QC_ERR_NOMEM;
    qc_status status = expand(ctx, S, A, val);
    if (status == QC_OK) status = factor_values(ctx, F, val);
    qc__free(val);
    return status;
}

qc_status NAME(qc_factorize)(qc_ctx *ctx, const qc_symbolic *S, const matrix *A, qc_factor **out) {
    qc_factor *F;
    qc_status status = qc__factor_create(ctx, S, NC, &F);
    if (status != QC_OK) return status;
    status = factor_matrix(ctx, F, A);
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
    return factor_matrix(ctx, F, A);
}
