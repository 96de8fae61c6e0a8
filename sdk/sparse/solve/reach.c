/* Union of paths in the tree by merging: a heap holds the next supernode of every path; equal ones
 * join. Parents have higher numbers, so supernodes come out in ascending order. */
#include "sdk/sparse/solve/reach.h"

typedef struct step {
    int32_t super, from; /* from: position of the child, -1 at the start of a path */
} step;

static bool before(step a, step b) {
    return a.super != b.super ? a.super < b.super : a.from < b.from;
}

static void sift_down(step *heap, int64_t count, int64_t k) {
    for (int64_t c; (c = 2 * k + 1) < count; k = c) {
        if (c + 1 < count && before(heap[c + 1], heap[c])) c++;
        if (!before(heap[c], heap[k])) return;
        const step swap = heap[c];
        heap[c] = heap[k];
        heap[k] = swap;
    }
}

/* Every step from the heap's least supernode becomes one node; its parent takes their place. */
static void merge_least(const qc_symbolic *S, step *heap, int64_t *count, qc__reach *reach) {
    const int32_t s = heap[0].super, position = reach->count++;
    qc__reached *node = &reach->node[position];
    *node = (qc__reached){s, -1, -1, -1, reach->own, reach->below};
    reach->own += S->super[s + 1] - S->super[s];
    reach->below += qc__rows_below(S, s);
    for (int32_t last = -1; *count > 0 && heap[0].super == s;) {
        const int32_t from = heap[0].from;
        if (from >= 0) {
            reach->node[from].parent = position;
            if (last < 0)
                node->child = from;
            else
                reach->node[last].sibling = from;
            last = from;
        }
        heap[0] = heap[--*count];
        sift_down(heap, *count, 0);
    }
    if (S->parent[s] == -1) return;
    heap[(*count)++] = (step){S->parent[s], position};
    for (int64_t k = *count - 1; k > 0 && before(heap[k], heap[(k - 1) / 2]); k = (k - 1) / 2) {
        const step swap = heap[k];
        heap[k] = heap[(k - 1) / 2];
        heap[(k - 1) / 2] = swap;
    }
}

static qc_status start(qc_ctx *ctx, const qc_symbolic *S, int32_t n, const int32_t *row,
                       step *heap) {
    for (int32_t p = 0; p < n; p++) {
        if (row[p] < 0 || row[p] >= S->n)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row[p], "sparse vector has row %d of %d",
                            (int)row[p], (int)S->n);
        heap[p] = (step){S->super_of[S->inverse[row[p]]], -1};
    }
    return QC_OK;
}

qc_status qc__reach_create(qc_ctx *ctx, const qc_symbolic *S, int32_t na, const int32_t *a,
                           int32_t nb, const int32_t *b, qc__reach *out) {
    *out = (qc__reach){0, 0, 0, 0, NULL};
    if (na < 0 || nb < 0 || (na > 0 && !a) || (nb > 0 && !b))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "sparse vector needs a count >= 0 and its rows");
    int64_t count = (int64_t)na + nb;
    step *heap = QC__NEW(ctx, step, count);
    if (!heap) return QC_ERR_NOMEM;
    qc_status status = start(ctx, S, na, a, heap);
    if (status == QC_OK) status = start(ctx, S, nb, b, heap + na);
    if (status == QC_OK)
        for (int64_t k = count / 2; k-- > 0;) sift_down(heap, count, k);
    while (status == QC_OK && count > 0) {
        if (qc__reserve(ctx, (void **)&out->node, &out->capacity, (int64_t)out->count + 1,
                        sizeof *out->node))
            merge_least(S, heap, &count, out);
        else
            status = QC_ERR_NOMEM;
    }
    qc__free(heap);
    if (status != QC_OK) qc__reach_free(out);
    return status;
}

void qc__reach_free(qc__reach *reach) {
    qc__free(reach->node);
    *reach = (qc__reach){0, 0, 0, 0, NULL};
}

int32_t qc__reach_find(const qc__reach *reach, int32_t super) {
    int32_t lo = 0, hi = reach->count;
    while (hi - lo > 1) {
        const int32_t middle = lo + (hi - lo) / 2;
        if (reach->node[middle].super <= super)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}
