/* CXSparse: complex up-looking L L^H by columns, the only peer with complex up- and downdates. A
 * given ordering is applied to the matrix beforehand. */
#include <cs.h> /* includes complex.h, so comes first */

#include "bench.h"

#include <stdlib.h>
#include <string.h>

typedef struct state {
    const bench_matrix *M;
    int ordering;
    cs_ci A;   /* the caller's numbering */
    cs_ci *PA; /* ORDER_GIVEN: permuted, upper triangle */
    int *inverse;
    cs_cis *S;
    cs_cin *N;
    cs_complex_t *x; /* n: permuted right-hand side */
} state;

static void *check(void *p) {
    if (!p) bench_die("CXSparse fails");
    return p;
}

static void *create(const bench_matrix *M, int ordering, const int32_t *perm, uint32_t threads) {
    (void)threads;
    const int32_t n = M->A.n;
    state *s = NEW(state, 1);
    s->M = M;
    s->ordering = ordering;
    s->A = (cs_ci){.nzmax = (int)M->A.colptr[n],
                   .m = n,
                   .n = n,
                   .p = NEW(int, n + 1),
                   .i = (int *)(uintptr_t)M->A.row,
                   .x = (cs_complex_t *)(uintptr_t)M->A.val,
                   .nz = -1};
    for (int32_t j = 0; j <= n; j++) s->A.p[j] = (int)M->A.colptr[j];
    s->inverse = NEW(int, n);
    s->x = NEW(cs_complex_t, n);
    if (perm) {
        for (int32_t k = 0; k < n; k++) s->inverse[perm[k]] = k;
        s->PA = check(cs_ci_symperm(&s->A, s->inverse, 1));
    }
    return s;
}

static const cs_ci *source(const state *s) {
    return s->PA ? s->PA : &s->A;
}

static void analyze(void *self) {
    state *s = self;
    cs_ci_sfree(s->S);
    s->S = check(cs_ci_schol(s->ordering == ORDER_AMD, source(s)));
    if (s->S->pinv) memcpy(s->inverse, s->S->pinv, (size_t)s->A.n * sizeof *s->inverse);
}

static void drop(void *self) {
    state *s = self;
    s->N = cs_ci_nfree(s->N);
}

static void factor(void *self) {
    state *s = self;
    s->N = check(cs_ci_chol(source(s), s->S));
}

static void forward(void *self, qc_complex *x) {
    state *s = self;
    cs_ci_ipvec(s->inverse, (const cs_complex_t *)x, s->x, s->A.n);
    cs_ci_lsolve(s->N->L, s->x);
    memcpy(x, s->x, (size_t)s->A.n * sizeof *x);
}

static void solve(void *self, int32_t nrhs, qc_complex *x) {
    state *s = self;
    for (int32_t r = 0; r < nrhs; r++) {
        cs_complex_t *b = (cs_complex_t *)x + (size_t)r * (size_t)s->A.n;
        cs_ci_ipvec(s->inverse, b, s->x, s->A.n);
        cs_ci_lsolve(s->N->L, s->x);
        cs_ci_ltsolve(s->N->L, s->x);
        cs_ci_pvec(s->inverse, s->x, b, s->A.n);
    }
}

/* L L^H <- L L^H + sigma w w^H, first the update, then the downdate. */
static void apply_flip(void *self, const bench_flip *f, int direction) {
    state *s = self;
    int row[3], colptr[2] = {0, 3};
    cs_complex_t w[3];
    cs_ci C = {.nzmax = 3, .m = s->A.n, .n = 1, .p = colptr, .i = row, .x = w, .nz = -1};
    for (int k = 0; k < 3; k++) row[k] = s->inverse[f->row[k]];
    for (int q = 0; q < 2; q++) {
        memcpy(w, f->w[direction > 0 ? q : 1 - q], sizeof w);
        if (!cs_ci_updown(s->N->L, q ? -1 : 1, &C, s->S->parent))
            bench_die("cs_ci_updown fails at row %d", (int)f->row[0]);
    }
}

static double stored(void *self) {
    const state *s = self;
    return s->S->lnz;
}

static void destroy(void *self) {
    state *s = self;
    drop(s);
    cs_ci_sfree(s->S);
    cs_ci_spfree(s->PA);
    free(s->A.p);
    free(s->inverse);
    free(s->x);
    free(s);
}

const bench_peer peer_cxsparse = {"CXSparse", create, analyze, factor, NULL,   forward, solve,
                                  apply_flip, NULL,   NULL,    NULL,   stored, drop,    destroy};
