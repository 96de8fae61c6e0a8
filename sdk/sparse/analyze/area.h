/* Planned places of update matrices in the shared area, see area.c. */
#ifndef QC_SPARSE_AREA_H
#define QC_SPARSE_AREA_H

#include "sdk/base/internal.h"

/* Blocks are numbers below n; live ones form a list by ascending offset. */
typedef struct qc__area {
    int64_t *offset; /* n, the caller's: filled by place */
    int64_t *size;
    int32_t *next, *previous, head, tail;
    int32_t before_gap; /* no gap lies in front of the end of this block (-1: of the area) */
    int64_t total;      /* largest end of any block so far */
} qc__area;

/* On failure, too, the area is to be freed. */
qc_status qc__area_create(qc_ctx *ctx, int32_t n, int64_t *offset, qc__area *out);
void qc__area_free(qc__area *area);
void qc__area_place(qc__area *area, int32_t block, int64_t size);
void qc__area_release(qc__area *area, int32_t block); /* a placed one */

#endif
