/* Rays by the built-in tree against all triangles; picking; strokes from rays. */
#include <math.h>
#include <qc/ray.h>
#include <string.h>

#include "unit/mesh/fixtures.h"

static double unit(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24);
}

/* The first hit of a ray, by asking every triangle. */
static double first_hit(int n, const double *x, const double *ray, int32_t *triangle) {
    double best = INFINITY, t, weight[3];
    *triangle = -1;
    for (int i = 0; i < n; i++)
        if (qc_triangle_ray(x + 9 * i, ray, ray + 3, &t, weight) && t < best) {
            best = t;
            *triangle = i;
        }
    return best;
}

static void the_tree_finds_the_first_hit(void **state) {
    enum { TRIANGLES = 200, RAYS = 500 };
    qc_ctx *ctx = *state;
    double x[9 * TRIANGLES];
    int32_t vertex[3 * TRIANGLES], hits = 0;
    uint32_t seed = 7;
    for (int t = 0; t < TRIANGLES; t++)
        for (int i = 0; i < 9; i++)
            x[9 * t + i] = (i < 3 ? unit(&seed) : x[9 * t + i % 3] + 0.3 * unit(&seed));
    for (int32_t i = 0; i < 3 * TRIANGLES; i++) vertex[i] = i;
    qc_ray_scene *scene = NULL;
    const qc_ray_caster *casts = &qc_ray_caster_builtin;
    assert_int_equal(casts->build(casts, ctx, TRIANGLES, x, vertex, &scene), QC_OK);
    for (int i = 0; i < RAYS; i++) {
        double ray[6], weight[3];
        for (int k = 0; k < 6; k++) ray[k] = k < 3 ? 3 * unit(&seed) - 1 : unit(&seed) - ray[k - 3];
        if (i % 3 == 0) ray[3 + i / 3 % 3] = 0; /* parallel to a side of the boxes */
        int32_t expected, found;
        const double t = first_hit(TRIANGLES, x, ray, &expected);
        const double got = casts->query(scene, ray, ray + 3, &found, weight);
        assert_int_equal(found, expected);
        if (found < 0) {
            assert_true(isinf(got));
            continue;
        }
        hits++;
        assert_near(got, t, 0);
        for (int k = 0; k < 3; k++)
            assert_near(ray[k] + t * ray[3 + k],
                        weight[0] * x[9 * found + k] + weight[1] * x[9 * found + 3 + k] +
                            weight[2] * x[9 * found + 6 + k],
                        1e-12);
    }
    assert_true(hits > 100);
    const double zero[3] = {0, 0, 0}, no[3] = {NAN, 0, 1};
    int32_t found = 0;
    double weight[3];
    assert_true(isinf(casts->query(scene, zero, zero, &found, weight)));
    assert_int_equal(found, -1);
    assert_true(isinf(casts->query(scene, zero, no, &found, weight)));
    casts->destroy(scene);
}

/* Rays through edges and vertices of a closed surface hit it. */
static void there_are_no_gaps(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *torus = grid(ctx, 30, 20, 3, 1);
    qc_ray_scene *scene = NULL;
    const qc_ray_caster *casts = &qc_ray_caster_builtin;
    assert_int_equal(
        casts->build(casts, ctx, torus->n_faces, torus->position, torus->face_vertex, &scene),
        QC_OK);
    uint32_t seed = 3;
    for (int32_t e = 0; e < torus->n_edges; e++) {
        const double *p = torus->position + 3 * torus->edge_vertex[2 * e];
        const double *q = torus->position + 3 * torus->edge_vertex[2 * e + 1];
        const double s = e % 5 == 0 ? 0 : unit(&seed);
        /* Out of the middle of the tube: the ray leaves it at this point of an edge. */
        double ray[6], weight[3];
        int32_t found;
        const double r = hypot(p[0] + q[0], p[1] + q[1]);
        const double middle[3] = {2 * (p[0] + q[0]) / r, 2 * (p[1] + q[1]) / r, 0};
        for (int k = 0; k < 3; k++) {
            ray[k] = middle[k];
            ray[3 + k] = (1 - s) * p[k] + s * q[k] - middle[k];
        }
        assert_near(casts->query(scene, ray, ray + 3, &found, weight), 1, 1e-9);
    }
    casts->destroy(scene);
    qc_object_release(torus);
}

static void picking_finds_vertex_and_feature(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *square = grid(ctx, 10, 10, 0, 1);
    qc_features *features = NULL;
    assert_int_equal(qc_features_detect(ctx, square, 1, 0, NULL, &features), QC_OK);
    const double ray[] = {0.33, 0.12, 5, 0, 0, -2, 2, 2, 5, 0, 0, -1};
    qc_pick pick[2];
    assert_int_equal(qc_mesh_pick(ctx, square, features, NULL, NULL, 2, ray, pick), QC_OK);
    assert_near(pick[0].t, 2.5, 1e-12);
    assert_near(pick[0].point[0], 0.33, 1e-12);
    assert_near(pick[0].vertex_distance, hypot(0.03, 0.02), 1e-12);
    assert_near(square->position[3 * pick[0].vertex], 0.3, 1e-12);
    assert_near(square->position[3 * pick[0].vertex + 1], 0.1, 1e-12);
    assert_near(pick[0].feature_distance, 0.12, 1e-12);
    assert_true(features->edge[pick[0].feature_edge] & QC_FEATURE_BOUNDARY);
    assert_int_equal(pick[1].face, -1);
    assert_int_equal(qc_mesh_pick(ctx, square, NULL, NULL, NULL, 1, ray, pick), QC_OK);
    assert_int_equal(pick[0].feature_edge, -1);
    qc_mesh *other = grid(ctx, 2, 2, 0, 1);
    assert_int_equal(qc_mesh_pick(ctx, other, features, NULL, NULL, 1, ray, pick), QC_ERR_ARGUMENT);
    qc_object_release(features);
    qc_object_release(other);
    qc_object_release(square);
}

/* Two triangles one above the other, the upper one smaller. */
static qc_polygon_mesh *two_levels(qc_ctx *ctx) {
    const double x[] = {-9, -9, 0, 9, -9, 0, 0, 9, 0, -1, -1, 1, 1, -1, 1, 0, 2, 1};
    qc_polygon_mesh *m = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, 6, 2, 6, 0, 0, 0, &m), QC_OK);
    memcpy(m->position, x, sizeof x);
    for (int32_t i = 0; i < 6; i++) m->face_vertex[i] = i;
    for (int32_t i = 0; i < 3; i++) m->face_offset[i] = 3 * i;
    return m;
}

static void strokes_run_on_the_surface_and_break(void **state) {
    qc_ctx *ctx = *state;
    qc_polygon_mesh *m = two_levels(ctx), *strokes = NULL;
    /* Two rays: from left to right over both levels. */
    const double ray[] = {-3, 0, 5, 0, 0, -1, 3, 0, 5, 0, 0, -4};
    const int32_t offset[] = {0, 2};
    assert_int_equal(qc_ray_strokes(ctx, m, NULL, 1, offset, ray, 0.1, &strokes), QC_OK);
    double length = 0;
    for (int32_t i = 0; i < strokes->n_lines; i++) {
        const double *p = strokes->position + 3 * strokes->line[2 * i];
        const double *q = strokes->position + 3 * strokes->line[2 * i + 1];
        const double d = sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[2] - q[2]) * (p[2] - q[2]));
        assert_true(d <= 0.1);
        assert_near(p[2], q[2], 1e-12); /* no line from one level to the other */
        assert_near(p[2], fabs(p[0]) < 2.0 / 3 ? 1 : 0, 1e-6);
        length += d;
    }
    assert_near(length, 6, 1e-3); /* up to the last bisection at the two jumps */
    qc_object_release(strokes);

    const double away[] = {-3, 0, 5, 0, 0, 1, 3, 0, 5, 0, 0, 1};
    assert_int_equal(qc_ray_strokes(ctx, m, NULL, 1, offset, away, 0, &strokes), QC_ERR_INPUT);
    const double bad[] = {-3, 0, 5, 0, 0, -1, 3, 0, 5, 0, 0, 0};
    assert_int_equal(qc_ray_strokes(ctx, m, NULL, 1, offset, bad, 0, &strokes), QC_ERR_INPUT);
    assert_int_equal(qc_ctx_error(ctx)->where, 1);
    m->n_faces = 0;
    assert_int_equal(qc_ray_strokes(ctx, m, NULL, 1, offset, ray, 0, &strokes), QC_ERR_ARGUMENT);
    m->n_faces = 2;
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tree_finds_the_first_hit),
        cmocka_unit_test(there_are_no_gaps),
        cmocka_unit_test(picking_finds_vertex_and_feature),
        cmocka_unit_test(strokes_run_on_the_surface_and_break),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
