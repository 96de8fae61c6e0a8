/* An allocator which counts blocks and fails once, at a given allocation. */
#ifndef QC_TESTS_COUNTING_H
#define QC_TESTS_COUNTING_H

#include <stdint.h>
#include <stdlib.h>

typedef struct counter {
    int64_t made, fail_at, blocks; /* fail_at < 0: none fails */
} counter;

static inline void *counting_resize(void *user, void *p, size_t old_size, size_t new_size) {
    counter *c = user;
    (void)old_size;
    if (new_size == 0) {
        c->blocks -= p != NULL;
        free(p);
        return NULL;
    }
    if (c->made++ == c->fail_at) return NULL;
    void *q = realloc(p, new_size);
    c->blocks += q && !p;
    return q;
}

#endif
