/* The backend `mumps` against `builtin`, alone and with workers: the program is started as it is,
 * and by mpirun beside qc-mumps-worker. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <qc/qc.h>

typedef struct fixture {
    qc_ctx *ctx;
    qc_registry *registry;
    const qc_solver *mumps;
    bool cancel;
} fixture;

static bool on_progress(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    return !((const fixture *)user)->cancel;
}

static int setup(void **state) {
    fixture *f = calloc(1, sizeof *f);
    const qc_interface *found = NULL;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = on_progress;
    options.user = f;
    *state = f;
    if (qc_ctx_create(&options, &f->ctx) || qc_registry_create(f->ctx, &f->registry)) return 1;
    if (qc_registry_load(f->registry, QC_MUMPS) ||
        qc_registry_find_interface(f->registry, QC_SOLVER_ID, "mumps", &found)) {
        print_error("%s\n", qc_ctx_error(f->ctx)->text);
        return 1;
    }
    f->mumps = (const qc_solver *)found;
    return 0;
}

static int teardown(void **state) {
    fixture *f = *state;
    qc_registry_free(f->registry);
    qc_ctx_free(f->ctx);
    free(f);
    return 0;
}

/* The stiffness matrix of a plate with three holes and a smooth cross field. */
static qc_stiffness *real_shape(const fixture *f) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_pipeline *pipeline = NULL;
    qc_bag *bag = NULL;
    qc_mesh *mesh = NULL;
    qc_stiffness *stiffness = NULL;
    options.resolution = 4000;
    options.genus = 3;
    assert_int_equal(qc_shape_create(f->ctx, "genus", &options, &mesh), QC_OK);
    assert_int_equal(qc_pipeline_create(f->registry, &pipeline), QC_OK);
    assert_int_equal(qc_pipeline_insert(pipeline, 0, "field", "qc.field.smoothest"), QC_OK);
    assert_int_equal(qc_pipeline_insert(pipeline, 1, "matching", "qc.matching"), QC_OK);
    assert_int_equal(qc_bag_create(f->ctx, &bag), QC_OK);
    assert_int_equal(qc_bag_put(bag, "mesh", mesh), QC_OK);
    assert_int_equal(qc_pipeline_run(pipeline, bag), QC_OK);
    const qc_matching *matching = qc_bag_latest(bag, QC_TYPE_MATCHING);
    const qc_cover cover = {mesh, matching->m};
    double *cotangent = malloc(3 * (size_t)mesh->n_faces * sizeof *cotangent);
    assert_int_equal(qc_mesh_geometry(f->ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL),
                     QC_OK);
    assert_int_equal(qc_stiffness_edges(f->ctx, &cover, cotangent, &stiffness), QC_OK);
    assert_true(stiffness->A.n > 1000);
    free(cotangent);
    qc_bag_free(bag);
    qc_pipeline_free(pipeline);
    qc_object_release(mesh);
    return stiffness;
}

/* Relative difference of the solutions of nrhs systems. */
static double difference(const fixture *f, qc_solver_state *state, const qc_hermitian *A,
                         int32_t nrhs) {
    const size_t n = (size_t)A->n * (size_t)nrhs;
    qc_complex *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y);
    qc_symbolic *symbolic = NULL;
    qc_factor *factor = NULL;
    double largest = 0, distance = 0;
    for (size_t i = 0; i < n; i++)
        x[i] = y[i] = (qc_complex){sin(1.0 + (double)i), cos(2.0 * (double)i)};
    assert_int_equal(qc_analyze(f->ctx, A, NULL, &symbolic), QC_OK);
    assert_int_equal(qc_factorize(f->ctx, symbolic, A, &factor), QC_OK);
    assert_int_equal(qc_solve(f->ctx, factor, nrhs, x), QC_OK);
    assert_int_equal(f->mumps->solve(f->ctx, state, nrhs, y), QC_OK);
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, hypot(x[i].re, x[i].im));
        distance = fmax(distance, hypot(x[i].re - y[i].re, x[i].im - y[i].im));
    }
    qc_factor_free(factor);
    qc_symbolic_free(symbolic);
    free(x);
    free(y);
    return distance / largest;
}

static qc_solver_state *analyze(const fixture *f, const qc_hermitian *A) {
    qc_solver_state *state = NULL;
    const qc_status status = f->mumps->analyze(f->mumps, f->ctx, A, NULL, &state);
    if (status != QC_OK) print_error("%s\n", qc_ctx_error(f->ctx)->text);
    assert_int_equal(status, QC_OK);
    return state;
}

static void solutions_are_those_of_builtin(void **unused) {
    const fixture *f = *unused;
    qc_stiffness *stiffness = real_shape(f);
    const qc_hermitian *A = &stiffness->A;
    qc_complex *val = malloc((size_t)A->colptr[A->n] * sizeof *val);
    assert_int_equal(qc_solver_check(f->ctx, f->mumps), QC_OK);
    qc_solver_state *state = analyze(f, A);
    assert_int_equal(f->mumps->factorize(f->ctx, state, A), QC_OK);
    assert_true(difference(f, state, A, 1) <= 1e-10);
    assert_true(difference(f, state, A, 7) <= 1e-10);
    for (int32_t j = 0; j < A->n; j++) /* new values: S A S + diagonal */
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = A->row[p];
            const double scale = (1 + i % 5) * (1 + j % 5) * 0.1;
            val[p] = (qc_complex){scale * A->val[p].re + (i == j), scale * A->val[p].im};
        }
    const qc_hermitian B = {A->n, A->colptr, A->row, val};
    assert_int_equal(f->mumps->factorize(f->ctx, state, &B), QC_OK);
    assert_true(difference(f, state, &B, 3) <= 1e-10);
    f->mumps->destroy(state);
    free(val);
    qc_stiffness_free(stiffness);
}

/* Laplacian of a ring of n nodes whose edges turn by the n-th part of `turn`; `shift` is added to
 * the diagonal. The eigenvalues are 2 - 2 cos((turn + 2 pi k) / n) + shift. */
typedef struct ring {
    int64_t colptr[301];
    int32_t row[600];
    qc_complex val[600];
} ring;
static qc_hermitian make_ring(ring *r, int32_t n, double turn, double shift) {
    const qc_complex w = {-cos(turn / n), -sin(turn / n)};
    int64_t q = 0;
    for (int32_t j = 0; j < n; j++) {
        r->colptr[j] = q;
        if (j == n - 1) r->row[q] = 0, r->val[q++] = (qc_complex){w.re, -w.im};
        if (j > 0) r->row[q] = j - 1, r->val[q++] = w;
        r->row[q] = j;
        r->val[q++] = (qc_complex){2 + shift, 77}; /* the 77 has to be ignored */
    }
    r->colptr[n] = q;
    return (qc_hermitian){n, r->colptr, r->row, r->val};
}

static void singular_matrices_are_refused(void **unused) {
    const fixture *f = *unused;
    const double pi = 3.14159265358979323846;
    ring r;
    qc_complex x[300] = {{1, 0}};
    for (int32_t n = 3; n <= 300; n += 99) {
        qc_hermitian A = make_ring(&r, n, 1, 0);
        qc_solver_state *state = analyze(f, &A);
        assert_int_equal(f->mumps->solve(f->ctx, state, 1, x), QC_ERR_ARGUMENT);
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_OK);
        assert_true(difference(f, state, &A, 2) <= 1e-10);
        A = make_ring(&r, n, 0, 0); /* the constants are its kernel */
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_NOT_POSDEF);
        assert_non_null(strstr(qc_ctx_error(f->ctx)->text, "mumps"));
        assert_int_equal(f->mumps->solve(f->ctx, state, 1, x), QC_ERR_ARGUMENT);
        assert_true(x[0].re == 1);
        A = make_ring(&r, n, 2 * pi, 0); /* a turn by 2 pi is none */
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_NOT_POSDEF);
        A = make_ring(&r, n, 0, -0.5 / n); /* one negative eigenvalue */
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_NOT_POSDEF);
        A = make_ring(&r, n, 0, 0.5 / n);
        r.val[A.colptr[2] - 1].re = -1;
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_NOT_POSDEF);
        assert_int_equal(qc_ctx_error(f->ctx)->where, 1);
        A = make_ring(&r, n, 0, 0.5 / n);
        assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_OK);
        assert_true(difference(f, state, &A, 1) <= 1e-10);
        f->mumps->destroy(state);
    }
}

/* Two rings side by side, one singular: `where` is in that one. */
static void the_row_of_a_kernel_is_named(void **unused) {
    const fixture *f = *unused;
    ring r;
    qc_hermitian A = make_ring(&r, 200, 0, 0);
    for (int32_t j = 0; j < 100; j++) r.val[r.colptr[j + 1] - 1].re += 1;
    r.val[r.colptr[199]].re = 0; /* open both rings */
    r.val[r.colptr[100]].re = 0;
    r.val[r.colptr[101] - 1].re = r.val[r.colptr[200] - 1].re = 1;
    qc_solver_state *state = analyze(f, &A);
    assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_NOT_POSDEF);
    assert_in_range(qc_ctx_error(f->ctx)->where, 100, 199);
    f->mumps->destroy(state);
}

static void wrong_arguments_are_refused(void **unused) {
    const fixture *f = *unused;
    ring r, other;
    qc_hermitian A = make_ring(&r, 20, 1, 0);
    const qc_hermitian B = make_ring(&other, 21, 1, 0);
    qc_solver_options options = QC_SOLVER_OPTIONS_INIT;
    qc_solver_state *state = NULL;
    options.real = 1;
    assert_int_equal(f->mumps->analyze(f->mumps, f->ctx, &A, &options, &state), QC_ERR_UNSUPPORTED);
    r.row[A.colptr[6]] = 6; /* not ascending */
    assert_int_equal(f->mumps->analyze(f->mumps, f->ctx, &A, NULL, &state), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(f->ctx)->where, 6);
    assert_null(state);
    A = make_ring(&r, 20, 1, 0);
    state = analyze(f, &A);
    assert_int_equal(f->mumps->factorize(f->ctx, state, &B), QC_ERR_ARGUMENT);
    f->mumps->destroy(state);
    f->mumps->destroy(NULL);
}

static void many_states_and_none_at_all(void **unused) {
    const fixture *f = *unused;
    ring r[4];
    qc_hermitian A[4];
    qc_solver_state *state[4];
    const int64_t nothing = 0;
    const qc_hermitian empty = {0, &nothing, NULL, NULL};
    for (int round = 0; round < 2; round++) { /* numbers of states are used again */
        for (int i = 0; i < 4; i++) {
            A[i] = make_ring(&r[i], 50 + 10 * i, 1, 0.1);
            state[i] = analyze(f, &A[i]);
        }
        for (int i = 4; i-- > 0;)
            assert_int_equal(f->mumps->factorize(f->ctx, state[i], &A[i]), QC_OK);
        f->mumps->destroy(state[1]);
        state[1] = analyze(f, &A[1]);
        assert_int_equal(f->mumps->factorize(f->ctx, state[1], &A[1]), QC_OK);
        for (int i = 0; i < 4; i++) assert_true(difference(f, state[i], &A[i], 2) <= 1e-10);
        for (int i = 0; i < 4; i++) f->mumps->destroy(state[i]);
    }
    state[0] = analyze(f, &empty);
    assert_int_equal(f->mumps->factorize(f->ctx, state[0], &empty), QC_OK);
    assert_int_equal(f->mumps->solve(f->ctx, state[0], 3, NULL), QC_OK);
    f->mumps->destroy(state[0]);
}

static void info_tells_the_processes(void **unused) {
    const fixture *f = *unused;
    const char *expected = getenv("QC_MUMPS_PROCESSES");
    ring r;
    const qc_hermitian A = make_ring(&r, 300, 1, 0);
    qc_solver_info info = QC_SOLVER_INFO_INIT;
    qc_solver_state *state = analyze(f, &A);
    assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_OK);
    f->mumps->info(state, &info);
    assert_int_equal(info.n, 300);
    assert_int_equal(info.processes, expected ? atoi(expected) : 1);
    assert_true(info.nnz >= 4 * 300 && info.bytes > 0 && info.flops > 0);
    f->mumps->destroy(state);
}

static void a_call_can_be_cancelled(void **unused) {
    fixture *f = *unused;
    ring r;
    const qc_hermitian A = make_ring(&r, 30, 1, 0);
    qc_complex x[30] = {{1, 0}};
    qc_solver_state *state = analyze(f, &A);
    f->cancel = true;
    assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_ERR_CANCELLED);
    f->cancel = false;
    assert_int_equal(f->mumps->solve(f->ctx, state, 1, x), QC_ERR_ARGUMENT);
    assert_int_equal(f->mumps->factorize(f->ctx, state, &A), QC_OK);
    f->mumps->destroy(state);
}

/* MPI outlives the registry which started it. */
static void registries_may_come_and_go(void **unused) {
    ring r;
    const qc_hermitian A = make_ring(&r, 30, 1, 0);
    (void)unused;
    for (int i = 0; i < 3; i++) {
        void *state;
        assert_int_equal(setup(&state), 0);
        const fixture *f = state;
        qc_solver_state *s = analyze(f, &A);
        assert_int_equal(f->mumps->factorize(f->ctx, s, &A), QC_OK);
        f->mumps->destroy(s);
        teardown(&state);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(solutions_are_those_of_builtin, setup, teardown),
        cmocka_unit_test_setup_teardown(singular_matrices_are_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(the_row_of_a_kernel_is_named, setup, teardown),
        cmocka_unit_test_setup_teardown(wrong_arguments_are_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(many_states_and_none_at_all, setup, teardown),
        cmocka_unit_test_setup_teardown(info_tells_the_processes, setup, teardown),
        cmocka_unit_test_setup_teardown(a_call_can_be_cancelled, setup, teardown),
        cmocka_unit_test(registries_may_come_and_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
