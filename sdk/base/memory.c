/* Aligned blocks which remember their allocator, growing arrays and arenas. */
#include "sdk/base/context_private.h"
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

typedef struct block_header {
    void *raw; /* what the allocator returned */
    size_t raw_size, size;
    void *(*resize)(void *user, void *p, size_t old_size, size_t new_size);
    void *user;
    char pad[ALIGNMENT - 3 * sizeof(size_t) - 2 * sizeof(void *)];
} block_header;

_Static_assert(sizeof(block_header) == ALIGNMENT, "the payload follows the header directly");

static block_header *header_of(void *p) {
    return (block_header *)((char *)p - ALIGNMENT);
}

void *qc__malloc(qc_ctx *ctx, size_t count, size_t size) {
    const size_t overhead = 2 * (size_t)ALIGNMENT;
    if (size != 0 && count > (SIZE_MAX / 2 - overhead) / size) {
        qc__nomem(ctx);
        return NULL;
    }
    const size_t bytes = count * size, raw_size = bytes + overhead;
    char *raw = ctx->resize(ctx->user, NULL, 0, raw_size);
    if (!raw) {
        qc__nomem(ctx);
        return NULL;
    }
    const uintptr_t first = ((uintptr_t)raw + ALIGNMENT - 1) & ~(uintptr_t)(ALIGNMENT - 1);
    block_header *header = (block_header *)first;
    header->raw = raw;
    header->raw_size = raw_size;
    header->size = bytes;
    header->resize = ctx->resize;
    header->user = ctx->user;
    return (char *)header + ALIGNMENT;
}

void *qc__calloc(qc_ctx *ctx, size_t count, size_t size) {
    void *p = qc__malloc(ctx, count, size);
    if (p) memset(p, 0, count * size);
    return p;
}

void *qc__realloc(qc_ctx *ctx, void *p, size_t count, size_t size) {
    void *q = qc__malloc(ctx, count, size);
    if (q && p) {
        const size_t old_size = header_of(p)->size;
        memcpy(q, p, old_size < count * size ? old_size : count * size);
        qc__free(p);
    }
    return q;
}

bool qc__shrink(qc_ctx *ctx, void **array, int64_t count, size_t size) {
    void *p = qc__realloc(ctx, *array, (size_t)count, size);
    if (p) *array = p;
    return p != NULL;
}

void qc__free(void *p) {
    if (!p) return;
    const block_header header = *header_of(p);
    header.resize(header.user, header.raw, header.raw_size, 0);
}

bool qc__reserve(qc_ctx *ctx, void **array, int64_t *capacity, int64_t need, size_t size) {
    if (need <= *capacity) return true;
    int64_t grown = *capacity < 16 ? 16 : *capacity + *capacity / 2;
    if (grown < need) grown = need;
    void *p = qc__realloc(ctx, *array, (size_t)grown, size);
    if (!p) return false;
    *array = p;
    *capacity = grown;
    return true;
}

/* --- arena ------------------------------------------------------------------------------------ */

typedef struct arena_block {
    struct arena_block *next;
    size_t used, size;
} arena_block;

struct qc__arena {
    qc_ctx *ctx;
    arena_block *first;
};

enum { ARENA_HEADER = 32, ARENA_BLOCK = 1 << 16 };
_Static_assert(sizeof(arena_block) <= ARENA_HEADER, "room for the block header");

qc__arena *qc__arena_create(qc_ctx *ctx) {
    qc__arena *arena = QC__NEW(ctx, qc__arena, 1);
    if (arena) *arena = (qc__arena){ctx, NULL};
    return arena;
}

void *qc__arena_alloc(qc__arena *arena, size_t bytes) {
    if (bytes > SIZE_MAX / 4) return NULL;
    bytes = (bytes + 15) & ~(size_t)15;
    arena_block *block = arena->first;
    if (!block || block->size - block->used < bytes) {
        const size_t size = bytes > ARENA_BLOCK ? bytes : ARENA_BLOCK;
        block = qc__malloc(arena->ctx, 1, ARENA_HEADER + size);
        if (!block) return NULL;
        *block = (arena_block){arena->first, 0, size};
        arena->first = block;
    }
    void *p = (char *)block + ARENA_HEADER + block->used;
    block->used += bytes;
    return p;
}

void qc__arena_free(qc__arena *arena) {
    if (!arena) return;
    for (arena_block *block = arena->first; block;) {
        arena_block *next = block->next;
        qc__free(block);
        block = next;
    }
    qc__free(arena);
}
