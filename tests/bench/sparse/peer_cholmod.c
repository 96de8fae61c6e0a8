/* CHOLMOD: complex supernodal L L^H with its default parameters, and METIS through it. */
#include "bench.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct state {
    cholmod_common common;
    cholmod_sparse A;
    int *colptr;
    int *perm; /* given, or NULL */
    cholmod_factor *symbolic, *L;
    cholmod_dense *X, *Y, *E, *P; /* solution, work space, permuted right-hand side */
} state;

static void check(state *s, bool good) {
    if (!good || s->common.status < CHOLMOD_OK)
        bench_die("CHOLMOD fails with status %d", s->common.status);
}

static void start(state *s, const bench_matrix *M) {
    const int32_t n = M->A.n;
    cholmod_start(&s->common);
    s->common.print = 0;
    s->common.supernodal = CHOLMOD_SUPERNODAL;
    s->colptr = NEW(int, n + 1);
    for (int32_t j = 0; j <= n; j++) s->colptr[j] = (int)M->A.colptr[j];
    s->A = (cholmod_sparse){.nrow = (size_t)n,
                            .ncol = (size_t)n,
                            .nzmax = (size_t)M->A.colptr[n],
                            .p = s->colptr,
                            .i = (void *)(uintptr_t)M->A.row,
                            .x = (void *)(uintptr_t)M->A.val,
                            .stype = 1,
                            .itype = CHOLMOD_INT,
                            .xtype = CHOLMOD_COMPLEX,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

static void *create(const bench_matrix *M, int ordering, const int32_t *perm, uint32_t threads) {
    (void)threads; /* one: main.c limits OpenMP and BLAS */
    static const int method[] = {CHOLMOD_GIVEN, CHOLMOD_AMD, CHOLMOD_METIS};
    state *s = NEW(state, 1);
    start(s, M);
    s->common.nmethods = 1;
    s->common.method[0].ordering = method[ordering];
    if (perm) {
        s->perm = NEW(int, M->A.n);
        memcpy(s->perm, perm, (size_t)M->A.n * sizeof *perm);
    }
    return s;
}

static void analyze(void *self) {
    state *s = self;
    cholmod_free_factor(&s->symbolic, &s->common);
    s->symbolic = cholmod_analyze_p(&s->A, s->perm, NULL, 0, &s->common);
    check(s, s->symbolic != NULL);
}

static void refactor(void *self) {
    state *s = self;
    check(s, cholmod_factorize(&s->A, s->L, &s->common) && s->common.status == CHOLMOD_OK);
}

static void factor(void *self) {
    state *s = self;
    s->L = cholmod_copy_factor(s->symbolic, &s->common); /* integers only: a few per row */
    check(s, s->L != NULL);
    refactor(s);
}

static cholmod_dense dense(const state *s, int32_t nrhs, qc_complex *x) {
    return (cholmod_dense){.nrow = s->A.nrow,
                           .ncol = (size_t)nrhs,
                           .nzmax = s->A.nrow * (size_t)nrhs,
                           .d = s->A.nrow,
                           .x = x,
                           .xtype = CHOLMOD_COMPLEX,
                           .dtype = CHOLMOD_DOUBLE};
}

static void take(const state *s, const cholmod_dense *X, int32_t nrhs, qc_complex *x) {
    memcpy(x, X->x, s->A.nrow * (size_t)nrhs * sizeof *x);
}

static void forward(void *self, qc_complex *x) {
    state *s = self;
    cholmod_dense b = dense(s, 1, x);
    check(s, cholmod_solve2(CHOLMOD_P, s->L, &b, NULL, &s->P, NULL, &s->Y, &s->E, &s->common));
    check(s, cholmod_solve2(CHOLMOD_L, s->L, s->P, NULL, &s->X, NULL, &s->Y, &s->E, &s->common));
    take(s, s->X, 1, x);
}

static void solve(void *self, int32_t nrhs, qc_complex *x) {
    state *s = self;
    cholmod_dense b = dense(s, nrhs, x);
    check(s, cholmod_solve2(CHOLMOD_A, s->L, &b, NULL, &s->X, NULL, &s->Y, &s->E, &s->common));
    take(s, s->X, nrhs, x);
}

static double stored(void *self) {
    const state *s = self;
    return (double)s->symbolic->xsize;
}

static void drop(void *self) {
    state *s = self;
    cholmod_free_factor(&s->L, &s->common);
    cholmod_free_dense(&s->X, &s->common);
    cholmod_free_dense(&s->Y, &s->common);
    cholmod_free_dense(&s->E, &s->common);
    cholmod_free_dense(&s->P, &s->common);
}

static void destroy(void *self) {
    state *s = self;
    drop(s);
    cholmod_free_factor(&s->symbolic, &s->common);
    cholmod_finish(&s->common);
    free(s->colptr);
    free(s->perm);
    free(s);
}

const bench_peer peer_cholmod = {"CHOLMOD", create, analyze, factor, refactor, forward, solve,
                                 NULL,      NULL,   NULL,    NULL,   stored,   drop,    destroy};

void order_metis(const bench_matrix *M, int32_t *perm) {
    state s = {0};
    start(&s, M);
    check(&s, cholmod_metis(&s.A, NULL, 0, false, perm, &s.common));
    cholmod_finish(&s.common);
    free(s.colptr);
}
