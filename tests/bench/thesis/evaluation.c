/* Thesis Table 6.1: times of the steps of an evaluation of E_D, with the factor made from scratch
 * and with updates of it. One thread, CPU time, medians over random edges. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/internal.h"

/* Steps in the columns of the table. */
enum { SMOOTH, CURL, FACTOR, SOLVE, OTHER, TOTAL, STEPS };
static const char *const STEP[STEPS] = {
    "min. E(alpha)", "curl* from alpha", "decompose, update L*", "solve Lx = b", "other", "total"};
enum { SCRATCH, UPDATE, WAYS };

/* The meshes of the thesis and ours which come nearest. ms. */
static const struct {
    const char *name;
    double scratch[STEPS], update[STEPS];
    const char *mesh;
    int32_t levels, repeat;
} MODELS[] = {
    {"bunny 3k",
     {0.1, 0.2, 15.5, 0.1, 0.3, 16.3},
     {0.1, 0.2, 0.1, 0.1, 0.2, 1.0},
     "bunny.off",
     0,
     200},
    {"bunny 20k",
     {1.0, 3.6, 208.6, 1.4, 0.7, 215.5},
     {0.9, 3.7, 0.7, 1.4, 1.7, 8.7},
     "rocker-arm.obj",
     0,
     100},
    {"armadillo 80k",
     {4.1, 17.4, 930.7, 8.8, 3.7, 965.0},
     {4.1, 17.4, 2.1, 8.8, 8.0, 40.5},
     "armadillo.obj",
     0,
     40},
    {"armadillo 346k",
     {NAN, NAN, NAN, NAN, NAN, NAN},
     {26.8, 87.9, 17.4, 33.4, 62.5, 228.2},
     "armadillo.obj",
     1,
     20},
};
enum { MODELS_COUNT = (int)(sizeof MODELS / sizeof *MODELS) };
static const double QUADS = 6500, LAMBDA = 0.9;

typedef struct outcome {
    double ms[WAYS][STEPS];
    double trial, analysis; /* ms: of one of QC__TRIALS trials without an update; of the ordering */
    double n, nnz, gflop, touched;
} outcome;

typedef struct clocks {
    bench_samples way[WAYS][STEPS], trial;
} clocks;

static bench_duration since(bench_duration begin) {
    const bench_duration now = bench_clock();
    return (bench_duration){now.wall - begin.wall, now.cpu - begin.cpu};
}

static qc_flip_step random_flip(const qc_distortion *d, uint64_t *state) {
    for (;;) {
        const int32_t e = (int32_t)(bench_uniform(state) * d->mesh->n_edges);
        if (qc_distortion_can_flip(d, e))
            return (qc_flip_step){e, bench_uniform(state) < 0.5 ? 1 : -1};
    }
}

/* The steps which both ways share: the angles, the curl of the field they give, |x|^2. */
static void time_common(qc_ctx *ctx, qc_distortion *d, bench_samples way[STEPS]) {
    const qc_flip_step none = {-1, 0};
    bench_duration begin = bench_clock();
    memcpy(d->angle, d->bend, (size_t)d->mesh->n_faces * sizeof *d->angle);
    bench_check(ctx, qc_solve_real(ctx, d->smoother.factor, 1, d->angle));
    bench_sample(&way[SMOOTH], since(begin));
    begin = bench_clock();
    qc__rotate_field(d->mesh->n_faces, d->angle, d->start->field->x, d->turned);
    qc__weak_curl(d, d->turned, none, d->curl);
    bench_sample(&way[CURL], since(begin));
}

static void time_solve(qc_ctx *ctx, qc_distortion *d, const qc_factor *factor,
                       bench_samples way[STEPS]) {
    const bench_duration begin = bench_clock();
    bench_check(ctx, qc_solve_forward(ctx, factor, 1, d->curl));
    bench_sample(&way[SOLVE], since(begin));
}

/* Other: assembling L*. */
static void time_scratch(qc_ctx *ctx, qc_distortion *d, const qc_symbolic *symbolic,
                         bench_samples way[STEPS]) {
    const qc_cover cover = {d->mesh, d->m};
    qc_stiffness *matrix = NULL;
    qc_factor *factor = NULL;
    const bench_duration start = bench_clock();
    time_common(ctx, d, way);
    bench_duration begin = bench_clock();
    bench_check(ctx, qc_stiffness_edges(ctx, &cover, d->cotangent, &matrix));
    bench_sample(&way[OTHER], since(begin));
    begin = bench_clock();
    bench_check(ctx, qc_factorize(ctx, symbolic, &matrix->A, &factor));
    bench_sample(&way[FACTOR], since(begin));
    time_solve(ctx, d, factor, way);
    bench_sample(&way[TOTAL], since(start));
    qc_stiffness_free(matrix);
    qc_factor_free(factor);
}

/* Total: qc_distortion_change, which takes the flip back as the limit cannot be met. */
static void time_update(qc_ctx *ctx, qc_distortion *d, qc_flip_step flip,
                        bench_samples way[STEPS]) {
    bench_duration begin = bench_clock();
    bench_check(ctx, qc_distortion_change(ctx, d, 1, &flip, -1, NULL, NULL));
    bench_sample(&way[TOTAL], since(begin));
    const qc__coupling c = qc__flip_coupling(d, flip);
    const qc_complex zero = {0, 0};
    const int last = c.n - 1;
    if (c.n == 0) return;
    time_common(ctx, d, way);
    bench_check(ctx, qc_factor_begin(ctx, d->factor));
    begin = bench_clock();
    const qc_status status =
        qc_flip(ctx, d->factor, c.k, c.row[0], c.d[0], c.row[last], last ? c.d[1] : zero);
    if (status == QC_OK) {
        bench_sample(&way[FACTOR], since(begin));
        time_solve(ctx, d, d->factor, way);
    }
    bench_check(ctx, qc_factor_rollback(ctx, d->factor));
}

static void time_trials(qc_ctx *ctx, qc_distortion *d, uint64_t *state, bench_samples *samples) {
    qc_flip_step flip[QC__TRIALS];
    double energy[QC__TRIALS];
    for (int i = 0; i < QC__TRIALS; i++) flip[i] = random_flip(d, state);
    const bench_duration begin = bench_clock();
    bench_check(ctx, qc_distortion_try(ctx, d, QC__TRIALS, flip, energy));
    const bench_duration all = since(begin);
    bench_sample(samples, (bench_duration){all.wall / QC__TRIALS, all.cpu / QC__TRIALS});
}

static qc_symbolic *analyse(qc_ctx *ctx, const qc_distortion *d, const qc_matching *matching,
                            outcome *o) {
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    qc_symbolic_info info = QC_SYMBOLIC_INFO_INIT;
    qc_symbolic *symbolic = NULL;
    options.ordering = QC_ORDER_DISSECTION;
    const bench_duration begin = bench_clock();
    bench_check(ctx, qc_analyze(ctx, &d->matrix->A, &options, &symbolic));
    o->analysis = 1e3 * since(begin).cpu;
    qc_symbolic_get_info(symbolic, &info);
    int32_t *perm = NEW(int32_t, d->n);
    bench_matrix *M = bench_make_matrix(ctx, "", matching, 0);
    qc_symbolic_get_permutation(symbolic, perm);
    const bench_quality quality = bench_order_quality(ctx, M, perm);
    o->n = d->n;
    o->nnz = 1e-6 * quality.nnz;
    o->gflop = 1e-9 * quality.flops;
    o->touched = 1e-3 * quality.touched;
    bench_matrix_free(M);
    free(perm);
    return symbolic;
}

static double middle(bench_samples *s) {
    const double ms = 1e3 * bench_median(s).cpu;
    free(s->value);
    return ms;
}

static outcome measure(qc_ctx *ctx, const bench_source *source, int32_t repeat, int32_t *faces) {
    outcome o = {0};
    clocks c = {0};
    uint64_t state = 1;
    qc_distortion *d = NULL;
    qc_matching *matching = bench_surface(ctx, source);
    qc_sizing *sizing = bench_sizing(ctx, matching->field->mesh, source->quads);
    bench_check(ctx, qc_distortion_create(ctx, matching, sizing, LAMBDA, &d));
    qc_symbolic *symbolic = analyse(ctx, d, matching, &o);
    for (int32_t i = 0; i < repeat; i++) {
        if (i < 10) time_scratch(ctx, d, symbolic, c.way[SCRATCH]);
        time_update(ctx, d, random_flip(d, &state), c.way[UPDATE]);
        time_trials(ctx, d, &state, &c.trial);
    }
    for (int w = 0; w < WAYS; w++)
        for (int s = 0; s < STEPS; s++) o.ms[w][s] = middle(&c.way[w][s]);
    double *ms = o.ms[UPDATE];
    ms[OTHER] = fmax(ms[TOTAL] - ms[SMOOTH] - ms[CURL] - ms[FACTOR] - ms[SOLVE], 0);
    o.trial = middle(&c.trial);
    *faces = d->mesh->n_faces;
    qc_symbolic_free(symbolic);
    qc_distortion_free(d);
    qc_object_release(sizing);
    qc_object_release(matching);
    return o;
}

static void print_times(int n, char (*name)[96], const outcome *o) {
    for (int w = 0; w < WAYS; w++) {
        printf("\n%s, ms:\n", w == SCRATCH ? "From scratch" : "By updates of the factor");
        thesis_head("thesis's model, ours", STEPS, STEP);
        for (int i = 0; i < n; i++)
            thesis_compare(name[i], STEPS, w ? MODELS[i].update : MODELS[i].scratch, o[i].ms[w]);
    }
    static const char *const column[] = {
        "thesis: by updates", "ours: by updates",          "ours: trials",
        "thesis / trials",    "scratch / updates: thesis", "ours"};
    printf("\nTrials, %d at a time and without touching the factor, ms each; gain over scratch:\n",
           QC__TRIALS);
    thesis_head("thesis's model, ours", 6, column);
    for (int i = 0; i < n; i++) {
        const double t = MODELS[i].update[TOTAL], scratch = MODELS[i].scratch[TOTAL];
        const double cell[] = {t,           o[i].ms[UPDATE][TOTAL],
                               o[i].trial,  t / o[i].trial,
                               scratch / t, o[i].ms[SCRATCH][TOTAL] / o[i].ms[UPDATE][TOTAL]};
        thesis_row(name[i], 6, cell);
    }
}

static void print_counts(int n, char (*name)[96], const outcome *o) {
    static const char *const column[] = {"rows of L*", "entries of L, M", "Gflop to factorise",
                                         "entries an update touches, k", "ordering once, ms"};
    printf("\nCounts which do not depend on the machine, and the ordering:\n");
    thesis_head("thesis's model, ours", 5, column);
    for (int i = 0; i < n; i++) {
        const double cell[] = {o[i].n, o[i].nnz, o[i].gflop, o[i].touched, o[i].analysis};
        thesis_row(name[i], 5, cell);
    }
}

void thesis_evaluation(thesis_run *run) {
    outcome o[MODELS_COUNT];
    char name[MODELS_COUNT][96], stem[64];
    const int n = run->quick ? 1 : MODELS_COUNT;
    for (int i = 0; i < n; i++) {
        const bench_source source = {thesis_mesh(run, MODELS[i].mesh), QUADS,
                                     run->quick ? 0 : MODELS[i].levels, NULL};
        int32_t faces = 0;
        o[i] = measure(run->ctx, &source, run->quick ? 2 : MODELS[i].repeat, &faces);
        bench_stem(source.path, sizeof stem, stem);
        snprintf(name[i], sizeof name[i], "%s, %s %d", MODELS[i].name, stem, (int)faces);
    }
    print_times(n, name, o);
    print_counts(n, name, o);
}
