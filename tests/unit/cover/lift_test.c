/* Lifted paths run along the gluing of the covering; symmetric loops are their own reversal two
 * layers up (Kaelberer 2013, 4.2). */
#include "unit/cover/surfaces.h"

enum { STEPS = 40 };

static void random_path(const qc_mesh *m, int32_t *path) {
    path[0] = random_int(m->n_faces);
    for (int i = 1; i < STEPS; i++) {
        int32_t twin;
        do twin = m->twin[3 * path[i - 1] + random_int(3)];
        while (twin < 0);
        path[i] = twin / 3;
    }
}

static bool adjacent(const qc_mesh *q, int32_t a, int32_t b) {
    for (int32_t h = 3 * a; h < 3 * a + 3; h++)
        if (q->twin[h] >= 0 && q->twin[h] / 3 == b) return true;
    return false;
}

static void lifts(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    int32_t path[STEPS], faces[2 * STEPS];
    int8_t layers[2 * STEPS], lift[STEPS];
    qc_mesh *q = NULL;
    assert_int_equal(qc_cover_mesh(ctx, cover, &q, NULL), QC_OK);
    random_path(cover->mesh, path);
    for (int32_t l = 0; l < 4; l++) {
        assert_int_equal(qc_cover_lift(ctx, cover, STEPS, path, l, lift), QC_OK);
        assert_int_equal(qc_cover_symmetric_loop(ctx, cover, STEPS, path, l, faces, layers), QC_OK);
        assert_int_equal(lift[0], l);
        for (int i = 0; i + 1 < STEPS; i++)
            assert_true(adjacent(q, 4 * path[i] + lift[i], 4 * path[i + 1] + lift[i + 1]));
        assert_memory_equal(layers, lift, sizeof(lift));
        for (int i = 0; i < 2 * STEPS; i++) {
            assert_int_equal(faces[i], faces[2 * STEPS - 1 - i]);
            assert_int_equal(layers[i], (layers[2 * STEPS - 1 - i] + 2) & 3);
        }
    }
    qc_object_release(q);
}

static void test_lifts(void **state) {
    (void)state, for_all_covers(lifts);
}

static void test_errors(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[3], 1);
    const qc_cover cover = {m, NULL};
    int8_t layers[3] = {9, 9, 9};
    const int32_t neighbour = m->twin[0] / 3;
    const int32_t gap[3] = {0, neighbour, m->n_faces - 1}, outside[3] = {0, neighbour, m->n_faces};
    assert_int_equal(qc_cover_lift(ctx, &cover, 3, gap, 0, layers), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 1);
    assert_int_equal(qc_cover_lift(ctx, &cover, 3, outside, 0, layers), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 2);
    assert_int_equal(layers[0], 9);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lifts), cmocka_unit_test(test_errors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
