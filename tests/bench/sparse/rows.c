/* The rows of the tables and the figures to be reached. */
#include "bench.h"

/* The first column of that peer: with AMD, in the table of own orderings. */
static void reach(const bench_lineup *L, bench_row *r, const bench_peer *p, double figure) {
    for (int c = 0; c < L->table->columns; c++)
        if (L->runner[L->peers + c].peer == p) {
            r->reach[c] = figure;
            return;
        }
}

/* Seconds; on several threads only the wall clock tells, else the time of the thread does better.
 */
static double seconds(const bench_runner *r, int op, bool wall) {
    return wall ? r->time[op].wall : r->time[op].cpu;
}

static bench_row *time_row(bench_lineup *L, const char *name, int who, unsigned ops) {
    const bool wall = who != OURS;
    bench_row *r = bench_add_row(L->table, name, "s", 0);
    for (int op = 0; op < OP_COUNT; op++) {
        if (!(ops >> op & 1)) continue;
        r->ours += seconds(&L->runner[who], op, wall);
        for (int c = 0; c < L->table->columns; c++)
            r->peer[c] += seconds(&L->runner[L->peers + c], op, wall);
    }
    return r;
}

static void rate(bench_row *r, double amount, const char *unit, double limit) {
    r->rate = r->ours > 0 ? amount / r->ours : 0;
    r->rate_unit = unit;
    r->percent = limit > 0 ? 100 * r->rate / limit : 0;
}

/* Of the level of the memory which holds so many bytes. */
static double stream_limit(const bench_limits *l, double bytes) {
    return bytes < l->l2_size ? l->l2 : bytes < l->l3_size ? l->l3 : l->memory;
}

static double factor_reach(int32_t faces) {
    return faces < 200000 ? 6 : faces < 1000000 ? 4.5 : 2;
}

void bench_factor_rows(bench_lineup *L) {
    const double flops = L->quality.flops, fma = L->limits->fma;
    bench_row *r = time_row(L, "factorise, 1 thread", OURS, 1u << OP_FACTOR);
    rate(r, flops, "flop/s", fma);
    if (!L->own) reach(L, r, &peer_cholmod, factor_reach(L->M->faces));
    rate(time_row(L, "factorise, 2 threads", OURS_2, 1u << OP_FACTOR), flops, "flop/s", 2 * fma);
    rate(time_row(L, "factorise again, 1 thread", OURS, 1u << OP_REFACTOR), flops, "flop/s", fma);
    rate(time_row(L, "factorise again, 2 threads", OURS_2, 1u << OP_REFACTOR), flops, "flop/s",
         2 * fma);
    bench_row *s = bench_add_row(L->table, "entries stored", "", L->runner[OURS].stored);
    for (int c = 0; c < L->table->columns; c++) s->peer[c] = L->runner[L->peers + c].stored;
}

void bench_solve_rows(bench_lineup *L) {
    const double bytes = 16 * L->quality.nnz, limit = stream_limit(L->limits, bytes);
    bench_row *r = time_row(L, "forward solve", OURS, 1u << OP_FORWARD);
    rate(r, bytes, "B/s", limit);
    if (!L->own) {
        reach(L, r, &peer_cholmod, 3);
        reach(L, r, &peer_cxsparse, 2);
    }
    r = time_row(L, "full solve", OURS, 1u << OP_SOLVE);
    rate(r, 2 * bytes, "B/s", limit);
    r = time_row(L, "full solve, 16 right-hand sides", OURS, 1u << OP_SOLVE16);
    rate(r, 16 * 16 * L->quality.nnz, "flop/s", L->limits->fma);
    if (!L->own) reach(L, r, &peer_cholmod, 2);
    time_row(L, "full solve, 16, 2 threads", OURS_2, 1u << OP_SOLVE16);
}

/* A flip needs its forward solution as well: for the peers that is a whole forward solve. */
static void carry_rows(bench_lineup *L) {
    const bench_runner *ours = &L->runner[OURS];
    const double total = seconds(ours, OP_CARRY, false), flip = seconds(ours, OP_FLIP, false);
    if (total <= 0) return;
    bench_row *r = bench_add_row(L->table, "flip and its forward solution", "s", total);
    bench_row *f = bench_add_row(L->table, "of this, the forward solution", "s", total - flip);
    for (int c = 0; c < L->table->columns; c++) {
        const bench_runner *peer = &L->runner[L->peers + c];
        f->peer[c] = seconds(peer, OP_FORWARD, false);
        if (seconds(peer, OP_FLIP, false) > 0)
            r->peer[c] = seconds(peer, OP_FLIP, false) + f->peer[c];
    }
    reach(L, f, &peer_cxsparse, 80);
}

/* One read and one write of 16 bytes per entry. */
void bench_update_rows(bench_lineup *L) {
    const double entries = L->quality.touched;
    bench_row *r = time_row(L, "update pair (one flip)", OURS, 1u << OP_FLIP);
    rate(r, 32 * entries, "B/s", stream_limit(L->limits, 16 * entries));
    reach(L, r, &peer_cxsparse, L->own ? 25 : 10);
    time_row(L, "update pair, 2 threads", OURS_2, 1u << OP_FLIP);
    const double undo = seconds(&L->runner[OURS], OP_UNDO, false), flip = r->ours;
    if (undo > 0) {
        r = bench_add_row(L->table, "flip taken back", "s", undo);
        for (int c = 0; c < L->table->columns; c++)
            r->peer[c] = seconds(&L->runner[L->peers + c], OP_FLIP, false);
        r->other = "own update";
        r->other_value = flip;
        r->other_reach = 3;
    }
    carry_rows(L);
}

void bench_memory_row(bench_lineup *L) {
    bench_row *r = bench_add_row(L->table, "peak memory of analysis and factor", "B",
                                 bench_peak_memory(L->M, &L->runner[OURS]));
    for (int c = 0; c < L->table->columns; c++)
        r->peer[c] = bench_peak_memory(L->M, &L->runner[L->peers + c]);
    reach(L, r, &peer_cholmod, 1 / 0.7);
}

void bench_analysis_rows(bench_lineup *L) {
    const unsigned both = 1u << OP_ANALYZE | 1u << OP_FACTOR;
    const int32_t faces = L->M->faces;
    time_row(L, "analyse, 1 thread", OURS, 1u << OP_ANALYZE);
    time_row(L, "analyse and factorise, 1 thread", OURS, both);
    bench_row *r = time_row(L, "analyse and factorise, 2 threads", OURS_2, both);
    bench_row *quick = time_row(L, "the same, ours with AMD", OURS_AMD_2, both);
    if (80000 < faces && faces < 100000) {
        reach(L, r, &peer_cholmod, 5);
        reach(L, quick, &peer_cholmod, 5);
    }
}

void bench_order_rows(bench_table *t, int ordering, double seconds, const bench_quality *q,
                      double metis_seconds, const bench_quality *metis) {
    static const char *const name[ORDER_KINDS][4] = {
        [ORDER_AMD] = {"AMD: time", "AMD: entries of L", "AMD: operations",
                       "AMD: entries touched by a flip"},
        [ORDER_DISSECTION] = {"dissection: time", "dissection: entries of L",
                              "dissection: operations", "dissection: entries touched by a flip"},
        [ORDER_PLACED] = {"with positions: time", "with positions: entries of L",
                          "with positions: operations", "with positions: entries touched"}};
    static const char *const unit[4] = {"s", "", "flop", ""};
    const double ours[4] = {seconds, q->nnz, q->flops, q->touched};
    const double theirs[4] = {metis_seconds, metis->nnz, metis->flops, metis->touched};
    const double figure[4] = {2, 0, 0, 1 / 0.9};
    for (int i = 0; i < 4; i++) {
        bench_row *row = bench_add_row(t, name[ordering][i], unit[i], ours[i]);
        row->peer[0] = theirs[i];
        if (ordering != ORDER_AMD) row->reach[0] = figure[i];
    }
}
