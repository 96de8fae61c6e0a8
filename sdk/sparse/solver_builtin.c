/* The backend `builtin` of qc.solver/1: qc/sparse.h behind the table. */
#include <qc/solver.h>
#include <string.h>
#include "sdk/sparse/internal.h"

struct qc_solver_state {
    qc_symbolic *symbolic;
    qc_factor *factor; /* made by the first factorisation, reused by the others */
    bool real;
};

static void destroy(qc_solver_state *s) {
    if (!s) return;
    qc_factor_free(s->factor);
    qc_symbolic_free(s->symbolic);
    qc__free(s);
}

static qc_status analyze(const qc_solver *self, qc_ctx *ctx, const qc_hermitian *A,
                         const qc_solver_options *options, qc_solver_state **out) {
    (void)self;
    qc_solver_options o = QC_SOLVER_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    qc_solver_state *s = QC__ZERO(ctx, qc_solver_state, 1);
    if (!s) return QC_ERR_NOMEM;
    s->real = o.real != 0;
    const qc_symmetric B = {A->n, A->colptr, A->row, NULL};
    const qc_status status = s->real ? qc_analyze_real(ctx, &B, NULL, &s->symbolic)
                                     : qc_analyze(ctx, A, NULL, &s->symbolic);
    if (status == QC_OK)
        *out = s;
    else
        destroy(s);
    return status;
}

static qc_status check(qc_ctx *ctx, const qc_solver_state *s, bool real, bool factorized) {
    if (s->real != real)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "solver builtin: analysed for %s values",
                        s->real ? "real" : "complex");
    if (factorized && !s->factor)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "solver builtin: factorise before this call");
    return QC_OK;
}

static qc_status factorize(qc_ctx *ctx, qc_solver_state *s, const qc_hermitian *A) {
    const qc_status status = check(ctx, s, false, false);
    if (status != QC_OK) return status;
    return s->factor ? qc_refactorize(ctx, s->factor, A)
                     : qc_factorize(ctx, s->symbolic, A, &s->factor);
}

static qc_status factorize_real(qc_ctx *ctx, qc_solver_state *s, const qc_symmetric *A) {
    const qc_status status = check(ctx, s, true, false);
    if (status != QC_OK) return status;
    return s->factor ? qc_refactorize_real(ctx, s->factor, A)
                     : qc_factorize_real(ctx, s->symbolic, A, &s->factor);
}

static qc_status solve(qc_ctx *ctx, qc_solver_state *s, int32_t nrhs, qc_complex *x) {
    const qc_status status = check(ctx, s, false, true);
    return status == QC_OK ? qc_solve(ctx, s->factor, nrhs, x) : status;
}

static qc_status solve_real(qc_ctx *ctx, qc_solver_state *s, int32_t nrhs, double *x) {
    const qc_status status = check(ctx, s, true, true);
    return status == QC_OK ? qc_solve_real(ctx, s->factor, nrhs, x) : status;
}

static qc_status updown(qc_ctx *ctx, qc_solver_state *s, int sigma, int32_t nw, const int32_t *row,
                        const qc_complex *w) {
    const qc_status status = check(ctx, s, false, true);
    return status == QC_OK ? qc_updown(ctx, s->factor, sigma, nw, row, w) : status;
}

static void info(const qc_solver_state *s, qc_solver_info *out) {
    qc_symbolic_info symbolic = QC_SYMBOLIC_INFO_INIT;
    qc_symbolic_get_info(s->symbolic, &symbolic);
    qc_solver_info i = QC_SOLVER_INFO_INIT;
    i.struct_size = out->struct_size;
    i.n = symbolic.n;
    i.processes = 1;
    i.nnz = symbolic.stored * (s->real ? 1 : 2);
    i.bytes = s->real ? symbolic.bytes_real : symbolic.bytes_complex;
    i.flops = symbolic.flops * (s->real ? 1 : 4);
    memcpy(out, &i, i.struct_size < sizeof i ? i.struct_size : sizeof i);
}

const qc_solver qc_solver_builtin = {
    .head = {sizeof(qc_solver), QC_SOLVER_COMPLEX | QC_SOLVER_REAL | QC_SOLVER_UPDATE, "builtin",
             "supernodal factorisation of qc/sparse.h, one machine"},
    .analyze = analyze,
    .factorize = factorize,
    .solve = solve,
    .info = info,
    .destroy = destroy,
    .factorize_real = factorize_real,
    .solve_real = solve_real,
    .updown = updown,
};
