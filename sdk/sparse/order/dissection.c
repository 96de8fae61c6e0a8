/* Nested dissection (George 1973; Lipton, Rose, Tarjan 1979) of the elements of a pattern.
 *
 * A bisection of the elements of a piece gives a separator, the rows with elements on both sides,
 * which is ordered last, and two pieces. Small pieces are ordered by minimum degree. The pieces of
 * one level are independent, from a fixed size on whole subtrees are. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

enum { LEAF = 128, CLUSTER = 16, TASK = 6000, BATCH = 32, DENSE = 128 };

typedef struct task {
    qc__piece piece, child[2]; /* children without rows do not exist */
} task;

typedef struct tasks {
    const qc__dissection *D;
    task *task;
    int64_t count, capacity;
} tasks;

/* The rows of a piece are put into the order as they are, for qc__order_dissection to improve. */
static void leave(const qc__dissection *D, const qc__piece *P) {
    const qc__cover C = qc__piece_view(D, P);
    for (int32_t r = 0; r < P->n; r++) D->perm[P->row + r] = C.net[r].name;
    D->left[P->row] = true;
    D->work.flow[2 * (int64_t)P->row] = P->n;
}

/* False when a piece has no useful separator. */
static bool cut(const qc__dissection *D, const qc__piece *P, qc__piece child[2]) {
    const qc__cover C = qc__piece_view(D, P);
    qc__cut_work w = qc__piece_work(D, P);
    int32_t size[3];
    if (P->m < 2) return false;
    qc__bisect(&C, D->center, &w);
    qc__row_sides(&C, &w, size);
    if (size[QC__FREE] > P->n / 5) return false;
    qc__piece_split(D, P, NULL, size, child);
    return true;
}

static void dissect(const qc__dissection *D, const qc__piece *P) {
    qc__piece child[2];
    if (P->n <= D->leaf) {
        leave(D, P);
    } else if (P->n <= LEAF || (P->m < 2 && P->n <= QC__SMALL_PIECE)) {
        const qc__cover C = qc__piece_view(D, P);
        qc__minimum_degree(&C, D->perm + P->row);
    } else if (cut(D, P, child)) {
        for (int s = 0; s < 2; s++)
            if (child[s].n > 0) dissect(D, &child[s]);
    } else {
        leave(D, P);
    }
}

static void cut_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const tasks *T = arg;
    (void)worker;
    for (int64_t k = begin; k < end; k++) {
        task *t = &T->task[k];
        t->child[0].n = t->child[1].n = 0;
        if (t->piece.n <= T->D->leaf || !cut(T->D, &t->piece, t->child)) leave(T->D, &t->piece);
    }
}

static void dissect_tasks(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const tasks *T = arg;
    (void)worker;
    for (int64_t k = begin; k < end; k++) dissect(T->D, &T->task[k].piece);
}

static bool add_task(qc_ctx *ctx, tasks *T, qc__piece P) {
    if (!qc__reserve(ctx, (void **)&T->task, &T->capacity, T->count + 1, sizeof *T->task))
        return false;
    T->task[T->count++].piece = P;
    return true;
}

/* Cuts level by level until all pieces are tasks for one thread, then these. */
static qc_status run(qc_ctx *ctx, const qc__dissection *D, qc__piece root) {
    tasks level = {.D = D}, next = {.D = D}, small = {.D = D};
    bool memory = root.n == 0 || add_task(ctx, root.n > TASK ? &level : &small, root), go = true;
    double progress = 0.15;
    while (level.count > 0 && memory && go) {
        qc__parallel_for(ctx, level.count, 1, cut_tasks, &level);
        next.count = 0;
        for (int64_t k = 0; k < 2 * level.count && memory; k++) {
            const qc__piece P = level.task[k / 2].child[k % 2];
            if (P.n > 0) memory = add_task(ctx, P.n > TASK ? &next : &small, P);
        }
        const tasks swap = level;
        level = next;
        next = swap;
        go = qc__progress(ctx, progress += 0.1 * (0.7 - progress));
    }
    const int64_t count = small.count;
    task *first = small.task;
    for (int64_t k = 0; k < count && memory && go; k += BATCH) {
        small.task = first + k;
        qc__parallel_for(ctx, count - k < BATCH ? count - k : BATCH, 1, dissect_tasks, &small);
        go = qc__progress(ctx, progress + (0.95 - progress) * (double)k / (double)count);
    }
    qc__free(first);
    qc__free(level.task);
    qc__free(next.task);
    return !memory ? QC_ERR_NOMEM : go ? QC_OK : QC_ERR_CANCELLED;
}

static bool allocate(qc_ctx *ctx, qc__dissection *D) {
    const int32_t m = D->buffer[0].m, n = D->buffer[0].n;
    const int64_t entries = D->buffer[0].element[m - 1].end;
    qc__cut_work *w = &D->work;
    D->buffer[1] = (qc__cover){m,
                               n,
                               QC__NEW(ctx, qc__element, m),
                               QC__NEW(ctx, qc__net, n),
                               QC__NEW(ctx, int32_t, entries),
                               QC__NEW(ctx, int32_t, entries)};
    w->distance = QC__NEW(ctx, int32_t, 11 * (int64_t)m + 2 * entries + 2 * (int64_t)n + 1);
    w->side = QC__NEW(ctx, uint8_t, m);
    D->left = QC__ZERO(ctx, bool, n);
    if (!D->buffer[1].element || !D->buffer[1].net || !D->buffer[1].entry ||
        !D->buffer[1].element_of || !w->distance || !w->side || !D->left)
        return false;
    w->queue = w->distance + m;
    w->list = w->queue + 2 * (int64_t)m;
    w->border = w->list + 2 * (int64_t)m;
    w->next = w->border + m;
    w->path = w->next + m;
    w->label = w->path + m;
    w->heap = w->label + m;
    w->flow = w->heap + 2 * (entries + m);
    return true;
}

static void release(qc__dissection *D) {
    qc__cover_free(&D->buffer[0]);
    qc__cover_free(&D->buffer[1]);
    qc__free(D->work.distance);
    qc__free(D->work.side);
    qc__free(D->left);
    qc__free(D->center);
}

/* Rows in very many elements come last, since hardly any bisection spares them; rows in none, which
 * have no neighbours, before these. */
static qc_status prepare(qc_ctx *ctx, qc__dissection *D, const double *position, qc__piece *root) {
    qc__cover C = D->buffer[0];
    int32_t size[3] = {0, 0, 0}, isolated = 0;
    const double dense = fmin(16 + 10 * sqrt((double)C.n), DENSE);
    for (int32_t r = 0; r < C.n; r++) {
        const int32_t count = C.net[r].end - C.net[r].begin;
        D->work.flow[r] = count > dense ? QC__FREE : QC__SOURCE;
        size[D->work.flow[r]] += count > 0;
    }
    for (int32_t r = 0; r < C.n; r++)
        if (C.net[r].end == C.net[r].begin) D->perm[size[QC__SOURCE] + isolated++] = r;
    const int32_t clusters = qc__cluster_elements(&C, CLUSTER, D->work.list);
    if (!qc__progress(ctx, 0.12)) return QC_ERR_CANCELLED;
    if (position) {
        D->center = QC__NEW(ctx, int16_t, 3 * (int64_t)clusters);
        if (!D->center || !qc__cluster_centers(ctx, &C, clusters, position, D->center))
            return QC_ERR_NOMEM;
    }
    const qc__piece all = {0, C.m, C.n, 0, 0, 0, 0};
    qc__piece child[2];
    memset(D->work.side, QC__SOURCE, (size_t)C.m);
    qc__piece_split(D, &all, D->work.list, size, child);
    *root = child[0];
    return qc__progress(ctx, 0.15) ? QC_OK : QC_ERR_CANCELLED;
}

static qc_status order_left(qc_ctx *ctx, qc__pattern A, const qc__dissection *D) {
    int32_t *place = NULL;
    qc_status status = QC_OK;
    for (int32_t k = 0; k < A.n && status == QC_OK; k++) {
        if (!D->left[k]) continue;
        if (!place) {
            place = QC__NEW(ctx, int32_t, A.n);
            if (!place) return QC_ERR_NOMEM;
            memset(place, 255, (size_t)A.n * sizeof *place);
        }
        status = qc__amd_rows(ctx, A, D->work.flow[2 * (int64_t)k], D->perm + k, place);
        if (status == QC_OK && !qc__progress(ctx, 0.95)) status = QC_ERR_CANCELLED;
    }
    qc__free(place);
    return status;
}

qc_status qc__order_dissection(qc_ctx *ctx, qc__pattern A, const double *position, int32_t leaf,
                               int32_t *perm) {
    qc__dissection D = {.perm = perm, .leaf = leaf};
    qc_status status = qc__cover_create(ctx, A, &D.buffer[0]);
    if (status == QC_OK && D.buffer[0].m == 0) { /* a diagonal matrix */
        for (int32_t k = 0; k < A.n; k++) perm[k] = k;
    } else if (status == QC_OK) {
        qc__piece root;
        status = allocate(ctx, &D) ? prepare(ctx, &D, position, &root) : QC_ERR_NOMEM;
        if (status == QC_OK) status = run(ctx, &D, root);
        if (status == QC_OK) status = order_left(ctx, A, &D);
    }
    release(&D);
    return status;
}
