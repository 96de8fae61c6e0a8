/* A <- A + sum sigma_q w_q w_q^H in one sweep over the union of the paths from the first rows of
 * the w_q to the roots (Davis, Hager 2001: multiple-rank modifications), front by front. A vector
 * takes part from the front of its first row on and is handed from parent to parent by relative
 * indices. Positive terms come first in every column, so that no intermediate matrix is less
 * definite than the result. The forward solution is redone on the same fronts. */
#include <string.h>
#include "sdk/sparse/modify/modify.h"

typedef struct sweep {
    qc_factor *F;
    struct qc__modify *M;
    const qc__change *change;
    int64_t nc;
    int32_t begin; /* of the path in M->path */
    int32_t active;
    int32_t *order, *start, *first, *next; /* by place in the order: index in the change, first
                                              supernode, first non-zero local row, list */
    int32_t *list;                         /* active vectors of the present front */
    double **v, **spare;                   /* the vectors on the present front; the other half */
    double **vector, **coefficient;        /* of the active ones, for the kernel */
    double *a, *multipliers, *solution;
    double negligible;
} sweep;

/* Local row of a permuted row in a supernode, or -1. */
static int64_t find_row(const qc_symbolic *S, int32_t s, int32_t row) {
    int64_t lo = S->rowptr[s], hi = S->rowptr[s + 1];
    while (hi - lo > 1) {
        const int64_t middle = lo + (hi - lo) / 2;
        if (S->rows[middle] <= row)
            lo = middle;
        else
            hi = middle;
    }
    return S->rows[lo] == row ? lo - S->rowptr[s] : -1;
}

/* Supernode of the first row of w_q, after checking that all rows fit the column of L which belongs
 * to it; -1 for an empty vector. */
static qc_status find_start(qc_ctx *ctx, const qc_symbolic *S, const qc__change *C, int32_t q,
                            int32_t *out) {
    int32_t lowest = S->n;
    *out = -1;
    if (C->start[q] == C->start[q + 1]) return QC_OK;
    for (int32_t i = C->start[q]; i < C->start[q + 1]; i++) {
        const int32_t row = C->row[i];
        if (row < 0 || row >= S->n)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row, "update has row %d of %d", (int)row,
                            (int)S->n);
        if (S->inverse[row] < lowest) lowest = S->inverse[row];
    }
    for (int32_t i = C->start[q]; i < C->start[q + 1]; i++)
        if (find_row(S, S->super_of[lowest], S->inverse[C->row[i]]) < 0)
            return qc__fail(ctx, QC_ERR_ARGUMENT, C->row[i],
                            "rows %d and %d of an update are not connected in the matrix",
                            (int)S->perm[lowest], (int)C->row[i]);
    *out = S->super_of[lowest];
    return QC_OK;
}

static qc_status allocate(qc_ctx *ctx, sweep *W) {
    struct qc__modify *M = W->M;
    const int64_t k = W->change->vectors > 0 ? W->change->vectors : 1,
                  front = W->nc * W->F->S->plan.largest_front;
    const int64_t half = (front + 7) / 8 * 8;
    if (!qc__reserve(ctx, (void **)&M->item, &M->items, 5 * k, sizeof *M->item) ||
        !qc__reserve(ctx, (void **)&M->pointer, &M->pointers, 4 * k, sizeof *M->pointer) ||
        !qc__reserve(ctx, (void **)&M->work, &M->works,
                     (2 * k + 1) * half + k * (QC__UPDATE_MULTIPLIERS + 1), sizeof *M->work))
        return QC_ERR_NOMEM;
    W->order = M->item;
    W->start = W->order + k;
    W->first = W->start + k;
    W->next = W->first + k;
    W->list = W->next + k;
    W->v = M->pointer;
    W->spare = W->v + k;
    W->vector = W->spare + k;
    W->coefficient = W->vector + k;
    W->solution = M->work;
    for (int64_t i = 0; i < k; i++) {
        W->v[i] = M->work + (2 * i + 1) * half;
        W->spare[i] = W->v[i] + half;
    }
    W->multipliers = M->work + (2 * k + 1) * half;
    W->a = W->multipliers + k * QC__UPDATE_MULTIPLIERS;
    return QC_OK;
}

/* The part of the path above s which is not yet there goes in front of the rest: children come
 * before their parents. */
static void add_path(sweep *W, int32_t s) {
    struct qc__modify *M = W->M;
    int32_t length = 0;
    for (; s != -1 && M->head[s] == QC__OFF_PATH; s = W->F->S->parent[s]) {
        M->head[s] = -1;
        M->path[length++] = s;
    }
    while (length > 0) M->path[--W->begin] = M->path[--length];
}

static void clear_path(sweep *W) {
    for (int32_t i = W->begin; i < W->F->S->nsuper; i++) W->M->head[W->M->path[i]] = QC__OFF_PATH;
}

/* Space for everything the sweep may record. */
static qc_status reserve_journal(qc_ctx *ctx, const sweep *W) {
    const qc_symbolic *S = W->F->S;
    const qc__change *C = W->change;
    const qc__forward *forward = W->M->forward;
    const int32_t entries = C->vectors > 0 ? C->start[C->vectors] - C->start[0] : 0;
    int64_t doubles = entries, records = entries + (forward ? forward->pendings : 0);
    for (int32_t i = W->begin; i < S->nsuper; i++) {
        const int32_t s = W->M->path[i];
        const int64_t w = S->super[s + 1] - S->super[s], r = S->rowptr[s + 1] - S->rowptr[s];
        if (C->vectors > 0) doubles += w + 7 + qc__update_journal((int32_t)W->nc, r, w);
        if (forward) doubles += W->nc * r + 1;
        records += 2;
    }
    return qc__journal_reserve(ctx, W->F, doubles, records);
}

/* Vector i waits at supernode s; lists ascend. */
static void enqueue(sweep *W, int32_t s, int32_t i) {
    int32_t *at = &W->M->head[s];
    while (*at != -1 && *at < i) at = &W->next[*at];
    W->next[i] = *at;
    *at = i;
}

/* Vector i of the order on the front of its first row. */
static void load_vector(sweep *W, int32_t i) {
    const qc_symbolic *S = W->F->S;
    const qc__change *C = W->change;
    const int32_t s = W->start[i], q = W->order[i];
    const int64_t nc = W->nc, r = S->rowptr[s + 1] - S->rowptr[s];
    memset(W->v[i], 0, (size_t)(nc * r) * sizeof(double));
    W->a[i] = C->sigma[q];
    W->first[i] = (int32_t)r;
    for (int32_t p = C->start[q]; p < C->start[q + 1]; p++) {
        const int64_t local = find_row(S, s, S->inverse[C->row[p]]);
        for (int64_t c = 0; c < nc; c++) {
            const double x = C->w[nc * p + c];
            W->v[i][nc * local + c] += x;
            W->negligible = fmax(W->negligible, 1e-80 * fabs(x));
        }
        if (local < W->first[i]) W->first[i] = (int32_t)local;
    }
    enqueue(W, s, i);
}

/* The diagonal of A, before the sweep: pivots are judged by the new one. */
static void change_diagonal(sweep *W) {
    const qc__change *C = W->change;
    for (int32_t q = 0; q < C->vectors; q++)
        for (int32_t p = C->start[q]; p < C->start[q + 1]; p++) {
            const int32_t column = W->F->S->inverse[C->row[p]];
            double size = 0;
            for (int64_t c = 0; c < W->nc; c++) size += C->w[W->nc * p + c] * C->w[W->nc * p + c];
            *qc__journal_record(W->F, QC__DIAGONAL, column, 0) = W->F->diagonal[column];
            W->M->journal.used++;
            W->F->diagonal[column] += C->sigma[q] * size;
        }
}

/* Hands vector i on to the rows of the parent of s; it ends where nothing but zeros is left. */
static void pass_up(sweep *W, int32_t s, int32_t i) {
    const qc_symbolic *S = W->F->S;
    const int32_t parent = S->parent[s];
    if (parent == -1) return;
    const int64_t nc = W->nc, w = S->super[s + 1] - S->super[s];
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s];
    const int64_t above = S->rowptr[parent + 1] - S->rowptr[parent];
    const int32_t *local = S->relative + S->rowptr[s];
    const double *from = W->v[i];
    double *to = W->spare[i];
    int64_t k = nc * w;
    while (k < nc * r && from[k] == 0) k++;
    if (k == nc * r) return;
    memset(to, 0, (size_t)(nc * above) * sizeof *to);
    if (nc == 1) {
        for (int64_t j = k; j < r; j++) to[local[j]] = from[j];
    } else {
        for (int64_t j = k / 2; j < r; j++) {
            to[2 * (int64_t)local[j]] = from[2 * j];
            to[2 * (int64_t)local[j] + 1] = from[2 * j + 1];
        }
    }
    W->first[i] = local[k / nc];
    W->spare[i] = W->v[i];
    W->v[i] = to;
    enqueue(W, parent, i);
}

/* The vectors which wait at s, and the first column which they change. */
static int64_t gather(sweep *W, int32_t s, int64_t w) {
    int64_t k0 = w;
    W->active = 0;
    for (int32_t i = W->M->head[s]; i != -1; i = W->next[i]) {
        W->list[W->active] = i;
        W->vector[W->active] = W->v[i];
        W->coefficient[W->active++] = &W->a[i];
        if (W->first[i] < k0) k0 = W->first[i];
    }
    return k0;
}

/* Returns the permuted column whose pivot failed, or -1. */
static int32_t sweep_front(sweep *W, int32_t s) {
    qc_factor *F = W->F;
    const qc_symbolic *S = F->S;
    qc__journal *J = &W->M->journal;
    const qc__forward *forward = W->M->forward;
    const int32_t first = S->super[s];
    const int64_t w = S->super[s + 1] - first, r = S->rowptr[s + 1] - S->rowptr[s];
    const int64_t k0 = gather(W, s, w);
    double below = 0;
    if (W->active == 0 && !forward) return -1;
    if (forward) {
        qc__forward_save(F, s);
        below = qc__forward_assemble(F, s, W->solution);
    }
    double *old = J->data + J->used;
    if (k0 < w) {
        qc__journal_record(F, QC__PANEL, s, (int32_t)k0);
        memcpy(old, F->D + first + k0, (size_t)(w - k0) * sizeof *old);
        old = J->data + qc__journal_panel(J->used, w - k0);
    }
    qc__update_front front = {r,
                              w,
                              k0,
                              F->values + W->nc * S->panel[s],
                              F->D + first,
                              F->diagonal + first,
                              qc__pivot_floor(S->n, 1),
                              W->active,
                              W->vector,
                              W->coefficient,
                              W->negligible,
                              forward ? W->solution : NULL,
                              old,
                              W->multipliers};
    const int32_t bad = F->kernels->update_front(&front);
    J->used = front.journal - J->data;
    if (bad >= 0) return first + bad;
    if (forward) qc__forward_store(F, s, W->solution, below);
    for (int32_t j = 0; j < W->active; j++) pass_up(W, s, W->list[j]);
    return -1;
}

/* Entries of L times vectors, as the measure of work. */
static double front_work(const sweep *W, int32_t s) {
    const qc_symbolic *S = W->F->S;
    const double w = S->super[s + 1] - S->super[s];
    return w * (double)(S->rowptr[s + 1] - S->rowptr[s]) * (W->active + 1);
}

static qc_status sweep_path(qc_ctx *ctx, sweep *W) {
    const int32_t ns = W->F->S->nsuper;
    double since = 0;
    for (int32_t i = W->begin; i < ns; i++) {
        const int32_t s = W->M->path[i], bad = sweep_front(W, s);
        if (bad >= 0)
            return qc__fail(ctx, QC_ERR_NOT_POSDEF, W->F->S->perm[bad],
                            "update would make the matrix indefinite at row %d; the factor is as "
                            "before",
                            (int)W->F->S->perm[bad]);
        since += front_work(W, s);
        if (since < 4e6) continue;
        since = 0;
        if (!qc__progress(ctx, (double)(i - W->begin) / (ns - W->begin))) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* Orders the vectors and finds their paths. */
static qc_status prepare(qc_ctx *ctx, sweep *W) {
    const qc__change *C = W->change;
    const qc__forward *forward = W->M->forward;
    int32_t count = 0;
    qc_status status = allocate(ctx, W);
    for (int sign = 1; sign >= -1 && status == QC_OK; sign -= 2)
        for (int32_t q = 0; q < C->vectors && status == QC_OK; q++) {
            if (C->sigma[q] != sign) continue;
            W->order[count] = q;
            status = find_start(ctx, W->F->S, C, q, &W->start[count]);
            if (status == QC_OK && W->start[count] != -1) add_path(W, W->start[count++]);
        }
    for (int32_t p = 0; forward && p < forward->pendings; p++) add_path(W, forward->pending[p]);
    W->active = count;
    return status == QC_OK ? reserve_journal(ctx, W) : status;
}

qc_status qc__sweep(qc_ctx *ctx, qc_factor *F, const qc__change *change) {
    const qc__forward *forward = F->modify->forward;
    if (forward && forward->stale) qc__forward_solve(F);
    sweep W = {
        .F = F, .M = F->modify, .change = change, .nc = F->components, .begin = F->S->nsuper};
    const int64_t mark = F->modify->journal.records;
    qc_status status = prepare(ctx, &W);
    if (status == QC_OK) {
        for (int32_t i = 0, count = W.active; i < count; i++) load_vector(&W, i);
        if (change->diagonal) change_diagonal(&W);
        status = sweep_path(ctx, &W);
        if (status == QC_OK)
            qc__forward_settle(F);
        else
            qc__journal_roll_back(F, mark);
    }
    clear_path(&W);
    return status;
}
