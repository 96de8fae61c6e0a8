/* Fill-reducing orders: valid for any pattern, the same for any number of threads, little fill. */
#include "sdk/sparse/order/internal.h"
#include "support.h"

static const int32_t methods[] = {QC_ORDER_AUTO, QC_ORDER_AMD, QC_ORDER_QUOTIENT,
                                  QC_ORDER_DISSECTION};
enum { METHODS = sizeof methods / sizeof *methods };

static qc_analyze_options with(int32_t ordering) {
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    options.ordering = ordering;
    return options;
}

static void check_permutation(const test_matrix *M, const int32_t *perm) {
    bool *seen = calloc((size_t)M->n + 1, sizeof *seen);
    for (int32_t k = 0; k < M->n; k++) {
        assert_true(perm[k] >= 0 && perm[k] < M->n && !seen[perm[k]]);
        seen[perm[k]] = true;
    }
    free(seen);
}

static qc__pattern pattern_of(const test_matrix *M) {
    return (qc__pattern){M->n, M->colptr, M->row};
}

static void every_pattern_gets_a_permutation(void **state) {
    (void)state;
    static const int32_t sizes[] = {0, 1, 2, 3, 17, 150, 700, 2000};
    qc_ctx *ctx = new_ctx(2);
    for (int shape = 0; shape < SHAPES; shape++)
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
            for (int m = 0; m < METHODS; m++) {
                test_matrix M = make_matrix(shape, sizes[i], 1);
                int32_t *perm = malloc(((size_t)M.n + 1) * sizeof *perm);
                const qc_analyze_options options = with(methods[m]);
                assert_int_equal(qc__order(ctx, pattern_of(&M), &options, perm), QC_OK);
                check_permutation(&M, perm);
                free(perm);
                free_matrix(&M);
            }
    qc_ctx_free(ctx);
}

/* Pattern of a triangulated torus of k x k squares: rows are its vertices or its edges, elements
 * its triangles. */
static test_matrix torus(int32_t k, bool edges) {
    const int32_t nv = k * k, faces = 2 * nv, n = edges ? 3 * nv : nv;
    int32_t(*face)[3] = malloc((size_t)faces * sizeof *face);
    for (int32_t v = 0; v < nv; v++) {
        const int32_t x = v % k, y = v / k, right = y * k + (x + 1) % k, up = (y + 1) % k * k + x,
                      across = (y + 1) % k * k + (x + 1) % k;
        const int32_t corner[2][3] = {{v, right, across}, {v, across, up}};
        /* edges 3 v: right, 3 v + 1: up, 3 v + 2: across */
        const int32_t side[2][3] = {{3 * v, 3 * right + 1, 3 * v + 2},
                                    {3 * v + 2, 3 * up, 3 * v + 1}};
        memcpy(face[2 * v], edges ? side : corner, sizeof corner);
    }
    int64_t *count = calloc((size_t)n + 1, sizeof *count);
    int32_t(*list)[16] = malloc((size_t)n * sizeof *list);
    for (int32_t t = 0; t < faces; t++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const int32_t i = face[t][a], j = face[t][b];
                bool known = i >= j;
                for (int64_t p = 0; p < count[j] && !known; p++) known = list[j][p] == i;
                if (!known) list[j][count[j]++] = i;
            }
    test_matrix M = {.n = n, .colptr = calloc((size_t)n + 1, 8), .row = malloc((size_t)n * 17 * 4)};
    for (int32_t j = 0; j < n; j++) {
        int64_t q = M.colptr[j];
        list[j][count[j]++] = j;
        for (int64_t p = 0; p < count[j]; p++) { /* insertion sort */
            int64_t to = q + p;
            for (; to > q && M.row[to - 1] > list[j][p]; to--) M.row[to] = M.row[to - 1];
            M.row[to] = list[j][p];
        }
        M.colptr[j + 1] = q + count[j];
    }
    free(count);
    free(list);
    free(face);
    return M;
}

static double flops_with(qc_ctx *ctx, const test_matrix *M, qc_analyze_options options,
                         int64_t *nnz) {
    const qc_hermitian A = hermitian(M);
    qc_symbolic *S = NULL;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_OK);
    const double flops = S->flops;
    *nnz = S->nnz_l;
    qc_symbolic_free(S);
    return flops;
}

static double flops_of(qc_ctx *ctx, const test_matrix *M, int32_t ordering, int64_t *nnz) {
    return flops_with(ctx, M, with(ordering), nnz);
}

static void dissection_needs_fewer_operations_on_meshes(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(2);
    for (int kind = 0; kind < 3; kind++) {
        test_matrix M = kind == 2 ? make_matrix(GRID, 4900, 1) : torus(70, kind == 1);
        int64_t nnz[2];
        const double amd = flops_of(ctx, &M, QC_ORDER_AMD, &nnz[0]),
                     dissection = flops_of(ctx, &M, QC_ORDER_DISSECTION, &nnz[1]);
        assert_true(dissection < 1.1 * amd);
        assert_true((double)nnz[1] < 1.1 * (double)nnz[0]);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

/* Pieces of at most 1000 of 30 000 rows are left to AMD: nearly as good as the whole dissection. */
static void dissection_may_stop_at_pieces(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(2);
    test_matrix M = torus(100, false);
    int64_t nnz[2];
    int32_t *perm = malloc((size_t)M.n * sizeof *perm);
    assert_int_equal(qc__order_dissection(ctx, pattern_of(&M), NULL, 1000, perm), QC_OK);
    qc_analyze_options given = with(QC_ORDER_GIVEN);
    given.permutation = perm;
    const double whole = flops_of(ctx, &M, QC_ORDER_DISSECTION, &nnz[0]),
                 pieces = flops_with(ctx, &M, given, &nnz[1]);
    assert_true(pieces != whole);
    assert_true(pieces < 1.4 * whole);
    assert_true((double)nnz[1] < 1.2 * (double)nnz[0]);
    free(perm);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

/* Random graphs have no small separators: the order must not be much worse than minimum degree. */
static void dissection_gives_way_without_separators(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = make_matrix(RANDOM, 2000, 1);
    int64_t nnz[2];
    const double amd = flops_of(ctx, &M, QC_ORDER_AMD, &nnz[0]),
                 dissection = flops_of(ctx, &M, QC_ORDER_DISSECTION, &nnz[1]);
    assert_true(dissection < 1.5 * amd);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void same_order_for_any_number_of_threads(void **state) {
    (void)state;
    test_matrix M = torus(100, true);
    int32_t *perm[2];
    for (int i = 0; i < 2; i++) {
        qc_ctx *ctx = new_ctx(i == 0 ? 1 : 4);
        const qc_analyze_options options = with(QC_ORDER_DISSECTION);
        perm[i] = malloc((size_t)M.n * sizeof *perm[i]);
        assert_int_equal(qc__order(ctx, pattern_of(&M), &options, perm[i]), QC_OK);
        qc_ctx_free(ctx);
    }
    check_permutation(&M, perm[0]);
    assert_memory_equal(perm[0], perm[1], (size_t)M.n * sizeof *perm[0]);
    free(perm[0]);
    free(perm[1]);
    free_matrix(&M);
}

/* Every edge of the graph lies in exactly one clique. */
static void cover_partitions_the_edges(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    for (int shape = 0; shape < SHAPES; shape++) {
        test_matrix M = make_matrix(shape, 60, 1);
        const int32_t n = M.n;
        int32_t *count = calloc((size_t)n * (size_t)n + 1, sizeof *count);
        qc__cover C;
        assert_int_equal(qc__cover_create(ctx, pattern_of(&M), &C), QC_OK);
        for (int32_t e = 0; e < C.m; e++)
            for (int32_t p = C.element[e].begin; p < C.element[e].active; p++)
                for (int32_t q = C.element[e].begin; q < C.element[e].active; q++)
                    count[C.entry[p] * n + C.entry[q]]++;
        for (int32_t j = 0; j < n; j++)
            for (int64_t p = M.colptr[j]; p < M.colptr[j + 1] - 1; p++) {
                assert_int_equal(count[M.row[p] * n + j], 1);
                count[M.row[p] * n + j] = count[j * n + M.row[p]] = 0;
            }
        for (int32_t i = 0; i < n * n; i++) assert_true(count[i] == 0 || i / n == i % n);
        free(count);
        qc__cover_free(&C);
        free_matrix(&M);
    }
    qc_ctx_free(ctx);
}

static bool count_down(void *user, const char *stage, double fraction) {
    int *left = user;
    (void)stage;
    assert_true(fraction >= 0 && fraction <= 1);
    return (*left)-- > 0;
}

static void cancel_at_every_report(void **state) {
    (void)state;
    test_matrix M = torus(100, true);
    int left = 0;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = count_down;
    options.user = &left;
    int32_t *perm = malloc((size_t)M.n * sizeof *perm);
    qc_status status = QC_ERR_CANCELLED;
    int reports = 0;
    for (; status != QC_OK; reports++) {
        qc_ctx *ctx = NULL;
        left = reports;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        const qc_analyze_options dissection = with(QC_ORDER_DISSECTION);
        status = qc__order(ctx, pattern_of(&M), &dissection, perm);
        if (status != QC_OK) assert_int_equal(status, QC_ERR_CANCELLED);
        qc_ctx_free(ctx);
    }
    assert_true(reports > 4);
    free(perm);
    free_matrix(&M);
}

static void *failing_resize(void *user, void *p, size_t old_size, size_t new_size) {
    int64_t *left = user;
    (void)old_size;
    if (new_size > 0 && (*left)-- == 0) return NULL;
    if (new_size > 0) return realloc(p, new_size);
    free(p);
    return NULL;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    test_matrix M[] = {torus(60, true), make_matrix(RANDOM, 900, 1)};
    for (size_t i = 0; i < sizeof M / sizeof *M; i++) {
        int32_t *perm = malloc((size_t)M[i].n * sizeof *perm);
        qc_status status = QC_ERR_NOMEM;
        for (int64_t allowed = 0; status != QC_OK; allowed++) {
            int64_t left = 1000;
            qc_ctx *ctx = NULL;
            qc_ctx_options host = QC_CTX_OPTIONS_INIT;
            host.resize = failing_resize;
            host.user = &left;
            host.threads = 1;
            assert_int_equal(qc_ctx_create(&host, &ctx), QC_OK);
            left = allowed;
            const qc_analyze_options options = with(QC_ORDER_DISSECTION);
            status = qc__order(ctx, pattern_of(&M[i]), &options, perm);
            if (status != QC_OK) assert_int_equal(status, QC_ERR_NOMEM);
            qc_ctx_free(ctx);
        }
        free(perm);
        free_matrix(&M[i]);
    }
}

/* Rows of the torus of k x k squares lie on the plane; place: unit of the coordinates. */
static double *positions(const test_matrix *M, int32_t k, double unit) {
    double *x = malloc(3 * (size_t)M->n * sizeof *x);
    for (int32_t e = 0; e < M->n; e++) {
        const int32_t v = e / 3, side = e % 3;
        x[3 * e] = (v % k + (side == 1 ? 0 : 0.5)) * unit;
        x[3 * e + 1] = (v / k + (side == 0 ? 0 : 0.5)) * unit;
        x[3 * e + 2] = 0.37 * x[3 * e] * x[3 * e + 1] / (k * unit);
    }
    return x;
}

static void unit_of_positions_does_not_matter(void **state) {
    (void)state;
    enum { K = 60 };
    qc_ctx *ctx = new_ctx(2);
    test_matrix M = torus(K, true);
    const double unit[] = {1, 1e-6, 1e6, 0};
    int32_t *perm[4];
    for (int i = 0; i < 4; i++) {
        double *x = positions(&M, K, unit[i] > 0 ? unit[i] : 1);
        qc_analyze_options options = with(QC_ORDER_DISSECTION);
        options.position = x;
        for (int32_t k = 0; k < 3 * M.n && unit[i] == 0; k++) x[k] = 7; /* all at one place */
        perm[i] = malloc((size_t)M.n * sizeof *perm[i]);
        assert_int_equal(qc__order(ctx, pattern_of(&M), &options, perm[i]), QC_OK);
        check_permutation(&M, perm[i]);
        if (i == 1 || i == 2) assert_memory_equal(perm[i], perm[0], (size_t)M.n * sizeof **perm);
        free(x);
    }
    for (int i = 0; i < 4; i++) free(perm[i]);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

static void groups_stay_together(void **state) {
    (void)state;
    static const int32_t ordering[] = {QC_ORDER_QUOTIENT, QC_ORDER_DISSECTION};
    qc_ctx *ctx = new_ctx(2);
    test_matrix M = torus(30, true);
    int32_t *group = malloc((size_t)M.n * sizeof *group),
            *perm = malloc((size_t)M.n * sizeof *perm);
    double *x = positions(&M, 30, 1);
    for (int32_t e = 0; e < M.n; e++)
        group[e] = (e / 3 - 450) * 1000003; /* negative ones as well */
    for (int k = 0; k < 2; k++) {
        qc_analyze_options options = with(ordering[k]);
        options.group = group;
        options.position = k == 1 ? x : NULL;
        assert_int_equal(qc__order(ctx, pattern_of(&M), &options, perm), QC_OK);
        check_permutation(&M, perm);
        for (int32_t i = 0; i < M.n; i += 3)
            assert_true(perm[i] / 3 == perm[i + 1] / 3 && perm[i] / 3 == perm[i + 2] / 3);
    }
    free(x);
    free(group);
    free(perm);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

/* Each row of a torus thrice: the three have the same neighbours. */
static void indistinguishable_rows_are_found(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix T = torus(20, false);
    const int32_t n = 3 * T.n;
    int64_t *colptr = malloc(((size_t)n + 1) * sizeof *colptr), q = 0;
    int32_t *row = malloc((size_t)T.colptr[T.n] * 9 * sizeof *row), count = 0;
    for (int32_t j = 0; j < n; j++) { /* row i of T becomes i, i + T.n, i + 2 T.n */
        colptr[j] = q;
        for (int32_t i = 0; i <= j; i++) {
            const int32_t a = i % T.n, b = j % T.n;
            bool present = false;
            const int32_t lo = a < b ? a : b, hi = a < b ? b : a;
            for (int64_t p = T.colptr[hi]; p < T.colptr[hi + 1]; p++) present |= T.row[p] == lo;
            if (present) row[q++] = i;
        }
    }
    colptr[n] = q;
    int32_t *group = malloc((size_t)n * sizeof *group), *perm = malloc((size_t)n * sizeof *perm);
    const qc__pattern A = {n, colptr, row};
    assert_int_equal(qc__find_groups(ctx, A, NULL, group, &count), QC_OK);
    assert_int_equal(count, T.n);
    for (int32_t i = 0; i < n; i++) assert_int_equal(group[i], i % T.n);
    const qc_analyze_options options = with(QC_ORDER_QUOTIENT);
    assert_int_equal(qc__order(ctx, A, &options, perm), QC_OK);
    for (int32_t i = 0; i < n; i += 3) assert_int_equal(perm[i] % T.n, perm[i + 2] % T.n);
    free(group);
    free(perm);
    free(colptr);
    free(row);
    free_matrix(&T);
    qc_ctx_free(ctx);
}

static void bad_hints_are_named(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = torus(4, true);
    const qc_hermitian A = hermitian(&M);
    qc_symbolic *S = NULL;
    double *x = positions(&M, 4, 1);
    qc_analyze_options options = with(QC_ORDER_DISSECTION);
    options.position = x;
    x[3 * 5 + 1] = NAN;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 5);
    options.ordering = QC_ORDER_AMD;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    options.position = NULL;
    options.group = M.row;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    options.group = NULL;
    options.ordering = 77;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_ERR_ARGUMENT);
    assert_null(S);
    free(x);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pattern_gets_a_permutation),
        cmocka_unit_test(cover_partitions_the_edges),
        cmocka_unit_test(dissection_needs_fewer_operations_on_meshes),
        cmocka_unit_test(dissection_may_stop_at_pieces),
        cmocka_unit_test(dissection_gives_way_without_separators),
        cmocka_unit_test(same_order_for_any_number_of_threads),
        cmocka_unit_test(cancel_at_every_report),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(unit_of_positions_does_not_matter),
        cmocka_unit_test(groups_stay_together),
        cmocka_unit_test(indistinguishable_rows_are_found),
        cmocka_unit_test(bad_hints_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
