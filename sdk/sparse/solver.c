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

/* One round: solution += A^-1 (b - A solution). */
static qc_status refine(qc_ctx *ctx, const qc_solver *solver, qc_solver_state *state,
                        const qc_hermitian *A, const qc_complex *b, qc_complex *solution,
                        qc_complex *r) {
    qc__residual(A, b, solution, r);
    const qc_status status = solver->solve(ctx, state, 1, r);
    for (int32_t i = 0; i < A->n && status == QC_OK; i++) {
        solution[i].re += r[i].re;
        solution[i].im += r[i].im;
    }
    return status;
}

qc_status qc_solver_solve_refined(qc_ctx *ctx, const qc_solver *solver, qc_solver_state *state,
                                  const qc_hermitian *A, int32_t steps, qc_complex *x,
                                  double *residual) {
    const size_t n = (size_t)A->n;
    qc_status status = qc_solver_check(ctx, solver);
    if (status != QC_OK) return status;
    qc_complex *r = QC__NEW(ctx, qc_complex, n), *solution = QC__NEW(ctx, qc_complex, n);
    if (!r || !solution) {
        status = QC_ERR_NOMEM;
    } else {
        if (n > 0) memcpy(solution, x, n * sizeof *x);
        status = solver->solve(ctx, state, 1, solution);
    }
    for (int32_t k = 0; k < steps && status == QC_OK; k++) {
        status = refine(ctx, solver, state, A, x, solution, r);
        if (status == QC_OK && !qc__progress(ctx, (k + 1.0) / steps)) status = QC_ERR_CANCELLED;
    }
    if (status == QC_OK) {
        if (residual) *residual = qc__residual_size(A, x, solution, r);
        if (n > 0) memcpy(x, solution, n * sizeof *x);
    }
    qc__free(r);
    qc__free(solution);
    return status;
}
