/* Splitting keeps the surface, the directions in space and the indices, and leaves no edge between
 * two cones; vertices with too few triangles get more. */
#include "surfaces.h"

static qc_sizing *sizing_of(qc_ctx *ctx, const qc_mesh *mesh) {
    double *length = malloc(sizeof *length * (size_t)mesh->n_faces);
    for (int32_t t = 0; t < mesh->n_faces; t++) length[t] = 1 + t;
    qc_sizing *out = NULL;
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.5, 100, length, &out), QC_OK);
    free(length);
    return out;
}

static qc_matching *match_weighted(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x) {
    double *weight = malloc(sizeof *weight * (size_t)mesh->n_faces);
    uint8_t *trusted = malloc((size_t)mesh->n_faces);
    qc_face_field *field = NULL;
    qc_matching *out = NULL;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        weight[t] = t;
        trusted[t] = (uint8_t)(t % 2);
    }
    assert_int_equal(qc_face_field_create(ctx, mesh, x, weight, trusted, &field), QC_OK);
    assert_int_equal(qc_matching_create(ctx, field, NULL, &out), QC_OK);
    qc_object_release(field);
    free(weight);
    free(trusted);
    return out;
}

static void direction(const double *real, const double *imaginary, qc_complex x, size_t t,
                      double out[3]) {
    for (size_t i = 0; i < 3; i++) out[i] = x.re * real[3 * t + i] + x.im * imaginary[3 * t + i];
}

/* Each child points in its parent's direction and has its numbers. */
static void check_children(qc_ctx *ctx, const qc_matching *old, const qc_sizing *old_sizing,
                           const qc_matching *new, const qc_sizing *sizing) {
    const qc_mesh *a = old->field->mesh, *b = new->field->mesh;
    double *frame = malloc(sizeof *frame * 6 * (size_t)(a->n_faces + b->n_faces));
    double *re = frame + 6 * (size_t)a->n_faces, *im = re + 3 * (size_t)b->n_faces;
    assert_int_equal(qc_tangent_frames(ctx, a, frame, frame + 3 * (size_t)a->n_faces), QC_OK);
    assert_int_equal(qc_tangent_frames(ctx, b, re, im), QC_OK);
    for (int32_t t = 0; t < b->n_faces; t++) {
        const int32_t s = b->source_face[t];
        double u[3], v[3];
        direction(frame, frame + 3 * (size_t)a->n_faces, old->field->x[s], (size_t)s, u);
        direction(re, im, new->field->x[t], (size_t)t, v);
        for (int i = 0; i < 3; i++) assert_true(fabs(u[i] - v[i]) < 1e-9);
        assert_true(new->field->weight[t] == old->field->weight[s]);
        assert_true(new->field->trusted[t] == old->field->trusted[s]);
        assert_true(sizing->length[t] == old_sizing->length[s]);
    }
    assert_true(sizing->edge_length == 0.5 && sizing->target_quads == 100);
    free(frame);
}

/* Edges inside an old face have no turn, halves of an edge have its angle. */
static void check_turns(const qc_matching *old, const qc_matching *new) {
    const qc_mesh *a = old->field->mesh, *b = new->field->mesh;
    int32_t inside = 0;
    for (int32_t e = 0; e < b->n_edges; e++) {
        if (b->edge_halfedge[2 * e + 1] < 0) continue;
        const int32_t s = b->source_face[b->edge_halfedge[2 * e] / 3];
        const int32_t t = b->source_face[b->edge_halfedge[2 * e + 1] / 3];
        if (s == t) {
            inside++;
            assert_true(new->m[e] == 0 && fabs(new->theta[e]) < 1e-9);
            continue;
        }
        assert_true(s < t);
        int32_t found = 0;
        for (int32_t k = 3 * s; k < 3 * s + 3; k++)
            found += a->twin[k] / 3 == t && a->twin[k] >= 0 &&
                     (new->m[e] - old->m[a->halfedge_edge[k]]) % 4 == 0 &&
                     fabs(new->theta[e] - old->theta[a->halfedge_edge[k]]) < 1e-9;
        assert_true(found > 0);
    }
    assert_true(inside > 0);
}

static void check(qc_ctx *ctx, qc_matching *old) {
    const qc_mesh *a = old->field->mesh;
    qc_sizing *old_sizing = sizing_of(ctx, a), *sizing = NULL;
    qc_matching *new = NULL;
    qc_mesh *b = NULL;
    assert_int_equal(qc_matching_split(ctx, old, old_sizing, &b, &sizing, &new), QC_OK);
    assert_ptr_equal(sizing->mesh, b);
    assert_ptr_equal(new->field->mesh, b);
    assert_true(b->n_vertices > a->n_vertices && b->euler == a->euler);
    assert_int_equal(b->n_boundary_loops, a->n_boundary_loops);
    assert_true(fabs(b->area / a->area - 1) < 1e-12);
    for (int32_t v = 0; v < b->n_vertices; v++) {
        assert_int_equal(new->index4[v], v < a->n_vertices ? old->index4[v] : 0);
        assert_int_equal(b->source_vertex[v], v < a->n_vertices ? v : -1);
    }
    assert_memory_equal(a->position, b->position, 3 * sizeof(double) * (size_t)a->n_vertices);
    assert_int_equal(new->index4_sum, old->index4_sum);
    assert_int_equal(new->n_singular, old->n_singular);
    int32_t *valence = calloc((size_t)b->n_vertices, sizeof *valence);
    for (int32_t c = 0; c < 3 * b->n_faces; c++) valence[b->face_vertex[c]]++;
    for (int32_t e = 0; e < b->n_edges; e++)
        assert_true(!new->index4[b->edge_vertex[2 * e]] || !new->index4[b->edge_vertex[2 * e + 1]]);
    for (int32_t v = 0; v < b->n_vertices; v++)
        assert_true(qc_vertex_on_boundary(b, v) || 2 * valence[v] > 4 - new->index4[v]);
    free(valence);
    check_children(ctx, old, old_sizing, new, sizing);
    check_turns(old, new);

    qc_mesh *same = NULL; /* once is enough */
    qc_sizing *same_sizing = NULL;
    qc_matching *same_matching = NULL;
    assert_int_equal(qc_matching_split(ctx, new, sizing, &same, &same_sizing, &same_matching),
                     QC_OK);
    assert_ptr_equal(same, b);
    assert_ptr_equal(same_sizing, sizing);
    assert_ptr_equal(same_matching, new);
    const void *made[] = {same, same_sizing, same_matching, b, sizing, new, old_sizing};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) qc_object_release(made[i]);
}

/* Random fields have cones everywhere: faces with one, two and three split edges. */
static void random_fields(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *meshes[] = {grid(ctx, TORUS, 24, 12, 1), ellipsoid(ctx, 16, 9, 1, 2, 3),
                         grid(ctx, CYLINDER, 12, 8, 1e-6), ellipsoid(ctx, 3, 3, 1, 1, 1)};
    for (size_t i = 0; i < 4; i++) {
        for (uint64_t seed = 0; seed < 5; seed++) {
            qc_complex *x = random_crosses(meshes[i], seed);
            qc_matching *m = match_weighted(ctx, meshes[i], x);
            check(ctx, m);
            qc_object_release(m);
            free(x);
        }
        qc_object_release(meshes[i]);
    }
}

/* On a flat mesh opposite representatives meet at turns of exactly pi, whose sign is rounding
 * noise. */
static void turns_of_pi(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 9, 7, 1);
    double *re = malloc(sizeof *re * 6 * (size_t)mesh->n_faces), *im = re + 3 * mesh->n_faces;
    qc_complex *x = malloc(sizeof *x * (size_t)mesh->n_faces);
    uint64_t seed = 3;
    assert_int_equal(qc_tangent_frames(ctx, mesh, re, im), QC_OK);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double angle = PI / 2 * floor(4 * uniform(&seed)) + (t % 5 == 0 ? 0.7 : 0.1);
        const double v[3] = {cos(angle), sin(angle), 0};
        x[t] = in_frame(re, im, (size_t)t, v);
    }
    qc_matching *straight = match_weighted(ctx, mesh, x), *turned = NULL;
    int8_t *m = malloc((size_t)mesh->n_edges);
    memcpy(m, straight->m, (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e += 7) m[e] = (int8_t)(m[e] + 1);
    assert_int_equal(qc_matching_create(ctx, straight->field, m, &turned), QC_OK);
    check(ctx, turned);
    qc_object_release(turned);
    qc_object_release(straight);
    qc_object_release(mesh);
    free(m);
    free(re);
    free(x);
}

/* A vertex of valence 3 with index -2/4 has 6 quarter turns: its link is split. */
static void small_stars_grow(void **state) {
    qc_ctx *ctx = *state;
    const double p[] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2};
    const int32_t t[] = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, 4, p, 3, t, &mesh), QC_OK);
    qc_complex *x = random_crosses(mesh, 1);
    qc_matching *straight = match_weighted(ctx, mesh, x), *m = NULL;
    int8_t turns[6];
    memcpy(turns, straight->m, (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t gain = straight->index4[0] + 2;
        if (mesh->edge_halfedge[2 * e + 1] < 0) continue;
        turns[e] = (int8_t)(turns[e] + (mesh->edge_vertex[2 * e] == 0 ? -gain : gain));
        break;
    }
    assert_int_equal(qc_matching_create(ctx, straight->field, turns, &m), QC_OK);
    assert_int_equal(m->index4[0], -2);
    check(ctx, m);
    qc_object_release(m);
    qc_object_release(straight);
    qc_object_release(mesh);
    free(x);
}

static void the_sizing_is_of_the_same_mesh(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, 8, 6, 1), *other = grid(ctx, TORUS, 8, 6, 1), *out = NULL;
    qc_complex *x = random_crosses(mesh, 5);
    qc_matching *m = match(ctx, mesh, x), *new = NULL;
    qc_sizing *sizing = sizing_of(ctx, other), *s = NULL;
    assert_int_equal(qc_matching_split(ctx, m, sizing, &out, &s, &new), QC_ERR_ARGUMENT);
    assert_true(!out && !s && !new);
    qc_object_release(sizing);
    qc_object_release(m);
    qc_object_release(mesh);
    qc_object_release(other);
    free(x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_fields),
        cmocka_unit_test(turns_of_pi),
        cmocka_unit_test(small_stars_grow),
        cmocka_unit_test(the_sizing_is_of_the_same_mesh),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
