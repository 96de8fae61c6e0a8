/* The smoothest field: few singularities, parallel where parallel fields exist, stationary. */
#include "sdk/field/power_system.h"
#include "surfaces.h"

static qc_complex *smoothest(qc_ctx *ctx, const qc_mesh *mesh) {
    qc_complex *x = malloc(sizeof *x * (size_t)mesh->n_faces);
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, NULL, 0, 0, x), QC_OK);
    return x;
}

static void few_singularities_on_simple_surfaces(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *sphere = ellipsoid(ctx, 32, 20, 1, 1, 1), *torus = grid(ctx, TORUS, 40, 20, 1);
    qc_complex *x = smoothest(ctx, sphere), *y = smoothest(ctx, torus);
    qc_matching *a = match(ctx, sphere, x), *b = match(ctx, torus, y);
    assert_int_equal(a->index4_sum, 8);
    assert_int_equal(a->n_singular, 8);
    assert_int_equal(b->index4_sum, 0);
    qc_object_release(a);
    qc_object_release(b);
    qc_object_release(sphere);
    qc_object_release(torus);
    free(x);
    free(y);
}

/* A flat square and a cylinder carry parallel fields: all theta vanish although the matrix is
 * singular. */
static void flat_surfaces_get_parallel_fields(void **state) {
    qc_ctx *ctx = *state;
    for (int kind = 0; kind < 2; kind++) {
        qc_mesh *mesh = grid(ctx, kind ? CYLINDER : PLANE, 12, 8, 1);
        qc_complex *x = smoothest(ctx, mesh);
        qc_matching *m = match(ctx, mesh, x);
        for (int32_t e = 0; e < mesh->n_edges; e++) assert_true(fabs(m->theta[e]) < 1e-6);
        qc_object_release(m);
        qc_object_release(mesh);
        free(x);
    }
}

/* Two components, one of them guided: each is solved by itself. */
static void components_are_independent(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *part = grid(ctx, PLANE, 6, 6, 1);
    int32_t V = part->n_vertices, F = part->n_faces, f[6 * 72];
    double p[6 * 49];
    for (int32_t i = 0; i < 6 * V; i++) p[i] = part->position[i % (3 * V)] * (i < 3 * V ? 1 : 1e-2);
    for (int32_t i = 0; i < 6 * F; i++) f[i] = part->face_vertex[i % (3 * F)] + (i < 3 * F ? 0 : V);
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, 2 * V, p, 2 * F, f, &mesh), QC_OK);
    double real[3 * 144], imaginary[3 * 144], diagonal[3] = {1, 0.5, 0};
    assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
    qc_complex x[144], guide = in_frame(real, imaginary, 10, diagonal);
    uint8_t trusted[144] = {0};
    for (int i = 0; i < 144; i++) x[i] = guide;
    trusted[10] = 1;
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, trusted, 1, 0, x), QC_OK);
    for (size_t t = 0; t < (size_t)F; t++)
        assert_true(cross_angle(x[t], in_frame(real, imaginary, t, diagonal)) < 1e-6);
    qc_matching *m = match(ctx, mesh, x);
    for (int32_t e = 0; e < mesh->n_edges; e++) assert_true(fabs(m->theta[e]) < 1e-6);
    qc_object_release(m);
    qc_object_release(mesh);
    qc_object_release(part);
}

static void alignment_moves_towards_the_guide(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 20, 13, 1, 1.3, 2);
    size_t F = (size_t)mesh->n_faces;
    qc_complex *guide = random_crosses(mesh, 11), *x = malloc(sizeof *x * F);
    uint8_t *all = malloc(F);
    memset(all, 1, F);
    double before = PI;
    double alignments[] = {1e-3, 1, 1e3, 1e6};
    for (int i = 0; i < 4; i++) {
        double sum = 0;
        memcpy(x, guide, sizeof *x * F);
        assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, all, alignments[i], 0, x), QC_OK);
        for (size_t t = 0; t < F; t++) sum += cross_angle(x[t], guide[t]) / (double)F;
        assert_true(sum < before);
        before = sum;
    }
    assert_true(before < 1e-3);
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, all, -1, 0, x), QC_ERR_ARGUMENT);
    qc_object_release(mesh);
    free(guide);
    free(x);
    free(all);
}

static void eigenvectors_have_no_residual(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 24, 15, 1, 1.4, 2);
    qc__power_system s;
    assert_int_equal(qc__power_create(ctx, mesh, NULL, NULL, 0, &s), QC_OK);
    qc__power_fill(&s, 1e-12, 0);
    assert_int_equal(qc__power_factorise(ctx, &s), QC_OK);
    assert_int_equal(qc__power_eigenvector(ctx, &s), QC_OK);
    qc__power_fill(&s, 0, 0);
    double norm = 0, residual = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) s.work[t] = -s.mu[0] * s.mass[t] * s.z[t];
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        for (int64_t k = s.pattern.colptr[t]; k < s.pattern.colptr[t + 1]; k++) {
            qc__cplx a = qc__c(s.value[k]);
            s.work[s.pattern.row[k]] += a * s.z[t];
            if (s.pattern.row[k] != t) s.work[t] += conj(a) * s.z[s.pattern.row[k]];
        }
        norm += s.mass[t] * pow(cabs(s.z[t]), 2);
    }
    assert_true(s.mu[0] > 0 && fabs(norm - 1) < 1e-9);
    for (int32_t t = 0; t < mesh->n_faces; t++) residual += pow(cabs(s.work[t]), 2) / s.mass[t];
    assert_true(sqrt(residual) < 1e-3 * s.mu[0]);
    qc__power_free(&s);
    qc_object_release(mesh);
}

/* Noise in the guide makes pairs; the flow closes those nearer than the detail and keeps the sum.
 */
static void detail_closes_pairs(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 60, 40, 1, 1, 1);
    size_t F = (size_t)mesh->n_faces;
    qc_complex *x = malloc(sizeof *x * F);
    uint8_t *all = malloc(F);
    memset(all, 1, F);
    int32_t before = INT32_MAX;
    for (int i = 0; i < 2; i++) {
        qc_complex *noise = random_crosses(mesh, 13);
        memcpy(x, noise, sizeof *x * F);
        assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, all, 0.1, 0.1 * i, x), QC_OK);
        qc_matching *m = match(ctx, mesh, x);
        assert_int_equal(m->index4_sum, 8);
        assert_true(m->n_singular < before);
        before = m->n_singular;
        qc_object_release(m);
        free(noise);
    }
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, all, 1, -1, x), QC_ERR_ARGUMENT);
    qc_object_release(mesh);
    free(x);
    free(all);
}

static void threads_give_the_same_bits(void **state) {
    (void)state;
    qc_complex *x[2];
    size_t bytes = 0;
    for (int i = 0; i < 2; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i ? 4 : 1;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        qc_mesh *mesh = ellipsoid(ctx, 50, 30, 1, 1.5, 2);
        bytes = sizeof **x * (size_t)mesh->n_faces;
        x[i] = smoothest(ctx, mesh);
        qc_object_release(mesh);
        qc_ctx_free(ctx);
    }
    assert_memory_equal(x[0], x[1], bytes);
    free(x[0]);
    free(x[1]);
}

/* A cap closed by a fan whose faces all follow the rim holds 4/4 at its apex; freed, it is regular
 * inside. */
static void crowded_indices_are_shared(void **state) {
    enum { N = 12 };
    qc_ctx *ctx = *state;
    double p[3 * (2 * N + 1)] = {0, 0, 1};
    int32_t f[9 * N];
    for (int32_t i = 0; i < N; i++) {
        int32_t a = 1 + i, b = 1 + (i + 1) % N, *t = f + 9 * i;
        for (int32_t k = 0; k < 2; k++) {
            double *q = p + 3 * (a + k * N);
            q[0] = cos(2 * PI * i / N), q[1] = sin(2 * PI * i / N), q[2] = 1 - k;
        }
        const int32_t faces[9] = {0, a, b, a, a + N, b, b, a + N, b + N};
        memcpy(t, faces, sizeof faces);
    }
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, 2 * N + 1, p, 3 * N, f, &mesh), QC_OK);
    qc_complex edge[9 * N], x[3 * N];
    uint8_t trusted[3 * N];
    memset(trusted, 1, sizeof trusted);
    assert_int_equal(qc_tangent_edges(ctx, mesh, edge), QC_OK);
    for (int32_t t = 0; t < 3 * N; t++) { /* along the horizontal edge */
        int32_t h = 3 * t + (t % 3 == 0 ? 0 : t % 3 == 1 ? 1 : 0);
        double r = hypot(edge[h].re, edge[h].im);
        x[t] = (qc_complex){edge[h].re / r, edge[h].im / r};
    }
    qc_matching *before = match(ctx, mesh, x);
    assert_int_equal(before->index4[0], 4);
    int32_t left = -1;
    assert_int_equal(qc_field_separate(ctx, mesh, 0.1, NULL, trusted, x, &left), QC_OK);
    assert_int_equal(left, 0);
    qc_matching *after = match(ctx, mesh, x);
    assert_int_equal(after->index4[0], 0);
    assert_int_equal(trusted[0], 0);
    for (int32_t v = 0; v < mesh->n_vertices; v++) assert_in_range(after->index4[v] + 1, 0, 2);
    assert_int_equal(qc_field_separate(ctx, mesh, -1, NULL, NULL, x, NULL), QC_ERR_ARGUMENT);
    qc_object_release(before);
    qc_object_release(after);
    qc_object_release(mesh);
}

/* The lines of latitude of a torus, turned by a dipole: one vertex of index 1/4 and one of -1/4, of
 * which no quad mesh exists; both go, however far apart they are. */
static void lone_pairs_on_a_torus_cancel(void **state) {
    enum { N = 40, M = 20 };
    qc_ctx *ctx = *state;
    qc_mesh *mesh = grid(ctx, TORUS, N, M, 1);
    qc_complex *edge = malloc(sizeof *edge * 3 * (size_t)mesh->n_faces);
    qc_complex *x = malloc(sizeof *x * (size_t)mesh->n_faces);
    assert_int_equal(qc_tangent_edges(ctx, mesh, edge), QC_OK);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int32_t *v = mesh->face_vertex + 3 * t;
        double column = 0, row = 0, along = 0;
        for (int32_t k = 0; k < 3; k++) { /* the centre, and the edge within a row */
            int32_t from = v[(k + 1) % 3], to = v[(k + 2) % 3];
            column += (from / M - v[0] / M + 3 * N / 2) % N - N / 2 + v[0] / M;
            row += (from % M - v[0] % M + 3 * M / 2) % M - M / 2 + v[0] % M;
            if (from % M != to % M) continue;
            along = atan2(edge[3 * t + k].im, edge[3 * t + k].re);
            if ((to / M - from / M + N) % N != 1) along += PI;
        }
        double y = row / 3 - 10.1;
        double turn = (atan2(y, column / 3 - 15.2) - atan2(y, column / 3 - 24.7)) / 4;
        x[t] = (qc_complex){cos(along + turn), sin(along + turn)};
    }
    qc_matching *before = match(ctx, mesh, x);
    assert_int_equal(before->n_singular, 2);
    assert_int_equal(qc_field_separate(ctx, mesh, 0.1, NULL, NULL, x, NULL), QC_OK);
    qc_matching *after = match(ctx, mesh, x);
    assert_int_equal(after->n_singular, 0);
    qc_object_release(before);
    qc_object_release(after);
    qc_object_release(mesh);
    free(edge);
    free(x);
}

/* At the tip of a spike the indices cannot be shared without pairs closer than the distance. */
static void spikes_share_their_index(void **state) {
    enum { N = 40, M = 20 };
    qc_ctx *ctx = *state;
    qc_mesh *flat = grid(ctx, TORUS, N, M, 1);
    double *p = malloc(sizeof *p * 3 * (size_t)flat->n_vertices);
    for (int i = 0; i < 8; i++) {
        const int32_t tip = 5 * i * M + 2 * (i / 2) + 1 - i % 2;
        qc_mesh *mesh = NULL, *fine = NULL;
        qc_features *none = NULL, *f = NULL;
        memcpy(p, flat->position, sizeof *p * 3 * (size_t)flat->n_vertices);
        for (int k = 0; k < 3; k++) p[3 * tip + k] *= 2.5;
        assert_int_equal(
            qc_mesh_create(ctx, flat->n_vertices, p, flat->n_faces, flat->face_vertex, &mesh),
            QC_OK);
        assert_int_equal(qc_features_detect(ctx, mesh, PI, 0, NULL, &none), QC_OK);
        assert_int_equal(qc_features_split(ctx, none, NULL, &fine, &f, NULL), QC_OK);
        qc_complex *x = smoothest(ctx, fine);
        int32_t left = -1;
        assert_int_equal(qc_field_separate(ctx, fine, 0.7, NULL, NULL, x, &left), QC_OK);
        assert_int_equal(left, 0);
        const void *made[] = {mesh, fine, none, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
        free(x);
    }
    qc_object_release(flat);
    free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lone_pairs_on_a_torus_cancel),
        cmocka_unit_test(spikes_share_their_index),
        cmocka_unit_test(crowded_indices_are_shared),
        cmocka_unit_test(few_singularities_on_simple_surfaces),
        cmocka_unit_test(flat_surfaces_get_parallel_fields),
        cmocka_unit_test(components_are_independent),
        cmocka_unit_test(alignment_moves_towards_the_guide),
        cmocka_unit_test(eigenvectors_have_no_residual),
        cmocka_unit_test(detail_closes_pairs),
        cmocka_unit_test(threads_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
