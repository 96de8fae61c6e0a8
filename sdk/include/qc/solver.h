/* qc/solver.h - sparse Hermitian solvers as a plugin point: the interface "qc.solver/1".
 *
 * A backend is a constant table. `builtin` (the factorisation of qc/sparse.h) is always there; a
 * plugin offers more through qc_plugin.extension(QC_SOLVER_ID), a program through
 * qc_registry_offer, and where a function takes a `const qc_solver *` any table will do, NULL being
 * `builtin`. Stages choose by name (qc_run.find). docs/solvers.md shows a whole backend.
 *
 * Matrices are the views of qc/sparse.h: upper triangle, columns sorted, every diagonal entry
 * present. A state is made by analyze, filled by factorize as often as values change, and used by
 * solve in between. All functions report through qc_ctx_fail and return the status.
 * Thread rule: a table is immutable and may be used by any number of threads; a state belongs to
 * one thread at a time, which need not be the one that made it; ctx is that of the calling thread.
 */
#ifndef QC_SOLVER_H
#define QC_SOLVER_H

#include <qc/sparse.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_SOLVER_ID "qc.solver/1"

enum { /* head.flags: what a backend can do */
       QC_SOLVER_COMPLEX = 1,
       QC_SOLVER_REAL = 2,       /* factorize_real and solve_real                  */
       QC_SOLVER_UPDATE = 4,     /* updown                                         */
       QC_SOLVER_DISTRIBUTED = 8 /* the factor may be spread over several machines */
};

typedef struct qc_solver_state qc_solver_state; /* defined by each backend for itself */

typedef struct qc_solver_options {
    uint32_t struct_size;
    int32_t real; /* 1: values will be real, given to factorize_real and solve_real */
} qc_solver_options;
#define QC_SOLVER_OPTIONS_INIT                                                                     \
    { sizeof(qc_solver_options), 0 }

typedef struct qc_solver_info {
    uint32_t struct_size;
    int32_t n;
    int32_t processes; /* which share the factor                             */
    int64_t nnz;       /* numbers stored for the factors; 0 = not known yet  */
    int64_t bytes;     /* memory of the factor in all processes              */
    double flops;      /* real floating point operations of one factorisation */
} qc_solver_info;
#define QC_SOLVER_INFO_INIT                                                                        \
    { sizeof(qc_solver_info), 0, 0, 0, 0, 0.0 }

typedef struct qc_solver {
    qc_interface head; /* struct_size = sizeof(qc_solver), flags, name, doc */
    void *user;        /* for the owner of the table */

    /* Symbolic analysis; only the pattern of A is read (val may be NULL). options NULL = defaults.
     * Errors: ARGUMENT (pattern), UNSUPPORTED (real or complex is missing), NOMEM, CANCELLED. */
    qc_status (*analyze)(const struct qc_solver *self, qc_ctx *ctx, const qc_hermitian *A,
                         const qc_solver_options *options, qc_solver_state **out);
    /* Numeric factorisation, again for each new set of values; A has the pattern analysed. On error
     * solves answer ARGUMENT until a factorisation succeeds. Errors: NOT_POSDEF (where = pivot, or
     * -1 where the backend cannot tell), ARGUMENT, NOMEM, CANCELLED, FAILED. */
    qc_status (*factorize)(qc_ctx *ctx, qc_solver_state *state, const qc_hermitian *A);
    /* Overwrites x, n x nrhs by columns, by the solutions; untouched on error. */
    qc_status (*solve)(qc_ctx *ctx, qc_solver_state *state, int32_t nrhs, qc_complex *x);
    /* Fills the members which info->struct_size covers. */
    void (*info)(const qc_solver_state *state, qc_solver_info *info);
    void (*destroy)(qc_solver_state *state); /* NULL is fine */

    /* Optional, NULL = absent. The same for real values, of a state analysed for them. */
    qc_status (*factorize_real)(qc_ctx *ctx, qc_solver_state *state, const qc_symmetric *A);
    qc_status (*solve_real)(qc_ctx *ctx, qc_solver_state *state, int32_t nrhs, double *x);
    /* Optional: A <- A + sigma w w^H, the contract of qc_updown. */
    qc_status (*updown)(qc_ctx *ctx, qc_solver_state *state, int sigma, int32_t nw,
                        const int32_t *row, const qc_complex *w);
} qc_solver;

/* The factorisation of qc/sparse.h: QC_SOLVER_COMPLEX, _REAL and _UPDATE. */
QC_API extern const qc_solver qc_solver_builtin;

/* Whether a table can be called: ABI (shorter than up to destroy), ARGUMENT (a function which is
 * not optional is NULL). Called by everything here which takes a solver. Thread: that of ctx. */
QC_API qc_status qc_solver_check(qc_ctx *ctx, const qc_solver *solver);

/* Solve with a factorised state, then up to `steps` rounds of iterative refinement with A, as
 * qc_solve_refined. x enters as b, leaves as the solution; *error may be NULL. Errors: those of
 * solve, NOMEM, CANCELLED. */
QC_API qc_status qc_solver_solve_refined(qc_ctx *ctx, const qc_solver *solver,
                                         qc_solver_state *state, const qc_hermitian *A,
                                         int32_t steps, qc_complex *x, double *error);

#ifdef __cplusplus
}
#endif
#endif
