/* Triangular solves with the supernodal factor: which blocks of right-hand sides and which subtrees
 * run when. The arithmetic is in kernels/forward_single.c, backward_single.c and solve_block.c; its
 * order is that of the tree, so neither threads nor the schedule change a bit. */
#include <string.h>
#include "sdk/sparse/internal.h"

/* Below this many entries of L (times right-hand sides) waking other threads costs more. */
static const double parallel_entries = 2e5;
static const int64_t chunk_rows = 8192;

typedef struct run {
    const qc__solve_kernels *kernels;
    const qc_symbolic *S;
    bool forward_only;
    int64_t blocks; /* of this round */
    qc__rhs_block *block;
    double **work; /* by worker */
} run;

/* Items of a loop: blocks vary fastest, so that what is read of L serves all blocks. */
static void forward_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    for (int64_t i = begin; i < end; i++) {
        const qc__task task = R->S->plan.task[i / R->blocks];
        R->kernels->forward(&R->block[i % R->blocks], R->work[worker], task.first, task.last);
    }
}

static void backward_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    for (int64_t i = begin; i < end; i++) {
        const qc__task task = R->S->plan.task[i / R->blocks];
        R->kernels->backward(&R->block[i % R->blocks], R->work[worker], task.first, task.last);
    }
}

/* Up and down through the supernodes above all tasks. */
static void run_top(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    const qc__solve_plan *plan = &R->S->solve;
    for (int64_t b = begin; b < end; b++) {
        for (int32_t k = 0; k < plan->ntop; k++)
            R->kernels->forward(&R->block[b], R->work[worker], plan->top[k], plan->top[k]);
        for (int32_t k = plan->ntop; !R->forward_only && k-- > 0;)
            R->kernels->backward(&R->block[b], R->work[worker], plan->top[k], plan->top[k]);
    }
}

static void run_rows(const run *R, qc__solve_rows *body, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; i++) {
        const int64_t first = i / R->blocks * chunk_rows, next = first + chunk_rows;
        body(&R->block[i % R->blocks], first, next < R->S->n ? next : R->S->n);
    }
}

static void load_rows(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    (void)worker;
    run_rows(R, R->kernels->load, begin, end);
}

static void store_rows(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const run *R = arg;
    (void)worker;
    run_rows(R, R->forward_only ? R->kernels->store_scaled : R->kernels->store, begin, end);
}

typedef void parallel_for(qc_ctx *ctx, int64_t n, int64_t chunk, qc__body *body, void *arg);

static void on_this_thread(qc_ctx *ctx, int64_t n, int64_t chunk, qc__body *body, void *arg) {
    (void)ctx;
    (void)chunk;
    body(arg, 0, n, 0);
}

static void run_round(qc_ctx *ctx, run *R, bool parallel) {
    parallel_for *loop = parallel ? qc__parallel_for : on_this_thread;
    const int64_t tasks = R->blocks * R->S->plan.ntask;
    const int64_t chunks = R->blocks * ((R->S->n + chunk_rows - 1) / chunk_rows);
    loop(ctx, chunks, 1, load_rows, R);
    loop(ctx, tasks, 1, forward_tasks, R);
    loop(ctx, R->blocks, 1, run_top, R);
    if (!R->forward_only) loop(ctx, tasks, 1, backward_tasks, R);
    loop(ctx, chunks, 1, store_rows, R);
}

/* One round: `blocks` blocks of `width` columns from `column` on. */
typedef struct round_shape {
    int64_t width, blocks, threads;
} round_shape;

/* One allocation for each block and worker: every one is aligned, and the allocator is more likely
 * to have such pieces at hand than their sum. */
static bool allocate(qc_ctx *ctx, const qc_factor *F, round_shape shape, run *R) {
    const qc_symbolic *S = F->S;
    const int64_t row = F->components * shape.width;
    const int64_t own = row * (S->n + S->solve.area), scratch = 3 * row * S->solve.work;
    R->block = QC__ZERO(ctx, qc__rhs_block, shape.blocks);
    R->work = QC__ZERO(ctx, double *, shape.threads);
    if (!R->block || !R->work) return false;
    for (int64_t b = 0; b < shape.blocks; b++) {
        double *Y = QC__NEW(ctx, double, own);
        if (!Y) return false;
        R->block[b] = (qc__rhs_block){F, NULL, 0, Y, Y + row * S->n};
    }
    for (int64_t t = 0; t < shape.threads; t++) {
        R->work[t] = QC__NEW(ctx, double, scratch + row * S->solve.stack);
        if (!R->work[t]) return false;
        memset(R->work[t] + scratch, 0, (size_t)(row * S->solve.stack) * sizeof **R->work);
    }
    return true;
}

static void release(run *R, round_shape shape) {
    for (int64_t b = 0; R->block && b < shape.blocks; b++) qc__free(R->block[b].Y);
    for (int64_t t = 0; R->work && t < shape.threads; t++) qc__free(R->work[t]);
    qc__free(R->block);
    qc__free(R->work);
}

static qc_status run_rounds(qc_ctx *ctx, run *R, round_shape shape, bool parallel, int64_t nrhs,
                            double *x) {
    const int64_t ld = R->block->F->components * (int64_t)R->S->n;
    for (int64_t column = 0; column < nrhs;) {
        for (R->blocks = 0; R->blocks < shape.blocks && column < nrhs; R->blocks++) {
            qc__rhs_block *B = &R->block[R->blocks];
            B->x = x + ld * column;
            B->columns = nrhs - column < shape.width ? nrhs - column : shape.width;
            column += B->columns;
        }
        run_round(ctx, R, parallel);
        if (column < nrhs && !qc__progress(ctx, (double)column / (double)nrhs))
            return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

static qc_status solve(qc_ctx *ctx, const qc_factor *F, int32_t components, int32_t nrhs, double *x,
                       bool forward_only) {
    qc_status status = qc__factor_check(ctx, F, components, true);
    if (status != QC_OK) return status;
    const qc_symbolic *S = F->S;
    if (nrhs < 0 || (nrhs > 0 && S->n > 0 && !x))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "solve needs nrhs >= 0 and an array");
    if (nrhs == 0 || S->n == 0) return QC_OK;
    const double work = (double)S->panel[S->nsuper] * nrhs;
    const bool parallel = qc_ctx_threads(ctx) > 1 && work > parallel_entries;
    const int64_t width = nrhs == 1 ? 1 : QC__BLOCK, blocks = (nrhs + width - 1) / width;
    const int64_t threads = parallel ? qc_ctx_threads(ctx) : 1, most = threads;
    const round_shape shape = {width, blocks < most ? blocks : most, threads};
    run R = {&F->kernels->solve[width > 1], S, forward_only, 0, NULL, NULL};
    status =
        allocate(ctx, F, shape, &R) ? run_rounds(ctx, &R, shape, parallel, nrhs, x) : QC_ERR_NOMEM;
    release(&R, shape);
    return status;
}

qc_status qc_solve(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x) {
    return solve(ctx, F, 2, nrhs, (double *)x, false);
}
qc_status qc_solve_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x) {
    return solve(ctx, F, 1, nrhs, x, false);
}
qc_status qc_solve_forward(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x) {
    return solve(ctx, F, 2, nrhs, (double *)x, true);
}
qc_status qc_solve_forward_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x) {
    return solve(ctx, F, 1, nrhs, x, true);
}
