/* Polygon meshes: creation, union, combinatorial check. */
#include "unit/mesh/fixtures.h"
#include "sdk/mesh/internal.h"

static qc_polygon_mesh *polygons(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces, int32_t size,
                                 const int32_t *vertex) {
    qc_polygon_mesh *p = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, n_vertices, n_faces, size * n_faces, 0, 0, 0, &p),
                     QC_OK);
    for (int32_t f = 0; f <= n_faces; f++) p->face_offset[f] = size * f;
    memcpy(p->face_vertex, vertex, (size_t)(size * n_faces) * sizeof *vertex);
    return p;
}

static qc_polygon_topology topology(qc_ctx *ctx, qc_polygon_mesh *p) {
    qc_polygon_topology t;
    assert_int_equal(qc_polygon_mesh_topology(ctx, p, &t), QC_OK);
    qc_object_release(p);
    return t;
}

/* n x m quads, closed in the first (1) and second (2) direction. */
static qc_polygon_mesh *quads(qc_ctx *ctx, int n, int m, int wrap) {
    int nv = n + !(wrap & 1), mv = m + !(wrap & 2), f = 0;
    int32_t *q = malloc((size_t)(n * m) * 4 * sizeof *q);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++, f++) {
            int32_t i2 = (i + 1) % nv * mv, j2 = (j + 1) % mv;
            int32_t four[4] = {i * mv + j, i2 + j, i2 + j2, i * mv + j2};
            memcpy(q + 4 * f, four, sizeof four);
        }
    qc_polygon_mesh *p = polygons(ctx, nv * mv, n * m, 4, q);
    free(q);
    return p;
}

static void test_clean(void **state) {
    int expected[4][3] = {{1, 1, 0}, {0, 2, 0}, {0, 2, 0}, {0, 0, 0}}; /* euler, loops, irregular */
    for (int wrap = 0; wrap < 4; wrap++) {
        qc_polygon_topology t = topology(*state, quads(*state, 5, 4, wrap));
        assert_int_equal(t.euler, expected[wrap][0]);
        assert_int_equal(t.boundary_loops, expected[wrap][1]);
        assert_int_equal(t.irregular, expected[wrap][2]);
        assert_int_equal(t.components, 1);
        assert_int_equal(t.non_quads, 0);
        assert_int_equal(t.first_bad_element, -1);
    }
    int32_t cube[] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    qc_polygon_topology t = topology(*state, polygons(*state, 8, 6, 4, cube));
    assert_int_equal(t.euler, 2);
    assert_int_equal(t.irregular, 8);
    assert_int_equal(t.boundary_loops, 0);
    assert_int_equal(t.first_bad_element, -1);
}

static void test_defects(void **state) {
    qc_ctx *c = *state;
    qc_polygon_topology t;
    t = topology(c, polygons(c, 5, 3, 3, (int32_t[]){0, 1, 2, 1, 0, 3, 0, 1, 4}));
    assert_int_equal(t.non_manifold_edges, 1);
    assert_int_equal(t.non_manifold_vertices, 0);
    assert_int_equal(t.inconsistent_edges, 0);
    assert_int_equal(t.first_bad_element, 2);
    t = topology(c, polygons(c, 4, 2, 3, (int32_t[]){0, 1, 2, 0, 1, 3}));
    assert_int_equal(t.inconsistent_edges, 1);
    assert_int_equal(t.first_bad_element, 1);
    t = topology(c, polygons(c, 5, 2, 3, (int32_t[]){0, 1, 2, 0, 3, 4}));
    assert_int_equal(t.non_manifold_vertices, 1);
    assert_int_equal(t.boundary_loops, 2);
    assert_int_equal(t.components, 1);
    assert_int_equal(t.first_bad_element, 0);
    t = topology(c, polygons(c, 7, 2, 3, (int32_t[]){4, 1, 2, 2, 1, 4}));
    assert_int_equal(t.duplicate_faces, 1);
    assert_int_equal(t.unreferenced_vertices, 4);
    assert_int_equal(t.first_bad_element, 1);
    assert_int_equal(t.euler, 2);
    t = topology(c, polygons(c, 4, 2, 4, (int32_t[]){0, 1, 2, 1, 0, 2, 2, 3}));
    assert_int_equal(t.degenerate_faces, 2);
    t = topology(c, polygons(c, 6, 2, 3, (int32_t[]){0, 1, 2, 3, 4, 5}));
    assert_int_equal(t.components, 2);
    assert_int_equal(t.non_quads, 2);
    t = topology(c, polygons(c, 0, 0, 3, (int32_t[]){0}));
    assert_int_equal(t.euler, 0);
}

static void test_bad_arrays(void **state) {
    qc_polygon_topology t;
    qc_polygon_mesh *p = polygons(*state, 2, 1, 3, (int32_t[]){0, 1, 2});
    assert_int_equal(qc_polygon_mesh_topology(*state, p, &t), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 0);
    p->face_vertex[2] = 0;
    p->face_offset[0] = 1;
    assert_int_equal(qc_polygon_mesh_topology(*state, p, &t), QC_ERR_ARGUMENT);
    qc_object_release(p);
}

static void test_merge(void **state) {
    qc_polygon_mesh *a = quads(*state, 3, 3, 3), *b = NULL, *both = NULL;
    assert_int_equal(qc_polygon_mesh_create(*state, 3, 1, 3, 2, 1,
                                            QC_POLYGON_SOURCE | QC_POLYGON_FACE_GROUP, &b),
                     QC_OK);
    for (int i = 0; i < 3; i++) {
        b->face_vertex[i] = i;
        b->source_face[i] = i;
        b->corner_uv[i] = i - 1;
        b->position[3 * i] = i;
    }
    b->face_offset[1] = 3;
    b->face_group[0] = 4;
    b->line[1] = 2;
    b->uv[3] = 0.5;
    const qc_polygon_mesh *parts[] = {a, b, b};
    const int32_t *map[] = {NULL, NULL, (int32_t[]){7, 8, 9}};
    assert_int_equal(qc_polygon_mesh_merge(*state, 3, parts, map, &both), QC_OK);
    assert_int_equal(both->n_vertices, 15);
    assert_int_equal(both->n_faces, 11);
    assert_int_equal(both->n_corners, 42);
    assert_int_equal(both->n_uvs, 4);
    assert_int_equal(both->face_offset[11], 42);
    assert_int_equal(both->face_vertex[41], 14);
    assert_int_equal(both->corner_uv[0], -1);
    assert_int_equal(both->corner_uv[39], -1);
    assert_int_equal(both->corner_uv[40], 2);
    assert_int_equal(both->source_face[0], -1);
    assert_int_equal(both->source_face[10], 1);
    assert_int_equal(both->source_face[14], 9);
    assert_int_equal(both->line[3], 14);
    assert_int_equal(both->face_group[0], 0);
    assert_int_equal(both->face_group[10], 4);
    assert_true(both->uv[7] == 0.5 && both->position[3 * 14] == 2);
    qc_polygon_topology t = topology(*state, both);
    assert_int_equal(t.components, 3);
    assert_int_equal(t.euler, 2);
    assert_int_equal(qc_polygon_mesh_merge(*state, 0, NULL, NULL, &both), QC_OK);
    assert_int_equal(both->n_faces, 0);
    qc_object_release(both);
    qc_object_release(a);
    qc_object_release(b);
}

/* The same at any scale; nothing is worse than two neighbours in one place. */
static void test_scaled_jacobian(void **state) {
    (void)state;
    static const int32_t order[] = {0, 1, 2, 3};
    static const double scale[] = {1, 1e-60, 1e60};
    for (int i = 0; i < 3; i++) {
        const double s = scale[i];
        double x[12] = {0, 0, 0, s, 0, 0, s, s, 0, 0, s, 0};
        assert_float_equal(qc__scaled_jacobian(x, order, 4), 1, 1e-12);
        x[6] = x[7] = 0.25 * s; /* reflex there */
        const double reflex = qc__scaled_jacobian(x, order, 4);
        assert_true(reflex < 0 && reflex > -1);
        x[6] = s; /* where the corner before is */
        x[7] = 0;
        assert_true(qc__scaled_jacobian(x, order, 4) == -1);
        for (int k = 0; k < 12; k++) x[k] = s;
        assert_true(qc__scaled_jacobian(x, order, 4) == -1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clean),           cmocka_unit_test(test_defects),
        cmocka_unit_test(test_bad_arrays),      cmocka_unit_test(test_merge),
        cmocka_unit_test(test_scaled_jacobian),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
