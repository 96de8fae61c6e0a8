/* The comparison of ways to round periods, thesis 6.3.3. */
#ifndef QC_BENCH_LATTICE_H
#define QC_BENCH_LATTICE_H

#include "sdk/sparse/lattice/internal.h"

/* Exits with a message unless OK. */
void bench_check(qc_ctx *ctx, qc_status status);
/* Next of a fixed sequence in [0, 1). */
double bench_uniform(uint64_t *state);

/* problem.c: the period matrix of a mesh file with the field of the default pipeline; without a
 * file that of a generated surface. n x n, free() it. */
double *bench_period_matrix(qc_ctx *ctx, const char *path, int32_t *n);
/* anneal.c: least energy which `runs` slow simulated annealings find in a reduced basis. */
double bench_anneal(qc_ctx *ctx, int32_t n, const double *P, const double *t, int32_t runs,
                    int64_t sweeps);

#endif
