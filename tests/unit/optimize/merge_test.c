/* Merging branch points (2007 paper, 4.2): the cost falls with every merge, the sum of the indices
 * stays, flips made before are found and undone. */
#include "unit/optimize/scratch.h"

static int32_t index_sum(const qc_matching *m) {
    int32_t sum = 0;
    for (int32_t p = 0; p < m->field->mesh->n_vertices; p++) sum += m->index4[p];
    return sum;
}

static double cost_of(const qc_matching *m, double lambda) {
    double cost = lambda * m->n_singular;
    for (int32_t e = 0; e < m->field->mesh->n_edges; e++) cost += fabs(m->theta[e]);
    return cost;
}

/* Directions of chance: branch points everywhere. */
static qc_matching *rough(qc_ctx *ctx, const qc_mesh *mesh) {
    qc_complex *x = random_crosses(mesh, 8);
    qc_matching *m = match(ctx, mesh, x);
    free(x);
    return m;
}

static void every_merge_lowers_the_cost(void **state) {
    qc_ctx *ctx = *state;
    for (int kind = 0; kind < 3; kind++) {
        qc_mesh *mesh = kind == 0   ? ellipsoid(ctx, 16, 12, 1, 1.2, 3)
                        : kind == 1 ? grid(ctx, TORUS, 16, 8, 1)
                                    : grid(ctx, CYLINDER, 14, 8, 1);
        qc_matching *start = rough(ctx, mesh);
        const double lambda = 2;
        double last = cost_of(start, lambda), cost[2];
        int32_t branch_points = start->n_singular;
        int merges = 0;
        for (bool more = true; more; merges++) {
            qc_matching *m = NULL;
            assert_int_equal(qc_matching_merge(ctx, start, lambda, merges, cost, &m), QC_OK);
            assert_true(fabs(cost[0] - cost_of(start, lambda)) < 1e-9 * cost[0]);
            assert_true(fabs(cost[1] - cost_of(m, lambda)) < 1e-9 * cost[0]);
            assert_int_equal(index_sum(m), index_sum(start));
            more = merges == 0 || m->n_singular < branch_points;
            if (merges > 0 && more) assert_true(cost[1] < last);
            if (!more) assert_true(cost[1] == last);
            branch_points = m->n_singular;
            last = cost[1];
            qc_object_release(m);
        }
        assert_true(merges > 10);
        assert_true(branch_points < start->n_singular / 2);
        qc_object_release(start);
        qc_object_release(mesh);
    }
}

/* A branch point may cost next to nothing: only what makes directions straighter is done. */
static void flips_are_undone(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 24, 20, 1, 1.2, 3);
    qc_matching *smooth = smooth_matching(ctx, mesh, false), *flipped = NULL, *merged = NULL;
    int8_t *m = malloc((size_t)mesh->n_edges);
    memcpy(m, smooth->m, (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e += 97) m[e] = (int8_t)(m[e] + (e % 2 ? 1 : -1));
    assert_int_equal(qc_matching_create(ctx, smooth->field, m, &flipped), QC_OK);
    assert_true(flipped->n_singular > smooth->n_singular + 10);
    assert_int_equal(qc_matching_merge(ctx, flipped, 1e-3, INT32_MAX, NULL, &merged), QC_OK);
    assert_memory_equal(merged->m, smooth->m, (size_t)mesh->n_edges);
    qc_object_release(merged);
    assert_int_equal(qc_matching_merge(ctx, flipped, 0, INT32_MAX, NULL, &merged), QC_OK);
    assert_memory_equal(merged->m, flipped->m, (size_t)mesh->n_edges);
    qc_object_release(merged);
    qc_object_release(flipped);
    qc_object_release(smooth);
    qc_object_release(mesh);
    free(m);
}

/* At any price: on a sphere what is left has one sign only, on a torus nothing is left; the crosses
 * are those of before. */
static void price_is_paid(void **state) {
    qc_ctx *ctx = *state;
    for (int kind = 0; kind < 2; kind++) {
        qc_mesh *mesh = kind ? grid(ctx, TORUS, 16, 8, 1) : ellipsoid(ctx, 16, 12, 1, 1.2, 3);
        qc_matching *start = rough(ctx, mesh), *m = NULL;
        assert_int_equal(qc_matching_merge(ctx, start, 1e4, INT32_MAX, NULL, &m), QC_OK);
        assert_ptr_equal(m->field, start->field);
        for (int32_t p = 0; p < mesh->n_vertices; p++) {
            assert_true(m->index4[p] >= 0);
            assert_true(m->index4[p] <= (start->index4[p] > 1 ? start->index4[p] : 1));
        }
        assert_int_equal(index_sum(m), kind ? 0 : 8);
        qc_object_release(m);
        qc_object_release(start);
        qc_object_release(mesh);
    }
}

static void scale_and_threads_do_not_matter(void **state) {
    (void)state;
    int8_t *m[3];
    size_t n = 0;
    for (int i = 0; i < 3; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i == 1 ? 4 : 1;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_mesh *mesh = grid(ctx, TORUS, 40, 16, i == 2 ? 1048576 : 1);
        qc_matching *start = rough(ctx, mesh), *merged = NULL;
        assert_int_equal(qc_matching_merge(ctx, start, 3, INT32_MAX, NULL, &merged), QC_OK);
        n = (size_t)mesh->n_edges;
        m[i] = malloc(n);
        memcpy(m[i], merged->m, n);
        qc_object_release(merged);
        qc_object_release(start);
        qc_object_release(mesh);
        qc_ctx_free(ctx);
    }
    assert_memory_equal(m[0], m[1], n);
    assert_memory_equal(m[0], m[2], n);
    for (int i = 0; i < 3; i++) free(m[i]);
}

static void bad_lambda_is_refused(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 6, 5, 1);
    qc_matching *start = rough(ctx, mesh), *m = NULL;
    assert_int_equal(qc_matching_merge(ctx, start, -1, 5, NULL, &m), QC_ERR_ARGUMENT);
    assert_int_equal(qc_matching_merge(ctx, start, (double)NAN, 5, NULL, &m), QC_ERR_ARGUMENT);
    assert_null(m);
    qc_object_release(start);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_merge_lowers_the_cost, set_up, tear_down),
        cmocka_unit_test_setup_teardown(flips_are_undone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(price_is_paid, set_up, tear_down),
        cmocka_unit_test(scale_and_threads_do_not_matter),
        cmocka_unit_test_setup_teardown(bad_lambda_is_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
