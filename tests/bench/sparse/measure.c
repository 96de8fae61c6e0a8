/* Clocks, medians, and rounds in which all runners take their turn. Short operations are repeated
 * within a turn. The first turn warms up and checks the solutions; it counts only where there is no
 * time for another one. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double short_turn = 4e-3; /* seconds in which an operation is repeated */
enum { MOST_REPEATS = 5, MANY = 16 };

static double read_clock(clockid_t id) {
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bench_duration bench_clock(void) {
    return (bench_duration){read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_THREAD_CPUTIME_ID)};
}

static void add_sample(bench_samples *s, bench_duration d) {
    if (s->n == s->capacity) {
        s->capacity = 2 * s->capacity + 8;
        s->value = realloc(s->value, (size_t)s->capacity * sizeof *s->value);
        if (!s->value) bench_die("no memory");
    }
    s->value[s->n++] = d;
}

void bench_sample(bench_samples *s, bench_duration begin, bench_duration end) {
    add_sample(s, (bench_duration){end.wall - begin.wall, end.cpu - begin.cpu});
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(int32_t n, double *x) {
    qsort(x, (size_t)n, sizeof *x, compare_doubles);
    return n ? 0.5 * (x[(n - 1) / 2] + x[n / 2]) : 0;
}

bench_duration bench_median(const bench_samples *s) {
    double *wall = NEW(double, s->n), *cpu = NEW(double, s->n);
    for (int32_t i = 0; i < s->n; i++) {
        wall[i] = s->value[i].wall;
        cpu[i] = s->value[i].cpu;
    }
    const bench_duration d = {median(s->n, wall), median(s->n, cpu)};
    free(wall);
    free(cpu);
    return d;
}

/* The work of one turn: right-hand sides and their copies. */
typedef struct desk {
    const bench_matrix *M;
    qc_complex *b, *x; /* n x MANY */
} desk;

static void prepare(const desk *d, bench_runner *r, int op) {
    const size_t n = (size_t)d->M->A.n * sizeof *d->b;
    if (op == OP_FACTOR) r->peer->drop(r->self);
    if (op == OP_FORWARD || op == OP_SOLVE) memcpy(d->x, d->b, n);
    if (op == OP_SOLVE16) memcpy(d->x, d->b, MANY * n);
}

static void run(const desk *d, bench_runner *r, int op) {
    const bench_peer *p = r->peer;
    switch (op) {
    case OP_ANALYZE:
        p->analyze(r->self);
        break;
    case OP_FACTOR:
        p->factor(r->self);
        break;
    case OP_REFACTOR:
        p->refactor(r->self);
        break;
    case OP_FORWARD:
        p->forward(r->self, d->x);
        break;
    case OP_SOLVE:
        p->solve(r->self, 1, d->x);
        break;
    case OP_SOLVE16:
        p->solve(r->self, MANY, d->x);
        break;
    default: /* OP_FLIP: applied and undone in turn */
        for (int32_t i = 0; i < d->M->n_flips; i++) {
            p->flip(r->self, &d->M->flips[i], 1);
            p->flip(r->self, &d->M->flips[i], -1);
        }
    }
}

static bool offers(const bench_peer *p, int op) {
    return !((op == OP_REFACTOR && !p->refactor) || (op == OP_FORWARD && !p->forward) ||
             (op == OP_FLIP && !p->flip));
}

static void time_operation(const desk *d, bench_runner *r, int op) {
    double spent = 0;
    for (int i = 0; i < MOST_REPEATS && spent < short_turn; i++) {
        prepare(d, r, op);
        const bench_duration begin = bench_clock();
        run(d, r, op);
        const bench_duration end = bench_clock();
        bench_sample(&r->samples[op], begin, end);
        spent += end.wall - begin.wall;
    }
}

static void demand(const bench_runner *r, const char *what, double error) {
    if (!(error < 1e-8))
        bench_die("%s: %s has a relative error of %.1e: another problem", r->label, what, error);
}

/* Residual of a solution before and after a flip, and |y|^2 = b^H A^{-1} b. */
static void check(const desk *d, bench_runner *r) {
    const int32_t n = d->M->A.n;
    const size_t size = (size_t)n * sizeof *d->b;
    double product = 0, norm = 0;
    memcpy(d->x, d->b, size);
    r->peer->solve(r->self, 1, d->x);
    r->residual = bench_residual(d->M, NULL, d->b, d->x);
    demand(r, "the solution", r->residual);
    for (int32_t i = 0; i < n; i++) product += d->b[i].re * d->x[i].re + d->b[i].im * d->x[i].im;
    if (r->peer->forward) {
        memcpy(d->x, d->b, size);
        r->peer->forward(r->self, d->x);
        for (int32_t i = 0; i < n; i++) norm += d->x[i].re * d->x[i].re + d->x[i].im * d->x[i].im;
        demand(r, "the forward solution", fabs(norm - product) / product);
    }
    if (r->peer->flip && d->M->n_flips) {
        const bench_flip *f = &d->M->flips[0];
        memcpy(d->x, d->b, size);
        r->peer->flip(r->self, f, 1);
        r->peer->solve(r->self, 1, d->x);
        demand(r, "the solution after a flip", bench_residual(d->M, f, d->b, d->x));
        r->peer->flip(r->self, f, -1);
    }
}

static void take_turn(const desk *d, bench_runner *r, const bench_plan *plan, bool first) {
    bool needs_factor = false, has_factor = !first && plan->keep;
    for (int op = OP_FACTOR; op < OP_COUNT; op++) needs_factor |= plan->op[op];
    if (plan->op[OP_ANALYZE])
        time_operation(d, r, OP_ANALYZE);
    else if (first)
        r->peer->analyze(r->self);
    if (!needs_factor) return;
    if (plan->op[OP_FACTOR])
        time_operation(d, r, OP_FACTOR);
    else if (!has_factor)
        r->peer->factor(r->self);
    if (first) check(d, r);
    for (int op = OP_REFACTOR; op < OP_COUNT; op++)
        if (plan->op[op] && offers(r->peer, op)) time_operation(d, r, op);
    if (!plan->keep) r->peer->drop(r->self);
}

/* The first use of a page may cost far more than later ones, for example on a virtual machine: not
 * to be paid by whoever comes first. */
static void touch_memory(double bytes) {
    char *p = malloc((size_t)bytes);
    if (!p) return;
    for (size_t i = 0; i < (size_t)bytes; i += 4096) ((volatile char *)p)[i] = 1;
    free(p);
}

static void finish(const bench_matrix *M, bench_runner *r) {
    for (int op = 0; op < OP_COUNT; op++) r->time[op] = bench_median(&r->samples[op]);
    if (!r->peer->refactor) r->time[OP_REFACTOR] = r->time[OP_FACTOR];
    r->time[OP_FLIP].wall /= 2 * M->n_flips;
    r->time[OP_FLIP].cpu /= 2 * M->n_flips;
    r->stored = r->peer->stored(r->self);
}

void bench_measure(const bench_matrix *M, int32_t n, bench_runner *runners,
                   const bench_plan *plan) {
    const int64_t size = (int64_t)M->A.n * MANY;
    desk d = {M, NEW(qc_complex, size), NEW(qc_complex, size)};
    double *spent = NEW(double, n);
    bench_random_vector(size, d.b);
    for (int32_t round = 0; round <= plan->repeat; round++)
        for (int32_t i = 0; i < n; i++) {
            bench_runner *r = &runners[i];
            const bool first = round == 0;
            if (!first && spent[i] > plan->seconds) continue;
            if (first) r->self = r->peer->create(M, r->ordering, r->perm, r->threads);
            for (int op = 0; op < OP_COUNT && round == 1; op++) r->samples[op].n = 0;
            if (first || !plan->keep) touch_memory(plan->memory);
            const double begin = bench_clock().wall;
            take_turn(&d, r, plan, first);
            spent[i] += bench_clock().wall - begin;
        }
    for (int32_t i = 0; i < n; i++) finish(M, &runners[i]);
    free(d.b);
    free(d.x);
    free(spent);
}

void bench_runner_clear(bench_runner *r) {
    if (r->self) r->peer->destroy(r->self);
    for (int op = 0; op < OP_COUNT; op++) free(r->samples[op].value);
    *r = (bench_runner){0};
}
