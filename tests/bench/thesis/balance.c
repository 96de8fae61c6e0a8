/* Figures 6.5 and 6.6: E_D, E_H and their sum over the number of branch points, at three densities,
 * and what qc.optimize.balance chooses of its own accord. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <qc/remesh.h>
#include <stdio.h>
#include <string.h>

enum { DENSITIES = 3, COUNTS = 4 };

typedef struct setting {
    qc_ctx *ctx;
    qc_pipeline *pipeline;
    double quads;
} setting;

typedef struct sums {
    int32_t points;
    double curl, harmonic; /* E_D, E_H in quad areas */
} sums;

static uint32_t step_of(const setting *s, const char *name) {
    uint32_t i = 0;
    while (strcmp(qc_pipeline_step_name(s->pipeline, i), name) != 0) i++;
    return i;
}

static void set(const setting *s, const char *step, const char *name, double value) {
    char text[40];
    snprintf(text, sizeof text, "%.12g", value);
    bench_check(s->ctx, qc_pipeline_set(s->pipeline, step, name, text));
}

static void run_steps(const setting *s, const char *first, const char *last, qc_bag *bag) {
    bench_check(s->ctx,
                qc_pipeline_run_range(s->pipeline, step_of(s, first), step_of(s, last) + 1, bag));
}

static qc_bag *copy(const setting *s, const qc_bag *from) {
    qc_bag *bag = NULL;
    bench_check(s->ctx, qc_bag_create(s->ctx, &bag));
    for (uint32_t i = 0; i < qc_bag_count(from); i++)
        bench_check(s->ctx,
                    qc_bag_put(bag, qc_bag_name(from, i), qc_bag_get(from, qc_bag_name(from, i))));
    return bag;
}

static sums measure(const setting *s, const qc_bag *state) {
    const qc_matching *matching = qc_bag_latest(state, QC_TYPE_MATCHING);
    qc_bag *bag = copy(s, state);
    run_steps(s, "split", "round", bag);
    const qc_corner_map *map = qc_bag_latest(bag, QC_TYPE_CORNER_MAP);
    const sums out = {matching->n_singular, map->curl_energy / map->field_energy * s->quads,
                      map->harmonic_energy};
    qc_bag_free(bag);
    return out;
}

static void row(const char *label, const setting *s, const sums *m) {
    const double percent = 100 / s->quads;
    const double value[4] = {m->points, percent * m->curl, percent * m->harmonic,
                             percent * (m->curl + m->harmonic)};
    thesis_row(label, 4, value);
    fflush(stdout); /* a row takes minutes */
}

static void at_density(const thesis_run *run, const setting *s, const qc_polygon_mesh *input) {
    static const double part[COUNTS] = {1.4, 1.2, 0.8, 0.65}; /* of the default's count */
    char label[80];
    qc_bag *state = NULL;
    bench_check(s->ctx, qc_bag_create(s->ctx, &state));
    bench_check(s->ctx, qc_bag_put(state, "input", input));
    run_steps(s, "repair", "curl", state);
    qc_bag *bag = copy(s, state);
    run_steps(s, "balance", "balance", bag);
    const sums own = measure(s, bag);
    qc_bag_free(bag);
    double least = own.curl + own.harmonic;
    snprintf(label, sizeof label, "%.0f quads, chosen", s->quads);
    row(label, s, &own);
    for (int i = 0; i < (run->quick ? 1 : COUNTS); i++) {
        bag = copy(s, state);
        set(s, "balance", "count", fmax(1, round(part[i] * own.points)));
        run_steps(s, "balance", "balance", bag);
        const sums m = measure(s, bag);
        qc_bag_free(bag);
        snprintf(label, sizeof label, "%.0f quads, count = %s", s->quads,
                 qc_pipeline_get(s->pipeline, "balance", "count"));
        row(label, s, &m);
        least = fmin(least, m.curl + m.harmonic);
    }
    set(s, "balance", "count", 0);
    qc_bag_free(state);
    fprintf(stderr, "%.0f quads: chosen / least = %.3f\n", s->quads,
            (own.curl + own.harmonic) / least);
}

void thesis_balance(thesis_run *run) {
    static const double quads[DENSITIES] = {1500, 5000, 20000};
    static const char *const columns[] = {"branch points", "E_D %", "E_H %", "sum %"};
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    setting s = {run->ctx, NULL, 0};
    qc_registry *registry = NULL;
    options.mode = QC_MODE_BEST;
    bench_check(s.ctx, qc_registry_create(s.ctx, &registry));
    bench_check(s.ctx, qc_default_pipeline(s.ctx, registry, &options, &s.pipeline));
    qc_polygon_mesh *input = bench_read(s.ctx, thesis_mesh(run, "armadillo.obj"));
    thesis_head("armadillo", 4, columns);
    for (int i = 0; i < (run->quick ? 1 : DENSITIES); i++) {
        s.quads = run->quick ? 500 : quads[i];
        set(&s, "size", "quads", s.quads);
        at_density(run, &s, input);
    }
    qc_object_release(input);
    qc_pipeline_free(s.pipeline);
    qc_registry_free(registry);
}
