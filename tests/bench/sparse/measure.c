/* Rounds in which all runners take their turn. Short operations are repeated within a turn. The
 * first turn warms up and checks the solutions; it counts only where there is no time for another
 * one. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double short_turn = 4e-3; /* seconds in which an operation is repeated */
enum { MOST_REPEATS = 5, MANY = 16 };

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
    default: /* OP_FLIP, OP_CARRY: applied and undone in turn */
        for (int32_t i = 0; i < 2 * d->M->n_flips; i++) {
            p->flip(r->self, &d->M->flips[i / 2], i % 2 ? -1 : 1);
            if (op == OP_CARRY) p->energy(r->self);
        }
    }
}

static void add_elapsed(bench_duration begin, bench_duration end, bench_duration *sum) {
    sum->wall += end.wall - begin.wall;
    sum->cpu += end.cpu - begin.cpu;
}

/* Only the undoing counts. Reading the clocks takes long compared with it and is deducted. */
static bench_duration time_undo(const desk *d, bench_runner *r) {
    bench_duration sum = {0, 0}, reading = {0, 0};
    for (int32_t i = 0; i < d->M->n_flips; i++) {
        r->peer->flip(r->self, &d->M->flips[i], 1);
        const bench_duration begin = bench_clock();
        r->peer->undo(r->self);
        add_elapsed(begin, bench_clock(), &sum);
        const bench_duration again = bench_clock();
        add_elapsed(again, bench_clock(), &reading);
    }
    return (bench_duration){sum.wall - reading.wall, sum.cpu - reading.cpu};
}

static bench_duration time_once(const desk *d, bench_runner *r, int op) {
    if (op == OP_UNDO) return time_undo(d, r);
    if (op == OP_CARRY) r->peer->carry(r->self, d->b);
    const bench_duration begin = bench_clock();
    run(d, r, op);
    bench_duration sum = {0, 0};
    add_elapsed(begin, bench_clock(), &sum);
    if (op == OP_CARRY) r->peer->carry(r->self, NULL);
    return sum;
}

static bool offers(const bench_peer *p, int op) {
    return !((op == OP_REFACTOR && !p->refactor) || (op == OP_FORWARD && !p->forward) ||
             (op == OP_FLIP && !p->flip) || (op == OP_UNDO && !p->undo) ||
             (op == OP_CARRY && !p->carry));
}

static void time_operation(const desk *d, bench_runner *r, int op) {
    double spent = 0;
    for (int i = 0; i < MOST_REPEATS && spent < short_turn; i++) {
        prepare(d, r, op);
        const bench_duration t = time_once(d, r, op);
        bench_sample(&r->samples[op], t);
        spent += t.wall;
    }
}

static void demand(const bench_runner *r, const char *what, double error) {
    if (!(error < 1e-8))
        bench_die("%s: %s has a relative error of %.1e: another problem", r->label, what, error);
}

/* Re b^H x. */
static double inner_product(int32_t n, const qc_complex *b, const qc_complex *x) {
    double sum = 0;
    for (int32_t i = 0; i < n; i++) sum += b[i].re * x[i].re + b[i].im * x[i].im;
    return sum;
}

/* Residual of a solution, and |y|^2 = b^H A^{-1} b. */
static void check(const desk *d, bench_runner *r) {
    const int32_t n = d->M->A.n;
    const size_t size = (size_t)n * sizeof *d->b;
    memcpy(d->x, d->b, size);
    r->peer->solve(r->self, 1, d->x);
    r->residual = bench_residual(d->M, NULL, d->b, d->x);
    demand(r, "the solution", r->residual);
    const double product = inner_product(n, d->b, d->x);
    if (r->peer->forward) {
        memcpy(d->x, d->b, size);
        r->peer->forward(r->self, d->x);
        demand(r, "the forward solution", fabs(inner_product(n, d->x, d->x) - product) / product);
    }
}

/* The same for the matrix with one flip, and the way back. */
static void check_flip(const desk *d, bench_runner *r) {
    const bench_peer *p = r->peer;
    const bench_flip *f = &d->M->flips[0];
    const size_t size = (size_t)d->M->A.n * sizeof *d->b;
    if (p->carry) p->carry(r->self, d->b);
    p->flip(r->self, f, 1);
    const double energy = p->carry ? p->energy(r->self) : 0;
    memcpy(d->x, d->b, size);
    p->solve(r->self, 1, d->x);
    demand(r, "the solution after a flip", bench_residual(d->M, f, d->b, d->x));
    const double product = inner_product(d->M->A.n, d->b, d->x);
    if (p->carry) {
        demand(r, "the forward solution after a flip", fabs(energy - product) / product);
        p->carry(r->self, NULL);
    }
    p->flip(r->self, f, -1);
    if (p->undo) {
        p->flip(r->self, f, 1);
        p->undo(r->self);
    }
    memcpy(d->x, d->b, size);
    p->solve(r->self, 1, d->x);
    demand(r, "the solution after undoing a flip", bench_residual(d->M, NULL, d->b, d->x));
}

static void take_turn(const desk *d, bench_runner *r, const bench_plan *plan, bool first) {
    bool needs_factor = false, has_factor = !first && plan->keep && !plan->op[OP_FACTOR];
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
    if (first && r->peer->flip && d->M->n_flips) check_flip(d, r);
    for (int op = OP_REFACTOR; op < OP_COUNT; op++) {
        if (!plan->op[op] || !offers(r->peer, op)) continue;
        if (op == OP_FLIP && !has_factor) run(d, r, op); /* records of old entries get their room */
        time_operation(d, r, op);
    }
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
    for (int op = OP_FLIP; op < OP_COUNT; op++) {
        const int32_t count = op == OP_UNDO ? M->n_flips : 2 * M->n_flips;
        r->time[op].wall /= count;
        r->time[op].cpu /= count;
    }
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
