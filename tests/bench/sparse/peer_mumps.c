/* MUMPS, sequential: it has no Hermitian mode, so this is complex L U without pivoting, scaling or
 * transversal, none of which a positive definite matrix needs. */
#include "bench.h"

#include <stdlib.h>
#include <zmumps_c.h>

typedef struct state {
    ZMUMPS_STRUC_C id;
    MUMPS_INT *row, *column, *inverse;
    ZMUMPS_COMPLEX *value;
} state;

static void call(state *s, int job) {
    s->id.job = job;
    zmumps_c(&s->id);
    if (s->id.infog[0] < 0)
        bench_die("MUMPS fails in job %d with INFOG(1) = %d, INFOG(2) = %d", job, s->id.infog[0],
                  s->id.infog[1]);
}

static void fill_matrix(state *s, const qc_hermitian *A) {
    const int64_t nnz = 2 * A->colptr[A->n] - A->n;
    s->row = NEW(MUMPS_INT, nnz);
    s->column = NEW(MUMPS_INT, nnz);
    s->value = NEW(ZMUMPS_COMPLEX, nnz);
    int64_t q = 0;
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            for (int mirror = 0; mirror <= (A->row[p] != j); mirror++) {
                s->row[q] = 1 + (mirror ? j : A->row[p]);
                s->column[q] = 1 + (mirror ? A->row[p] : j);
                s->value[q].r = A->val[p].re;
                s->value[q].i = A->row[p] == j ? 0 : mirror ? -A->val[p].im : A->val[p].im;
                q++;
            }
    s->id.n = A->n;
    s->id.nnz = nnz;
    s->id.irn = s->row;
    s->id.jcn = s->column;
    s->id.a = s->value;
}

static void *create(const bench_matrix *M, int ordering, const int32_t *perm, uint32_t threads) {
    (void)threads;
    enum { GIVEN = 1, AMD = 0, AUTOMATIC = 7 };
    static const int method[] = {GIVEN, AMD, AUTOMATIC};
    state *s = NEW(state, 1);
    s->id.par = 1;
    s->id.sym = 0;
    s->id.comm_fortran = -987654; /* MPI_COMM_WORLD */
    call(s, -1);
    for (int k = 0; k < 4; k++) s->id.icntl[k] = 0; /* silent */
    s->id.icntl[5] = 0;                             /* no transversal */
    s->id.icntl[6] = method[ordering];
    s->id.icntl[7] = 0; /* no scaling */
    s->id.cntl[0] = 0;  /* no pivoting */
    fill_matrix(s, &M->A);
    if (perm) {
        s->inverse = NEW(MUMPS_INT, M->A.n);
        for (int32_t k = 0; k < M->A.n; k++) s->inverse[perm[k]] = k + 1;
        s->id.perm_in = s->inverse;
    }
    return s;
}

static void analyze(void *self) {
    call(self, 1);
}

static void factor(void *self) {
    call(self, 2);
}

static void solve(void *self, int32_t nrhs, qc_complex *x) {
    state *s = self;
    s->id.rhs = (ZMUMPS_COMPLEX *)x;
    s->id.nrhs = nrhs;
    s->id.lrhs = s->id.n;
    call(s, 3);
}

/* Entries of L and U. */
static double stored(void *self) {
    const state *s = self;
    return s->id.infog[2] < 0 ? -1e6 * s->id.infog[2] : s->id.infog[2];
}

static void drop(void *self) {
    (void)self; /* the next factorisation reuses the storage */
}

static void destroy(void *self) {
    state *s = self;
    call(s, -2);
    free(s->row);
    free(s->column);
    free(s->inverse);
    free(s->value);
    free(s);
}

const bench_peer peer_mumps = {"MUMPS", create, analyze, factor, NULL,   NULL, solve,
                               NULL,    NULL,   NULL,    NULL,   stored, drop, destroy};
