/* Levels of features (see features.h). Internal to sdk/map. */
#ifndef QC_MAP_LEVELS_H
#define QC_MAP_LEVELS_H

#include "sdk/map/seams/features.h"

typedef struct qc__symbol_term {
    int32_t symbol, value;
} qc__symbol_term;

typedef struct qc__coordinate { /* x = sign L + offset_sign offset */
    int32_t level;              /* L; -1 = the coordinate is on no feature */
    int8_t sign, offset_sign;
    int32_t n; /* terms of the offset, from `start` in the pool */
    int64_t start;
} qc__coordinate;

typedef struct qc__levels {
    qc__coordinate *coordinate; /* 2 n_vertices; NULL = no features */
    qc__symbol_term *pool;      /* translations */
} qc__levels;

/* The levels of s and their relations, and which coordinates of the F_v they determine. Errors:
 * NOMEM; free as well then. */
qc_status qc__levels_find(qc_ctx *ctx, qc__seams *s, const qc__features *f, qc__levels *out);
void qc__levels_free(qc__levels *levels);

#endif
