/* qc_quads_relax: squares come out, nothing turns over, features and boundary are kept. */
#include "unit/finish/quads.h"

static qc_polygon_mesh *relax(qc_ctx *ctx, const qc_mesh *m, const qc_polygon_mesh *q,
                              const uint8_t *feature) {
    qc_relax_options options = QC_RELAX_OPTIONS_INIT;
    options.feature = feature;
    qc_polygon_mesh *out = NULL;
    assert_int_equal(qc_quads_relax(ctx, m, q, &options, &out), QC_OK);
    assert_int_equal(out->n_faces, q->n_faces);
    assert_memory_equal(out->face_vertex, q->face_vertex, (size_t)q->n_corners * 4);
    check_sources(m, out);
    return out;
}

static void quads_become_squares(void **state) {
    enum { N = 12 };
    qc_mesh *m = grid(*state, 9, 9, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, N, 0.3, -1, 1), *out = relax(*state, m, q, NULL);
    assert_true(skewness(out) < 0.2 * skewness(q));
    assert_true(least_jacobian(out) > 0.8);
    for (int i = 0; i <= N; i++)
        for (int j = 0; j <= N; j++) {
            const double *x = out->position + 3 * (i * (N + 1) + j);
            if (i % N == 0) assert_near(x[0], i / N, 1e-15);
            if (j % N == 0) assert_near(x[1], j / N, 1e-15);
            assert_near(x[2], 0, 1e-15);
        }
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(m);
}

/* Greatest deviation of the ratio of the two mean edges of a quad from that of all. */
static double uneven(const qc_polygon_mesh *q) {
    double mean = 0, most = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t f = 0; f < q->n_faces; f++) {
            double sum[2] = {0, 0};
            for (int k = 0; k < 4; k++) {
                const double *a = q->position + 3 * q->face_vertex[4 * f + k];
                const double *b = q->position + 3 * q->face_vertex[4 * f + (k + 1) % 4];
                sum[k & 1] += hypot(a[0] - b[0], a[1] - b[1]);
            }
            const double ratio = log(sum[0] / sum[1]);
            if (pass == 0)
                mean += ratio / q->n_faces;
            else
                most = fmax(most, fabs(ratio - mean));
        }
    return most;
}

/* Three times as long as wide: their corners are nearer to right angles than towards squares. */
static void proportions_are_kept(void **state) {
    enum { N = 12 };
    qc_mesh *m = grid(*state, 9, 9, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, N, 0.3, -1, 1), *squares = NULL, *rectangles = NULL;
    for (int32_t v = 0; v < m->n_vertices; v++) ((double *)(uintptr_t)m->position)[3 * v] *= 3;
    for (int32_t v = 0; v < q->n_vertices; v++) q->position[3 * v] *= 3;
    qc_relax_options options = QC_RELAX_OPTIONS_INIT;
    assert_int_equal(qc_quads_relax(*state, m, q, &options, &squares), QC_OK);
    options.rectangles = true;
    assert_int_equal(qc_quads_relax(*state, m, q, &options, &rectangles), QC_OK);
    check_sources(m, rectangles);
    assert_true(uneven(rectangles) < 0.1 * uneven(q));
    assert_true(skewness(rectangles) < 0.75 * skewness(squares));
    qc_object_release(squares);
    qc_object_release(rectangles);
    qc_object_release(q);
    qc_object_release(m);
}

/* One vertex far inside the next quad: the quads about it are turned over. */
static void turned_quads_are_repaired(void **state) {
    qc_mesh *m = grid(*state, 5, 5, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 6, 0.1, -1, 1);
    q->position[3 * (3 * 7 + 3)] += 0.3;
    assert_true(least_jacobian(q) < -0.5);
    qc_polygon_mesh *out = relax(*state, m, q, NULL);
    assert_true(least_jacobian(out) > 0.5);
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(m);
}

/* No quad gets worse than min(its own quality, the limit), whatever the limit. */
static void no_quad_gets_worse(void **state) {
    qc_mesh *m = grid(*state, 5, 5, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 10, 0.45, -1, 1), *out = NULL;
    qc_relax_options options = QC_RELAX_OPTIONS_INIT;
    for (options.quality = -1; options.quality <= 1; options.quality += 0.25) {
        assert_int_equal(qc_quads_relax(*state, m, q, &options, &out), QC_OK);
        assert_true(least_jacobian(out) >= fmin(least_jacobian(q), options.quality));
        qc_object_release(out);
    }
    qc_object_release(q);
    qc_object_release(m);
}

/* Quads of a flat grid whose area vector points down. */
static int facing_away(const qc_polygon_mesh *q) {
    int n = 0;
    for (int32_t f = 0; f < q->n_faces; f++) {
        double d[2][2];
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++)
                d[i][j] = q->position[3 * q->face_vertex[4 * f + i + 2] + j] -
                          q->position[3 * q->face_vertex[4 * f + i] + j];
        n += d[0][0] * d[1][1] - d[0][1] * d[1][0] < 0;
    }
    return n;
}

/* Measured against its own normal, a quad folded wholly over is better than a squeezed one. */
static void no_quad_comes_to_face_away(void **state) {
    qc_mesh *m = grid(*state, 5, 5, 0, 1);
    for (int i = 1; i <= 40; i++) {
        qc_polygon_mesh *q = quad_grid(*state, 8, 0.05 * i, -1, 1), *out = NULL;
        assert_int_equal(qc_quads_relax(*state, m, q, NULL, &out), QC_OK);
        assert_true(facing_away(out) <= facing_away(q));
        qc_object_release(out);
        qc_object_release(q);
    }
    qc_object_release(m);
}

/* So much moved that no vertex alone finds a place where its quads are right. */
static void tangled_quads_are_mended(void **state) {
    qc_mesh *m = grid(*state, 5, 5, 0, 1);
    for (int i = 19; i <= 25; i++) {
        qc_polygon_mesh *q = quad_grid(*state, 8, 0.05 * i, -1, 1);
        qc_polygon_mesh *out = relax(*state, m, q, NULL);
        assert_true(least_jacobian(q) < -0.9);
        assert_true(least_jacobian(out) > 0.15);
        assert_true(facing_away(out) <= facing_away(q));
        qc_object_release(out);
        qc_object_release(q);
    }
    qc_object_release(m);
}

/* A copy which says that the edges in column i of quad_grid() are on features. */
static qc_polygon_mesh *with_lines(qc_ctx *ctx, const qc_polygon_mesh *q, int n, int i) {
    qc_polygon_mesh *copy = NULL;
    assert_int_equal(
        qc_polygon_mesh_create(ctx, q->n_vertices, q->n_faces, q->n_corners, 0, n, 0, &copy),
        QC_OK);
    memcpy(copy->position, q->position, 3 * sizeof(double) * (size_t)q->n_vertices);
    memcpy(copy->face_offset, q->face_offset, sizeof(int32_t) * ((size_t)q->n_faces + 1));
    memcpy(copy->face_vertex, q->face_vertex, sizeof(int32_t) * (size_t)q->n_corners);
    for (int j = 0; j < n; j++) {
        copy->line[2 * j] = i * (n + 1) + j;
        copy->line[2 * j + 1] = i * (n + 1) + j + 1;
    }
    return copy;
}

static void features_are_kept(void **state) {
    enum { N = 8 };
    qc_mesh *flat = grid(*state, 10, 10, 0, 1), *m = NULL;
    qc_polygon_mesh *q = quad_grid(*state, N, 0.3, N / 2, 1);
    qc_features *features = NULL;
    double x[3 * 121];
    memcpy(x, flat->position, sizeof x);
    fold(121, x, 1);
    fold(q->n_vertices, q->position, 1);
    assert_int_equal(qc_mesh_create(*state, 121, x, flat->n_faces, flat->face_vertex, &m), QC_OK);
    assert_int_equal(qc_features_detect(*state, m, 0.5, 0, NULL, &features), QC_OK);
    assert_int_equal(features->n_creases, 10);
    qc_polygon_mesh *out = relax(*state, m, q, features->edge);
    double moved = 0;
    for (int j = 0; j <= N; j++) {
        const double *y = out->position + 3 * (N / 2 * (N + 1) + j);
        assert_near(y[0], 0.5, 1e-15);
        assert_near(y[2], 0, 1e-15);
        moved = fmax(moved, fabs(y[1] - q->position[3 * (N / 2 * (N + 1) + j) + 1]));
    }
    assert_true(moved > 0.01);
    assert_true(skewness(out) < 0.3 * skewness(q));
    qc_polygon_mesh *known = with_lines(*state, q, N, N / 2);
    qc_polygon_mesh *same = relax(*state, m, known, features->edge);
    assert_memory_equal(same->position, out->position, 3 * sizeof(double) * (size_t)q->n_vertices);
    assert_int_equal(same->n_lines, N);
    qc_object_release(same);
    qc_object_release(known);
    qc_object_release(out);
    qc_object_release(features);
    qc_object_release(q);
    qc_object_release(flat);
    qc_object_release(m);
}

static void scale_changes_nothing_else(void **state) {
    static const double scale[] = {1.0 / (1 << 20), 1 << 20};
    qc_mesh *m = grid(*state, 9, 7, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 9, 0.3, -1, 1), *out = relax(*state, m, q, NULL);
    for (int i = 0; i < 2; i++) {
        qc_mesh *m2 = grid(*state, 9, 7, 0, scale[i]);
        qc_polygon_mesh *q2 = quad_grid(*state, 9, 0.3, -1, scale[i]);
        qc_polygon_mesh *out2 = relax(*state, m2, q2, NULL);
        for (int32_t k = 0; k < 3 * q->n_vertices; k++)
            assert_near(out2->position[k], scale[i] * out->position[k], 1e-9 * scale[i]);
        qc_object_release(out2);
        qc_object_release(q2);
        qc_object_release(m2);
    }
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(m);
}

static void threads_change_nothing(void **state) {
    qc_mesh *m = grid(*state, 20, 20, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 40, 0.4, -1, 1), *first = NULL;
    for (uint32_t threads = 1; threads <= 7; threads += 3) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = threads;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_polygon_mesh *out = relax(ctx, m, q, NULL);
        if (first) {
            const size_t size = 3 * (size_t)q->n_vertices * sizeof(double);
            assert_memory_equal(out->position, first->position, size);
            assert_memory_equal(out->source_barycentric, first->source_barycentric, size);
            qc_object_release(out);
        } else {
            first = out;
        }
        qc_ctx_free(ctx);
    }
    qc_object_release(first);
    qc_object_release(q);
    qc_object_release(m);
}

static void bad_input_is_named(void **state) {
    qc_mesh *m = grid(*state, 3, 3, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 3, 0, -1, 1), *out = NULL;
    q->face_offset[4] = 15;
    assert_int_equal(qc_quads_relax(*state, m, q, NULL, &out), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 3);
    qc_object_release(q);
    assert_int_equal(qc_polygon_mesh_create(*state, 4, 1, 4, 0, 0, QC_POLYGON_SOURCE, &q), QC_OK);
    q->face_offset[1] = 4;
    for (int i = 0; i < 4; i++) q->face_vertex[i] = i;
    q->source_face[2] = 18;
    assert_int_equal(qc_quads_relax(*state, m, q, NULL, &out), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 2);
    assert_null(out);
    qc_object_release(q);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_become_squares),   cmocka_unit_test(turned_quads_are_repaired),
        cmocka_unit_test(no_quad_gets_worse),     cmocka_unit_test(no_quad_comes_to_face_away),
        cmocka_unit_test(features_are_kept),      cmocka_unit_test(scale_changes_nothing_else),
        cmocka_unit_test(threads_change_nothing), cmocka_unit_test(bad_input_is_named),
        cmocka_unit_test(proportions_are_kept),   cmocka_unit_test(tangled_quads_are_mended),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
