/* qc/sparse.h as a peer. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

#include "sdk/sparse/internal.h"

typedef struct state {
    qc_ctx *ctx;
    const bench_matrix *M;
    qc_analyze_options options;
    qc_symbolic *S;
    qc_factor *F;
} state;

static qc_analyze_options ordering_options(const bench_matrix *M, int ordering,
                                           const int32_t *perm) {
    static const int32_t name[] = {QC_ORDER_GIVEN, QC_ORDER_AMD, QC_ORDER_DISSECTION,
                                   QC_ORDER_DISSECTION};
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    options.ordering = name[ordering];
    options.permutation = perm;
    if (ordering == ORDER_PLACED) options.position = M->position;
    return options;
}

static void *create(const bench_matrix *M, int ordering, const int32_t *perm, uint32_t threads) {
    state *s = NEW(state, 1);
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = threads;
    bench_check(NULL, qc_ctx_create(&options, &s->ctx));
    s->M = M;
    s->options = ordering_options(M, ordering, perm);
    return s;
}

static void analyze(void *self) {
    state *s = self;
    qc_symbolic_free(s->S);
    bench_check(s->ctx, qc_analyze(s->ctx, &s->M->A, &s->options, &s->S));
}

static void factor(void *self) {
    state *s = self;
    bench_check(s->ctx, qc_factorize(s->ctx, s->S, &s->M->A, &s->F));
}

static void refactor(void *self) {
    state *s = self;
    bench_check(s->ctx, qc_refactorize(s->ctx, s->F, &s->M->A));
}

static void forward(void *self, qc_complex *x) {
    state *s = self;
    bench_check(s->ctx, qc_solve_forward(s->ctx, s->F, 1, x));
}

static void solve(void *self, int32_t nrhs, qc_complex *x) {
    state *s = self;
    bench_check(s->ctx, qc_solve(s->ctx, s->F, nrhs, x));
}

static void apply_flip(void *self, const bench_flip *f, int direction) {
    state *s = self;
    const qc_complex dl = {direction * f->dl.re, direction * f->dl.im};
    const qc_complex dm = {direction * f->dm.re, direction * f->dm.im};
    bench_check(s->ctx, qc_flip(s->ctx, s->F, f->row[0], f->row[1], dl, f->row[2], dm));
}

static void undo(void *self) {
    state *s = self;
    bench_check(s->ctx, qc_factor_rollback(s->ctx, s->F));
}

static void carry(void *self, const qc_complex *b) {
    state *s = self;
    bench_check(s->ctx, b ? qc_forward_attach(s->ctx, s->F, b) : qc_forward_detach(s->ctx, s->F));
}

static double energy(void *self) {
    state *s = self;
    double result = 0;
    bench_check(s->ctx, qc_forward_energy(s->ctx, s->F, &result));
    return result;
}

static double stored(void *self) {
    const state *s = self;
    qc_symbolic_info info = QC_SYMBOLIC_INFO_INIT;
    qc_symbolic_get_info(s->S, &info);
    return (double)info.stored;
}

static void drop(void *self) {
    state *s = self;
    qc_factor_free(s->F);
    s->F = NULL;
}

static void destroy(void *self) {
    state *s = self;
    drop(s);
    qc_symbolic_free(s->S);
    qc_ctx_free(s->ctx);
    free(s);
}

const bench_peer peer_quadcover = {"QuadCover", create, analyze,    factor, refactor,
                                   forward,     solve,  apply_flip, undo,   carry,
                                   energy,      stored, drop,       destroy};

void order_quadcover(const bench_matrix *M, int ordering, int32_t *perm) {
    const qc_analyze_options options = ordering_options(M, ordering, NULL);
    const qc__pattern pattern = {M->A.n, M->A.colptr, M->A.row};
    qc_ctx_options one = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    one.threads = 1;
    bench_check(NULL, qc_ctx_create(&one, &ctx));
    bench_check(ctx, qc__order(ctx, pattern, &options, perm));
    qc_ctx_free(ctx);
}
