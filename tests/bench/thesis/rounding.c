/* Thesis 6.3.3: mean energies of rounding random targets with the period matrix of a surface, in
 * percent of direct rounding. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct method {
    const char *name;
    double thesis; /* percent, on its bunny */
    int32_t start, radius;
    int64_t budget;
} method;

static const method METHODS[] = {
    {"direct", 100, QC_ROUND_DIRECT, 0, 0},        {"greedy (MIQ)", 61.0, QC_ROUND_GREEDY, 0, 0},
    {"r = 1", 63.8, QC_ROUND_DIRECT, 1, 0},        {"r = 3", 54.8, QC_ROUND_DIRECT, 3, 0},
    {"greedy, r = 3", NAN, QC_ROUND_GREEDY, 3, 0}, {"ours", NAN, QC_ROUND_GREEDY, 3, -1},
};
enum { N_METHODS = (int)(sizeof METHODS / sizeof *METHODS), COLUMNS = N_METHODS + 1 };
enum { RUNS = 3, SWEEPS = 60000 }; /* of annealing */

typedef struct outcome {
    double share[COLUMNS], seconds[COLUMNS]; /* percent; of the last column: annealed */
} outcome;

static double round_once(qc_ctx *ctx, const method *m, int32_t n, const double *P, const double *t,
                         double *z, double *seconds) {
    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
    qc_lattice_result result;
    options.start = m->start;
    options.radius = m->radius;
    options.budget = m->budget;
    const double begin = bench_clock().cpu;
    bench_check(ctx, qc_lattice_round(ctx, n, P, t, &options, z, &result));
    *seconds += bench_clock().cpu - begin;
    return result.energy;
}

static outcome compare(qc_ctx *ctx, int32_t n, const double *P, int32_t instances, int64_t sweeps) {
    double *t = NEW(double, 2 * n), *z = t + n;
    outcome o = {{0}, {0}};
    for (int32_t k = 0; k < instances; k++) {
        double energy[COLUMNS];
        uint64_t state = 1000 + (uint64_t)k;
        for (int32_t i = 0; i < n; i++) t[i] = bench_uniform(&state);
        for (int m = 0; m < N_METHODS; m++)
            energy[m] = round_once(ctx, &METHODS[m], n, P, t, z, &o.seconds[m]);
        const double begin = bench_clock().cpu;
        energy[N_METHODS] = thesis_anneal(ctx, n, P, t, RUNS, sweeps);
        o.seconds[N_METHODS] += bench_clock().cpu - begin;
        for (int c = 0; c < COLUMNS; c++) o.share[c] += 100 * energy[c] / energy[0] / instances;
    }
    for (int c = 0; c < COLUMNS; c++) o.seconds[c] *= 1e3 / instances;
    free(t);
    return o;
}

static void surface(const thesis_run *run, const char *mesh, int32_t instances, int64_t sweeps) {
    const bench_source source = {thesis_mesh(run, mesh), 10000, 0, NULL};
    const char *column[COLUMNS];
    double thesis[COLUMNS];
    char label[128], stem[64];
    int32_t n = 0;
    qc_matching *matching = bench_surface(run->ctx, &source);
    qc_sizing *sizing = bench_sizing(run->ctx, matching->field->mesh, source.quads);
    double *P = thesis_period_matrix(run->ctx, matching, sizing, &n);
    const outcome o = compare(run->ctx, n, P, instances, sweeps);
    for (int c = 0; c < COLUMNS; c++) {
        column[c] = c < N_METHODS ? METHODS[c].name : "annealed";
        thesis[c] = c < N_METHODS ? METHODS[c].thesis : NAN;
    }
    bench_stem(source.path, sizeof stem, stem);
    snprintf(label, sizeof label, "%s, %d variables, %d instances", stem, (int)n, (int)instances);
    thesis_head(label, COLUMNS, column);
    thesis_compare("E_H, %", COLUMNS, thesis, o.share);
    thesis_row("ms each", COLUMNS, o.seconds);
    fflush(stdout);
    qc_object_release(sizing);
    qc_object_release(matching);
    free(P);
}

void thesis_rounding(thesis_run *run) {
    if (run->quick) {
        surface(run, NULL, 2, 100);
        return;
    }
    surface(run, "bunny.off", 100, SWEEPS);
    surface(run, "fertility.off", 20, SWEEPS);
    surface(run, "botijo.obj", 20, SWEEPS);
}
