/* Who is compared with whom. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_runner(bench_lineup *L, const char *label, const bench_peer *p, int ordering,
                       const int32_t *perm, uint32_t threads) {
    if (L->peers && L->effort->peers && p != &peer_quadcover && !strstr(L->effort->peers, p->name))
        return;
    L->runner[L->n++] = (bench_runner){
        .label = label, .peer = p, .ordering = ordering, .perm = perm, .threads = threads};
    if (L->peers) L->table->column[L->table->columns++] = label;
}

static void measure(bench_lineup *L) {
    const unsigned parts = L->effort->parts;
    const bench_plan plan = {.op = {[OP_ANALYZE] = parts & PART_FACTOR && L->own,
                                    [OP_FACTOR] = parts & PART_FACTOR,
                                    [OP_REFACTOR] = parts & PART_FACTOR,
                                    [OP_FORWARD] = parts & (PART_SOLVE | PART_UPDATE),
                                    [OP_SOLVE] = parts & PART_SOLVE,
                                    [OP_SOLVE16] = parts & PART_SOLVE,
                                    [OP_FLIP] = parts & PART_UPDATE,
                                    [OP_UNDO] = parts & PART_UPDATE,
                                    [OP_CARRY] = parts & PART_UPDATE},
                             .repeat = L->effort->repeat,
                             .seconds = L->effort->seconds,
                             .memory = 2.5 * 16 * L->quality.nnz,
                             .keep = L->quality.nnz < 25e6};
    if (parts & PART_MEMORY) bench_memory_row(L);
    if (!(parts & (PART_FACTOR | PART_SOLVE | PART_UPDATE))) return;
    bench_measure(L->M, L->n, L->runner, &plan);
    if (parts & PART_FACTOR && L->own) bench_analysis_rows(L);
    if (parts & PART_FACTOR) bench_factor_rows(L);
    if (parts & PART_SOLVE) bench_solve_rows(L);
    if (parts & PART_UPDATE) bench_update_rows(L);
}

enum { METIS = ORDER_KINDS, ORDERINGS }; /* after ours */

/* Our orderings and METIS, in turns. */
static void compare_orderings(qc_ctx *ctx, const bench_matrix *M, bench_table *t) {
    const int32_t repeat = M->faces < 200000 ? 3 : 1;
    int32_t *perm = NEW(int32_t, M->A.n);
    bench_samples s[ORDERINGS] = {{0, 0, NULL}};
    bench_quality q[ORDERINGS];
    double seconds[ORDERINGS];
    for (int32_t i = 0; i < repeat; i++)
        for (int k = ORDER_AMD; k < ORDERINGS; k++) {
            const bench_duration begin = bench_clock();
            k == METIS ? order_metis(M, perm) : order_quadcover(M, k, perm);
            const bench_duration end = bench_clock();
            bench_sample(&s[k], (bench_duration){end.wall - begin.wall, end.cpu - begin.cpu});
            if (i == 0) q[k] = bench_order_quality(ctx, M, perm);
        }
    for (int k = ORDER_AMD; k < ORDERINGS; k++) {
        seconds[k] = bench_median(&s[k]).cpu;
        free(s[k].value);
    }
    t->title = "Orderings";
    t->columns = 1;
    t->column[0] = "METIS";
    for (int k = ORDER_AMD; k < METIS; k++)
        bench_order_rows(t, k, seconds[k], &q[k], seconds[METIS], &q[METIS]);
    free(perm);
}

static void finish(bench_lineup *L, bench_comparison *out) {
    for (int i = 0; i < L->n; i++) {
        if (L->runner[i].residual > out->residual) out->residual = L->runner[i].residual;
        bench_runner_clear(&L->runner[i]);
    }
    L->n = 0;
}

/* perm: the ordering for all, or NULL = each its own. */
static void line_up(bench_lineup *L, const int32_t *perm) {
    const int amd = perm ? ORDER_GIVEN : ORDER_AMD, own = perm ? ORDER_GIVEN : ORDER_PLACED;
    const int theirs = perm ? ORDER_GIVEN : ORDER_DISSECTION;
    L->peers = 0;
    add_runner(L, "ours", &peer_quadcover, own, perm, 1);
    add_runner(L, "ours, 2 threads", &peer_quadcover, own, perm, 2);
    if (!perm) add_runner(L, "ours, AMD, 2 threads", &peer_quadcover, amd, NULL, 2);
    L->peers = L->n;
    add_runner(L, perm ? "CHOLMOD" : "CHOLMOD, AMD", &peer_cholmod, amd, perm, 1);
    add_runner(L, perm ? "CXSparse" : "CXSparse, AMD", &peer_cxsparse, amd, perm, 1);
    if (!perm) add_runner(L, "CHOLMOD, METIS", &peer_cholmod, theirs, NULL, 1);
    if (!perm) add_runner(L, "ours, AMD", &peer_quadcover, amd, NULL, 1);
#ifdef BENCH_MUMPS
    add_runner(L, perm ? "MUMPS" : "MUMPS, its choice", &peer_mumps, theirs, perm, 1);
#endif
}

static void compare(bench_lineup *L, const int32_t *perm, bench_comparison *out) {
    L->own = !perm;
    L->table = &out->table[perm ? TABLE_SAME : TABLE_OWN];
    L->table->title =
        perm ? "The same ordering (AMD) for all" : "Each its own (ours: with positions)";
    line_up(L, perm);
    measure(L);
    finish(L, out);
}

void bench_compare(qc_ctx *ctx, const bench_matrix *M, const bench_limits *l,
                   const bench_effort *effort, bench_comparison *out) {
    int32_t *perm = NEW(int32_t, M->A.n);
    bench_lineup L = {.M = M, .limits = l, .effort = effort};
    snprintf(out->name, sizeof out->name, "%s", M->name);
    out->faces = M->faces;
    out->n = M->A.n;
    out->nnz = (double)M->A.colptr[M->A.n];
    if (effort->parts & PART_ORDER) compare_orderings(ctx, M, &out->table[TABLE_ORDER]);
    order_quadcover(M, ORDER_AMD, perm);
    L.quality = bench_order_quality(ctx, M, perm);
    if (effort->same) compare(&L, perm, out);
    order_quadcover(M, ORDER_PLACED, perm);
    L.quality = bench_order_quality(ctx, M, perm);
    if (effort->own) compare(&L, NULL, out);
    free(perm);
}
