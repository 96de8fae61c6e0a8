/* Binary heap over the elements 0..n-1 with decreasing keys, as Dijkstra's algorithm needs it. Ties
 * are resolved by the lower index, so the order of removal depends on the keys alone. */
#include "sdk/mesh/internal.h"

qc_status qc__heap_create(qc_ctx *ctx, int32_t n, const double *key, qc__heap *out) {
    qc__heap heap = {0, QC__NEW(ctx, int32_t, n), QC__NEW(ctx, int32_t, n), key};
    if (!heap.item || !heap.place) {
        qc__heap_free(&heap);
        return QC_ERR_NOMEM;
    }
    for (int32_t i = 0; i < n; i++) heap.place[i] = -1;
    *out = heap;
    return QC_OK;
}

void qc__heap_free(qc__heap *heap) {
    qc__free(heap->item);
    qc__free(heap->place);
    heap->item = heap->place = NULL;
}

static bool before(const qc__heap *heap, int32_t a, int32_t b) {
    return heap->key[a] < heap->key[b] || (heap->key[a] == heap->key[b] && a < b);
}

static void put(qc__heap *heap, int32_t at, int32_t i) {
    heap->item[at] = i;
    heap->place[i] = at;
}

void qc__heap_push(qc__heap *heap, int32_t i) {
    int32_t at = heap->place[i] < 0 ? heap->n++ : heap->place[i];
    for (; at > 0 && before(heap, i, heap->item[(at - 1) / 2]); at = (at - 1) / 2)
        put(heap, at, heap->item[(at - 1) / 2]);
    put(heap, at, i);
}

int32_t qc__heap_pop(qc__heap *heap) {
    int32_t top = heap->item[0], last = heap->item[--heap->n], at = 0;
    heap->place[top] = -1;
    if (heap->n == 0) return top;
    for (;;) {
        int32_t child = 2 * at + 1;
        if (child >= heap->n) break;
        if (child + 1 < heap->n && before(heap, heap->item[child + 1], heap->item[child])) child++;
        if (!before(heap, heap->item[child], last)) break;
        put(heap, at, heap->item[child]);
        at = child;
    }
    put(heap, at, last);
    return top;
}
