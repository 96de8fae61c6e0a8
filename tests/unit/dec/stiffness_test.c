/* Both stiffness matrices: pattern, f^H A f = |grad f|^2, positive definite, L = 1/4 C^T L* C. */
#include <lapacke.h>

#include "unit/dec/forms.h"

static void check_pattern(const qc_hermitian *A) {
    for (int32_t j = 0; j < A->n; j++) {
        assert_true(A->colptr[j] < A->colptr[j + 1]);
        assert_int_equal(A->row[A->colptr[j + 1] - 1], j);
        assert_true(A->val[A->colptr[j + 1] - 1].im == 0);
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++)
            assert_true(A->row[p - 1] < A->row[p]);
    }
}

/* Re f^H A f and whether A f = B holds against the forms. */
static double quadratic(const qc_stiffness *s, int32_t n, const qc_complex *f) {
    double _Complex *D = dense(&s->A), sum = 0;
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++)
            if (s->unknown[i] >= 0 && s->unknown[j] >= 0)
                sum +=
                    conj(number(f[i])) * D[s->unknown[i] + s->unknown[j] * s->A.n] * number(f[j]);
    free(D);
    assert_true(fabs(cimag(sum)) < 1e-11 * (1 + fabs(creal(sum))));
    return creal(sum);
}

/* Ratio of the smallest and the largest pivot of a dense Cholesky factorisation. */
static double pivot_ratio(const qc_stiffness *s) {
    double _Complex *D = dense(&s->A);
    const int32_t n = s->A.n;
    double smallest = 1, greatest = 1;
    if (n > 0) assert_int_equal(LAPACKE_zpotrf(LAPACK_COL_MAJOR, 'U', n, D, n), 0);
    for (int32_t i = 0; i < n; i++) {
        const double pivot = pow(creal(D[i + i * n]), 2);
        smallest = i ? fmin(smallest, pivot) : pivot;
        greatest = i ? fmax(greatest, pivot) : pivot;
    }
    free(D);
    return smallest / greatest;
}

static void both(qc_ctx *ctx, const surface *surf, const qc_cover *cover, int kind) {
    const qc_mesh *m = cover->mesh;
    double *cot = cotangents(ctx, m);
    qc_complex *z = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    uint8_t *pinned = NEW_ARRAY(uint8_t, m->n_vertices);
    pinned[m->n_vertices / 2] = 1;
    for (int which = 0; which < 3; which++) {
        const int32_t n = which ? m->n_vertices : m->n_edges;
        qc_stiffness *s = NULL;
        assert_int_equal(which
                             ? qc_stiffness_vertices(ctx, cover, cot, which > 1 ? pinned : NULL, &s)
                             : qc_stiffness_edges(ctx, cover, cot, &s),
                         QC_OK);
        check_pattern(&s->A);
        qc_complex *f = random_function(s, n);
        assert_int_equal(which ? qc_form_gradient(ctx, cover, f, z)
                               : qc_form_gradient_edges(ctx, cover, f, z),
                         QC_OK);
        const double energy = qc_form_product(m, cot, z, z).re;
        assert_true(fabs(quadratic(s, n, f) - energy) < 1e-12 * energy);
        assert_true(pivot_ratio(s) > 1e-6);
        int32_t fixed = 0;
        for (int32_t i = 0; i < n; i++) fixed += s->unknown[i] < 0;
        if (which == 0 && (kind == PLAIN || kind == GAUGE))
            assert_int_equal(fixed, surf->boundaries ? m->n_boundary_edges : m->n_components);
        if (which == 1 && (kind == PLAIN || kind == GAUGE))
            assert_int_equal(fixed, m->n_components);
        if (which == 2) assert_int_equal(s->unknown[m->n_vertices / 2], -1);
        free(f);
        qc_stiffness_free(s);
    }
    free(cot), free(z), free(pinned);
}

/* On the plain closed mesh, with C the vertex-edge incidence: phi_p = 1/2 sum psi_e (1.4). The
 * fixed rows (edge 0, vertex 0) follow from the constants in the kernel. */
static void test_averaging(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[2], 1);
    const qc_cover cover = {m, NULL};
    double *cot = cotangents(ctx, m);
    qc_stiffness *L = NULL, *S = NULL;
    assert_int_equal(qc_stiffness_vertices(ctx, &cover, cot, NULL, &L), QC_OK);
    assert_int_equal(qc_stiffness_edges(ctx, &cover, cot, &S), QC_OK);
    double _Complex *A = dense(&L->A), *B = dense(&S->A);
    const int32_t n = S->A.n;
    for (int32_t p = 1; p < m->n_vertices; p++)
        for (int32_t q = 1; q < m->n_vertices; q++) {
            double _Complex sum = 0;
            /* Shifting C's columns by the value at edge 0 puts them into the space with v_0 = 0. */
            const bool p0 = m->edge_vertex[0] == p || m->edge_vertex[1] == p;
            const bool q0 = m->edge_vertex[0] == q || m->edge_vertex[1] == q;
            for (int32_t e = 1; e < m->n_edges; e++)
                for (int32_t f = 1; f < m->n_edges; f++) {
                    const bool a = m->edge_vertex[2 * e] == p || m->edge_vertex[2 * e + 1] == p;
                    const bool b = m->edge_vertex[2 * f] == q || m->edge_vertex[2 * f + 1] == q;
                    if (a == p0 || b == q0) continue;
                    sum += ((int)a - (int)p0) * ((int)b - (int)q0) *
                           B[S->unknown[e] + S->unknown[f] * n];
                }
            assert_true(cabs(A[L->unknown[p] + L->unknown[q] * L->A.n] - sum / 4) < 1e-12);
        }
    free(cot), free(A), free(B);
    qc_stiffness_free(L);
    qc_stiffness_free(S);
    qc_stiffness_free(NULL);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

static void test_both(void **state) {
    (void)state, for_all_covers(both);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_both),
                                       cmocka_unit_test(test_averaging)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
