/* Integration undoes the gradient, up to the constant of each patch, in the combed gauge. */
#include "unit/dec/forms.h"

typedef struct opened {
    int8_t *turn, *residual, *corner_turn, *shift;
    uint8_t *cut, *base;
} opened;

/* Combs the surface cut along a graph through the branch points. */
static opened open_surface(qc_ctx *ctx, const qc_cover *cover) {
    const qc_mesh *m = cover->mesh;
    opened o = {NEW_ARRAY(int8_t, m->n_faces),     NEW_ARRAY(int8_t, m->n_edges),
                NEW_ARRAY(int8_t, 3 * m->n_faces), NEW_ARRAY(int8_t, m->n_vertices),
                NEW_ARRAY(uint8_t, m->n_edges),    NEW_ARRAY(uint8_t, m->n_vertices)};
    assert_int_equal(qc_cover_shifts(ctx, cover, o.shift), QC_OK);
    assert_int_equal(qc_cover_corner_turns(ctx, cover, o.corner_turn), QC_OK);
    for (int32_t v = 0; v < m->n_vertices; v++) o.base[v] = o.shift[v] != 0;
    assert_int_equal(qc_mesh_cut_graph(ctx, m, NULL, o.base, o.cut), QC_OK);
    assert_int_equal(qc_cover_comb(ctx, cover, o.cut, o.turn, o.residual, NULL), QC_OK);
    return o;
}

static void close_surface(opened *o) {
    free(o->turn), free(o->residual), free(o->corner_turn), free(o->shift), free(o->cut);
    free(o->base);
}

static void undo_gradient(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    opened o = open_surface(ctx, cover);
    qc_complex *F = random_numbers(m->n_vertices), *z = NEW_ARRAY(qc_complex, n);
    qc_complex *f = NEW_ARRAY(qc_complex, n);
    double residual = 1;
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (o.shift[v]) F[v] = (qc_complex){0, 0};
    assert_int_equal(qc_form_gradient(ctx, cover, F, z), QC_OK);
    assert_int_equal(qc_form_integrate(ctx, cover, o.cut, o.turn, z, f, &residual), QC_OK);
    assert_true(residual < 1e-13);
    int32_t *first = NEW_ARRAY(int32_t, m->n_components);
    for (int32_t t = m->n_faces - 1; t >= 0; t--) first[m->face_component[t]] = t;
    for (int32_t c = 0; c < n; c++) {
        const int32_t c0 = 3 * first[m->face_component[c / 3]];
        const double _Complex a =
            number(qc_quarter_turn(F[m->face_vertex[c]], o.corner_turn[c] + o.turn[c / 3]));
        const double _Complex b =
            number(qc_quarter_turn(F[m->face_vertex[c0]], o.corner_turn[c0] + o.turn[c0 / 3]));
        assert_true(cabs(number(f[c]) - (a - b)) < 1e-12);
        if (c == c0) assert_true(f[c].re == 0 && f[c].im == 0);
    }
    free(F), free(z), free(f), free(first);
    close_surface(&o);
}

/* After the curl is removed any form integrates to a map with one translation per edge of the cut:
 * f_t = i^{-residual} f_s + tau at both ends. */
static void seamless(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    opened o = open_surface(ctx, cover);
    double *cot = cotangents(ctx, m), residual = 1;
    qc_complex *z = random_form(m), *f = NEW_ARRAY(qc_complex, n);
    assert_int_equal(qc_form_integrate(ctx, cover, o.cut, o.turn, z, f, &residual), QC_OK);
    assert_true(residual > 1e-3);
    assert_int_equal(qc_hodge_remove_curl(ctx, cover, cot, NULL, z, z, NULL, NULL), QC_OK);
    assert_int_equal(qc_form_integrate(ctx, cover, o.cut, o.turn, z, f, &residual), QC_OK);
    assert_true(residual < 1e-11);
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1],
                      r = o.residual[e];
        if (k < 0) continue;
        const double _Complex a =
            number(f[qc_prev(k)]) - number(qc_quarter_turn(f[qc_next(h)], -r));
        const double _Complex b =
            number(f[qc_next(k)]) - number(qc_quarter_turn(f[qc_prev(h)], -r));
        assert_true(cabs(a - b) < 1e-11);
        if (!o.cut[e]) assert_true(cabs(a) < 1e-11);
    }
    free(cot), free(z), free(f);
    close_surface(&o);
}

static void test_undo(void **state) {
    (void)state, for_all_covers(undo_gradient);
}
static void test_seamless(void **state) {
    (void)state, for_all_covers(seamless);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_undo),
                                       cmocka_unit_test(test_seamless)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
