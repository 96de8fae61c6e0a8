/* The backend `mumps` of qc.solver/1: complex LU by MUMPS (Amestoy, Duff, L'Excellent, Koster 2001,
 * a fully asynchronous multifrontal solver) on all processes of the group.
 *
 * MUMPS has no complex Hermitian mode. LU of A (SYM = 0, both triangles given, hardly any pivoting,
 * which a positive definite matrix does not need) is faster than the real form [Re -Im; Im Re] of
 * twice the size with SYM = 1, and needs less memory. It does not see the sign of pivots; see
 * check.c. */
#include "solver.h"
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MORE_MEMORY = 6 }; /* times the workspace may be doubled */

static void destroy(qc_solver_state *s) {
    if (!s) return;
    if (s->slot >= 0) qm_run(JOB_END, &s->slot, &s->id);
    free(s->irn);
    free(s->jcn);
    free(s->a);
    free(s->position);
    free(s->scale);
    free(s);
}

/* --- errors ----------------------------------------------------------------------------------- */

/* INFOG(1) and INFOG(2), section "Error and warning diagnostics" of the MUMPS users' guide. */
static qc_status report(qc_ctx *ctx, const qc_solver_state *s) {
    const int code = s->id.infog[0], detail = s->id.infog[1];
    char text[160];
    switch (code) {
    case -6:
    case -10:
        return qc_ctx_fail(ctx, QC_ERR_NOT_POSDEF, -1, "solver mumps: the matrix is singular");
    case -5:
    case -7:
    case -8:
    case -9:
    case -13:
    case -19:
    case -22:
        snprintf(text, sizeof text,
                 "solver mumps: out of memory on one of %d processes (MUMPS error %d, %d)",
                 qm_size(), code, detail);
        return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, text);
    default:
        snprintf(text, sizeof text,
                 "solver mumps: MUMPS error %d, %d; its users' guide lists them under INFOG", code,
                 detail);
        return qc_ctx_fail(ctx, QC_ERR_FAILED, -1, text);
    }
}

/* Runs a job, with twice the workspace as often as MUMPS finds its estimate too small. */
static qc_status run(qc_ctx *ctx, qc_solver_state *s, int job) {
    for (int round = 0;; round++) {
        qm_run(job, &s->slot, &s->id);
        const int code = s->id.infog[0];
        if (code >= 0) return QC_OK;
        const bool workspace = code == -8 || code == -9 || code == -14 || code == -15;
        if (job != JOB_FACTORIZE || !workspace || round == MORE_MEMORY) return report(ctx, s);
        s->id.icntl[13] *= 2; /* ICNTL(14): per cent above the estimate */
    }
}

/* --- the table -------------------------------------------------------------------------------- */

static qc_status create(qc_ctx *ctx, const qc_hermitian *A, qc_solver_state **out) {
    qc_solver_state *s = calloc(1, sizeof *s);
    if (!s) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    s->slot = -1;
    s->n = A->n;
    s->nnz = A->colptr[A->n];
    const size_t entries = 2 * (size_t)s->nnz - (size_t)A->n + 1;
    s->irn = malloc(entries * sizeof *s->irn);
    s->jcn = malloc(entries * sizeof *s->jcn);
    s->a = malloc(entries * sizeof *s->a);
    s->position = malloc(((size_t)A->n + 1) * sizeof *s->position);
    s->scale = malloc(((size_t)A->n + 1) * sizeof *s->scale);
    if (!s->irn || !s->jcn || !s->a || !s->position || !s->scale) {
        destroy(s);
        return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    }
    qm_write_pattern(A, s->irn, s->jcn);
    *out = s;
    return QC_OK;
}

static qc_status begin(qc_ctx *ctx, qc_solver_state *s) {
    qm_run(JOB_BEGIN, &s->slot, &s->id);
    if (s->id.infog[0] < 0) return report(ctx, s);
    ZMUMPS_STRUC_C *id = &s->id;
    id->n = s->n;
    id->nnz = 2 * s->nnz - s->n;
    id->irn = s->irn;
    id->jcn = s->jcn;
    id->a = s->a;
    id->cntl[0] = 1e-8; /* CNTL(1): pivots as ordered; with 0 null pivots are not looked for */
    id->icntl[5] = 0;   /* ICNTL(6): the diagonal is where it should be */
    id->perm_in = s->position;
    id->icntl[6] = 1;  /* ICNTL(7): the order given  */
    id->icntl[7] = 0;  /* ICNTL(8): no scaling; values change between analysis and factorisation */
    id->icntl[23] = 1; /* ICNTL(24): rows of null pivots are counted and listed */
    id->cntl[2] = (s->n > 10 ? s->n : 10) * DBL_EPSILON; /* CNTL(3): null, relative to |A| */
    id->icntl[32] = 1; /* ICNTL(33): the determinant, for its sign */
    return run(ctx, s, JOB_ANALYZE);
}

static qc_status analyze(const qc_solver *self, qc_ctx *ctx, const qc_hermitian *A,
                         const qc_solver_options *options, qc_solver_state **out) {
    (void)self;
    const size_t known = offsetof(qc_solver_options, real) + sizeof options->real;
    const char *reason = qm_start();
    char text[256];
    if (reason) {
        snprintf(text, sizeof text, "solver mumps: %s", reason);
        return qc_ctx_fail(ctx, QC_ERR_UNSUPPORTED, -1, text);
    }
    if (options && options->struct_size >= known && options->real)
        return qc_ctx_fail(ctx, QC_ERR_UNSUPPORTED, -1, "solver mumps takes complex values only");
    qc_solver_state *s = NULL;
    qc_status status = qm_check_pattern(ctx, A);
    if (status == QC_OK) status = create(ctx, A, &s);
    if (status == QC_OK && A->n > 0) status = qm_order(ctx, A, s->position);
    if (status == QC_OK && A->n > 0) status = begin(ctx, s);
    if (status == QC_OK && !qc_ctx_progress(ctx, 1)) status = QC_ERR_CANCELLED;
    if (status == QC_OK)
        *out = s;
    else
        destroy(s);
    return status;
}

static qc_status factorize(qc_ctx *ctx, qc_solver_state *s, const qc_hermitian *A) {
    s->factorized = false;
    if (!qm_same_pattern(s, A))
        return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, -1,
                           "solver mumps: the matrix has not the pattern which was analysed");
    qc_status status = qm_check_diagonal(ctx, s, A);
    if (status != QC_OK || s->n == 0) {
        s->factorized = status == QC_OK;
        return status;
    }
    qm_write_values(A, s->a);
    status = run(ctx, s, JOB_FACTORIZE);
    if (status == QC_OK) status = qm_check_definite(ctx, s);
    if (status == QC_OK && !qc_ctx_progress(ctx, 1)) status = QC_ERR_CANCELLED;
    s->factorized = status == QC_OK;
    return status;
}

qc_status qm_solve(qc_ctx *ctx, qc_solver_state *s, int32_t nrhs, qc_complex *x) {
    const size_t bytes = (size_t)s->n * (size_t)nrhs * sizeof *x;
    if (bytes == 0) return QC_OK;
    mumps_double_complex *rhs = malloc(bytes);
    if (!rhs) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    memcpy(rhs, x, bytes);
    s->id.rhs = rhs;
    s->id.nrhs = nrhs;
    s->id.lrhs = s->n;
    const qc_status status = run(ctx, s, JOB_SOLVE);
    s->id.rhs = NULL;
    if (status == QC_OK) memcpy(x, rhs, bytes);
    free(rhs);
    return status;
}

static qc_status solve(qc_ctx *ctx, qc_solver_state *s, int32_t nrhs, qc_complex *x) {
    if (!s->factorized)
        return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, -1, "solver mumps: factorise before solving");
    if (nrhs < 0)
        return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, nrhs, "a negative number of right-hand sides");
    return qm_solve(ctx, s, nrhs, x);
}

static void info(const qc_solver_state *s, qc_solver_info *out) {
    const double million = 1e6, entries = s->id.infog[28]; /* INFOG(29), negative in millions */
    qc_solver_info i = QC_SOLVER_INFO_INIT;
    i.struct_size = out->struct_size;
    i.n = s->n;
    i.processes = qm_size();
    i.nnz = (int64_t)(2 * (entries < 0 ? -million * entries : entries));
    i.bytes = (int64_t)(million * s->id.infog[21]); /* INFOG(22), all processes */
    if (i.bytes < 8 * i.nnz) i.bytes = 8 * i.nnz;
    i.flops = 4 * s->id.rinfog[2]; /* RINFOG(3) counts complex operations */
    memcpy(out, &i, i.struct_size < sizeof i ? i.struct_size : sizeof i);
}

const qc_solver qm_solver = {
    .head = {sizeof(qc_solver), QC_SOLVER_COMPLEX | QC_SOLVER_DISTRIBUTED, "mumps",
             "complex LU by MUMPS, on all processes of an MPI run"},
    .analyze = analyze,
    .factorize = factorize,
    .solve = solve,
    .info = info,
    .destroy = destroy,
};
