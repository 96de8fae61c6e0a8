/* Gradient fields have their extrema as vertices of index 1; cutting these open keeps the surface,
 * the directions in space and all indices, and leaves a loop of tips at each. */
#include "surfaces.h"

static qc_matching *gradient(qc_ctx *ctx, const qc_mesh *mesh, const double *g) {
    const size_t n = (size_t)mesh->n_faces;
    qc_complex *x = malloc(sizeof *x * n);
    double *weight = malloc(sizeof *weight * n);
    uint8_t *trusted = calloc(n, 1);
    qc_face_field *field = NULL;
    qc_matching *out = NULL;
    assert_int_equal(qc_field_gradient(ctx, mesh, g, x, weight, trusted), QC_OK);
    assert_int_equal(qc_face_field_create(ctx, mesh, x, weight, trusted, &field), QC_OK);
    field->is_vector = 1;
    assert_int_equal(qc_matching_create(ctx, field, NULL, &out), QC_OK);
    for (int32_t e = 0; e < mesh->n_edges; e++) assert_int_equal(out->m[e], 0);
    qc_object_release(field);
    free(x);
    free(weight);
    free(trusted);
    return out;
}

static qc_matching *height_field(qc_ctx *ctx, const qc_mesh *mesh, int axis) {
    double *g = malloc(sizeof *g * (size_t)mesh->n_vertices);
    for (int32_t v = 0; v < mesh->n_vertices; v++) g[v] = mesh->position[3 * v + axis];
    qc_matching *out = gradient(ctx, mesh, g);
    free(g);
    return out;
}

static qc_sizing *sizing_of(qc_ctx *ctx, const qc_mesh *mesh, double length) {
    qc_sizing *out = NULL;
    assert_int_equal(qc_sizing_create(ctx, mesh, length, 0, NULL, &out), QC_OK);
    return out;
}

static void extrema_have_index_one(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *sphere = ellipsoid(ctx, 6, 9, 1, 2, 3), *torus = grid(ctx, TORUS, 24, 12, 1e6);
    qc_matching *m = height_field(ctx, sphere, 2), *t = height_field(ctx, torus, 0);
    int32_t maxima = 0;
    assert_int_equal(m->n_singular, 2);
    assert_int_equal(m->index4[sphere->n_vertices - 1], 4);
    assert_int_equal(m->index4[sphere->n_vertices - 2], 4);
    for (int32_t v = 0; v < torus->n_vertices; v++) maxima += t->index4[v] == 4;
    assert_int_equal(maxima, 2);
    assert_int_equal(t->index4_sum, 0);
    qc_object_release(m);
    qc_object_release(t);
    qc_object_release(sphere);
    qc_object_release(torus);
}

/* The gradient of a linear function of the plane is that vector; faces without get it from others.
 */
static void linear_functions(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, PLANE, 9, 7, 1e-6);
    const size_t n = (size_t)mesh->n_faces;
    double *g = malloc(sizeof *g * (size_t)mesh->n_vertices), *weight = malloc(sizeof *weight * n);
    double *re = malloc(sizeof *re * 6 * n), *im = re + 3 * n;
    qc_complex *x = malloc(sizeof *x * n);
    uint8_t *trusted = calloc(n, 1);
    assert_int_equal(qc_tangent_frames(ctx, mesh, re, im), QC_OK);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double *p = mesh->position + 3 * v;
        g[v] = 1e3 + 3 * fmax(p[0], 0.5e-6) + 0 * p[1];
    }
    assert_int_equal(qc_field_gradient(ctx, mesh, g, x, weight, trusted), QC_OK);
    int32_t flat = 0;
    for (size_t t = 0; t < n; t++) {
        const double u = x[t].re * re[3 * t] + x[t].im * im[3 * t];
        if (trusted[t]) assert_true(fabs(u - 1) < 1e-3 && weight[t] > 0.1);
        if (!trusted[t]) assert_true(weight[t] == 0);
        flat += !trusted[t];
        assert_true(fabs(hypot(x[t].re, x[t].im) - 1) < 1e-9);
    }
    assert_true(flat > 0 && flat < mesh->n_faces);
    g[3] = NAN;
    assert_int_equal(qc_field_gradient(ctx, mesh, g, x, weight, trusted), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 3);
    free(g);
    free(weight);
    free(re);
    free(x);
    free(trusted);
    qc_object_release(mesh);
}

static void check_poles(const qc_mesh *old, const qc_matching *m) {
    const qc_mesh *mesh = m->field->mesh;
    for (int32_t i = 0; i < mesh->n_poles; i++) {
        const int32_t first = mesh->pole_corner[mesh->pole_start[i]];
        const int32_t p = mesh->face_vertex[first];
        const int32_t n = mesh->pole_start[i + 1] - mesh->pole_start[i];
        int32_t valence = 0;
        assert_true(p < old->n_vertices);
        for (int32_t c = 0; c < 3 * old->n_faces; c++) valence += old->face_vertex[c] == p;
        assert_int_equal(n, valence);
        assert_int_equal(m->pole_index4[i], 4);
        for (int32_t j = 0; j < n; j++) {
            const int32_t c = mesh->pole_corner[mesh->pole_start[i] + j];
            const int32_t d = mesh->pole_corner[mesh->pole_start[i] + (j + 1) % n];
            const int32_t v = mesh->face_vertex[c];
            assert_true(mesh->twin[qc_next(c)] < 0 && mesh->twin[qc_prev(c)] < 0);
            assert_int_equal(mesh->face_vertex[qc_prev(c)], mesh->face_vertex[qc_next(d)]);
            assert_int_equal(mesh->source_vertex[v], p);
            assert_memory_equal(mesh->position + 3 * v, old->position + 3 * p, 3 * sizeof(double));
        }
    }
}

static void opening_keeps_the_field(void **state) {
    qc_ctx *ctx = *state;
    const double scale[] = {1, 1e-6, 1e6}, length[] = {10, 0.3, 0.01};
    for (int i = 0; i < 9; i++) {
        qc_mesh *old = ellipsoid(ctx, 7, 9, scale[i % 3], 2 * scale[i % 3], 3 * scale[i % 3]);
        qc_mesh *mesh = NULL, *same = NULL;
        qc_matching *m = height_field(ctx, old, 2), *opened = NULL, *again = NULL;
        qc_sizing *sizing = sizing_of(ctx, old, length[i / 3] * scale[i % 3]), *s = NULL, *r = NULL;
        assert_int_equal(qc_matching_open(ctx, m, sizing, 1, &mesh, &s, &opened), QC_OK);
        assert_int_equal(mesh->n_poles, 2);
        assert_int_equal(mesh->n_boundary_loops, 2);
        assert_int_equal(mesh->euler, 0);
        assert_true(fabs(mesh->area / old->area - 1) < 1e-12);
        assert_ptr_equal(s->mesh, mesh);
        assert_int_equal(opened->index4_sum, m->index4_sum);
        assert_int_equal(opened->n_singular, m->n_singular);
        check_poles(old, opened);
        double radius = 0; /* of the star, not above half a quad and always smaller than before */
        for (int32_t j = 0; j < mesh->pole_start[2]; j++) {
            const int32_t c = mesh->pole_corner[j];
            const double *p = mesh->position + 3 * mesh->face_vertex[c];
            const double *q = mesh->position + 3 * mesh->face_vertex[qc_next(c)];
            radius += hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) / mesh->pole_start[2];
        }
        assert_true(radius <= 0.5001 * sizing->edge_length);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            assert_int_equal(opened->index4[v],
                             v < old->n_vertices && m->index4[v] != 4 ? m->index4[v] : 0);
        for (int32_t e = 0; e < mesh->n_edges; e++) assert_int_equal(opened->m[e], 0);
        assert_int_equal(qc_matching_open(ctx, opened, s, 1, &same, &r, &again), QC_OK);
        assert_ptr_equal(same, mesh);
        assert_ptr_equal(again, opened);
        const void *made[] = {same, r, again, mesh, s, opened, m, sizing, old};
        for (size_t k = 0; k < sizeof made / sizeof *made; k++) qc_object_release(made[k]);
    }
}

static void neighbours_are_refused(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *old = ellipsoid(ctx, 6, 6, 1, 1, 1), *mesh = NULL;
    double *g = malloc(sizeof *g * (size_t)old->n_vertices);
    for (int32_t v = 0; v < old->n_vertices; v++) g[v] = old->position[3 * v + 2];
    g[old->n_vertices - 3] = 10; /* next to the pole, which is a minimum now */
    g[old->n_vertices - 1] = -10;
    qc_matching *m = gradient(ctx, old, g), *out = NULL;
    qc_sizing *sizing = sizing_of(ctx, old, 1), *s = NULL;
    assert_int_equal(qc_matching_open(ctx, m, sizing, 1, &mesh, &s, &out), QC_ERR_ARGUMENT);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "qc.split"));
    qc_matching *split = NULL;
    qc_sizing *finer = NULL;
    qc_mesh *between = NULL;
    assert_int_equal(qc_matching_split(ctx, m, sizing, &between, &finer, &split), QC_OK);
    assert_int_equal(qc_matching_open(ctx, split, finer, 1, &mesh, &s, &out), QC_OK);
    assert_true(mesh->n_poles >= 2 && mesh->n_boundary_loops == mesh->n_poles);
    const void *made[] = {mesh, s, out, between, finer, split, m, sizing, old};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) qc_object_release(made[k]);
    free(g);
}

/* The constant field of the plane on the sphere, by stereographic projection, has index 2. */
static void dipoles_are_opened_on_request(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *old = ellipsoid(ctx, 16, 12, 1, 1, 1), *mesh = NULL;
    const size_t n = (size_t)old->n_faces;
    double *re = malloc(sizeof *re * 6 * n), *im = re + 3 * n;
    qc_complex *x = malloc(sizeof *x * n);
    qc_face_field *field = NULL;
    qc_matching *m = NULL, *out = NULL;
    qc_sizing *sizing = sizing_of(ctx, old, 0.1), *s = NULL;
    assert_int_equal(qc_tangent_frames(ctx, old, re, im), QC_OK);
    for (size_t t = 0; t < n; t++) {
        double c[3] = {0, 0, 0};
        for (int i = 0; i < 9; i++)
            c[i % 3] += old->position[3 * old->face_vertex[3 * t + (size_t)i / 3] + i % 3];
        const double r = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        const double a = c[0] / (r - c[2]), b = c[1] / (r - c[2]);
        const double d[3] = {1 - a * a + b * b, -2 * a * b, 2 * a};
        const double *e = re + 3 * t, *f = im + 3 * t;
        x[t] = (qc_complex){d[0] * e[0] + d[1] * e[1] + d[2] * e[2],
                            d[0] * f[0] + d[1] * f[1] + d[2] * f[2]};
    }
    assert_int_equal(qc_face_field_create(ctx, old, x, NULL, NULL, &field), QC_OK);
    field->is_vector = 1;
    assert_int_equal(qc_matching_create(ctx, field, NULL, &m), QC_OK);
    assert_int_equal(m->n_singular, 1);
    assert_int_equal(m->index4[old->n_vertices - 1], 8);
    assert_int_equal(qc_matching_open(ctx, m, sizing, 1, &mesh, &s, &out), QC_ERR_FAILED);
    assert_int_equal(qc_ctx_error(ctx)->where, old->n_vertices - 1);
    assert_null(mesh);
    assert_int_equal(qc_matching_open(ctx, m, sizing, 2, &mesh, &s, &out), QC_OK);
    assert_int_equal(mesh->n_poles, 1);
    assert_int_equal(mesh->n_boundary_loops, 1);
    const void *made[] = {mesh, s, out, m, field, sizing, old};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) qc_object_release(made[k]);
    free(re);
    free(x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extrema_have_index_one),        cmocka_unit_test(linear_functions),
        cmocka_unit_test(opening_keeps_the_field),       cmocka_unit_test(neighbours_are_refused),
        cmocka_unit_test(dipoles_are_opened_on_request),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
