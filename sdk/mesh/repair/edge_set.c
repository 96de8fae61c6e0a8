/* A set of undirected edges: open hashing of vertex pairs, sized once. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

qc_status qc__edge_set_create(qc_ctx *ctx, int64_t most, qc__edge_set *out) {
    size_t size = 16;
    while (size < (size_t)(most + most / 2)) size *= 2;
    out->mask = size - 1;
    out->slot = QC__ZERO(ctx, uint64_t, size);
    return out->slot ? QC_OK : QC_ERR_NOMEM;
}

/* The place of the edge, or the free place where it belongs. Keys are never 0: vertices count
 * from 1. */
static size_t find(const qc__edge_set *s, uint64_t key) {
    uint64_t h = key * UINT64_C(0x9e3779b97f4a7c15);
    size_t i = (size_t)(h ^ h >> 32) & s->mask;
    while (s->slot[i] && s->slot[i] != key) i = (i + 1) & s->mask;
    return i;
}

static uint64_t edge_key(int32_t a, int32_t b) {
    uint64_t lo = (uint64_t)(a < b ? a : b) + 1, hi = (uint64_t)(a < b ? b : a) + 1;
    return lo << 32 | hi;
}

bool qc__edge_set_has(const qc__edge_set *s, int32_t a, int32_t b) {
    return s->slot[find(s, edge_key(a, b))] != 0;
}

void qc__edge_set_add(qc__edge_set *s, int32_t a, int32_t b) {
    uint64_t key = edge_key(a, b);
    s->slot[find(s, key)] = key;
}
