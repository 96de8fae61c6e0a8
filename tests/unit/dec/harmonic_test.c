/* The harmonic basis: 2 g (+ b - 1) independent real fields without curl* and divergence, fixed by
 * the Hodge projection, with integer periods along closed paths. */
#include <lapacke.h>

#include "unit/dec/forms.h"

static int32_t gram_rank(const qc_mesh *m, const double *cot, int32_t n, const qc_complex *basis) {
    if (n == 0) return 0;
    double *G = NEW_ARRAY(double, n *n), *w = NEW_ARRAY(double, n);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++)
            G[i + j * n] = qc_form_product(m, cot, basis + 3 * (size_t)m->n_faces * (size_t)i,
                                           basis + 3 * (size_t)m->n_faces * (size_t)j)
                               .re;
    assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'U', n, G, n, w), 0);
    int32_t r = 0;
    for (int32_t i = 0; i < n; i++) r += w[i] > 1e-6 * w[n - 1];
    free(G), free(w);
    return r;
}

/* The jump of the integral of z across every edge of a cut which opens the surface is an integer
 * (the two ends agree since z has no curl). */
static void check_periods(qc_ctx *ctx, const qc_mesh *m, const qc_complex *z) {
    const qc_cover cover = {m, NULL};
    uint8_t *cut = NEW_ARRAY(uint8_t, m->n_edges);
    qc_complex *f = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    double residual = 1;
    bool moved = false;
    assert_int_equal(qc_mesh_cut_graph(ctx, m, NULL, NULL, cut), QC_OK);
    assert_int_equal(qc_form_integrate(ctx, &cover, cut, NULL, z, f, &residual), QC_OK);
    assert_true(residual < 1e-12);
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (!cut[e]) continue;
        const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        const double jump = f[qc_prev(k)].re - f[qc_next(h)].re;
        assert_true(fabs(jump - round(jump)) < 1e-11);
        moved = moved || round(jump) != 0;
    }
    assert_true(moved);
    free(cut), free(f);
}

static void basis(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    if (kind != PLAIN) return;
    const qc_mesh *m = cover->mesh;
    double *cot = cotangents(ctx, m);
    qc_complex *z = NULL, *p = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    qc_complex *c = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    int32_t n = -1;
    assert_int_equal(qc_hodge_harmonic_basis(ctx, m, &n, &z), QC_OK);
    assert_int_equal(n, 2 * s->genus + (s->boundaries ? s->boundaries - 1 : 0));
    assert_int_equal(gram_rank(m, cot, n, z), n);
    for (int32_t i = 0; i < n; i++) {
        const qc_complex *h = z + 3 * (size_t)m->n_faces * (size_t)i;
        const double size = norm(m, cot, h);
        for (int32_t k = 0; k < 3 * m->n_faces; k++) assert_true(h[k].im == 0);
        assert_int_equal(qc_hodge_decompose(ctx, cover, QC_HODGE_CONFORMING, h, p, c, NULL), QC_OK);
        assert_true(norm(m, cot, p) < 1e-12 * size && norm(m, cot, c) < 1e-12 * size);
        check_periods(ctx, m, h);
    }
    qc_cover_free_array(z);
    free(cot), free(p), free(c);
}

static void test_basis(void **state) {
    (void)state, for_all_covers(basis);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_basis)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
