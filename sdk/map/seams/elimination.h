/* Sums of integer symbols in which eliminated symbols are replaced. Internal to sdk/map.
 *
 * Each eliminated symbol has a row: the sum of other symbols which it equals, all of them
 * eliminated later, if at all. One sum at a time is collected in a dense accumulator. */
#ifndef QC_MAP_ELIMINATION_H
#define QC_MAP_ELIMINATION_H

#include "sdk/base/internal.h"

typedef struct qc__span { /* a row of `term`; n = -1: there is none */
    int64_t start;
    int32_t n;
} qc__span;

typedef struct qc__term {
    int32_t symbol;
    int64_t value;
} qc__term;

typedef struct qc__elimination {
    int32_t n;              /* symbols */
    qc__span *row;          /* n */
    int32_t *time;          /* n: of elimination */
    int32_t *order, n_done; /* eliminated symbols, earliest first */
    qc__term *term;
    int64_t n_terms, term_capacity;
    int64_t *sum; /* dense accumulator ... */
    uint8_t *in_sum;
    int32_t *touched, n_touched; /* ... and the symbols in it */
    int32_t *heap, n_heap;       /* eliminated symbols in the sum, by time */
    int64_t row_capacity, time_capacity, order_capacity, sum_capacity, in_sum_capacity,
        touched_capacity, heap_capacity;
    bool overflow; /* a value was beyond 2^40: nothing holds any more */
} qc__elimination;

/* Room for symbols up to n; false = no memory, as below. */
bool qc__elimination_grow(qc_ctx *ctx, qc__elimination *e, int32_t n);
void qc__elimination_free(qc__elimination *e);
/* Gives `symbol` a row. */
void qc__eliminate(qc__elimination *e, int32_t symbol, qc__span row);
/* Makes all rows sums of symbols which are not eliminated, unless values overflow. */
bool qc__elimination_expand(qc_ctx *ctx, qc__elimination *e);

void qc__sum_add(qc__elimination *e, int32_t symbol, int64_t value);
void qc__sum_add_row(qc__elimination *e, qc__span row, int64_t factor);
/* Replaces eliminated symbols. */
void qc__sum_substitute(qc__elimination *e);
/* Drops zeros and divides by the content. */
void qc__sum_normalise(qc__elimination *e);
/* A symbol with coefficient +-1: `prefer` where it has, else the last one, -1 = none. */
int32_t qc__sum_unit(const qc__elimination *e, int32_t prefer);
/* Room for n more terms. */
bool qc__terms_reserve(qc_ctx *ctx, qc__elimination *e, int64_t n);
/* Stores factor * sum without `skip`. */
bool qc__sum_store(qc_ctx *ctx, qc__elimination *e, int64_t factor, int32_t skip, qc__span *out);
/* sum = 0 eliminates symbol `unit`, which has coefficient +-1. */
bool qc__sum_eliminate(qc_ctx *ctx, qc__elimination *e, int32_t unit);
void qc__sum_clear(qc__elimination *e);

#endif
