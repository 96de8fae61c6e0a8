/* A context for all tests of a group, in their state. */
#ifndef QC_TEST_CONTEXT_H
#define QC_TEST_CONTEXT_H

#include <qc/base.h>

static inline int set_up(void **state) {
    qc_ctx *ctx = NULL;
    if (qc_ctx_create(NULL, &ctx) != QC_OK) return -1;
    *state = ctx;
    return 0;
}

static inline int tear_down(void **state) {
    qc_ctx_free(*state);
    return 0;
}

#endif
