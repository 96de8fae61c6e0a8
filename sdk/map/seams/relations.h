/* Linear relations between integers, solved without fractions. Internal to sdk/map.
 *
 * Given relations sum_j c_j s_j = 0 between integer symbols s, every symbol becomes an integer
 * combination of free integers which no relation binds. A relation with a coefficient +-1 gives
 * that symbol by the others; with content divided out this is almost every one. Where none is left,
 * s_p = t - sum_j q_j s_j with the smallest coefficient c_p, q_j = round(c_j / c_p) and a new
 * symbol t is a unimodular change of variables which makes the coefficients smaller until one is
 * +-1 (Pugh, The Omega test, 1991: the column operations of the Hermite normal form, sparse). */
#ifndef QC_MAP_RELATIONS_H
#define QC_MAP_RELATIONS_H

#include "sdk/base/internal.h"

typedef struct qc__relations qc__relations;
qc_status qc__relations_create(qc_ctx *ctx, int32_t n_symbols, qc__relations **out);
void qc__relations_free(qc__relations *relations);

/* Adds sum of value[i] symbol[i] = 0 (equal symbols add). The relation gives symbol `prefer` (-1 =
 * none) where that has a coefficient +-1 after the earlier relations, else the last symbol which
 * has; *pivot (may be NULL) is that symbol, -1 when there is none yet. Errors: NOMEM, FAILED (a
 * coefficient beyond 2^40). */
qc_status qc__relations_add(qc_ctx *ctx, qc__relations *relations, int32_t n, const int32_t *symbol,
                            const int64_t *value, int32_t prefer, int32_t *pivot);

/* Sparse rows. */
typedef struct qc__rows {
    int64_t *start; /* n + 1 */
    int32_t *column;
    double *value;
} qc__rows;
void qc__rows_free(qc__rows *rows);

/* Solves what is left. symbol (n_symbols rows) is each symbol by the *n_free free integers, and
 * free_integer (*n_free rows) each free integer by the symbols: free ones in their order, then the
 * new ones. */
qc_status qc__relations_solve(qc_ctx *ctx, qc__relations *relations, int32_t *n_free,
                              qc__rows *symbol, qc__rows *free_integer);

#endif
