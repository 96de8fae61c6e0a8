/* A program which runs under MPI itself: rank 0 solves on all processes, the others serve it,
 * twice; in between it solves alone. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <qc/qc.h>
#include "plugins/mumps/qc_mumps.h"

static int rank, size;
static const qc_mumps *mumps;

static void check(bool good, const char *what) {
    if (good) return;
    fprintf(stderr, "rank %d: FAILED: %s\n", rank, what);
    MPI_Abort(MPI_COMM_WORLD, 1);
}

/* tridiag(-i, 3, i): x = 1 for the row sums; returns the number of processes. */
static int solve(qc_ctx *ctx, const qc_solver *solver) {
    enum { N = 1000 };
    static int64_t colptr[N + 1];
    static int32_t row[2 * N];
    static qc_complex val[2 * N], x[N];
    int64_t q = 0;
    for (int32_t j = 0; j < N; j++) {
        colptr[j] = q;
        if (j > 0) row[q] = j - 1, val[q++] = (qc_complex){0, 1};
        row[q] = j;
        val[q++] = (qc_complex){3, 0};
        x[j] = (qc_complex){3, (j < N - 1) - (j > 0)};
    }
    colptr[N] = q;
    const qc_hermitian A = {N, colptr, row, val};
    qc_solver_state *state = NULL;
    qc_solver_info info = QC_SOLVER_INFO_INIT;
    check(solver->analyze(solver, ctx, &A, NULL, &state) == QC_OK, "analyze");
    check(solver->factorize(ctx, state, &A) == QC_OK, "factorize");
    check(solver->solve(ctx, state, 1, x) == QC_OK, "solve");
    for (int32_t j = 0; j < N; j++) {
        const double re = x[j].re - 1, im = x[j].im;
        check(re * re + im * im < 1e-24, "solution");
    }
    check(mumps->release(ctx) == QC_ERR_ARGUMENT, "release with a state");
    solver->info(state, &info);
    solver->destroy(state);
    return info.processes;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    const int comm = (int)MPI_Comm_c2f(MPI_COMM_WORLD);
    qc_ctx *ctx = NULL;
    qc_registry *registry = NULL;
    const qc_interface *found = NULL, *control = NULL;
    check(qc_ctx_create(NULL, &ctx) == QC_OK, "context");
    check(qc_registry_create(ctx, &registry) == QC_OK, "registry");
    check(qc_registry_load(registry, QC_MUMPS) == QC_OK, "load");
    check(qc_registry_find_interface(registry, QC_SOLVER_ID, "mumps", &found) == QC_OK, "solver");
    check(qc_registry_find_interface(registry, QC_MUMPS_ID, NULL, &control) == QC_OK, "control");
    const qc_solver *solver = (const qc_solver *)found;
    mumps = (const qc_mumps *)control;
    check(solve(ctx, solver) == 1, "each process alone");
    check(mumps->release(ctx) == QC_ERR_ARGUMENT, "release before use");
    for (int i = 0; i < 2; i++) {
        if (rank > 0) {
            check(mumps->use(ctx, comm) == QC_ERR_ARGUMENT, "use on a wrong rank");
            check(mumps->serve(ctx, comm) == QC_OK, "serve");
            continue;
        }
        check(mumps->serve(ctx, comm) == QC_ERR_ARGUMENT, "serve on rank 0");
        check(mumps->use(ctx, comm) == QC_OK, "use");
        check(mumps->use(ctx, comm) == QC_ERR_ARGUMENT, "use twice");
        check(solve(ctx, solver) == size, "on all processes");
        check(mumps->release(ctx) == QC_OK, "release");
        check(solve(ctx, solver) == 1, "alone again");
    }
    qc_registry_free(registry);
    qc_ctx_free(ctx);
    MPI_Finalize();
    return 0;
}
