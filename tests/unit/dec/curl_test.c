/* qc_hodge_remove_curl: no curl is left (1e-12), E_D is the energy of what was taken away, the rest
 * is orthogonal to it, and neither gauge nor the unit of length matters. */
#include "unit/dec/forms.h"

static void remove_curl(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    double *cot = cotangents(ctx, m), energy = -1, again = -1;
    qc_complex *z = random_form(m), *out = NEW_ARRAY(qc_complex, n),
               *diff = NEW_ARRAY(qc_complex, n);
    qc_complex *v = NEW_ARRAY(qc_complex, m->n_edges), *curl = NEW_ARRAY(qc_complex, m->n_edges);
    assert_int_equal(qc_hodge_remove_curl(ctx, cover, cot, NULL, z, out, v, &energy), QC_OK);
    assert_int_equal(qc_form_curl_edges(ctx, cover, out, curl), QC_OK);
    assert_true(largest(m->n_edges, curl) < 1e-12 * largest(n, z));
    for (int32_t h = 0; h < n; h++)
        diff[h] = (qc_complex){z[h].re - out[h].re, z[h].im - out[h].im};
    assert_true(fabs(0.5 * qc_form_product(m, cot, diff, diff).re - energy) < 1e-12 * energy);
    assert_true(cosine(m, cot, diff, out, norm(m, cot, z)) < 1e-12);
    /* The difference is J grad v. */
    assert_int_equal(qc_form_gradient_edges(ctx, cover, v, out), QC_OK);
    assert_int_equal(qc_form_rotate(ctx, m, cot, out, out), QC_OK);
    for (int32_t h = 0; h < n; h++)
        assert_true(cabs(number(out[h]) - number(diff[h])) < 1e-12 * largest(n, z));
    /* In place, with nothing else asked for; a second time nothing is found. */
    assert_int_equal(qc_hodge_remove_curl(ctx, cover, cot, NULL, z, z, NULL, NULL), QC_OK);
    assert_int_equal(qc_hodge_remove_curl(ctx, cover, cot, NULL, z, NULL, NULL, &again), QC_OK);
    assert_true(again < 1e-22 * energy);
    free(cot), free(z), free(out), free(diff), free(v), free(curl);
}

/* Turning the frame of every face changes neither the energy nor the size of the result. */
static void test_gauge(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[2], 1);
    double *cot = cotangents(ctx, m), energy[2];
    int8_t *matching = random_matching(m, SPARSE);
    int32_t *turn = NEW_ARRAY(int32_t, m->n_faces);
    qc_complex *z = random_form(m);
    const qc_cover cover = {m, matching};
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, NULL, NULL, &energy[0]),
                     QC_OK);
    for (int32_t t = 0; t < m->n_faces; t++) turn[t] = random_int(4);
    for (int32_t h = 0; h < 3 * m->n_faces; h++) z[h] = qc_quarter_turn(z[h], turn[h / 3]);
    for (int32_t e = 0; e < m->n_edges; e++)
        matching[e] = (int8_t)(matching[e] + turn[m->edge_halfedge[2 * e] / 3] -
                               turn[m->edge_halfedge[2 * e + 1] / 3]);
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, NULL, NULL, &energy[1]),
                     QC_OK);
    assert_true(fabs(energy[0] / energy[1] - 1) < 1e-12);
    free(cot), free(matching), free(turn), free(z);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

/* The unit of length does not matter. */
static void test_scale(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    double energy[3];
    for (int i = 0; i < 3; i++) {
        random_state = 5;
        qc_mesh *m = build_surface(ctx, &SURFACES[1], pow(10, 6 * (i - 1)));
        int8_t *matching = random_matching(m, DENSE);
        const qc_cover cover = {m, matching};
        double *cot = cotangents(ctx, m);
        qc_complex *z = random_form(m);
        assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, NULL, NULL, &energy[i]),
                         QC_OK);
        assert_true(fabs(energy[i] / energy[0] - 1) < 1e-11);
        free(cot), free(matching), free(z);
        qc_object_release(m);
    }
    qc_ctx_free(ctx);
}

/* Moves corner 0 of face 0 towards a point of the opposite edge: a cap of relative height d, and
 * makes the first edge of the last face a needle of relative length d. */
static qc_mesh *with_slivers(qc_ctx *ctx, const qc_mesh *m, double d) {
    double *p = NEW_ARRAY(double, 3 * m->n_vertices);
    memcpy(p, m->position, 3 * (size_t)m->n_vertices * sizeof(*p));
    const int32_t *a = m->face_vertex, *b = m->face_vertex + 3 * (m->n_faces - 1);
    for (int i = 0; i < 3; i++) {
        const double foot = 0.4 * p[3 * a[1] + i] + 0.6 * p[3 * a[2] + i];
        p[3 * a[0] + i] = (1 - d) * foot + d * p[3 * a[0] + i];
        p[3 * b[0] + i] = (1 - d) * p[3 * b[1] + i] + d * p[3 * b[0] + i];
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, m->n_vertices, p, m->n_faces, m->face_vertex, &out),
                     QC_OK);
    free(p);
    return out;
}

static void test_slivers(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    for (int i = 1; i <= 5; i++) {
        random_state = 7;
        qc_mesh *plain = build_surface(ctx, &SURFACES[2], 1);
        qc_mesh *m = with_slivers(ctx, plain, pow(10, -2 * i));
        int8_t *matching = random_matching(m, DENSE);
        const qc_cover cover = {m, matching};
        const int32_t n = 3 * m->n_faces;
        double *cot = cotangents(ctx, m);
        qc_complex *edge = NEW_ARRAY(qc_complex, n), *z = NEW_ARRAY(qc_complex, n);
        qc_complex *x = random_numbers(m->n_faces), *curl = NEW_ARRAY(qc_complex, m->n_edges);
        assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
        assert_int_equal(qc_form_from_cross(ctx, m, edge, x, NULL, z), QC_OK);
        const double size = largest(n, z);
        assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, z, NULL, NULL), QC_OK);
        assert_int_equal(qc_form_curl_edges(ctx, &cover, z, curl), QC_OK);
        assert_true(largest(m->n_edges, curl) < 1e-12 * size);
        free(matching), free(cot), free(edge), free(z), free(x), free(curl);
        qc_object_release(plain);
        qc_object_release(m);
    }
    qc_ctx_free(ctx);
}

static void test_remove_curl(void **state) {
    (void)state, for_all_covers(remove_curl);
}

/* The table given is the one which factorises and solves. */
static int solves;
static qc_status counted_solve(qc_ctx *ctx, qc_solver_state *state, int32_t nrhs, qc_complex *x) {
    solves++;
    return qc_solver_builtin.solve(ctx, state, nrhs, x);
}

static void test_solver(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[2], 1);
    double *cot = cotangents(ctx, m), energy[2];
    int8_t *matching = random_matching(m, SPARSE);
    qc_complex *z = random_form(m);
    const qc_cover cover = {m, matching};
    qc_solver mine = qc_solver_builtin;
    mine.solve = counted_solve;
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, NULL, NULL, &energy[0]),
                     QC_OK);
    assert_int_equal(solves, 0);
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, &mine, z, NULL, NULL, &energy[1]),
                     QC_OK);
    assert_true(solves >= 1 && energy[0] == energy[1]);
    mine.destroy = NULL;
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, &mine, z, z, NULL, NULL),
                     QC_ERR_ARGUMENT);
    free(cot), free(matching), free(z);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_remove_curl), cmocka_unit_test(test_solver),
        cmocka_unit_test(test_gauge), cmocka_unit_test(test_scale), cmocka_unit_test(test_slivers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
