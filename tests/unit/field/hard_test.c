/* Hard features: meshes get room for them, crosses run along them in every step, sectors between
 * them keep at least one quarter turn. */
#include "hard.h"

#include <qc/optimize.h>

#include "unit/mesh/failing_allocator.h"

static const struct {
    const char *name;
    int32_t resolution;
} shapes[] = {{"cube", 300}, {"cylinder", 500}, {"truncated-cone", 600}, {"hyperboloid", 300}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static double feature_length(qc_ctx *ctx, const qc_features *f) {
    double *length = malloc(sizeof *length * (size_t)f->mesh->n_edges), sum = 0;
    assert_int_equal(qc_mesh_geometry(ctx, f->mesh, length, NULL, NULL, NULL, NULL, NULL), QC_OK);
    for (int32_t e = 0; e < f->mesh->n_edges; e++) sum += f->edge[e] ? length[e] : 0;
    free(length);
    return sum;
}

/* A tetrahedron (every edge is a crease), a cube of 12 faces, and finer surfaces. */
static void meshes_get_room(void **state) {
    qc_ctx *ctx = *state;
    const double p[] = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
    const int32_t t[] = {0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    qc_mesh *meshes[] = {NULL, shape(ctx, "cube", 12, 1), shape(ctx, "cylinder", 200, 1e-6),
                         shape(ctx, "truncated-cone", 60, 1e6), grid(ctx, PLANE, 1, 1, 1)};
    assert_int_equal(qc_mesh_create(ctx, 4, p, 4, t, &meshes[0]), QC_OK);
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        qc_features *before = NULL;
        assert_int_equal(qc_features_detect(ctx, meshes[i], 35 * PI / 180, 0, NULL, &before),
                         QC_OK);
        qc_features *f = hard_features(ctx, meshes[i]);
        check_room(f);
        assert_int_equal(f->n_corners, before->n_corners);
        assert_int_equal(f->mesh->euler, before->mesh->euler);
        assert_true(fabs(f->mesh->area / before->mesh->area - 1) < 1e-12);
        assert_true(fabs(feature_length(ctx, f) / feature_length(ctx, before) - 1) < 1e-12);
        for (int32_t s = 0; s < f->mesh->n_faces; s++)
            assert_true(
                f->mesh->source_face == NULL ||
                (f->mesh->source_face[s] >= 0 && f->mesh->source_face[s] < before->mesh->n_faces));
        qc_object_release(f);
        qc_object_release(before);
    }
}

/* The index of an interior vertex is within half its valence, in quarters, of its curvature; one
 * from -2/4 to 1/4 is well within it after the split, and the surface is the same. */
static void spikes_get_more_edges(void **state) {
    qc_ctx *ctx = *state;
    const int32_t t[] = {0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    for (int height = 1; height <= 100; height *= 10) {
        const double p[] = {1, 0, 0, -0.5, 0.8, 0, -0.5, -0.8, 0, 0, 0, -height};
        qc_mesh *mesh = NULL, *out = NULL, *same = NULL;
        qc_features *soft = NULL, *f = NULL, *again = NULL;
        assert_int_equal(qc_mesh_create(ctx, 4, p, 4, t, &mesh), QC_OK);
        assert_int_equal(qc_features_detect(ctx, mesh, 0.5, 0, NULL, &soft), QC_OK);
        assert_int_equal(qc_features_split(ctx, soft, NULL, &out, &f, NULL), QC_OK);
        assert_true(out->n_faces > mesh->n_faces && f->mesh == out);
        assert_true(fabs(out->area / mesh->area - 1) < 1e-12);
        assert_true(fabs(feature_length(ctx, f) / feature_length(ctx, soft) - 1) < 1e-12);
        double *gauss = malloc(sizeof *gauss * (size_t)out->n_vertices);
        double *valence = calloc((size_t)out->n_vertices, sizeof *valence);
        assert_int_equal(qc_mesh_geometry(ctx, out, NULL, NULL, NULL, NULL, NULL, gauss), QC_OK);
        for (int32_t c = 0; c < 3 * out->n_faces; c++) valence[out->face_vertex[c]]++;
        for (int32_t v = 0; v < out->n_vertices; v++)
            assert_true(gauss[v] * 2 / PI - 0.2 * valence[v] <= 1 &&
                        gauss[v] * 2 / PI + 0.2 * valence[v] >= -2);
        assert_int_equal(qc_features_split(ctx, f, NULL, &same, &again, NULL), QC_OK);
        assert_true(same == out && again == f);
        const void *made[] = {out, f, same, again, soft, mesh};
        for (size_t i = 0; i < sizeof made / sizeof *made; i++) qc_object_release(made[i]);
        free(gauss);
        free(valence);
    }
}

/* Soft features split nothing; the sizing goes along. */
static void only_hard_features_split(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = shape(ctx, "cube", 12, 1), *out = NULL;
    qc_features *soft = NULL, *hard = NULL, *f = NULL;
    qc_sizing *sizing = NULL, *s = NULL;
    double *length = malloc(sizeof *length * (size_t)mesh->n_faces);
    for (int32_t t = 0; t < mesh->n_faces; t++) length[t] = 1 + t;
    assert_int_equal(qc_sizing_create(ctx, mesh, 0.5, 100, length, &sizing), QC_OK);
    assert_int_equal(qc_features_detect(ctx, mesh, 0.5, 0, NULL, &soft), QC_OK);
    assert_int_equal(qc_features_split(ctx, soft, sizing, &out, &f, &s), QC_OK);
    assert_true(out == mesh && f == soft && s == sizing);
    const void *same[] = {out, f, s};
    for (int i = 0; i < 3; i++) qc_object_release(same[i]);
    assert_int_equal(qc_features_create(ctx, mesh, soft->edge, true, &hard), QC_OK);
    assert_int_equal(qc_features_split(ctx, hard, sizing, &out, &f, &s), QC_OK);
    assert_true(out->n_faces > mesh->n_faces && s->mesh == out && f->mesh == out);
    for (int32_t t = 0; t < out->n_faces; t++)
        assert_true(s->length[t] == length[out->source_face[t]]);
    const void *made[] = {out, f, s, soft, hard, sizing, mesh};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) qc_object_release(made[i]);
    free(length);
}

static void crosses_stay_on_features(void **state) {
    qc_ctx *ctx = *state;
    for (size_t i = 0; i < SHAPES; i++) {
        qc_features *f = hard_features(ctx, shape(ctx, shapes[i].name, shapes[i].resolution, 1));
        check_room(f);
        qc_matching *m = hard_matching(ctx, f);
        check_matching(ctx, m);
        qc_sizing *sizing = NULL, *fine = NULL;
        qc_matching *split = NULL;
        qc_mesh *mesh = NULL;
        assert_int_equal(
            qc_sizing_create(ctx, f->mesh, sqrt(f->mesh->area / 300), 0, NULL, &sizing), QC_OK);
        assert_int_equal(qc_matching_split(ctx, m, sizing, &mesh, &fine, &split), QC_OK);
        check_matching(ctx, split);
        const void *made[] = {sizing, fine, split, mesh, m, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
    }
}

static int32_t count_branch_points(const qc_matching *m) {
    int32_t n = 0;
    for (int32_t v = 0; v < m->field->mesh->n_vertices; v++) n += m->index4[v] != 0;
    return n;
}

/* Cancelling, moving and creating branch points leave features and sectors as they are. */
static void branch_points_move_elsewhere(void **state) {
    qc_ctx *ctx = *state;
    for (size_t i = 0; i < SHAPES; i++) {
        qc_features *f = hard_features(ctx, shape(ctx, shapes[i].name, shapes[i].resolution, 1));
        qc_matching *m = hard_matching(ctx, f), *out = NULL;
        qc_sizing *sizing = NULL;
        qc_distortion *d = NULL;
        qc_reduce_options reduce = QC_REDUCE_OPTIONS_INIT;
        reduce.create = 1;
        reduce.evaluations = 200;
        assert_int_equal(
            qc_sizing_create(ctx, f->mesh, sqrt(f->mesh->area / 3000), 0, NULL, &sizing), QC_OK);
        assert_int_equal(qc_distortion_create(ctx, m, sizing, 0.9, &d), QC_OK);
        for (int32_t e = 0; e < f->mesh->n_edges; e++)
            if (f->vertex[f->mesh->edge_vertex[2 * e]] ||
                f->vertex[f->mesh->edge_vertex[2 * e + 1]])
                assert_false(qc_distortion_can_flip(d, e));
        qc_distortion_state before, after;
        qc_distortion_get_state(d, &before);
        assert_int_equal(qc_distortion_cancel(ctx, d, NULL, NULL), QC_OK);
        assert_int_equal(qc_distortion_reduce(ctx, d, &reduce), QC_OK);
        qc_distortion_get_state(d, &after);
        assert_true(after.energy <= before.energy);
        assert_int_equal(qc_distortion_matching(ctx, d, &out), QC_OK);
        check_matching(ctx, out);
        assert_true(count_branch_points(out) > 0 || strcmp(shapes[i].name, "cube") != 0);
        for (int32_t v = 0; v < f->mesh->n_vertices; v++)
            if (f->vertex[v]) assert_int_equal(out->index4[v], m->index4[v]);
        qc_distortion_free(d);
        const void *made[] = {out, m, sizing, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
    }
}

/* A wedge of 20 degrees: the straightest matching gives its tip k = 0; one quarter turn is made,
 * the surplus is a cone inside. */
static void sharp_tips_get_a_quarter_turn(void **state) {
    qc_ctx *ctx = *state;
    enum { N = 12 };
    double p[3 * (N + 1) * (N + 2) / 2];
    int32_t t[3 * N * N], n = 0, f = 0;
    for (int i = 0; i <= N; i++)
        for (int j = 0; j <= i; j++) {
            const double a = (i ? (double)j / i - 0.5 : 0) * 20 * PI / 180;
            p[n++] = i * cos(a);
            p[n++] = i * sin(a);
            p[n++] = 0;
        }
    for (int i = 0; i < N; i++)
        for (int j = 0; j <= i; j++) {
            const int a = i * (i + 1) / 2 + j, b = (i + 1) * (i + 2) / 2 + j;
            const int32_t up[3] = {a, b, b + 1}, down[3] = {a, b + 1, a + 1};
            memcpy(t + 3 * f++, up, sizeof up);
            if (j < i) memcpy(t + 3 * f++, down, sizeof down);
        }
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, n / 3, p, f, t, &mesh), QC_OK);
    qc_features *features = hard_features(ctx, mesh);
    qc_matching *m = hard_matching(ctx, features);
    check_matching(ctx, m);
    int32_t cones = 0;
    for (int32_t v = 0; v < features->mesh->n_vertices; v++) cones += m->index4[v];
    assert_int_equal(cones, 1); /* three corners of one quarter turn each, chi = 1 */
    qc_object_release(m);
    qc_object_release(features);
}

/* Random crosses, aligned only: sectors open under any matching. */
static void sectors_open_in_random_fields(void **state) {
    qc_ctx *ctx = *state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        qc_features *f = hard_features(ctx, shape(ctx, "cube", 300, 1));
        const size_t F = (size_t)f->mesh->n_faces;
        qc_complex *x = random_crosses(f->mesh, seed);
        double *weight = calloc(F, sizeof *weight);
        uint8_t *trusted = calloc(F, 1);
        qc_face_field *field = NULL;
        qc_matching *m = NULL;
        assert_int_equal(
            qc_field_align(ctx, f->mesh, f->edge, (double)INFINITY, x, weight, trusted), QC_OK);
        assert_int_equal(qc_face_field_create(ctx, f->mesh, x, weight, trusted, &field), QC_OK);
        assert_int_equal(qc_face_field_set_aligned(ctx, field, f->edge, 0), QC_OK);
        assert_int_equal(qc_matching_create(ctx, field, NULL, &m), QC_OK);
        check_matching(ctx, m);
        const void *made[] = {m, field, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
        free(x);
        free(weight);
        free(trusted);
    }
}

/* The mesh times 1e6 or 1e-6 has the same faces, crosses and indices; one thread the same bytes. */
static void scale_and_threads_do_not_matter(void **state) {
    (void)state;
    const double scale[] = {1, 1e-6, 1e6, 1};
    qc_matching *m[4] = {NULL};
    qc_ctx *ctx[4] = {NULL};
    for (int i = 0; i < 4; i++) {
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = i == 3 ? 1 : 3;
        assert_int_equal(qc_ctx_create(&options, &ctx[i]), QC_OK);
        qc_features *f = hard_features(ctx[i], shape(ctx[i], "truncated-cone", 600, scale[i]));
        m[i] = hard_matching(ctx[i], f);
        qc_object_release(f);
    }
    const qc_mesh *mesh = m[0]->field->mesh;
    for (int i = 1; i < 4; i++) {
        const qc_mesh *other = m[i]->field->mesh;
        assert_int_equal(mesh->n_faces, other->n_faces);
        assert_memory_equal(mesh->face_vertex, other->face_vertex, 12 * (size_t)mesh->n_faces);
        for (int32_t t = 0; t < mesh->n_faces; t++)
            assert_true(cross_angle(m[0]->field->x[t], m[i]->field->x[t]) < 1e-6);
        assert_memory_equal(m[0]->index4, m[i]->index4, 4 * (size_t)mesh->n_vertices);
    }
    assert_memory_equal(m[0]->m, m[3]->m, (size_t)mesh->n_edges);
    assert_memory_equal(m[0]->field->x, m[3]->field->x, sizeof(qc_complex) * (size_t)mesh->n_faces);
    for (int i = 0; i < 4; i++) {
        qc_object_release(m[i]);
        qc_ctx_free(ctx[i]);
    }
}

/* From the features to a refined matching, and a given field beside it. */
static qc_status every_step(qc_ctx *ctx, const void *data) {
    const qc_mesh *mesh = data;
    qc_complex x[256];
    double weight[256] = {0};
    uint8_t trusted[256] = {0};
    qc_mesh *fine = NULL, *finer = NULL;
    qc_features *found = NULL, *hard = NULL, *f = NULL;
    qc_sizing *sizing = NULL, *s = NULL, *t = NULL;
    qc_face_field *field = NULL, *given = NULL;
    qc_matching *m = NULL, *split = NULL;
    qc_status status = qc_features_detect(ctx, mesh, 0.5, 0, NULL, &found);
    if (!status) status = qc_features_create(ctx, mesh, found->edge, true, &hard);
    if (!status) status = qc_sizing_create(ctx, mesh, 0.5, 0, NULL, &sizing);
    if (!status) status = qc_features_split(ctx, hard, sizing, &fine, &f, &s);
    for (int i = 0; i < 256; i++) x[i] = (qc_complex){1, 0.1 * i};
    assert_true(status || fine->n_faces <= 256);
    if (!status) status = qc_field_align(ctx, fine, f->edge, (double)INFINITY, x, weight, trusted);
    if (!status) status = qc_field_smoothest(ctx, fine, weight, trusted, 1, 0.2, x);
    if (!status) status = qc_field_smooth(ctx, fine, NULL, weight, trusted, f->edge, 0, 0.5, 3, x);
    if (!status) status = qc_field_separate(ctx, fine, 0.2, f->edge, trusted, x, NULL);
    if (!status) status = qc_face_field_create(ctx, fine, x, weight, trusted, &field);
    if (!status) status = qc_face_field_set_aligned(ctx, field, f->edge, 0);
    if (!status) status = qc_field_follow(ctx, field, f->edge, 0.1, &given);
    if (!status) status = qc_matching_create(ctx, field, NULL, &m);
    if (!status) status = qc_matching_split(ctx, m, s, &finer, &t, &split);
    const void *made[] = {split, m, given, field, t, s, sizing, finer, fine, f, hard, found};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) qc_object_release(made[i]);
    return status;
}

static void failed_allocations_leave_nothing(void **state) {
    qc_ctx *ctx = *state;
    const double p[] = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
    const int32_t t[] = {0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, 4, p, 4, t, &mesh), QC_OK);
    fail_every_allocation(every_step, mesh);
    qc_object_release(mesh);
}

/* Sectors of each kind on a plane of 30 x 30 unit squares with one path of n edges in directions
 * 0..3 (right, up, left, down): how many want k quarter turns. */
static void count_corners(qc_ctx *ctx, int x, int y, int n, const int *way, double bend,
                          int count[5]) {
    enum { N = 30 };
    static const int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
    double p[3 * (N + 1) * (N + 1)] = {0};
    int32_t t[6 * N * N];
    for (int i = 0; i < (N + 1) * (N + 1); i++) p[3 * i] = i % (N + 1), p[3 * i + 1] = i / (N + 1);
    for (int i = 0; i < N * N; i++) {
        const int32_t a = i / N * (N + 1) + i % N;
        const int32_t face[6] = {a, a + 1, a + N + 2, a, a + N + 2, a + N + 1};
        memcpy(t + 6 * i, face, sizeof face);
    }
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, (N + 1) * (N + 1), p, 2 * N * N, t, &mesh), QC_OK);
    uint8_t *edge = calloc((size_t)mesh->n_edges, 1);
    double *theta = calloc((size_t)mesh->n_edges, sizeof *theta);
    qc_complex *tangent = malloc(3 * (size_t)mesh->n_faces * sizeof *tangent);
    for (int i = 0; i < n; i++) {
        const int32_t a = y * (N + 1) + x, b = a + dy[way[i]] * (N + 1) + dx[way[i]];
        for (int32_t e = 0; e < mesh->n_edges; e++)
            edge[e] |= (mesh->edge_vertex[2 * e] == a && mesh->edge_vertex[2 * e + 1] == b) ||
                       (mesh->edge_vertex[2 * e] == b && mesh->edge_vertex[2 * e + 1] == a);
        x += dx[way[i]];
        y += dy[way[i]];
    }
    qc__sectors all = {0, NULL};
    assert_int_equal(qc_tangent_edges(ctx, mesh, tangent), QC_OK);
    assert_int_equal(qc__sectors_create(ctx, mesh, edge, tangent, theta, &all), QC_OK);
    assert_int_equal(all.n, 2 * n);
    assert_int_equal(qc__sectors_find_corners(ctx, mesh, tangent, bend, &all), QC_OK);
    for (int k = 0; k < 5; k++) count[k] = 0;
    for (int32_t i = 0; i < all.n; i++) {
        assert_in_range(all.sector[i].wanted, 1, 4);
        count[all.sector[i].wanted]++;
    }
    qc__sectors_free(&all);
    free(edge);
    free(theta);
    free(tangent);
    qc_object_release(mesh);
}

/* Stairs of single edges are straight when seen over four, a bend has one corner on either side;
 * both free ends have four quarters. */
static void corners_follow_the_direction(void **state) {
    int stairs[18], bent[20], count[5];
    for (int i = 0; i < 18; i++) stairs[i] = i % 2;
    count_corners(*state, 5, 5, 18, stairs, 0.5, count);
    assert_true(count[1] == 17 && count[3] == 17 && count[4] == 2);
    count_corners(*state, 5, 5, 18, stairs, 4, count);
    assert_true(count[1] == 0 && count[2] == 34 && count[3] == 0 && count[4] == 2);
    for (int i = 0; i < 20; i++) bent[i] = i >= 10;
    count_corners(*state, 5, 5, 20, bent, 4, count);
    assert_true(count[1] == 1 && count[2] == 36 && count[3] == 1 && count[4] == 2);
}

/* A plane with a field along its sides, but for 5 degrees: all features stay and the crosses beside
 * them are turned; at 30 degrees none stays. */
static void given_fields_follow_what_they_agree_with(void **state) {
    qc_ctx *ctx = *state;
    const double off[] = {5 * PI / 180, 30 * PI / 180};
    for (int i = 0; i < 2; i++) {
        qc_features *f = hard_features(ctx, grid(ctx, PLANE, 7, 5, 1));
        const qc_mesh *mesh = f->mesh;
        const size_t F = (size_t)mesh->n_faces;
        double *re = malloc(6 * F * sizeof *re), *im = re + 3 * F;
        qc_complex *x = malloc(F * sizeof *x);
        const double along[3] = {cos(off[i]), sin(off[i]), 0};
        assert_int_equal(qc_tangent_frames(ctx, mesh, re, im), QC_OK);
        for (size_t t = 0; t < F; t++) x[t] = in_frame(re, im, t, along);
        qc_face_field *field = NULL, *out = NULL;
        assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
        assert_int_equal(qc_field_follow(ctx, field, f->edge, 15 * PI / 180, &out), QC_OK);
        int32_t kept = 0;
        for (int32_t e = 0; e < mesh->n_edges; e++) kept += out->aligned[e];
        assert_int_equal(kept, i == 0 ? f->n_feature_edges : 0);
        check_along(ctx, mesh, out->aligned, out->x);
        qc_matching *m = NULL;
        assert_int_equal(qc_matching_create(ctx, out, NULL, &m), QC_OK);
        if (i == 0) check_matching(ctx, m);
        const void *made[] = {m, out, field, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
        free(re);
        free(x);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_get_room),
        cmocka_unit_test(spikes_get_more_edges),
        cmocka_unit_test(only_hard_features_split),
        cmocka_unit_test(corners_follow_the_direction),
        cmocka_unit_test(crosses_stay_on_features),
        cmocka_unit_test(branch_points_move_elsewhere),
        cmocka_unit_test(sharp_tips_get_a_quarter_turn),
        cmocka_unit_test(sectors_open_in_random_fields),
        cmocka_unit_test(scale_and_threads_do_not_matter),
        cmocka_unit_test(failed_allocations_leave_nothing),
        cmocka_unit_test(given_fields_follow_what_they_agree_with),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
