/* Thesis Figure 6.1: E_D and the number of branch points over the evaluations of E_D, with the
 * edges sorted by their share or not, with new branch points or without. (a) to (d) are
 * Algorithm 6.1 to the letter, one flip at a time; (e) and (f) are what the library does instead of
 * (c) and (d). */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "sdk/optimize/internal.h"

typedef struct setting {
    const char *title;
    bool sort, create, ours;
} setting;
static const setting SETTINGS[] = {
    {"(a) sorting off, new branch points off", false, false, false},
    {"(b) sorting off, new branch points on", false, true, false},
    {"(c) sorting on, new branch points off", true, false, false},
    {"(d) sorting on, new branch points on", true, true, false},
    {"(e) ours, new branch points off", true, false, true},
    {"(f) ours, new branch points on", true, true, true},
};
enum { COUNT = (int)(sizeof SETTINGS / sizeof *SETTINGS), REFERENCE = 3 };
enum { ENERGY, POINTS, GREY, CURVES }; /* curves of a panel */

/* In the thesis curl reduction ends after 6000 iterations, balancing after 11000. */
static const int64_t CURL_END = 6000, END = 11000;
static const double QUADS = 6500, LAMBDA = 0.9;

typedef struct descent {
    qc_ctx *ctx;
    qc_distortion *d;
    const qc_sizing *sizing;
    plot_panel *panel;
    double *share, *theta; /* n_edges */
    int32_t *order;        /* n_edges */
    int64_t cancelled;     /* evaluations after step 1 */
    double pair_cost;      /* expected fall of E_H for a pair (6.4), 0 = not measured */
} descent;

static qc_distortion_state state_of(const descent *s) {
    qc_distortion_state state;
    qc_distortion_get_state(s->d, &state);
    return state;
}

static void record(void *user) {
    descent *s = user;
    const qc_distortion_state now = state_of(s);
    plot_curve *energy = &s->panel->curve[ENERGY];
    if (energy->n > 0 && energy->x[energy->n - 1] >= (double)now.evaluations) return;
    plot_add(energy, (double)now.evaluations, 100 * now.energy / now.whole);
    plot_add(&s->panel->curve[POINTS], (double)now.evaluations, now.branch_points);
}

static const double *sort_key;
static int by_share(const void *a, const void *b) {
    const int32_t i = *(const int32_t *)a, j = *(const int32_t *)b;
    if (sort_key[i] != sort_key[j]) return sort_key[i] > sort_key[j] ? -1 : 1;
    return i - j;
}

/* Step 3 (a): m_e by one such that |theta_e| falls, if E_D does. */
static bool try_edge(descent *s, int32_t e, bool create) {
    const qc_flip_step flip = {e, s->theta[e] > 0 ? 1 : -1};
    bool accepted = false;
    if (!qc_distortion_can_flip(s->d, e)) return false;
    if (!create && qc__new_branch_points(s->d, flip) > 0) return false;
    bench_check(s->ctx,
                qc_distortion_change(s->ctx, s->d, 1, &flip, state_of(s).energy, NULL, &accepted));
    if (accepted) bench_check(s->ctx, qc_distortion_shares(s->ctx, s->d, NULL, s->theta));
    record(s);
    return accepted;
}

/* Steps 2 and 3: sorted again when one matching in a thousand has changed. */
static void reduce(descent *s, bool sort, bool create, int64_t end) {
    const int32_t E = s->d->mesh->n_edges;
    for (bool any = true; any && state_of(s).evaluations < end;) {
        any = false;
        bench_check(s->ctx, qc_distortion_shares(s->ctx, s->d, s->share, s->theta));
        for (int32_t e = 0; e < E; e++) s->order[e] = e;
        sort_key = s->share;
        if (sort) qsort(s->order, (size_t)E, sizeof *s->order, by_share);
        int32_t changed = 0;
        for (int32_t i = 0; i < E && state_of(s).evaluations < end; i++) {
            if (!try_edge(s, s->order[i], create)) continue;
            any = true;
            if (sort && ++changed > E / 1000) break;
        }
    }
}

static int32_t cancel(descent *s, double increase) {
    qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
    int32_t cancelled = 0;
    options.increase = increase;
    bench_check(s->ctx, qc_distortion_cancel(s->ctx, s->d, &options, &cancelled));
    record(s);
    return cancelled;
}

/* What E_H is expected to fall by for a pair of branch points, four real periods: measured for the
 * present matching with random periods, which are rounded with r = 3 (6.4). */
static double measure_pair_cost(const descent *s) {
    enum { INSTANCES = 10 };
    qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
    qc_matching *matching = NULL;
    int32_t n = 0;
    uint64_t state = 1;
    double sum = 0;
    options.start = QC_ROUND_DIRECT;
    options.radius = 3;
    bench_check(s->ctx, qc_distortion_matching(s->ctx, s->d, &matching));
    double *P = thesis_period_matrix(s->ctx, matching, s->sizing, &n);
    double *t = NEW(double, 2 * n);
    for (int k = 0; k < INSTANCES && n > 0; k++) {
        qc_lattice_result result;
        for (int32_t i = 0; i < n; i++) t[i] = bench_uniform(&state);
        bench_check(s->ctx, qc_lattice_round(s->ctx, n, P, t, &options, t + n, &result));
        sum += result.energy / INSTANCES;
    }
    qc_object_release(matching);
    free(P);
    free(t);
    return n > 0 ? 4 * sum / n : 0;
}

/* The library's search for the same evaluations. */
static void reduce_ours(descent *s, bool create, int64_t end) {
    qc_reduce_options options = QC_REDUCE_OPTIONS_INIT;
    options.create = create;
    options.evaluations = end - state_of(s).evaluations;
    if (options.evaluations <= 0) return;
    bench_check(s->ctx, qc_distortion_reduce(s->ctx, s->d, &options));
    record(s);
}

static void phase(descent *s, const setting *how, bool create, int64_t end) {
    if (how->ours)
        reduce_ours(s, create, end);
    else
        reduce(s, how->sort, create, end);
}

static void descend(descent *s, const setting *how, int64_t curl_end, int64_t end) {
    const bool balance = how->sort && how->create;
    record(s);
    cancel(s, 0);
    s->cancelled = state_of(s).evaluations;
    phase(s, how, how->create, balance ? curl_end : end);
    if (balance) s->pair_cost = measure_pair_cost(s);
    while (balance && state_of(s).evaluations < end && cancel(s, s->pair_cost) > 0)
        phase(s, how, false, end);
    plot_curve *energy = &s->panel->curve[ENERGY], *points = &s->panel->curve[POINTS];
    if (energy->x[energy->n - 1] < (double)end) { /* nothing was left to try */
        plot_add(energy, (double)end, energy->y[energy->n - 1]);
        plot_add(points, (double)end, points->y[points->n - 1]);
    }
}

static void run_setting(thesis_run *run, const qc_matching *matching, const qc_sizing *sizing,
                        const setting *how, plot_panel *panel, descent *s) {
    const int32_t E = matching->field->mesh->n_edges;
    *panel = (plot_panel){how->title, CURVES, {{0}}};
    panel->curve[ENERGY] = (plot_curve){.name = "E_D", .colour = "#c33"};
    panel->curve[POINTS] = (plot_curve){.name = "branch points", .colour = "#36c", .right = true};
    panel->curve[GREY] = (plot_curve){.name = "E_D of (d)", .colour = "#aaa", .repeated = true};
    *s = (descent){.ctx = run->ctx,
                   .sizing = sizing,
                   .panel = panel,
                   .share = NEW(double, E),
                   .theta = NEW(double, E),
                   .order = NEW(int32_t, E)};
    bench_check(run->ctx, qc_distortion_create(run->ctx, matching, sizing, LAMBDA, &s->d));
    run->watch = record;
    run->watch_user = s;
    descend(s, how, run->quick ? 100 : CURL_END, run->quick ? 200 : END);
    run->watch = NULL;
    qc_distortion_free(s->d);
    free(s->share);
    free(s->theta);
    free(s->order);
}

/* Value of the curve after so many evaluations. */
static double value_at(const plot_curve *c, double x) {
    int32_t j = 0;
    while (j + 1 < c->n && c->x[j + 1] <= x) j++;
    return c->y[j];
}

/* Evaluations after step 1 until E_D has fallen by so much of its value there; NAN: never. */
static double needed(const plot_curve *c, double start, double part) {
    const double from = value_at(c, start);
    for (int32_t j = 0; j < c->n; j++)
        if (c->x[j] >= start && c->y[j] <= (1 - part) * from) return c->x[j] - start;
    return NAN;
}

/* Evaluations at the last change of E_D. */
static double last_change(const plot_curve *c) {
    int32_t j = c->n - 1;
    while (j > 0 && c->y[j - 1] == c->y[c->n - 1]) j--;
    return c->x[j];
}

static void print_table(const plot *p, const descent *s) {
    enum { COLUMNS = 12 };
    static const char *const column[COLUMNS] = {"E_D, %: start",
                                                "after 2000",
                                                "6000",
                                                "11000",
                                                "last change",
                                                "branch points: start",
                                                "6000",
                                                "11000",
                                                "evaluations to -9.1 %",
                                                "thesis",
                                                "fall in 10000, %",
                                                "thesis"};
    thesis_head("setting", COLUMNS, column);
    for (int i = 0; i < COUNT; i++) {
        const plot_curve *e = &p->panel[i].curve[ENERGY], *b = &p->panel[i].curve[POINTS];
        const double start = (double)s[i].cancelled, from = value_at(e, start);
        const double cell[] = {e->y[0],
                               value_at(e, 2000),
                               value_at(e, (double)CURL_END),
                               value_at(e, (double)END),
                               last_change(e),
                               b->y[0],
                               value_at(b, (double)CURL_END),
                               value_at(b, (double)END),
                               needed(e, start, 0.091),
                               i == 1           ? 10000
                               : i == REFERENCE ? 59
                                                : NAN,
                               100 * (1 - value_at(e, start + 10000) / from),
                               i == 1 ? 9.1 : NAN};
        thesis_row(SETTINGS[i].title, COLUMNS, cell);
    }
    printf("\nCancellation took %d evaluations (thesis: 230). Balancing expects a pair to cost "
           "%.2f quad "
           "areas of E_H in (d), %.2f in (f).\n",
           (int)s[REFERENCE].cancelled, s[REFERENCE].pair_cost, s[COUNT - 1].pair_cost);
}

void thesis_descent(thesis_run *run) {
    const bench_source source = {thesis_mesh(run, "elephant.obj"), QUADS, 0, NULL};
    qc_matching *matching = bench_surface(run->ctx, &source);
    qc_sizing *sizing = bench_sizing(run->ctx, matching->field->mesh, QUADS);
    plot p = {.x_label = "evaluations of E_D",
              .left_label = "E_D, % of the field",
              .right_label = "branch points",
              .columns = 2,
              .n_panels = COUNT};
    descent s[COUNT];
    for (int i = 0; i < COUNT; i++)
        run_setting(run, matching, sizing, &SETTINGS[i], &p.panel[i], &s[i]);
    const plot_curve *reference = &p.panel[REFERENCE].curve[ENERGY];
    for (int i = 0; i < COUNT; i++)
        for (int32_t j = 0; i != REFERENCE && j < reference->n; j++)
            plot_add(&p.panel[i].curve[GREY], reference->x[j], reference->y[j]);
    char stem[64];
    bench_stem(source.path, sizeof stem, stem);
    printf("\n%s, %d faces.\n", stem, (int)matching->field->mesh->n_faces);
    print_table(&p, s);
    if (run->figures) plot_write(&p, run->figures, "figure-6.1");
    plot_clear(&p);
    qc_object_release(sizing);
    qc_object_release(matching);
}
