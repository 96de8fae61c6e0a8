/* Rounding errors over long chains of modifications, and next to singular matrices. */
#include "triangles.h"

/* |A - L D L^H| / |A|, Frobenius norm */
static double backward_error(const qc_factor *F, const test_matrix *M) {
    cplx *A = dense_of(M, false), *B = reconstruct(F);
    double error = 0, norm = 0;
    for (int64_t i = 0; i < (int64_t)M->n * M->n; i++) {
        error += creal((A[i] - B[i]) * conj(A[i] - B[i]));
        norm += creal(A[i] * conj(A[i]));
    }
    free(A);
    free(B);
    return sqrt(error / norm);
}

static void many_flips(const char *instructions) {
    qc_ctx *ctx = new_ctx_with(1, instructions);
    if (!ctx) return;
    int32_t(*triangle)[3] = malloc(300 * sizeof *triangle), count;
    test_matrix M = triangles(120, 20, triangle, &count);
    qc_factor *F = factor_of(ctx, &M, NULL);
    for (int step = 1; step <= 10000; step++) {
        const flip f = random_flip(&M, triangle, count);
        assert_int_equal(apply_flip(ctx, F, f), QC_OK);
        add_flip(&M, f);
        if (step % 2000 == 0) assert_true(backward_error(F, &M) < 1e-14);
    }
    qc_factor_free(F);
    free_matrix(&M);
    free(triangle);
    qc_ctx_free(ctx);
}

static void ten_thousand_flips(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) many_flips(instruction_sets[i]);
}

/* Laplacian of a square grid on the flat torus plus a shift; constants are its kernel at 0. */
static test_matrix torus(int32_t side, double shift) {
    const int32_t n = side * side;
    int32_t(*edge)[2] = malloc(2 * (size_t)n * sizeof *edge);
    for (int32_t y = 0, e = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++) {
            edge[e][0] = y * side + x, edge[e++][1] = y * side + (x + 1) % side;
            edge[e][0] = y * side + x, edge[e++][1] = (y + 1) % side * side + x;
        }
    test_matrix M = from_edges(n, 2 * (int64_t)n, (const int32_t(*)[2])edge, 0);
    for (int32_t j = 0; j < n; j++)
        for (int64_t p = M.colptr[j]; p < M.colptr[j + 1]; p++)
            M.val[p] = (qc_complex){M.row[p] == j ? 4 + shift : -1, 0};
    free(edge);
    return M;
}

/* Condition 8e7: the error of A stays that of rounding, the error of D may be that times the
 * condition. */
static void update_and_downdate_near_singular(void **state) {
    (void)state;
    qc_ctx *ctx = new_ctx(1);
    test_matrix M = torus(12, 1e-7);
    qc_factor *F = factor_of(ctx, &M, NULL), *fresh = factor_of(ctx, &M, NULL);
    for (int step = 0; step < 300; step++) {
        int32_t row[2];
        while (!random_clique(&M, row)) continue;
        const qc_complex w[2] = {{uniform(), uniform()}, {uniform(), uniform()}};
        assert_int_equal(qc_updown(ctx, F, 1, 2, row, w), QC_OK);
        assert_int_equal(qc_updown(ctx, F, -1, 2, row, w), QC_OK);
    }
    assert_true(backward_error(F, &M) < 1e-14);
    for (int32_t k = 0; k < M.n; k++)
        assert_true(fabs(F->D[k] - fresh->D[k]) < 1e-13 * 8e7 * fresh->D[k]);
    qc_factor_free(F);
    qc_factor_free(fresh);
    free_matrix(&M);
    qc_ctx_free(ctx);
}

/* One edge turned by i makes two adjacent branch points: definite. Turning it back is refused, from
 * wherever it is tried; other flips go on. */
static void last_branch_points_stay(void **state) {
    (void)state;
    for (int set = 0; set < 3; set++) {
        qc_ctx *ctx = new_ctx_with(1, instruction_sets[set]);
        if (!ctx) continue;
        for (int trial = 0; trial < 12; trial++) {
            test_matrix M = torus(9, 0);
            int32_t row[2], other[2];
            while (!random_clique(&M, row)) continue;
            while (!random_clique(&M, other) || (other[0] == row[0] && other[1] == row[1]))
                continue;
            const qc_complex none = {0, 0}, there = {1, -1}, back = {-1, 1};
            add(&M, row[0], row[1], there); /* -1 becomes -i */
            qc_factor *F = factor_of(ctx, &M, NULL);
            const uint64_t before = fingerprint(F);
            assert_int_equal(qc_flip(ctx, F, row[0], row[1], back, row[1], none),
                             QC_ERR_NOT_POSDEF);
            assert_true(before == fingerprint(F));
            assert_int_equal(qc_flip(ctx, F, other[0], other[1], there, other[1], none), QC_OK);
            assert_int_equal(qc_flip(ctx, F, row[0], row[1], back, row[1], none), QC_OK);
            const uint64_t moved = fingerprint(F);
            assert_int_equal(qc_flip(ctx, F, other[0], other[1], back, other[1], none),
                             QC_ERR_NOT_POSDEF);
            assert_true(moved == fingerprint(F));
            add(&M, other[0], other[1], there);
            add(&M, row[0], row[1], back);
            assert_true(backward_error(F, &M) < 1e-14);
            qc_factor_free(F);
            free_matrix(&M);
        }
        qc_ctx_free(ctx);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_flips),
        cmocka_unit_test(update_and_downdate_near_singular),
        cmocka_unit_test(last_branch_points_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
