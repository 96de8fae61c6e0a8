/* A context whose allocator counts blocks and fails on request. */
#ifndef QC_TESTS_BASE_TEST_H
#define QC_TESTS_BASE_TEST_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "sdk/base/internal.h"

typedef struct counter {
    int64_t allowed; /* allocations before one fails; < 0 = all succeed */
    int64_t blocks, bytes;
} counter;

static void *counting_resize(void *user, void *p, size_t old_size, size_t new_size) {
    counter *c = user;
    if (new_size == 0) {
        if (p) c->blocks--, c->bytes -= (int64_t)old_size;
        free(p);
        return NULL;
    }
    if (c->allowed == 0) return NULL;
    if (c->allowed > 0) c->allowed--;
    if (!p) c->blocks++;
    c->bytes += (int64_t)new_size - (int64_t)(p ? old_size : 0);
    return realloc(p, new_size);
}

static inline qc_ctx *counting_context(counter *c, uint32_t threads) {
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    *c = (counter){-1, 0, 0};
    o.resize = counting_resize;
    o.user = c;
    o.threads = threads;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    return ctx;
}

static inline void free_counting_context(qc_ctx *ctx, const counter *c) {
    qc_ctx_free(ctx);
    assert_int_equal(c->blocks, 0);
    assert_int_equal(c->bytes, 0);
}

#endif
