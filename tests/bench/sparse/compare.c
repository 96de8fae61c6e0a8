/* Who is compared in what: the rows of the two tables, and the figures to be reached. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>

enum { OURS, OURS_2, PEERS }; /* positions among the runners; columns follow from PEERS on */
enum { MOST_RUNNERS = PEERS + MOST_COLUMNS };

typedef struct lineup {
    const bench_matrix *M;
    const bench_limits *limits;
    const bench_effort *effort;
    bench_quality quality; /* of our ordering */
    int n;
    bench_runner runner[MOST_RUNNERS];
    bench_table *table;
} lineup;

static void add_runner(lineup *L, const char *label, const bench_peer *p, int ordering,
                       const int32_t *perm, uint32_t threads) {
    L->runner[L->n++] = (bench_runner){
        .label = label, .peer = p, .ordering = ordering, .perm = perm, .threads = threads};
    if (L->n > PEERS) L->table->column[L->table->columns++] = label;
}

/* The first column of that peer: with AMD, in the table of own orderings. */
static void reach(const lineup *L, bench_row *r, const bench_peer *p, double figure) {
    for (int c = 0; c < L->table->columns; c++)
        if (L->runner[PEERS + c].peer == p) {
            r->reach[c] = figure;
            return;
        }
}

/* Seconds; on several threads only the wall clock tells, else the time of the thread does better.
 */
static double seconds(const bench_runner *r, int op, bool wall) {
    return wall ? r->time[op].wall : r->time[op].cpu;
}

static bench_row *time_row(lineup *L, const char *name, int who, unsigned ops) {
    const bool wall = who == OURS_2;
    bench_row *r = bench_add_row(L->table, name, "s", 0);
    for (int op = 0; op < OP_COUNT; op++) {
        if (!(ops >> op & 1)) continue;
        r->ours += seconds(&L->runner[who], op, wall);
        for (int c = 0; c < L->table->columns; c++)
            r->peer[c] += seconds(&L->runner[PEERS + c], op, wall);
    }
    return r;
}

static void rate(bench_row *r, double amount, const char *unit, double limit) {
    r->rate = r->ours > 0 ? amount / r->ours : 0;
    r->rate_unit = unit;
    r->percent = limit > 0 ? 100 * r->rate / limit : 0;
}

static double factor_reach(int32_t faces) {
    return faces < 200000 ? 6 : faces < 1000000 ? 4.5 : 2;
}

static void factor_rows(lineup *L) {
    const double flops = L->quality.flops, fma = L->limits->fma;
    bench_row *r = time_row(L, "factorise, 1 thread", OURS, 1u << OP_FACTOR);
    rate(r, flops, "flop/s", fma);
    if (L->runner[OURS].perm) reach(L, r, &peer_cholmod, factor_reach(L->M->faces));
    rate(time_row(L, "factorise, 2 threads", OURS_2, 1u << OP_FACTOR), flops, "flop/s", 2 * fma);
    rate(time_row(L, "factorise again, 1 thread", OURS, 1u << OP_REFACTOR), flops, "flop/s", fma);
    rate(time_row(L, "factorise again, 2 threads", OURS_2, 1u << OP_REFACTOR), flops, "flop/s",
         2 * fma);
    bench_row *s = bench_add_row(L->table, "entries stored", "", L->runner[OURS].stored);
    for (int c = 0; c < L->table->columns; c++) s->peer[c] = L->runner[PEERS + c].stored;
}

static void solve_rows(lineup *L) {
    const double bytes = 16 * L->quality.nnz;
    const bool same = L->runner[OURS].perm;
    bench_row *r = time_row(L, "forward solve", OURS, 1u << OP_FORWARD);
    rate(r, bytes, "B/s", 0);
    if (same) {
        reach(L, r, &peer_cholmod, 3);
        reach(L, r, &peer_cxsparse, 2);
    }
    r = time_row(L, "full solve", OURS, 1u << OP_SOLVE);
    rate(r, 2 * bytes, "B/s", 0);
    r = time_row(L, "full solve, 16 right-hand sides", OURS, 1u << OP_SOLVE16);
    rate(r, 16 * 16 * L->quality.nnz, "flop/s", L->limits->fma);
    if (same) reach(L, r, &peer_cholmod, 2);
    time_row(L, "full solve, 16, 2 threads", OURS_2, 1u << OP_SOLVE16);
}

/* One read and one write of 16 bytes per entry. */
static void update_rows(lineup *L) {
    const double entries = L->quality.touched;
    const bool hot = 16 * entries < 1e6;
    bench_row *r = time_row(L, "update pair (one flip)", OURS, 1u << OP_FLIP);
    rate(r, 32 * entries, "B/s", hot ? L->limits->l2 : L->limits->memory);
    reach(L, r, &peer_cxsparse, L->runner[OURS].perm ? 10 : 25);
}

static void memory_row(lineup *L) {
    bench_row *r = bench_add_row(L->table, "peak memory of analysis and factor", "B",
                                 bench_peak_memory(L->M, &L->runner[OURS]));
    for (int c = 0; c < L->table->columns; c++)
        r->peer[c] = bench_peak_memory(L->M, &L->runner[PEERS + c]);
    reach(L, r, &peer_cholmod, 1 / 0.7);
}

static void measure(lineup *L, bool analysis) {
    const unsigned parts = L->effort->parts;
    const bench_plan plan = {.op = {[OP_ANALYZE] = parts & PART_FACTOR && analysis,
                                    [OP_FACTOR] = parts & PART_FACTOR,
                                    [OP_REFACTOR] = parts & PART_FACTOR,
                                    [OP_FORWARD] = parts & PART_SOLVE,
                                    [OP_SOLVE] = parts & PART_SOLVE,
                                    [OP_SOLVE16] = parts & PART_SOLVE,
                                    [OP_FLIP] = parts & PART_UPDATE},
                             .repeat = L->effort->repeat,
                             .seconds = L->effort->seconds,
                             .keep = L->quality.nnz < 25e6};
    if (parts & PART_MEMORY) memory_row(L);
    if (!(parts & (PART_FACTOR | PART_SOLVE | PART_UPDATE))) return;
    bench_measure(L->M, L->n, L->runner, &plan);
    if (parts & PART_FACTOR && analysis) {
        time_row(L, "analyse, 1 thread", OURS, 1u << OP_ANALYZE);
        time_row(L, "analyse and factorise, 1 thread", OURS, 1u << OP_ANALYZE | 1u << OP_FACTOR);
        bench_row *r = time_row(L, "analyse and factorise, 2 threads", OURS_2,
                                1u << OP_ANALYZE | 1u << OP_FACTOR);
        reach(L, r, &peer_cholmod, 5);
    }
    if (parts & PART_FACTOR) factor_rows(L);
    if (parts & PART_SOLVE) solve_rows(L);
    if (parts & PART_UPDATE) update_rows(L);
}

static double order_time(const bench_matrix *M, int32_t repeat, int which, int32_t *perm) {
    bench_samples s = {0};
    for (int32_t i = 0; i < repeat; i++) {
        const bench_duration begin = bench_clock();
        which < 0 ? order_metis(M, perm) : order_quadcover(M, which, perm);
        bench_sample(&s, begin, bench_clock());
    }
    const double t = bench_median(&s).cpu;
    free(s.value);
    return t;
}

static void order_row(bench_table *t, const char *name, const char *unit, double ours, double metis,
                      double figure) {
    bench_row *r = bench_add_row(t, name, unit, ours);
    r->peer[0] = metis;
    r->reach[0] = figure;
}

static void compare_orderings(qc_ctx *ctx, const bench_matrix *M, bench_table *t) {
    const int32_t repeat = M->faces < 200000 ? 3 : 1;
    int32_t *perm = NEW(int32_t, M->A.n);
    const double metis = order_time(M, repeat, -1, perm);
    const bench_quality m = bench_order_quality(ctx, M, perm);
    const double amd = order_time(M, repeat, ORDER_AMD, perm);
    const bench_quality q = bench_order_quality(ctx, M, perm);
    t->title = "Orderings";
    t->columns = 1;
    t->column[0] = "METIS";
    order_row(t, "AMD: time", "s", amd, metis, 0);
    order_row(t, "AMD: entries of L", "", q.nnz, m.nnz, 0);
    order_row(t, "AMD: operations", "flop", q.flops, m.flops, 0);
    order_row(t, "AMD: entries touched by a flip", "", q.touched, m.touched, 0);
    free(perm);
}

static void finish(lineup *L, bench_comparison *out) {
    for (int i = 0; i < L->n; i++) {
        if (L->runner[i].residual > out->residual) out->residual = L->runner[i].residual;
        bench_runner_clear(&L->runner[i]);
    }
    L->n = 0;
}

/* perm: the ordering for all, or NULL = each its own. */
static void line_up(lineup *L, const int32_t *perm) {
    const int amd = perm ? ORDER_GIVEN : ORDER_AMD;
    add_runner(L, "ours", &peer_quadcover, amd, perm, 1);
    add_runner(L, "ours, 2 threads", &peer_quadcover, amd, perm, 2);
    add_runner(L, perm ? "CHOLMOD" : "CHOLMOD, AMD", &peer_cholmod, amd, perm, 1);
    add_runner(L, perm ? "CXSparse" : "CXSparse, AMD", &peer_cxsparse, amd, perm, 1);
    if (!perm) add_runner(L, "CHOLMOD, METIS", &peer_cholmod, ORDER_DISSECTION, NULL, 1);
#ifdef BENCH_MUMPS
    add_runner(L, perm ? "MUMPS" : "MUMPS, its choice", &peer_mumps,
               perm ? ORDER_GIVEN : ORDER_DISSECTION, perm, 1);
#endif
}

void bench_compare(qc_ctx *ctx, const bench_matrix *M, const bench_limits *l,
                   const bench_effort *effort, bench_comparison *out) {
    const int32_t n = M->A.n;
    int32_t *perm = NEW(int32_t, n);
    lineup L = {.M = M, .limits = l, .effort = effort};
    snprintf(out->name, sizeof out->name, "%s", M->name);
    out->faces = M->faces;
    out->n = n;
    out->nnz = (double)M->A.colptr[n];
    if (effort->parts & PART_ORDER) compare_orderings(ctx, M, &out->table[TABLE_ORDER]);
    order_quadcover(M, ORDER_AMD, perm);
    L.quality = bench_order_quality(ctx, M, perm);
    if (effort->same) {
        L.table = &out->table[TABLE_SAME];
        L.table->title = "The same ordering (AMD) for all";
        line_up(&L, perm);
        measure(&L, false);
        finish(&L, out);
    }
    if (effort->own) {
        L.table = &out->table[TABLE_OWN];
        L.table->title = "Each with its own ordering";
        line_up(&L, NULL);
        measure(&L, true);
        finish(&L, out);
    }
    free(perm);
}
