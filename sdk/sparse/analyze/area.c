/* Places of blocks in one area of memory, planned before any exists: first fit among the live ones,
 * with a bounded search so that any tree is planned in linear time. */
#include "sdk/sparse/analyze/area.h"

enum { SEARCH = 64 };

qc_status qc__area_create(qc_ctx *ctx, int32_t n, int64_t *offset, qc__area *out) {
    *out = (qc__area){.offset = offset, .head = -1, .tail = -1, .before_gap = -1};
    out->size = QC__NEW(ctx, int64_t, n);
    out->next = QC__NEW(ctx, int32_t, n);
    out->previous = QC__NEW(ctx, int32_t, n);
    return out->size && out->next && out->previous ? QC_OK : QC_ERR_NOMEM;
}

void qc__area_free(qc__area *area) {
    qc__free(area->size);
    qc__free(area->next);
    qc__free(area->previous);
}

static int64_t end_of(const qc__area *area, int32_t block) {
    return block == -1 ? 0 : area->offset[block] + area->size[block];
}

static int32_t after(const qc__area *area, int32_t block) {
    return block == -1 ? area->head : area->next[block];
}

static void insert(qc__area *area, int32_t previous, int32_t block) {
    const int32_t next = after(area, previous);
    area->previous[block] = previous;
    area->next[block] = next;
    *(previous == -1 ? &area->head : &area->next[previous]) = block;
    *(next == -1 ? &area->tail : &area->previous[next]) = block;
}

void qc__area_place(qc__area *area, int32_t block, int64_t size) {
    area->size[block] = size;
    area->offset[block] = 0;
    if (size == 0) return;
    int32_t previous = area->before_gap, next = after(area, previous);
    for (int k = 0; next != -1; k++) {
        if (area->offset[next] - end_of(area, previous) >= size) break;
        previous = k < SEARCH ? next : area->tail;
        next = after(area, previous);
    }
    area->offset[block] = end_of(area, previous);
    insert(area, previous, block);
    if (previous == area->before_gap) area->before_gap = block;
    if (end_of(area, block) > area->total) area->total = end_of(area, block);
}

void qc__area_release(qc__area *area, int32_t block) {
    if (area->size[block] == 0) return;
    const int32_t previous = area->previous[block], next = area->next[block];
    *(previous == -1 ? &area->head : &area->next[previous]) = next;
    *(next == -1 ? &area->tail : &area->previous[next]) = previous;
    if (area->before_gap == block || end_of(area, area->before_gap) > end_of(area, previous))
        area->before_gap = previous;
}
