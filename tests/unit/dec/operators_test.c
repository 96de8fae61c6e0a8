/* Gradients have no curl, divergence and weak curl are adjoint to the gradients, J is an isometry
 * with J J = -1, and curls do not depend on the gauge. */
#include "unit/dec/forms.h"

static void gradients(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    double *cot = cotangents(ctx, m);
    qc_stiffness *L = NULL;
    assert_int_equal(qc_stiffness_vertices(ctx, cover, cot, NULL, &L), QC_OK);
    qc_complex *F = random_function(L, m->n_vertices), *z = NEW_ARRAY(qc_complex, n);
    qc_complex *curl = NEW_ARRAY(qc_complex, m->n_edges), *w = random_form(m);
    qc_complex *div = NEW_ARRAY(qc_complex, m->n_vertices), *r = NEW_ARRAY(qc_complex, m->n_edges);
    qc_complex *v = random_numbers(m->n_edges), *g = NEW_ARRAY(qc_complex, n);
    /* d d = 0, branch points included. */
    assert_int_equal(qc_form_gradient(ctx, cover, F, z), QC_OK);
    assert_int_equal(qc_form_curl_edges(ctx, cover, z, curl), QC_OK);
    assert_true(largest(m->n_edges, curl) < 1e-14);
    /* <grad F, W> = F^H div W. */
    assert_int_equal(qc_form_divergence(ctx, cover, cot, w, div), QC_OK);
    double _Complex left = number(qc_form_product(m, cot, z, w)), right = 0;
    for (int32_t i = 0; i < m->n_vertices; i++) right += conj(number(F[i])) * number(div[i]);
    assert_true(cabs(left - right) < 1e-12 * norm(m, cot, z) * norm(m, cot, w));
    /* <J grad v, W> = v^H r for v = 0 on the boundary; r = -curl. */
    for (int32_t e = 0; e < m->n_edges; e++)
        if (m->edge_halfedge[2 * e + 1] < 0) v[e] = (qc_complex){0, 0};
    assert_int_equal(qc_form_gradient_edges(ctx, cover, v, g), QC_OK);
    assert_int_equal(qc_form_rotate(ctx, m, cot, g, g), QC_OK);
    assert_int_equal(qc_form_weak_curl_edges(ctx, cover, w, r), QC_OK);
    assert_int_equal(qc_form_curl_edges(ctx, cover, w, curl), QC_OK);
    left = number(qc_form_product(m, cot, g, w)), right = 0;
    for (int32_t e = 0; e < m->n_edges; e++) {
        right += conj(number(v[e])) * number(r[e]);
        assert_true(r[e].re == -curl[e].re && r[e].im == -curl[e].im);
    }
    assert_true(cabs(left - right) < 1e-12 * norm(m, cot, g) * norm(m, cot, w));
    /* grad F is orthogonal to J grad v. */
    assert_true(cosine(m, cot, z, g, 1) < 1e-13);
    /* J is an isometry and J J = -1. */
    assert_int_equal(qc_form_rotate(ctx, m, cot, w, g), QC_OK);
    assert_true(fabs(norm(m, cot, g) / norm(m, cot, w) - 1) < 1e-13);
    assert_true(
        cabs(number(qc_form_product(m, cot, g, w)) + conj(number(qc_form_product(m, cot, g, w)))) <
        1e-12 * norm(m, cot, w) * norm(m, cot, w));
    assert_int_equal(qc_form_rotate(ctx, m, cot, g, g), QC_OK);
    for (int32_t h = 0; h < n; h++) assert_true(cabs(number(g[h]) + number(w[h])) < 1e-11);
    qc_stiffness_free(L);
    free(cot), free(F), free(z), free(curl), free(w), free(div), free(r), free(v), free(g);
}

/* curl* as it is written in the conventions. */
static void curl_definition(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    qc_complex *z = random_form(m), *curl = NEW_ARRAY(qc_complex, m->n_edges);
    assert_int_equal(qc_form_curl_edges(ctx, cover, z, curl), QC_OK);
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t hs = m->edge_halfedge[2 * e], ht = m->edge_halfedge[2 * e + 1];
        double _Complex expected = 0; /* i^m Z_t(e) - Z_s(e) with Z_t(e) = -z[ht] */
        if (ht >= 0)
            expected =
                cpow(I, cover->matching ? cover->matching[e] : 0) * -number(z[ht]) - number(z[hs]);
        assert_true(cabs(number(curl[e]) - expected) < 1e-13);
    }
    free(z), free(curl);
}

static void test_gradients(void **state) {
    (void)state, for_all_covers(gradients);
}
static void test_curl(void **state) {
    (void)state, for_all_covers(curl_definition);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gradients),
                                       cmocka_unit_test(test_curl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
