/* bench_lattice [--smoke] [--instances N] [MESH ...]: the table of thesis 6.3.3, mean energies of
 * rounding random targets with the period matrices of surfaces, in percent of direct rounding. */
#include "tests/bench/lattice/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct method {
    const char *name;
    int32_t start, radius;
    int64_t budget;
} method;

static const method METHODS[] = {
    {"direct", QC_ROUND_DIRECT, 0, 0},   {"greedy", QC_ROUND_GREEDY, 0, 0},
    {"r = 1", QC_ROUND_DIRECT, 1, 0},    {"r = 3", QC_ROUND_DIRECT, 3, 0},
    {"g, r = 3", QC_ROUND_GREEDY, 3, 0}, {"search", QC_ROUND_GREEDY, 3, -1},
};
enum { N_METHODS = (int)(sizeof METHODS / sizeof *METHODS), RUNS = 3, SWEEPS = 60000 };

void bench_check(qc_ctx *ctx, qc_status status) {
    if (status == QC_OK) return;
    fprintf(stderr, "bench_lattice: %s\n", qc_ctx_error(ctx)->text);
    exit(1);
}

double bench_uniform(uint64_t *state) {
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (double)((x ^ (x >> 31)) >> 11) / 9007199254740992.0;
}

static void compare(qc_ctx *ctx, const char *path, int32_t instances, bool smoke) {
    int32_t n = 0;
    double *P = bench_period_matrix(ctx, path, &n);
    double *t = malloc(2 * (size_t)n * sizeof *t + 1), *z = t + n;
    double share[N_METHODS] = {0}, seconds[N_METHODS] = {0}, annealed = 0;
    for (int32_t k = 0; k < instances && n > 0; k++) {
        double direct = 1;
        uint64_t state = 1000 + (uint64_t)k;
        for (int32_t i = 0; i < n; i++) t[i] = bench_uniform(&state);
        for (int32_t m = 0; m < N_METHODS; m++) {
            qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
            qc_lattice_result result;
            options.start = METHODS[m].start;
            options.radius = METHODS[m].radius;
            options.budget = METHODS[m].budget;
            const double begin = qc__now();
            bench_check(ctx, qc_lattice_round(ctx, n, P, t, &options, z, &result));
            seconds[m] += (qc__now() - begin) / instances;
            if (m == 0) direct = result.energy;
            share[m] += 100 * result.energy / direct / instances;
        }
        const int64_t sweeps = smoke ? 100 : SWEEPS;
        annealed += 100 * bench_anneal(ctx, n, P, t, RUNS, sweeps) / direct / instances;
    }
    const char *slash = path ? strrchr(path, '/') : NULL;
    printf("| %s | %d |", slash ? slash + 1 : path ? path : "generated", (int)n);
    for (int32_t m = 1; m < N_METHODS; m++) printf(" %.2f |", share[m]);
    printf(" %.2f | %.1f | %.1f |\n", annealed, 1e3 * seconds[3], 1e3 * seconds[N_METHODS - 1]);
    fflush(stdout);
    free(t);
    free(P);
}

int main(int argc, char **argv) {
    bool smoke = false;
    int32_t instances = 100, meshes = 0;
    qc_ctx *ctx = NULL;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = 1;
    bench_check(ctx, qc_ctx_create(&options, &ctx));
    printf("| surface | variables |");
    for (int32_t m = 1; m < N_METHODS; m++) printf(" %s |", METHODS[m].name);
    printf(" annealed | r = 3, ms | search, ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--smoke") == 0) {
            smoke = true;
            instances = 2;
        } else if (strcmp(argv[i], "--instances") == 0 && i + 1 < argc) {
            instances = (int32_t)strtol(argv[++i], NULL, 10);
        } else {
            compare(ctx, argv[i], instances, smoke);
            meshes++;
        }
    }
    if (meshes == 0) compare(ctx, NULL, instances, smoke);
    qc_ctx_free(ctx);
    return 0;
}
