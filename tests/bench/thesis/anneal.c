/* Simulated annealing with single steps in a reduced basis: the reference, slow. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/sparse/lattice/internal.h"

static const double hot = 0.06, cold = 0.003; /* of the mean G_ii */

static double anneal(qc__lattice *Q, int64_t sweeps, uint64_t *state) {
    const int64_t n = Q->n;
    double mean = 0, energy = qc__lattice_gradient(Q), best = energy;
    for (int64_t i = 0; i < n; i++) mean += Q->P[i + i * n] / (double)n;
    for (int64_t sweep = 0; sweep < sweeps; sweep++) {
        const double heat = mean * hot * pow(cold / hot, (double)sweep / (double)sweeps);
        for (int64_t q = 0; q < n; q++) {
            const int64_t i = (int64_t)(bench_uniform(state) * (double)n);
            double sign = Q->g[i] > 0 ? -1 : 1;
            if (bench_uniform(state) < 0.125) sign = -sign;
            const double change = 0.5 * Q->P[i + i * n] + sign * Q->g[i];
            if (change > 0 && bench_uniform(state) >= exp(-change / heat)) continue;
            Q->z[i] += sign;
            for (int64_t k = 0; k < n; k++) Q->g[k] += sign * Q->P[k + i * n];
            energy += change;
            best = fmin(best, energy);
        }
    }
    return best;
}

double thesis_anneal(qc_ctx *ctx, int32_t n, const double *P, const double *t, int32_t runs,
                     int64_t sweeps) {
    const size_t N = (size_t)n, square = N * N * sizeof(double);
    double *U = bench_alloc(1, square), *G = bench_alloc(1, square), *work = bench_alloc(1, square);
    double *vectors = NEW(double, 3 * N), best = INFINITY;
    memcpy(vectors, t, N * sizeof *t);
    qc__lattice_basis B = {n, U, G, vectors, 0, INT64_MAX};
    bench_check(ctx, qc__lattice_reduce(ctx, &B, P, work));
    uint64_t state = 1;
    for (int32_t run = 0; run < runs; run++) {
        qc__lattice Q = {.n = n, .P = G, .t = vectors, .z = vectors + N, .g = vectors + 2 * N};
        for (size_t i = 0; i < N; i++) Q.z[i] = rint(Q.t[i]);
        best = fmin(best, anneal(&Q, sweeps, &state));
    }
    free(U);
    free(G);
    free(work);
    free(vectors);
    return best;
}
