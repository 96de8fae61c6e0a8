/* Planes of symmetry, and halves: found at any place and scale, cut exactly, refused where there is
 * nothing to cut. */
#include <qc/closest_point.h>

#include "sdk/mesh/plane.h"
#include "unit/mesh/fixtures.h"

/* The mesh turned by 1 radian about (1, 2, 3) / |.|, scaled, then moved. */
static qc_mesh *moved(qc_ctx *ctx, const qc_mesh *m, double scale, const double by[3]) {
    const double n = sqrt(14), k[3] = {1 / n, 2 / n, 3 / n}, c = cos(1), s = sin(1);
    double *p = malloc(3 * sizeof *p * (size_t)m->n_vertices);
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const double *x = m->position + 3 * v, d = qc__dot3(k, x);
        double across[3];
        qc__cross3(k, x, across);
        for (int i = 0; i < 3; i++)
            p[3 * v + i] = scale * (c * x[i] + s * across[i] + (1 - c) * d * k[i] + by[i]);
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, m->n_vertices, p, m->n_faces, m->face_vertex, &out),
                     QC_OK);
    free(p);
    return out;
}

/* An L of cubes, whose one plane of symmetry is x = y, in the grid; turned it is anywhere. */
static qc_mesh *bracket(qc_ctx *ctx) {
    return voxels(ctx, 3, 3, 1,
                  "###"
                  "#.."
                  "#..",
                  1);
}

static void planes_are_found_anywhere(void **state) {
    static const double scale[] = {1, 1e-6, 1e6}, by[3] = {3, -2, 0.5};
    qc_mesh *m = bracket(*state);
    for (int i = 0; i < 3; i++) {
        qc_mesh *t = moved(*state, m, scale[i], by);
        qc_plane plane;
        double off = 1, q[3], w[3];
        assert_int_equal(qc_mesh_find_symmetry(*state, t, -1, 1e-3, NULL, &plane, &off), QC_OK);
        assert_true(off < 1e-6);
        qc_closest_tree *tree = NULL;
        assert_int_equal(qc_closest_point_builtin.build(&qc_closest_point_builtin, *state,
                                                        t->n_faces, t->position, t->face_vertex,
                                                        &tree),
                         QC_OK);
        int32_t face = 0;
        for (int32_t v = 0; v < t->n_vertices; v++) {
            qc__mirror(&plane, t->position + 3 * v, q);
            assert_true(qc_closest_point_builtin.query(tree, q, &face, w) <= 2e-6 * t->diagonal);
        }
        qc_closest_point_builtin.destroy(tree);
        qc_object_release(t);
    }
    qc_object_release(m);
}

static void coordinate_planes_come_first(void **state) {
    qc_mesh *m = grid(*state, 24, 16, 3, 1);
    for (int axis = -1; axis < 3; axis++) {
        qc_plane plane;
        double off = 1;
        assert_int_equal(qc_mesh_find_symmetry(*state, m, axis, 0.01, NULL, &plane, &off), QC_OK);
        assert_true(off < 0.01);
        assert_int_equal(qc__plane_axis(&plane), axis < 0 ? 0 : axis);
        assert_true(plane.offset == 0);
    }
    qc_object_release(m);
}

/* Arms of lengths 3, 2 and 1 along the axes. */
static void asymmetry_is_seen(void **state) {
    qc_mesh *m = voxels(*state, 4, 3, 2,
                        "####"
                        "#..."
                        "#..."
                        "#..."
                        "...."
                        "....",
                        1);
    qc_plane plane = {{0, 0, 0}, 7};
    double off = 0;
    assert_int_equal(qc_mesh_find_symmetry(*state, m, -1, 0.01, NULL, &plane, &off), QC_OK);
    assert_true(isinf(off) && plane.offset == 7);
    assert_int_equal(qc_mesh_find_symmetry(*state, m, 0, INFINITY, NULL, &plane, &off), QC_OK);
    assert_true(off > 0.01 && off < 1 && plane.normal[0] == 1);
    assert_int_equal(qc_mesh_find_symmetry(*state, m, 3, 1, NULL, &plane, &off), QC_ERR_ARGUMENT);
    qc_object_release(m);
}

/* The part of a torus on one side: its boundary on the plane, its faces parts of those of the
 * torus, about half the area, the same at every scale. */
static void check_half(qc_ctx *ctx, const qc_mesh *m, const qc_plane *plane, double area) {
    qc_mesh *half = NULL;
    assert_int_equal(qc_mesh_half(ctx, m, plane, &half), QC_OK);
    assert_int_equal(half->euler, 0);
    assert_int_equal(half->n_boundary_loops, 2);
    assert_near(half->area, area * m->area, 0.02 * m->area);
    for (int32_t v = 0; v < half->n_vertices; v++) {
        const double d = qc__plane_distance(plane, half->position + 3 * v);
        if (qc_vertex_on_boundary(half, v))
            assert_near(d, 0, qc__plane_axis(plane) < 0 ? 1e-15 * m->diagonal : 0);
        else
            assert_true(d > 0);
    }
    for (int32_t t = 0; t < half->n_faces; t++) {
        const double third[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
        double x[3], w[3];
        qc__face_point(half, t, third, x);
        assert_true(half->source_face[t] >= 0 && half->source_face[t] < m->n_faces);
        assert_true(qc__face_coordinates(m, half->source_face[t], x, w));
        for (int k = 0; k < 3; k++) assert_true(w[k] > -0.06); /* vertices were moved */
    }
    qc_object_release(half);
}

static void halves_are_cut_exactly(void **state) {
    for (int i = 0; i < 3; i++) {
        static const double scale[] = {1, 1e-6, 1e6};
        qc_mesh *m = grid(*state, 31, 17, 3, scale[i]), *half[2] = {NULL, NULL};
        const qc_plane planes[] = {
            {{1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{0, 0, 1}, 0}, {{0.6, 0.8, 0}, 0}};
        for (int k = 0; k < 4; k++) check_half(*state, m, &planes[k], 0.5);
        const qc_plane beside = {{1, 0, 0}, -0.3 * scale[i]};
        check_half(*state, m, &beside, 0.55);
        qc_mesh *unit = grid(*state, 31, 17, 3, 1);
        const qc_plane of_unit = {{1, 0, 0}, -0.3};
        assert_int_equal(qc_mesh_half(*state, m, &beside, &half[0]), QC_OK);
        assert_int_equal(qc_mesh_half(*state, unit, &of_unit, &half[1]), QC_OK);
        assert_int_equal(half[0]->n_faces, half[1]->n_faces);
        assert_memory_equal(half[0]->face_vertex, half[1]->face_vertex,
                            3 * sizeof(int32_t) * (size_t)half[0]->n_faces);
        for (int k = 0; k < 2; k++) qc_object_release(half[k]);
        qc_object_release(unit);
        qc_object_release(m);
    }
}

/* A bent quad across the plane: three corners on it, the fourth beside, one triangle in it. */
static void faces_in_the_plane_are_on_neither_side(void **state) {
    static const double p[] = {0, 0, 0, 0, 1, 0.2, 0, 2, 0, 1, 1, -1, -1, 1, -1};
    static const int32_t f[] = {0, 1, 2, 0, 2, 3, 1, 0, 4, 2, 1, 4, 3, 4, 0, 4, 3, 2};
    qc_mesh *m = NULL, *half = NULL;
    assert_int_equal(qc_mesh_create(*state, 5, p, 6, f, &m), QC_OK);
    const qc_plane plane = {{1, 0, 0}, 0};
    assert_int_equal(qc_mesh_half(*state, m, &plane, &half), QC_OK);
    assert_int_equal(half->n_components, 1);
    assert_int_equal(half->n_boundary_loops, 1);
    assert_int_equal(half->euler, 1);
    qc_object_release(half);
    qc_object_release(m);
}

static void nothing_to_cut_is_an_error(void **state) {
    qc_mesh *m = grid(*state, 12, 8, 3, 1), *half = NULL;
    const qc_plane beside = {{1, 0, 0}, 5}, none = {{1, 1, 0}, 0};
    assert_int_equal(qc_mesh_half(*state, m, &beside, &half), QC_ERR_FAILED);
    assert_int_equal(qc_mesh_half(*state, m, &none, &half), QC_ERR_ARGUMENT);
    assert_null(half);
    qc_object_release(m);
}

/* Mirror images of mirror images. */
static void images_come_in_pairs(void **state) {
    (void)state;
    const qc_plane plane = {{0, 1, 0}, 0.1};
    uint32_t seed = 1;
    for (int i = 0; i < 10000; i++) {
        double p[3] = {1, 0, 2}, q[3], back[3];
        seed = seed * 1664525u + 1013904223u;
        const double before = p[1] = 20.0 * seed / 4294967296.0 - 7;
        qc__mirror_pair(&plane, p, q);
        qc__mirror(&plane, q, back);
        assert_memory_equal(back, p, sizeof p);
        assert_near(p[1], before, 1e-14);
        assert_near(q[1], 0.2 - before, 1e-14);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_are_found_anywhere),
        cmocka_unit_test(coordinate_planes_come_first),
        cmocka_unit_test(asymmetry_is_seen),
        cmocka_unit_test(halves_are_cut_exactly),
        cmocka_unit_test(faces_in_the_plane_are_on_neither_side),
        cmocka_unit_test(nothing_to_cut_is_an_error),
        cmocka_unit_test(images_come_in_pairs),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
