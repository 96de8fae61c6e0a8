/* Large neighbourhood search in the lattice. Neighbourhoods are the entries which couple most
 * strongly with one entry, by |P_ij| / sqrt(P_jj).
 *   - Sweeps: every neighbourhood is solved exactly (window.c), in two widths, until none
 *     gains. A neighbourhood of everything is all that is needed.
 *   - Then kicks: a few entries of one neighbourhood are changed at random, and tabu search (Glover
 *     1989: the best step, even upwards, but no entry again before some others) looks for an
 *     energy below that from which it left; if it finds none the kick is taken back.
 * Best in a reduced basis (reduce.c), where single entries hardly interact. The result
 * depends on the seed and on the budget, which counts entries of P read, not seconds. */
#include "sdk/sparse/lattice/internal.h"
#include <math.h>
#include <string.h>

enum {
    NARROW = 20,   /* first sweep, and entries among which kicks choose; the last one: all */
    SHARE = 64,    /* inverse part of the budget which a sweep may cost */
    KICK = 8,      /* entries changed at random */
    TENURE = 8,    /* steps before an entry may change again: so many to twice as many */
    PATIENCE = 50, /* steps without a new lowest energy since the kick */
    TOUCHED = 4096 /* steps after one kick, at most */
};
static const double least_gain = 1e-10; /* of the first energy and of the largest P_ii */
static const double forbidden = INFINITY;

typedef struct neighbourhoods {
    qc__lattice *Q;
    int32_t width;
    int32_t *near;          /* n x width: by coupling, first the entry itself */
    double *half, *allowed; /* P_ii / 2; allowed: forbidden while tabu */
    double *z_best, *g_best;
    int32_t *touched; /* entries changed since z was z_best */
    int64_t n_touched;
    double energy, energy_best, gain; /* gain: least which counts */
    int32_t ring[2 * TENURE];         /* the last entries changed, -1: none */
    int32_t tenure, turn;
    uint64_t random;
    int64_t budget;
} neighbourhoods;

/* splitmix64 (Steele, Lea, Flood 2014) */
static uint32_t random_below(neighbourhoods *N, uint32_t n) {
    uint64_t x = N->random += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)(((x ^ (x >> 31)) >> 32) * n >> 32);
}

/* --- neighbourhoods --------------------------------------------------------------------------- */

/* The strongest ones by insertion; ties go to the lower index. */
static void find_near(neighbourhoods *N, int64_t i) {
    const int64_t n = N->Q->n;
    const double *p = N->Q->P + i * n;
    int32_t *near = N->near + i * N->width, count = 1;
    double strength[QC__LATTICE_WINDOW];
    near[0] = (int32_t)i;
    for (int64_t j = 0; j < n; j++) {
        const double s = p[j] * p[j] / N->half[j];
        if (j == i) continue;
        if (count == N->width && !(s > strength[count - 1] * (1 + qc__lattice_tie))) continue;
        int32_t at = count < N->width ? count++ : count - 1;
        for (; at > 1 && s > strength[at - 1] * (1 + qc__lattice_tie); at--) {
            strength[at] = strength[at - 1];
            near[at] = near[at - 1];
        }
        strength[at] = s;
        near[at] = (int32_t)j;
    }
    N->Q->work += n;
}

static void add(qc__lattice *Q, int64_t i, double step) {
    const int64_t n = Q->n;
    const double *column = Q->P + i * n;
    Q->z[i] += step;
    for (int64_t k = 0; k < n; k++) Q->g[k] += step * column[k];
    Q->work += n;
}

/* Solves neighbourhoods of this width exactly until none gains; unless n is small that is not worth
 * more than a small part of the budget. */
static qc_status sweep(qc_ctx *ctx, neighbourhoods *N, int32_t width) {
    qc__lattice *Q = N->Q;
    double change[QC__LATTICE_WINDOW];
    const int64_t n = Q->n, needed = width == n ? 1 : n, cost = n * width * width * width;
    if (width > n || (width < n && cost * SHARE > N->budget)) return QC_OK;
    int64_t idle = 0, reported = Q->work;
    for (int64_t i = 0; idle < needed && Q->work < N->budget; i = (i + 1) % n) {
        const int32_t *near = N->near + i * N->width;
        const double gain = qc__lattice_window(Q, near, width, N->gain, change, &Q->work);
        idle = gain < 0 ? 0 : idle + 1;
        if (gain < 0) {
            for (int32_t k = 0; k < width; k++)
                if (change[k] != 0) add(Q, near[k], change[k]);
            N->energy += gain;
            Q->moves++;
        }
        if (Q->work - reported < QC__LATTICE_REPORT) continue;
        reported = Q->work;
        if (!qc__progress(ctx, (double)Q->work / (double)N->budget)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* --- kicks ------------------------------------------------------------------------------------ */

/* Changes entry i by a step against or along its slope and forbids it for a while. */
static void step(neighbourhoods *N, int64_t i, bool against) {
    const double sign = (N->Q->g[i] > 0) == against ? -1.0 : 1.0;
    N->energy += N->half[i] + sign * N->Q->g[i];
    add(N->Q, i, sign);
    N->touched[N->n_touched++] = (int32_t)i;
    const int32_t freed = N->ring[N->turn];
    if (freed >= 0) N->allowed[freed] = N->half[freed];
    N->ring[N->turn] = (int32_t)i;
    N->allowed[i] = forbidden;
    N->turn = (N->turn + 1) % N->tenure;
}

/* The entry whose best step costs least, or -1. */
static int64_t cheapest(const neighbourhoods *N) {
    enum { LANES = 8 };
    const int64_t n = N->Q->n, whole = n - n % LANES;
    const double *a = N->allowed, *g = N->Q->g;
    double low[LANES], least = forbidden;
    for (int l = 0; l < LANES; l++) low[l] = forbidden;
    for (int64_t i = 0; i < whole; i += LANES)
        for (int l = 0; l < LANES; l++) {
            const double cost = a[i + l] - fabs(g[i + l]);
            low[l] = cost < low[l] ? cost : low[l];
        }
    for (int l = 0; l < LANES; l++) least = low[l] < least ? low[l] : least;
    for (int64_t i = whole; i < n; i++) least = fmin(least, a[i] - fabs(g[i]));
    if (least == forbidden) return -1;
    for (int64_t i = 0; i < n; i++)
        if (a[i] - fabs(g[i]) <= least + qc__lattice_tie * N->half[i]) return i;
    return -1;
}

/* The present z is the best from now on, */
static void keep(neighbourhoods *N) {
    for (int64_t k = 0; k < N->n_touched; k++) N->z_best[N->touched[k]] = N->Q->z[N->touched[k]];
    memcpy(N->g_best, N->Q->g, (size_t)N->Q->n * sizeof *N->g_best);
    N->energy_best = N->energy;
    N->n_touched = 0;
    N->Q->moves++;
}
/* or the best becomes the present one. */
static void take_back(neighbourhoods *N) {
    for (int64_t k = 0; k < N->n_touched; k++) N->Q->z[N->touched[k]] = N->z_best[N->touched[k]];
    memcpy(N->Q->g, N->g_best, (size_t)N->Q->n * sizeof *N->g_best);
    N->energy = N->energy_best;
    N->n_touched = 0;
}

static void kick(neighbourhoods *N) {
    const int32_t *near = N->near + random_below(N, (uint32_t)N->Q->n) * (int64_t)N->width;
    N->tenure = TENURE + (int32_t)random_below(N, TENURE);
    N->turn = 0;
    for (int32_t k = 0; k < N->tenure; k++) N->ring[k] = -1;
    for (int32_t k = 0; k < KICK; k++) {
        const int32_t i = near[k ? random_below(N, NARROW) : 0];
        const bool against = random_below(N, 4) > 0;
        if (N->allowed[i] < forbidden) step(N, i, against);
    }
    double lowest = INFINITY;
    for (int32_t idle = 0; idle < PATIENCE && N->Q->work < N->budget; idle++) {
        const int64_t i = cheapest(N);
        if (i < 0) break;
        step(N, i, true);
        N->Q->evaluations += N->Q->n;
        if (N->energy >= lowest - N->gain) continue;
        lowest = N->energy;
        idle = 0;
        if (lowest < N->energy_best - N->gain) keep(N);
        if (N->n_touched >= TOUCHED) break;
    }
    take_back(N);
    for (int32_t k = 0; k < N->tenure; k++)
        if (N->ring[k] >= 0) N->allowed[N->ring[k]] = N->half[N->ring[k]];
}

/* --- the whole -------------------------------------------------------------------------------- */

static qc_status prepare(qc_ctx *ctx, neighbourhoods *N, double *vectors) {
    const int64_t n = N->Q->n;
    N->half = vectors;
    N->allowed = vectors + n;
    N->z_best = vectors + 2 * n;
    N->g_best = vectors + 3 * n;
    for (int64_t i = 0; i < n; i++) N->half[i] = N->allowed[i] = 0.5 * N->Q->P[i + i * n];
    for (int64_t i = 0; i < n; i++) {
        find_near(N, i);
        if (i % 64 == 0 && !qc__progress(ctx, 0.0)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

static qc_status search(qc_ctx *ctx, neighbourhoods *N) {
    qc__lattice *Q = N->Q;
    const size_t bytes = (size_t)Q->n * sizeof *Q->z;
    double largest = 0;
    for (int64_t i = 0; i < Q->n; i++) largest = fmax(largest, N->half[i]);
    N->energy = qc__lattice_gradient(Q);
    N->gain = least_gain * (N->energy + largest);
    qc_status status = sweep(ctx, N, NARROW);
    if (status == QC_OK) status = sweep(ctx, N, N->width);
    if (status != QC_OK || N->width == Q->n) return status;
    N->energy = N->energy_best = qc__lattice_gradient(Q);
    memcpy(N->z_best, Q->z, bytes);
    memcpy(N->g_best, Q->g, bytes);
    for (int64_t reported = Q->work; Q->work < N->budget && N->energy > N->gain;) {
        kick(N);
        if (Q->work - reported < QC__LATTICE_REPORT) continue;
        reported = Q->work;
        if (!qc__progress(ctx, (double)Q->work / (double)N->budget)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

qc_status qc__lattice_neighbourhoods(qc_ctx *ctx, qc__lattice *Q, uint64_t seed, int64_t budget) {
    const int32_t n = Q->n, width = n < QC__LATTICE_WINDOW ? n : QC__LATTICE_WINDOW;
    neighbourhoods N = {.Q = Q, .width = width, .random = seed, .budget = budget};
    double *vectors = QC__NEW(ctx, double, 4 * (int64_t)n);
    N.near = QC__NEW(ctx, int32_t, (int64_t)n * width);
    N.touched = QC__NEW(ctx, int32_t, TOUCHED + KICK);
    qc_status status = QC_ERR_NOMEM;
    if (vectors && N.near && N.touched) {
        status = prepare(ctx, &N, vectors);
        if (status == QC_OK) status = search(ctx, &N);
    }
    qc__free(vectors);
    qc__free(N.near);
    qc__free(N.touched);
    return status;
}
