/* The interface qc.solver/1: the built-in backend gives the bits of qc/sparse.h, states refuse what
 * they were not made for, tables are checked, refinement works with any backend. */
#include <qc/solver.h>
#include "support.h"

enum { N = 120, RHS = 3 };

static const qc_solver *builtin = &qc_solver_builtin;

static void fill(qc_complex *x) {
    for (int i = 0; i < N * RHS; i++) x[i] = (qc_complex){uniform(), uniform()};
}

static qc_solver_state *analyze(qc_ctx *ctx, const test_matrix *M, bool real) {
    qc_hermitian A = hermitian(M);
    qc_solver_options options = QC_SOLVER_OPTIONS_INIT;
    qc_solver_state *state = NULL;
    options.real = real;
    A.val = NULL; /* the pattern alone */
    assert_int_equal(builtin->analyze(builtin, ctx, &A, &options, &state), QC_OK);
    return state;
}

static void builtin_gives_the_bits_of_the_functions(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(RANDOM, N, 0.5);
    qc_hermitian A = hermitian(&M);
    qc_complex x[N * RHS], y[N * RHS];
    qc_solver_state *state = analyze(ctx, &M, false);
    for (int round = 0; round < 2; round++) { /* twice: with new values */
        assert_int_equal(builtin->factorize(ctx, state, &A), QC_OK);
        fill(x);
        memcpy(y, x, sizeof x);
        qc_factor *F = factor_of(ctx, &M, NULL);
        assert_int_equal(builtin->solve(ctx, state, RHS, x), QC_OK);
        assert_int_equal(qc_solve(ctx, F, RHS, y), QC_OK);
        assert_memory_equal(x, y, sizeof x);
        qc_factor_free(F);
        for (int32_t j = 0; j < N; j++) M.val[M.colptr[j + 1] - 1].re += 1 + j % 3;
    }
    builtin->destroy(state);
    builtin->destroy(NULL);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void builtin_solves_real_systems(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, N, 0.5);
    const qc_symmetric A = symmetric(&M);
    double x[N], y[N];
    for (int32_t i = 0; i < M.n; i++) x[i] = y[i] = uniform();
    qc_solver_state *state = analyze(ctx, &M, true);
    qc_factor *F = real_factor_of(ctx, &M, NULL);
    assert_int_equal(builtin->factorize_real(ctx, state, &A), QC_OK);
    assert_int_equal(builtin->solve_real(ctx, state, 1, x), QC_OK);
    assert_int_equal(qc_solve_real(ctx, F, 1, y), QC_OK);
    assert_memory_equal(x, y, (size_t)M.n * sizeof *x);
    qc_factor_free(F);
    builtin->destroy(state);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void an_update_equals_a_factorisation(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(PATH, N, 0.5);
    const qc_hermitian A = hermitian(&M);
    qc_complex x[N * RHS], y[N * RHS];
    const int32_t row = 17;
    const qc_complex w = {2, 0};
    fill(x);
    memcpy(y, x, sizeof x);
    qc_solver_state *state = analyze(ctx, &M, false);
    assert_int_equal(builtin->factorize(ctx, state, &A), QC_OK);
    assert_int_equal(builtin->updown(ctx, state, 1, 1, &row, &w), QC_OK);
    assert_int_equal(builtin->solve(ctx, state, RHS, x), QC_OK);
    M.val[M.colptr[row + 1] - 1].re += 4;
    assert_int_equal(builtin->factorize(ctx, state, &A), QC_OK);
    assert_int_equal(builtin->solve(ctx, state, RHS, y), QC_OK);
    for (int i = 0; i < N * RHS; i++)
        assert_true(hypot(x[i].re - y[i].re, x[i].im - y[i].im) < 1e-12);
    builtin->destroy(state);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void states_refuse_what_they_were_not_made_for(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, N, 0.5);
    qc_hermitian A = hermitian(&M);
    const qc_symmetric B = symmetric(&M);
    qc_complex x[N] = {{0, 0}};
    double y[N] = {0};
    qc_solver_state *state = analyze(ctx, &M, false);
    assert_int_equal(builtin->solve(ctx, state, 1, x), QC_ERR_ARGUMENT);
    assert_int_equal(builtin->factorize_real(ctx, state, &B), QC_ERR_ARGUMENT);
    assert_int_equal(builtin->solve_real(ctx, state, 1, y), QC_ERR_ARGUMENT);
    const double kept = M.val[M.colptr[8] - 1].re;
    M.val[M.colptr[8] - 1].re = -1;
    assert_int_equal(builtin->factorize(ctx, state, &A), QC_ERR_NOT_POSDEF);
    assert_int_equal(qc_ctx_error(ctx)->where, 7);
    assert_int_equal(builtin->solve(ctx, state, 1, x), QC_ERR_ARGUMENT);
    M.val[M.colptr[8] - 1].re = kept;
    assert_int_equal(builtin->factorize(ctx, state, &A), QC_OK);
    assert_int_equal(builtin->solve(ctx, state, 1, x), QC_OK);
    builtin->destroy(state);
    A.row = NULL;
    state = NULL;
    assert_int_equal(builtin->analyze(builtin, ctx, &A, NULL, &state), QC_ERR_ARGUMENT);
    assert_null(state);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void info_fills_what_the_caller_knows(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(GRID, N, 0.5);
    qc_solver_state *state = analyze(ctx, &M, false);
    qc_solver_info info = QC_SOLVER_INFO_INIT,
                   old = {offsetof(qc_solver_info, bytes), 0, 0, 0, -7, 0};
    builtin->info(state, &info);
    assert_int_equal(info.struct_size, sizeof info);
    assert_int_equal(info.n, M.n);
    assert_int_equal(info.processes, 1);
    assert_true(info.nnz >= 2 * M.n && info.bytes > 8 * info.nnz && info.flops > 0);
    builtin->info(state, &old);
    assert_int_equal(old.nnz, info.nnz);
    assert_int_equal(old.bytes, -7);
    builtin->destroy(state);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void tables_are_checked(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    qc_solver table = qc_solver_builtin;
    assert_int_equal(qc_solver_check(ctx, &table), QC_OK);
    table.head.struct_size = offsetof(qc_solver, factorize_real); /* all that is required */
    assert_int_equal(qc_solver_check(ctx, &table), QC_OK);
    table.head.struct_size--;
    assert_int_equal(qc_solver_check(ctx, &table), QC_ERR_ABI);
    table = qc_solver_builtin;
    table.info = NULL;
    assert_int_equal(qc_solver_check(ctx, &table), QC_ERR_ARGUMENT);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "'builtin'"));
    assert_int_equal(qc_solver_check(ctx, NULL), QC_ERR_ARGUMENT);
    qc_ctx_free(ctx);
}

/* A backend which is off by a part in a thousand. */
static qc_status sloppy_solve(qc_ctx *ctx, qc_solver_state *state, int32_t nrhs, qc_complex *x) {
    const qc_status status = builtin->solve(ctx, state, nrhs, x);
    for (int i = 0; i < N * nrhs && status == QC_OK; i++) x[i].re *= 1.001, x[i].im *= 1.001;
    return status;
}

static void refinement_needs_nothing_but_the_table(void **unused) {
    (void)unused;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(RANDOM, N, 0.5);
    const qc_hermitian A = hermitian(&M);
    qc_complex x[N * RHS], y[N * RHS];
    qc_solver sloppy = qc_solver_builtin;
    double before, after;
    sloppy.solve = sloppy_solve;
    fill(x);
    memcpy(y, x, sizeof x);
    qc_solver_state *state = analyze(ctx, &M, false);
    assert_int_equal(qc_solver_solve_refined(ctx, &sloppy, state, &A, 1, x, NULL), QC_ERR_ARGUMENT);
    assert_memory_equal(x, y, sizeof x);
    assert_int_equal(sloppy.factorize(ctx, state, &A), QC_OK);
    assert_int_equal(qc_solver_solve_refined(ctx, &sloppy, state, &A, 0, x, &before), QC_OK);
    memcpy(x, y, sizeof x);
    assert_int_equal(qc_solver_solve_refined(ctx, &sloppy, state, &A, 5, x, &after), QC_OK);
    assert_true(before > 1e-5 && after < 1e-15);
    memcpy(x, y, sizeof x);
    qc_factor *F = factor_of(ctx, &M, NULL);
    assert_int_equal(qc_solver_solve_refined(ctx, builtin, state, &A, 1, x, &after), QC_OK);
    assert_int_equal(qc_solve_refined(ctx, F, &A, 1, 1, y, &before), QC_OK);
    assert_memory_equal(x, y, N * sizeof *x);
    assert_true(before == after);
    qc_factor_free(F);
    builtin->destroy(state);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(builtin_gives_the_bits_of_the_functions),
        cmocka_unit_test(builtin_solves_real_systems),
        cmocka_unit_test(an_update_equals_a_factorisation),
        cmocka_unit_test(states_refuse_what_they_were_not_made_for),
        cmocka_unit_test(info_fills_what_the_caller_knows),
        cmocka_unit_test(tables_are_checked),
        cmocka_unit_test(refinement_needs_nothing_but_the_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
