/* Indices of any field sum to 4 chi; the matching does not depend on scale, threads or the choice
 * of x among the four directions of a cross. */
#include "surfaces.h"

static void random_fields_sum_to_four_chi(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *meshes[] = {grid(ctx, TORUS, 24, 12, 1), ellipsoid(ctx, 16, 9, 1, 2, 3),
                         ellipsoid(ctx, 3, 3, 1, 1, 1)};
    for (size_t i = 0; i < 3; i++) {
        for (uint64_t seed = 0; seed < 5; seed++) {
            qc_complex *x = random_crosses(meshes[i], seed);
            qc_matching *m = match(ctx, meshes[i], x);
            assert_int_equal(m->index4_sum, 4 * meshes[i]->euler);
            for (int32_t e = 0; e < meshes[i]->n_edges; e++) {
                assert_true(fabs(m->theta[e]) <= PI / 4 + 1e-12);
                assert_true(m->m[e] >= -2 && m->m[e] <= 2);
            }
            qc_object_release(m);
            free(x);
        }
        qc_object_release(meshes[i]);
    }
}

static void boundary_vertices_have_no_index(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, CYLINDER, 12, 8, 1);
    qc_complex *x = random_crosses(mesh, 1);
    qc_matching *m = match(ctx, mesh, x);
    int32_t sum = 0, singular = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (qc_vertex_on_boundary(mesh, v)) assert_int_equal(m->index4[v], 0);
        sum += m->index4[v];
        singular += m->index4[v] != 0;
    }
    assert_int_equal(sum, m->index4_sum);
    assert_int_equal(singular, m->n_singular);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (mesh->edge_halfedge[2 * e + 1] < 0) assert_true(m->m[e] == 0 && m->theta[e] == 0);
    qc_object_release(m);
    qc_object_release(mesh);
    free(x);
}

/* The boundary of a cylinder is a feature; the axis found turns the cross onto the halfedge. */
static void hard_features_have_an_axis(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, CYLINDER, 12, 8, 1);
    const size_t n_faces = (size_t)mesh->n_faces, n_edges = (size_t)mesh->n_edges;
    qc_complex *x = random_crosses(mesh, 3), *tangent = calloc(3 * n_faces, sizeof *tangent);
    double *weight = calloc(n_faces, sizeof *weight);
    uint8_t *trusted = calloc(n_faces, 1), *edge = calloc(n_edges, 1);
    for (int32_t e = 0; e < mesh->n_edges; e++) edge[e] = mesh->edge_halfedge[2 * e + 1] < 0;
    qc_face_field *field = NULL;
    qc_matching *m = NULL;
    assert_int_equal(qc_tangent_edges(ctx, mesh, tangent), QC_OK);
    assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
    assert_int_equal(qc_face_field_set_aligned(ctx, field, edge, 0), QC_ERR_ARGUMENT);
    assert_null(field->aligned);
    qc_object_release(field);
    assert_int_equal(qc_field_align(ctx, mesh, edge, 1, x, weight, trusted), QC_OK);
    assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
    assert_int_equal(qc_face_field_set_aligned(ctx, field, edge, 0), QC_OK);
    assert_int_equal(qc_matching_create(ctx, field, NULL, &m), QC_OK);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (!edge[e]) {
            assert_int_equal(m->axis[e], -1);
            continue;
        }
        const int32_t h = mesh->edge_halfedge[2 * e];
        const qc_complex along = qc_quarter_turn(x[h / 3], m->axis[e]);
        assert_true(along.re * tangent[h].re + along.im * tangent[h].im >
                    (1 - 1e-12) * hypot(tangent[h].re, tangent[h].im));
    }
    qc_object_release(m);
    qc_object_release(field);
    qc_object_release(mesh);
    free(x);
    free(tangent);
    free(weight);
    free(trusted);
    free(edge);
}

static void quarter_turns_change_the_matching_only_by_the_gauge(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 10, 7, 1);
    qc_complex *x = random_crosses(mesh, 2);
    qc_matching *before = match(ctx, mesh, x);
    for (int32_t t = 0; t < mesh->n_faces; t += 3) x[t] = (qc_complex){-x[t].im, x[t].re};
    qc_matching *after = match(ctx, mesh, x);
    assert_memory_equal(before->index4, after->index4, sizeof(int32_t) * (size_t)mesh->n_vertices);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t s = mesh->edge_halfedge[2 * e] / 3, t = mesh->edge_halfedge[2 * e + 1] / 3;
        int turn = after->m[e] - before->m[e] - (t % 3 == 0) + (s % 3 == 0);
        assert_int_equal(turn % 4, 0);
        assert_true(fabs(after->theta[e] - before->theta[e]) < 1e-12);
    }
    qc_object_release(before);
    qc_object_release(after);
    qc_object_release(mesh);
    free(x);
}

/* One more quarter turn at an edge takes pi/2 from theta. s lies left of the edge, so s -> t is
 * clockwise about its start, which gains a quarter, and counter-clockwise about its end, which
 * loses one. */
static void given_matchings_move_indices(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 10, 7, 1);
    qc_complex *x = random_crosses(mesh, 3);
    qc_matching *straight = match(ctx, mesh, x), *turned = NULL;
    int8_t *m = malloc((size_t)mesh->n_edges);
    memcpy(m, straight->m, (size_t)mesh->n_edges);
    m[17] = (int8_t)(m[17] + 1);
    assert_int_equal(qc_matching_create(ctx, straight->field, m, &turned), QC_OK);
    assert_int_equal(turned->index4_sum, 0);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int change = turned->index4[v] - straight->index4[v];
        bool start = v == mesh->edge_vertex[2 * 17], end = v == mesh->edge_vertex[2 * 17 + 1];
        assert_int_equal(change, start ? 1 : end ? -1 : 0);
    }
    qc_object_release(turned);
    qc_object_release(straight);
    qc_object_release(mesh);
    free(m);
    free(x);
}

static void scale_does_not_matter(void **state) {
    qc_ctx *ctx = *state;
    double scales[] = {1e-6, 1, 1e6};
    qc_matching *m[3];
    qc_mesh *mesh[3];
    for (int i = 0; i < 3; i++) {
        mesh[i] = grid(ctx, TORUS, 20, 9, scales[i]);
        qc_complex *x = random_crosses(mesh[i], 4);
        m[i] = match(ctx, mesh[i], x);
        free(x);
    }
    for (int i = 0; i < 3; i++) {
        assert_memory_equal(m[i]->m, m[1]->m, (size_t)mesh[1]->n_edges);
        assert_memory_equal(m[i]->index4, m[1]->index4,
                            sizeof(int32_t) * (size_t)mesh[1]->n_vertices);
    }
    for (int i = 0; i < 3; i++) {
        qc_object_release(m[i]);
        qc_object_release(mesh[i]);
    }
}

static void objects_check_their_numbers(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 3, 3, 1);
    qc_complex *x = random_crosses(mesh, 5);
    qc_face_field *field = NULL;
    qc_sizing *sizing = NULL;
    double weight[18] = {0};
    x[7] = (qc_complex){0, 0};
    assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 7);
    x[7] = (qc_complex){3, 4};
    weight[5] = -1;
    assert_int_equal(qc_face_field_create(ctx, mesh, x, weight, NULL, &field), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 5);
    assert_null(field);
    assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
    assert_true(fabs(field->x[7].re - 0.6) < 1e-15 && fabs(field->x[7].im - 0.8) < 1e-15);
    assert_int_equal(qc_sizing_create(ctx, mesh, 0, 10, NULL, &sizing), QC_ERR_ARGUMENT);
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.1, (double)NAN, NULL, &sizing), QC_ERR_ARGUMENT);
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.1, 0, weight, &sizing), QC_ERR_ARGUMENT);
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.1, 10, NULL, &sizing), QC_OK);
    qc_object_release(sizing);
    qc_object_release(field);
    qc_object_release(mesh);
    free(x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_fields_sum_to_four_chi),
        cmocka_unit_test(boundary_vertices_have_no_index),
        cmocka_unit_test(hard_features_have_an_axis),
        cmocka_unit_test(quarter_turns_change_the_matching_only_by_the_gauge),
        cmocka_unit_test(given_matchings_move_indices),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(objects_check_their_numbers),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
