/* Edge vectors, frames and transport against the embedding and the angle defect. */
#include "unit/dec/forms.h"

static double dot3(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void frames(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s;
    if (kind != PLAIN) return;
    const qc_mesh *m = cover->mesh;
    qc_complex *edge = NEW_ARRAY(qc_complex, 3 * m->n_faces),
               *rho = NEW_ARRAY(qc_complex, m->n_edges);
    double *x = NEW_ARRAY(double, 3 * m->n_faces), *y = NEW_ARRAY(double, 3 * m->n_faces);
    double *normal = NEW_ARRAY(double, 3 * m->n_faces), *gauss = NEW_ARRAY(double, m->n_vertices);
    assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
    assert_int_equal(qc_tangent_frames(ctx, m, x, y), QC_OK);
    assert_int_equal(qc_tangent_transport(ctx, m, edge, rho), QC_OK);
    assert_int_equal(qc_mesh_geometry(ctx, m, NULL, NULL, NULL, NULL, normal, gauss), QC_OK);
    for (int32_t t = 0; t < m->n_faces; t++) {
        const double *a = x + 3 * t, *b = y + 3 * t, *n = normal + 3 * t;
        assert_true(fabs(dot3(a, a) - 1) < 1e-14 && fabs(dot3(b, b) - 1) < 1e-14);
        assert_true(fabs(dot3(a, b)) < 1e-14 && fabs(dot3(a, n)) < 1e-13);
        assert_true(edge[3 * t].im == 0 && edge[3 * t].re > 0);
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            const double *p = m->position + 3 * qc_halfedge_start(m, h);
            const double *q = m->position + 3 * qc_halfedge_end(m, h);
            for (int i = 0; i < 3; i++)
                assert_true(fabs(q[i] - p[i] - edge[h].re * a[i] - edge[h].im * b[i]) < 1e-13);
        }
        const double _Complex e0 = number(edge[3 * t]), e1 = number(edge[3 * t + 1]);
        assert_true(cimag(conj(e0) * e1) > 0); /* counter-clockwise */
    }
    /* Transport once round a vertex turns by the angle defect. */
    for (int32_t v = 0; v < m->n_vertices; v++) {
        if (qc_vertex_on_boundary(m, v)) continue;
        double _Complex turn = 1;
        int32_t c = m->vertex_corner[v];
        do {
            const int32_t h = qc_next(c), e = m->halfedge_edge[h];
            const double _Complex r = number(rho[e]);
            assert_true(fabs(cabs(r) - 1) < 1e-14);
            turn *= m->edge_halfedge[2 * e] == h ? r : 1 / r;
            c = qc_corner_ccw(m, c);
        } while (c != m->vertex_corner[v]);
        assert_true(cabs(turn - cexp(I * gauss[v])) < 1e-12);
    }
    free(edge), free(rho), free(x), free(y), free(normal), free(gauss);
}

/* Form of a cross: Z(e) = <X, e> + i <JX, e> = conj(x) e. */
static void test_cross(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[1], 1);
    qc_complex *edge = NEW_ARRAY(qc_complex, 3 * m->n_faces),
               *z = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    qc_complex *x = random_numbers(m->n_faces), *jz = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    double *scale = NEW_ARRAY(double, m->n_faces), *cot = cotangents(ctx, m);
    for (int32_t t = 0; t < m->n_faces; t++) scale[t] = random_unit();
    assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
    assert_int_equal(qc_form_from_cross(ctx, m, edge, x, scale, z), QC_OK);
    assert_int_equal(qc_form_rotate(ctx, m, cot, z, jz), QC_OK);
    for (int32_t h = 0; h < 3 * m->n_faces; h++) {
        const double _Complex X = scale[h / 3] * number(x[h / 3]), e = number(edge[h]);
        assert_true(cabs(number(z[h]) - (creal(conj(X) * e) + I * creal(conj(I * X) * e))) < 1e-14);
        /* J turns both X and Y: conj(J x) e = -i conj(x) e. */
        assert_true(cabs(number(jz[h]) + I * number(z[h])) < 1e-13);
    }
    free(edge), free(z), free(x), free(jz), free(scale), free(cot);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

static void test_frames(void **state) {
    (void)state, for_all_covers(frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_frames), cmocka_unit_test(test_cross)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
