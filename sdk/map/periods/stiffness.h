/* Real conforming stiffness matrix of the unknown coordinates of a map with seams, factorised.
 * Internal to sdk/map.
 *
 * Quarter turns only swap and negate, so the Dirichlet energy of f' = W F + (given) couples
 * coordinate with coordinate by scalars: the matrix is that of the covering modulo the deck
 * transformation of two layers, with one row for every coordinate of every F_v that is not given.
 */
#ifndef QC_MAP_STIFFNESS_H
#define QC_MAP_STIFFNESS_H

#include "sdk/map/seams/seams.h"

typedef struct qc__map_stiffness {
    const qc__seams *seams;  /* borrowed, as are ...  */
    const double *cotangent; /* ... 3 n_faces */
    const qc_solver *solver;
    int32_t n;
    int32_t *unknown;       /* 2 n_vertices: row of coordinate c of F_v at 2 v + c, -1 = given */
    qc_solver_state *state; /* NULL when n = 0 */
} qc__map_stiffness;

/* solver NULL = builtin. A coordinate of a component which neither symbols nor holonomy bind, where
 * the constants are in the kernel, has one unknown set to zero. Errors: those of the solver, NOMEM.
 */
qc_status qc__map_stiffness_create(qc_ctx *ctx, const qc__seams *seams, const double *cotangent,
                                   const qc_solver *solver, qc__map_stiffness **out);
void qc__map_stiffness_free(qc__map_stiffness *stiffness);
/* Solves in place for nrhs columns of length n. */
qc_status qc__map_stiffness_solve(qc_ctx *ctx, const qc__map_stiffness *stiffness, int32_t nrhs,
                                  double *x);

#endif
