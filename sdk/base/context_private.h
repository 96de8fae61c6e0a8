/* Layout of qc_ctx, shared by the files of sdk/base only. */
#ifndef QC_BASE_CONTEXT_PRIVATE_H
#define QC_BASE_CONTEXT_PRIVATE_H

#include "sdk/base/internal.h"
#include <stdatomic.h>

typedef struct qc__pool qc__pool;

struct qc_ctx {
    void *(*resize)(void *user, void *p, size_t old_size, size_t new_size);
    void (*log)(void *user, int32_t level, const char *stage, const char *text);
    bool (*progress)(void *user, const char *stage, double fraction);
    void (*sample)(void *user, const char *stage, const char *curve, double x, double y);
    void *user;
    uint32_t threads;
    qc__isa isa;
    qc__pool *pool; /* made by the first parallel_for which needs it */

    qc__range range;
    double furthest; /* fraction reported within the outermost range: a bar never runs back */
    atomic_bool cancelled;
    qc__time time;
    char detail[128];

    qc_error error;
    char stage_text[64], error_text[512];
};

void qc__pool_free(qc__pool *pool);
/* malloc which asks for large pages where a block is large enough to gain. */
void *qc__large_block(size_t size);

#endif
