/* State of the backend, shared by its files. */
#ifndef QC_MUMPS_SOLVER_H
#define QC_MUMPS_SOLVER_H

#include <qc/solver.h>
#include "group.h"

struct qc_solver_state {
    ZMUMPS_STRUC_C id; /* rank 0's part of the instance           */
    int slot;          /* its number on the workers; -1 = none    */
    int32_t n;
    int64_t nnz;             /* entries of the upper triangle           */
    MUMPS_INT *irn, *jcn;    /* 2 nnz - n, from 1                       */
    mumps_double_complex *a; /* parallel                                */
    MUMPS_INT *position;     /* n: of a row in the order, from 1        */
    double *scale;           /* n: square roots of the diagonal         */
    bool factorized;
};

extern const qc_solver qm_solver;

/* solver.c: solve without asking whether the last factorisation counts. */
qc_status qm_solve(qc_ctx *ctx, qc_solver_state *state, int32_t nrhs, qc_complex *x);

/* matrix.c: ARGUMENT unless columns ascend and end with the diagonal. */
qc_status qm_check_pattern(qc_ctx *ctx, const qc_hermitian *A);
void qm_write_pattern(const qc_hermitian *A, MUMPS_INT *irn, MUMPS_INT *jcn);
void qm_write_values(const qc_hermitian *A, mumps_double_complex *a);
bool qm_same_pattern(const qc_solver_state *state, const qc_hermitian *A);
qc_status qm_order(qc_ctx *ctx, const qc_hermitian *A, MUMPS_INT *position);

/* check.c: NOT_POSDEF when a diagonal entry is not positive; fills scale. */
qc_status qm_check_diagonal(qc_ctx *ctx, qc_solver_state *state, const qc_hermitian *A);
/* check.c: NOT_POSDEF when the factor is that of a matrix which is singular or has, as far as can
 * be told, negative eigenvalues. */
qc_status qm_check_definite(qc_ctx *ctx, qc_solver_state *state);

#endif
