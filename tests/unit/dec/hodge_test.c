/* Hodge decomposition, both versions: the parts add up, are orthogonal and have the kernels and
 * dimensions of Theorem 1.12; on a covering the harmonic space has complex dimension e - f - v + b.
 */
#include <lapacke.h>

#include "unit/dec/forms.h"

static void check_parts(qc_ctx *ctx, const qc_cover *cover, const double *cot, int version) {
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    qc_complex *z = random_form(m), *p = NEW_ARRAY(qc_complex, n), *c = NEW_ARRAY(qc_complex, n);
    qc_complex *h = NEW_ARRAY(qc_complex, n), *div = NEW_ARRAY(qc_complex, m->n_vertices);
    qc_complex *curl = NEW_ARRAY(qc_complex, m->n_edges);
    const double size = norm(m, cot, z);
    assert_int_equal(qc_hodge_decompose(ctx, cover, version, z, p, c, h), QC_OK);
    for (int32_t i = 0; i < n; i++)
        assert_true(cabs(number(p[i]) + number(c[i]) + number(h[i]) - number(z[i])) < 1e-12 * size);
    assert_true(cosine(m, cot, p, c, size) < 1e-12);
    assert_true(cosine(m, cot, c, h, size) < 1e-12);
    assert_true(cosine(m, cot, h, p, size) < 1e-12);
    /* ker curl* and ker div hold P + H and C + H; with J for the other version. */
    for (int32_t i = 0; i < n; i++) z[i] = (qc_complex){p[i].re + h[i].re, p[i].im + h[i].im};
    for (int32_t i = 0; i < n; i++) c[i] = (qc_complex){c[i].re + h[i].re, c[i].im + h[i].im};
    const bool conforming = version == QC_HODGE_CONFORMING;
    if (!conforming) {
        assert_int_equal(qc_form_rotate(ctx, m, cot, z, z), QC_OK);
        assert_int_equal(qc_form_rotate(ctx, m, cot, c, c), QC_OK);
    }
    assert_int_equal(qc_form_curl_edges(ctx, cover, conforming ? z : c, curl), QC_OK);
    assert_int_equal(qc_form_divergence(ctx, cover, cot, conforming ? c : z, div), QC_OK);
    assert_true(largest(m->n_edges, curl) < 1e-12 * size);
    assert_true(largest(m->n_vertices, div) < 1e-12 * size);
    /* Any output may be missing; the harmonic part is a fixed point. */
    assert_int_equal(qc_hodge_decompose(ctx, cover, version, h, p, NULL, NULL), QC_OK);
    assert_true(norm(m, cot, p) < 1e-12 * size);
    free(z), free(p), free(c), free(h), free(div), free(curl);
}

static void parts(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    double *cot = cotangents(ctx, cover->mesh);
    check_parts(ctx, cover, cot, QC_HODGE_CONFORMING);
    check_parts(ctx, cover, cot, QC_HODGE_NONCONFORMING);
    free(cot);
}

/* Orthonormal coordinates of a form: two per face. */
static void coordinates(const qc_mesh *m, const qc_complex *edge, const qc_complex *z,
                        double _Complex *out) {
    for (int32_t t = 0; t < m->n_faces; t++) {
        const double _Complex a = number(edge[3 * t]), b = number(edge[3 * t + 1]);
        const double det = cimag(conj(a) * b); /* twice the area; solve X.a, X.b = z_0, z_1 */
        const double _Complex p = number(z[3 * t]), q = number(z[3 * t + 1]);
        out[2 * t] = sqrt(det / 2) * (p * cimag(b) - q * cimag(a)) / det;
        out[2 * t + 1] = sqrt(det / 2) * (q * creal(a) - p * creal(b)) / det;
    }
}

static int32_t rank(int32_t n, int32_t columns, double _Complex *A) {
    double *s = NEW_ARRAY(double, n), *super = NEW_ARRAY(double, n);
    double _Complex none[1];
    assert_int_equal(
        LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', n, columns, A, n, s, none, 1, none, 1, super),
        0);
    int32_t r = 0;
    while (r < n && r < columns && s[r] > 1e-8 * fmax(1, s[0])) r++;
    free(s), free(super);
    return r;
}

/* Ranks of the three projections applied to every form of a basis. */
static void dimensions(qc_ctx *ctx, const qc_cover *cover, int version, int32_t dim[3]) {
    const qc_mesh *m = cover->mesh;
    const int32_t n = 2 * m->n_faces;
    double _Complex *A[3];
    qc_complex *z = NEW_ARRAY(qc_complex, 3 * m->n_faces), *part[3];
    qc_complex *edge = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
    for (int k = 0; k < 3; k++) {
        A[k] = NEW_ARRAY(double _Complex, n *n);
        part[k] = NEW_ARRAY(qc_complex, 3 * m->n_faces);
    }
    for (int32_t i = 0; i < n; i++) {
        memset(z, 0, 3 * (size_t)m->n_faces * sizeof(*z));
        z[3 * (i / 2) + i % 2].re = 1;
        z[3 * (i / 2) + 2].re = -1;
        assert_int_equal(qc_hodge_decompose(ctx, cover, version, z, part[0], part[1], part[2]),
                         QC_OK);
        for (int k = 0; k < 3; k++) coordinates(m, edge, part[k], A[k] + i * n);
    }
    for (int k = 0; k < 3; k++) {
        dim[k] = rank(n, n, A[k]);
        free(A[k]);
        free(part[k]);
    }
    free(z), free(edge);
}

static void count_dimensions(qc_ctx *ctx, const surface *s, int kind) {
    qc_mesh *m = build_surface(ctx, s, 1);
    int8_t *matching = random_matching(m, kind);
    const qc_cover cover = {m, matching};
    qc_cover_info info;
    assert_int_equal(qc_cover_get_info(ctx, &cover, &info), QC_OK);
    const int32_t b = info.odd + info.even, constants = info.components == 4; /* trivial holonomy */
    const int32_t inner = m->n_edges - m->n_boundary_edges;
    const int32_t vertices = m->n_vertices - b - constants;
    const int32_t edges = inner - (m->n_boundary_edges ? 0 : constants);
    const int32_t harmonic = 2 * m->n_faces - vertices - edges;
    int32_t dim[3];
    dimensions(ctx, &cover, QC_HODGE_CONFORMING, dim);
    assert_int_equal(dim[0], vertices);
    assert_int_equal(dim[1], edges);
    assert_int_equal(dim[2], harmonic);
    dimensions(ctx, &cover, QC_HODGE_NONCONFORMING, dim);
    assert_int_equal(dim[0], edges);
    assert_int_equal(dim[1], vertices);
    assert_int_equal(dim[2], harmonic);
    if (kind == PLAIN && s->boundaries == 0) assert_int_equal(harmonic, 2 * s->genus);
    if (kind == PLAIN && s->boundaries)
        assert_int_equal(harmonic, 2 * s->genus + s->boundaries - 1);
    /* Half of the symmetric loops (4.1): a complex form counts for two real ones. */
    if (b > 0 && s->boundaries == 0) assert_int_equal(2 * harmonic, info.symmetric_loops);
    free(matching);
    qc_object_release(m);
}

static void test_dimensions(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    surface cube = SURFACES[0];
    cube.sub = 1;
    random_state = 3;
    for (int kind = PLAIN; kind < N_MATCHINGS; kind += DENSE) {
        count_dimensions(ctx, &cube, kind);
        count_dimensions(ctx, &SURFACES[1], kind);
        count_dimensions(ctx, &SURFACES[5], kind);
    }
    qc_ctx_free(ctx);
}

static void test_version(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[0], 1);
    const qc_cover cover = {m, NULL};
    qc_complex *z = random_form(m);
    assert_int_equal(qc_hodge_decompose(ctx, &cover, 2, z, z, NULL, NULL), QC_ERR_ARGUMENT);
    free(z);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

static void test_parts(void **state) {
    (void)state, for_all_covers(parts);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts),
                                       cmocka_unit_test(test_dimensions),
                                       cmocka_unit_test(test_version)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
