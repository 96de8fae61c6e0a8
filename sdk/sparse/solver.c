/* What can be done with any table of the interface qc.solver/1. */
#include <qc/solver.h>
#include <string.h>
#include "sdk/sparse/internal.h"

qc_status qc_solver_check(qc_ctx *ctx, const qc_solver *solver) {
    if (!solver) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no solver given");
    if (solver->head.struct_size < offsetof(qc_solver, factorize_real))
        return qc__fail(ctx, QC_ERR_ABI, -1, "a solver table of %u bytes is too short (%u needed)",
                        solver->head.struct_size, (unsigned)offsetof(qc_solver, factorize_real));
    if (!solver->analyze || !solver->factorize || !solver->solve || !solver->info ||
        !solver->destroy)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "solver '%.64s' needs analyze, factorize, solve, info and destroy",
                        solver->head.name ? solver->head.name : "");
    return QC_OK;
}

typedef struct solver_state {
    const qc_solver *solver;
    qc_solver_state *state;
} solver_state;

static qc_status solve(qc_ctx *ctx, void *arg, int32_t nrhs, double *x) {
    const solver_state *s = arg;
    return s->solver->solve(ctx, s->state, nrhs, (qc_complex *)x);
}

qc_status qc_solver_solve_refined(qc_ctx *ctx, const qc_solver *solver, qc_solver_state *state,
                                  const qc_hermitian *A, int32_t steps, qc_complex *x,
                                  double *error) {
    solver_state s = {solver, state};
    const qc_status status = qc_solver_check(ctx, solver);
    if (status != QC_OK) return status;
    return qc__refine(ctx, qc__view_complex(A), 1, steps, solve, &s, (double *)x, error);
}
