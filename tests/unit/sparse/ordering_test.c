/* Fill-reducing orders: valid for any pattern, the same for any number of threads, little fill. */
#include "sdk/sparse/order/internal.h"
#include "support.h"

static const int32_t methods[] = {QC_ORDER_AUTO, QC_ORDER_AMD, QC_ORDER_DISSECTION};
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

static double flops_of(qc_ctx *ctx, const test_matrix *M, int32_t ordering, int64_t *nnz) {
    const qc_hermitian A = hermitian(M);
    const qc_analyze_options options = with(ordering);
    qc_symbolic *S = NULL;
    assert_int_equal(qc_analyze(ctx, &A, &options, &S), QC_OK);
    const double flops = S->flops;
    *nnz = S->nnz_l;
    qc_symbolic_free(S);
    return flops;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pattern_gets_a_permutation),
        cmocka_unit_test(cover_partitions_the_edges),
        cmocka_unit_test(dissection_needs_fewer_operations_on_meshes),
        cmocka_unit_test(dissection_gives_way_without_separators),
        cmocka_unit_test(same_order_for_any_number_of_threads),
        cmocka_unit_test(cancel_at_every_report),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
