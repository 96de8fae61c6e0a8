/* Connectivity of triangle meshes: conventions, counts, errors. */
#include "unit/mesh/fixtures.h"
#include "sdk/mesh/names.h"

static void check_conventions(const qc_mesh *m) {
    int32_t boundary = 0;
    for (int32_t h = 0; h < 3 * m->n_faces; h++) {
        int32_t e = m->halfedge_edge[h], t = m->twin[h];
        boundary += t < 0;
        assert_true(m->edge_halfedge[2 * e] == h || m->edge_halfedge[2 * e + 1] == h);
        if (t < 0) continue;
        assert_int_equal(m->twin[t], h);
        assert_int_equal(m->halfedge_edge[t], e);
        assert_int_equal(qc_halfedge_start(m, h), qc_halfedge_end(m, t));
        assert_int_equal(qc_halfedge_end(m, h), qc_halfedge_start(m, t));
    }
    assert_int_equal(boundary, m->n_boundary_edges);
    for (int32_t e = 0; e < m->n_edges; e++) {
        int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        assert_true(k < 0 || h / 3 < k / 3);
        assert_int_equal(m->edge_vertex[2 * e], qc_halfedge_start(m, h));
        assert_int_equal(m->edge_vertex[2 * e + 1], qc_halfedge_end(m, h));
    }
    int32_t corners = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        int32_t c = m->vertex_corner[v];
        do {
            assert_int_equal(m->face_vertex[c], v);
            int32_t next = qc_corner_ccw(m, c);
            if (next >= 0) {
                assert_int_equal(qc_corner_cw(m, next), c);
                assert_int_equal(m->halfedge_edge[qc_next(c)], m->halfedge_edge[qc_prev(next)]);
            }
            c = next;
            corners++;
        } while (c >= 0 && c != m->vertex_corner[v]);
        assert_int_equal(c < 0, qc_vertex_on_boundary(m, v));
    }
    assert_int_equal(corners, 3 * m->n_faces);
    assert_int_equal(m->euler, m->n_vertices - m->n_edges + m->n_faces);
}

static void expect(qc_mesh *m, int genus, int loops, int components) {
    check_conventions(m);
    assert_int_equal(m->genus, genus);
    assert_int_equal(m->n_boundary_loops, loops);
    assert_int_equal(m->n_components, components);
    qc_object_release(m);
}

static void test_topology(void **state) {
    qc_ctx *ctx = *state;
    expect(grid(ctx, 3, 2, 0, 1), 0, 1, 1);
    expect(grid(ctx, 1, 1, 0, 1), 0, 1, 1);
    expect(grid(ctx, 5, 3, 1, 1), 0, 2, 1);
    expect(grid(ctx, 6, 5, 3, 1), 1, 0, 1);
    for (int holes = 0; holes < 4; holes++) expect(plate(ctx, holes, holes % 2), holes, 0, 1);
    expect(voxels(ctx, 3, 1, 1, "#.#", 0), 0, 0, 2);
}

static void test_extent(void **state) {
    qc_mesh *cube = voxels(*state, 2, 2, 2, "########", 1);
    assert_near(cube->area, 24, 1e-12);
    assert_near(cube->diagonal, sqrt(12), 1e-12);
    assert_true(cube->mean_edge_length > 0.7 && cube->mean_edge_length < 1.0);
    qc_object_release(cube);
}

static void test_boundary_loops(void **state) {
    qc_mesh *m = grid(*state, 5, 3, 1, 1);
    int32_t offset[3], vertex[10];
    assert_int_equal(m->n_boundary_edges, 10);
    assert_int_equal(qc_mesh_boundary_loops(*state, m, offset, vertex), QC_OK);
    assert_int_equal(offset[0], 0);
    assert_int_equal(offset[1], 5);
    assert_int_equal(offset[2], 10);
    for (int loop = 0; loop < 2; loop++) {
        for (int i = 0; i < 5;
             i++) { /* consecutive vertices: a halfedge with the face on its left */
            int32_t v = vertex[offset[loop] + i], w = vertex[offset[loop] + (i + 1) % 5];
            int32_t h = qc_prev(m->vertex_corner[v]);
            assert_int_equal(m->twin[h], -1);
            assert_int_equal(qc_halfedge_start(m, h), v);
            assert_int_equal(qc_halfedge_end(m, h), w);
        }
    }
    qc_object_release(m);
}

static void test_component(void **state) {
    qc_mesh *m = voxels(*state, 4, 1, 1, "##.#", 0), *part = NULL;
    assert_int_equal(m->n_components, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(qc_mesh_component(*state, m, i, &part), QC_OK);
        assert_int_equal(part->n_faces, i == 0 ? 20 : 12);
        assert_int_equal(part->euler, 2);
        for (int32_t f = 0; f < part->n_faces; f++) {
            assert_int_equal(m->face_component[part->source_face[f]], i);
            for (int k = 0; k < 3; k++)
                assert_int_equal(part->source_vertex[part->face_vertex[3 * f + k]],
                                 m->face_vertex[3 * part->source_face[f] + k]);
        }
        for (int32_t v = 0; v < 3 * part->n_vertices; v++)
            assert_true(part->position[v] == m->position[3 * part->source_vertex[v / 3] + v % 3]);
        qc_object_release(part);
    }
    assert_int_equal(qc_mesh_component(*state, m, 2, &part), QC_ERR_ARGUMENT);
    qc_object_release(m);
}

static void refuse(qc_ctx *ctx, int32_t nv, int32_t nf, const int32_t *f, qc_status status,
                   int64_t where) {
    double p[30] = {0};
    for (int i = 0; i < 30; i++) p[i] = (i * 7 % 11) + 0.1 * (i % 3);
    qc_mesh *untouched = (qc_mesh *)p, *out = untouched;
    assert_int_equal(qc_mesh_create(ctx, nv, p, nf, f, &out), status);
    assert_int_equal(qc_ctx_error(ctx)->status, status);
    assert_int_equal(qc_ctx_error(ctx)->where, where);
    assert_ptr_equal(out, untouched);
}

static void test_errors(void **state) {
    refuse(*state, 3, 0, (int32_t[]){0}, QC_ERR_ARGUMENT, -1);
    refuse(*state, 4, 2, (int32_t[]){0, 1, 2, 0, 2, 4}, QC_ERR_ARGUMENT, 1);
    refuse(*state, 4, 2, (int32_t[]){0, 1, -2, 0, 2, 3}, QC_ERR_ARGUMENT, 0);
    refuse(*state, 4, 2, (int32_t[]){0, 1, 2, 3, 2, 3}, QC_ERR_ARGUMENT, 1);
    refuse(*state, 5, 2, (int32_t[]){0, 1, 2, 0, 2, 4}, QC_ERR_ARGUMENT, 3);
    refuse(*state, 5, 3, (int32_t[]){0, 1, 2, 1, 0, 3, 0, 1, 4}, QC_ERR_NON_MANIFOLD, 2);
    refuse(*state, 4, 2, (int32_t[]){0, 1, 2, 0, 1, 3}, QC_ERR_NON_MANIFOLD, 1);
    refuse(*state, 5, 2, (int32_t[]){0, 1, 2, 0, 3, 4}, QC_ERR_NON_MANIFOLD, 0);
    /* two tetrahedra with vertex 0 in common: a vertex with two closed fans */
    refuse(*state, 7, 8,
           (int32_t[]){0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5},
           QC_ERR_NON_MANIFOLD, 0);
    double p[9] = {0, 0, 0, 1, 0, NAN, 0, 1, 0};
    qc_mesh *out;
    assert_int_equal(qc_mesh_create(*state, 3, p, 1, (int32_t[]){0, 1, 2}, &out), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 1);
}

/* Messages name what the input numbers, and the place of what it has not. */
static void test_names(void **state) {
    static const double position[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.5, 0.25, 2};
    static const int32_t face[] = {0, 1, 2, 0, 2, 3};
    static const int32_t source_vertex[] = {40, 7, 12, -1}, source_face[] = {9, 3};
    char text[QC__ELEMENT_NAME];
    qc_mesh *mesh = NULL, *plain = NULL;
    assert_int_equal(
        qc_mesh_create_from(*state, 4, position, 2, face, source_vertex, source_face, &mesh),
        QC_OK);
    assert_int_equal(qc_mesh_create(*state, 4, position, 2, face, &plain), QC_OK);
    assert_string_equal(qc__vertex_name(mesh, 0, text), "vertex 40");
    assert_string_equal(qc__vertex_name(mesh, 3, text), "the point (0.5, 0.25, 2)");
    assert_string_equal(qc__vertex_name(mesh, -1, text), "an unknown vertex");
    assert_string_equal(qc__vertex_name(plain, 3, text), "vertex 3");
    assert_int_equal(qc__face_number(mesh, 1), 3);
    assert_int_equal(qc__face_number(mesh, -1), -1);
    assert_int_equal(qc__face_number(plain, 1), 1);
    qc_object_release(mesh);
    qc_object_release(plain);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_topology),       cmocka_unit_test(test_extent),
        cmocka_unit_test(test_boundary_loops), cmocka_unit_test(test_component),
        cmocka_unit_test(test_errors),         cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
