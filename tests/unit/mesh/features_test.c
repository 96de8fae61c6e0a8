/* Creases, boundaries and strokes. */
#include "unit/mesh/fixtures.h"

static void test_cube(void **state) {
    qc_mesh *m = voxels(*state, 2, 2, 2, "########", 1);
    qc_features *f = NULL;
    assert_int_equal(qc_features_detect(*state, m, 35 * PI / 180, 0, NULL, &f), QC_OK);
    qc_object_release(m); /* the features keep it alive */
    assert_int_equal(f->n_feature_edges, 24);
    assert_int_equal(f->n_creases, 24);
    assert_int_equal(f->n_corners, 8);
    for (int32_t e = 0; e < f->mesh->n_edges; e++)
        assert_int_equal(f->vertex[f->mesh->edge_vertex[2 * e]] > 0 || !f->edge[e], 1);
    qc_object_release(f);
    m = voxels(*state, 2, 2, 2, "########", 1);
    assert_int_equal(qc_features_detect(*state, m, 1.6, 0, NULL, &f), QC_OK);
    assert_int_equal(f->n_feature_edges, 0);
    qc_object_release(f);
    qc_object_release(m);
}

static int32_t warnings, ignored;
static void count_messages(void *user, int32_t level, const char *stage, const char *text) {
    (void)user, (void)stage;
    warnings += level == QC_LOG_WARNING;
    ignored += strstr(text, "ignored") != NULL;
}

static qc_ctx *listening(void) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.log = count_messages;
    qc_ctx *ctx = NULL;
    warnings = ignored = 0;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

static int32_t count(const qc_mesh *m, const uint8_t *edge) {
    int32_t n = 0;
    for (int32_t e = 0; e < m->n_edges; e++) n += edge[e] != 0;
    return n;
}

static uint8_t *boundary_flags(const qc_mesh *m) {
    uint8_t *edge = calloc((size_t)m->n_edges, 1);
    for (int32_t e = 0; e < m->n_edges; e++)
        if (m->edge_halfedge[2 * e + 1] < 0) edge[e] = QC_FEATURE_BOUNDARY;
    return edge;
}

static void test_boundary_and_lines(void **state) {
    (void)state;
    qc_ctx *ctx = listening();
    qc_mesh *m = grid(ctx, 6, 4, 0, 1);
    qc_features *f = NULL;
    /* 5 vertices per column; interior edges (6, 7), (7, 8); one vertex which is none */
    int32_t lines[] = {6, 7, 8, 7, 3, 99};
    assert_int_equal(qc_features_detect(ctx, m, 0.5, 3, lines, &f), QC_OK);
    assert_int_equal(f->n_creases, 0);
    assert_int_equal(f->n_feature_edges, 20 + 2);
    assert_int_equal(f->n_corners, 2); /* 6 and 8, the ends of the stroke */
    assert_int_equal(ignored, 1);
    assert_false(f->hard);
    qc_object_release(f);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

/* A stroke above a plane of 20 x 20 cells becomes the row of edges below it, at any scale; what is
 * far away is ignored. */
static void test_strokes(void **state) {
    (void)state;
    const double scale[] = {1, 1e-6, 1e6};
    for (int i = 0; i < 3; i++) {
        qc_ctx *ctx = listening();
        qc_mesh *m = grid(ctx, 20, 20, 0, scale[i]);
        uint8_t *edge = calloc((size_t)m->n_edges, 1);
        const double *p = m->position; /* 21 vertices per column */
        double point[12];
        for (int k = 0; k < 3; k++) {
            const double lift = k == 2 ? 0.1 * m->mean_edge_length : 0;
            point[k] = p[3 * (21 * 5 + 3) + k] + lift;
            point[3 + k] = p[3 * (21 * 5 + 17) + k] + lift;
            point[6 + k] = p[3 * (21 * 14 + 17) + k] + lift;
            point[9 + k] = p[k] + (k == 2 ? 9 * m->mean_edge_length : 0);
        }
        const int32_t segment[] = {0, 1, 1, 2, 2, 3, 2, 7};
        assert_int_equal(
            qc_features_add_strokes(ctx, m, 4, point, 4, segment, m->mean_edge_length, edge),
            QC_OK);
        assert_int_equal(count(m, edge), 14 + 9);
        assert_int_equal(ignored, 1);
        for (int32_t e = 0; e < m->n_edges; e++) {
            const int32_t v = m->edge_vertex[2 * e], w = m->edge_vertex[2 * e + 1];
            if (!edge[e]) continue;
            assert_int_equal(edge[e], QC_FEATURE_LINE);
            assert_true((v / 21 == 5 && w / 21 == 5) || (v % 21 == 17 && w % 21 == 17));
        }
        free(edge);
        qc_object_release(m);
        qc_ctx_free(ctx);
    }
}

static void test_groups(void **state) {
    qc_mesh *m = grid(*state, 6, 4, 0, 1);
    uint8_t *edge = calloc((size_t)m->n_edges, 1);
    int32_t *group = calloc((size_t)m->n_faces, sizeof *group);
    for (int32_t t = 0; t < m->n_faces; t++) group[t] = t >= m->n_faces / 2 ? 7 : 3;
    qc_features_add_groups(m, group, edge);
    assert_int_equal(count(m, edge), 4); /* across the columns */
    free(edge);
    free(group);
    qc_object_release(m);
}

static void prune(qc_ctx *ctx, const qc_mesh *m, qc_prune_options options, uint8_t *edge) {
    options.struct_size = sizeof options;
    assert_int_equal(qc_features_prune(ctx, m, &options, edge), QC_OK);
}

/* On a cube a scratch with a free end goes when it is shorter than asked for, and a missing piece
 * of an edge comes back. */
static void test_prune(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *m = voxels(ctx, 2, 2, 2, "########", 1);
    qc_features *f = NULL;
    assert_int_equal(qc_features_detect(ctx, m, 0.6, 0, NULL, &f), QC_OK);
    uint8_t *edge = malloc((size_t)m->n_edges);
    int32_t *chain = malloc((size_t)m->n_edges * sizeof *chain), n = 0, missing = -1, extra = -1;
    memcpy(edge, f->edge, (size_t)m->n_edges);
    assert_int_equal(qc_features_chains(ctx, m, edge, chain, &n), QC_OK);
    assert_int_equal(n, 12);
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t v = m->edge_vertex[2 * e], w = m->edge_vertex[2 * e + 1];
        assert_true((chain[e] >= 0) == (edge[e] != 0));
        if (edge[e] && missing < 0) missing = e;
        if (!edge[e] && (f->vertex[v] == 0) != (f->vertex[w] == 0)) extra = e;
    }
    assert_true(missing >= 0 && extra >= 0);
    edge[missing] = 0;
    edge[extra] = QC_FEATURE_CREASE;
    const double length = m->mean_edge_length;
    /* an older caller knows no `least`: none is the default */
    const qc_prune_options shorter = {
        .struct_size = offsetof(qc_prune_options, least), .weak = 0.4, .least = 2 * length};
    uint8_t *same = malloc((size_t)m->n_edges);
    memcpy(same, edge, (size_t)m->n_edges);
    assert_int_equal(qc_features_prune(ctx, m, &shorter, same), QC_OK);
    assert_true(same[missing] == QC_FEATURE_CREASE && same[extra] == QC_FEATURE_CREASE);
    same[missing] = 0;
    assert_int_equal(qc_features_prune(ctx, m, NULL, same), QC_OK);
    assert_true(same[missing] == QC_FEATURE_CREASE && same[extra] == 0); /* flat, hence blunt */
    free(same);
    prune(ctx, m, (qc_prune_options){.weak = 0.4, .least = 0.1 * length}, edge);
    assert_int_equal(edge[missing], QC_FEATURE_CREASE);
    assert_int_equal(edge[extra], QC_FEATURE_CREASE);
    prune(ctx, m, (qc_prune_options){.weak = 0.4, .least = 2 * length}, edge);
    assert_memory_equal(edge, f->edge, (size_t)m->n_edges);
    /* longer than all edges: only what has a free end goes */
    prune(ctx, m, (qc_prune_options){.weak = 0.4, .least = 1e9}, edge);
    assert_memory_equal(edge, f->edge, (size_t)m->n_edges);
    free(edge);
    free(chain);
    qc_object_release(f);
    qc_object_release(m);
}

/* Two sides of a face which meet in 45 degrees become the third; strokes stay as drawn. */
static void test_zigzag(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *m = grid(ctx, 6, 4, 0, 1);
    double *angle = malloc(3 * (size_t)m->n_faces * sizeof *angle);
    uint8_t *edge = calloc((size_t)m->n_edges, 1);
    int32_t c = 0;
    assert_int_equal(qc_mesh_geometry(ctx, m, NULL, NULL, NULL, angle, NULL, NULL), QC_OK);
    while (m->twin[c] < 0 || m->twin[qc_next(c)] < 0 || m->twin[qc_prev(c)] < 0 || angle[c] > 1)
        c++;
    const int32_t side[] = {m->halfedge_edge[qc_next(c)], m->halfedge_edge[qc_prev(c)]};
    edge[side[0]] = edge[side[1]] = QC_FEATURE_LINE;
    prune(ctx, m, (qc_prune_options){.weak = 1}, edge);
    assert_true(count(m, edge) == 2 && edge[side[0]] && edge[side[1]]);
    edge[side[0]] = edge[side[1]] = QC_FEATURE_CREASE;
    prune(ctx, m, (qc_prune_options){.weak = 1}, edge);
    assert_true(count(m, edge) == 1 && edge[m->halfedge_edge[c]] == QC_FEATURE_CREASE);
    free(angle);
    free(edge);
    qc_object_release(m);
}

/* A fan of 36 triangles: two strokes from its middle to the rim, 30 degrees apart. The boundary and
 * one stroke stay when 40 degrees are asked for, both for 20. */
static void test_sharp_features(void **state) {
    (void)state;
    enum { N = 36 };
    double p[3 * (2 * N + 1)] = {0};
    int32_t t[9 * N];
    for (int i = 0; i < N; i++) {
        const double a = 2 * PI * i / N;
        const int32_t b = 1 + i, c = 1 + (i + 1) % N;
        const int32_t face[9] = {0, b, c, b, b + N, c + N, b, c + N, c};
        for (int k = 0; k < 2; k++) {
            p[3 * (1 + i + N * k)] = (1 + k) * cos(a);
            p[3 * (1 + i + N * k) + 1] = (1 + k) * sin(a);
        }
        memcpy(t + 9 * i, face, sizeof face);
    }
    qc_ctx *ctx = listening();
    qc_mesh *m = NULL;
    assert_int_equal(qc_mesh_create(ctx, 2 * N + 1, p, 3 * N, t, &m), QC_OK);
    const int32_t stroke[] = {0, 1, 1, 1 + N, 0, 4, 4, 4 + N};
    uint8_t *edge = boundary_flags(m);
    assert_int_equal(
        qc_features_add_strokes(ctx, m, m->n_vertices, m->position, 4, stroke, 0, edge), QC_OK);
    assert_int_equal(count(m, edge), N + 4);
    prune(ctx, m, (qc_prune_options){.weak = 1, .sharp = 20 * PI / 180}, edge);
    assert_int_equal(count(m, edge), N + 4);
    assert_int_equal(warnings, 0);
    prune(ctx, m, (qc_prune_options){.weak = 1, .sharp = 40 * PI / 180}, edge);
    assert_int_equal(count(m, edge), N + 2);
    assert_int_equal(warnings, 1);
    free(edge);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

/* A plane of 24 x 24 unit squares, its vertices up to rough / 2 off, folded along its middle. */
static qc_mesh *rough_plane(qc_ctx *ctx, double rough, double fold) {
    enum { N = 24 };
    double p[3 * (N + 1) * (N + 1)];
    int32_t t[6 * N * N];
    uint32_t random = 1;
    for (int i = 0; i < (N + 1) * (N + 1); i++) {
        random = random * 1664525u + 1013904223u;
        const double noise = rough * ((random >> 8) / 16777216.0 - 0.5);
        p[3 * i] = cos(fold / 2) * (i % (N + 1) - N / 2);
        p[3 * i + 1] = i / (N + 1);
        p[3 * i + 2] = sin(fold / 2) * abs(i % (N + 1) - N / 2) + noise;
    }
    for (int i = 0; i < N * N; i++) {
        const int32_t a = i / N * (N + 1) + i % N;
        const int32_t face[6] = {a, a + 1, a + N + 2, a, a + N + 2, a + N + 1};
        memcpy(t + 6 * i, face, sizeof face);
    }
    qc_mesh *m = NULL;
    assert_int_equal(qc_mesh_create(ctx, (N + 1) * (N + 1), p, 2 * N * N, t, &m), QC_OK);
    return m;
}

/* Roughness has hundreds of sharp edges and no crease when seen from three edges away; a fold of 80
 * degrees in half of it stays, alone. */
static void test_scale(void **state) {
    qc_ctx *ctx = *state;
    const double degree = PI / 180;
    for (int folded = 0; folded < 2; folded++) {
        qc_mesh *m = rough_plane(ctx, folded ? 0.35 : 0.7, folded * 80 * degree);
        qc_features *f = NULL;
        assert_int_equal(qc_features_detect(ctx, m, 35 * degree, 0, NULL, &f), QC_OK);
        uint8_t *edge = malloc((size_t)m->n_edges);
        memcpy(edge, f->edge, (size_t)m->n_edges);
        assert_true(f->n_creases > (folded ? 20 : 200));
        prune(
            ctx, m,
            (qc_prune_options){.weak = 20 * degree, .half = 1.5, .blunt = 30 * degree, .least = 4},
            edge);
        int32_t kept = 0, along = 0;
        for (int32_t e = 0; e < m->n_edges; e++) {
            if (edge[e] != QC_FEATURE_CREASE) continue;
            kept++;
            along += m->edge_vertex[2 * e] % 25 == 12 && m->edge_vertex[2 * e + 1] % 25 == 12;
        }
        print_message("fold %d: %d creases, %d kept, %d along the fold\n", folded,
                      (int)f->n_creases, (int)kept, (int)along);
        assert_true(kept == along && (folded ? along == 24 : along == 0));
        free(edge);
        qc_object_release(f);
        qc_object_release(m);
    }
}

/* Chains of a cube measured: twelve of 90 degrees. */
static void test_chains(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *m = voxels(ctx, 2, 2, 2, "########", 1);
    qc_features *f = NULL;
    qc_feature_chain chain[12];
    assert_int_equal(qc_features_detect(ctx, m, 0.6, 0, NULL, &f), QC_OK);
    assert_int_equal(qc_features_measure_chains(ctx, m, f->edge, chain), QC_OK);
    for (int i = 0; i < 12; i++) {
        assert_int_equal(chain[i].n_edges, 2);
        assert_int_equal(chain[i].kinds, QC_FEATURE_CREASE);
        assert_true(fabs(chain[i].angle - PI / 2) < 1e-12 && chain[i].end[0] != chain[i].end[1]);
    }
    qc_object_release(f);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),           cmocka_unit_test(test_boundary_and_lines),
        cmocka_unit_test(test_strokes),        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_prune),          cmocka_unit_test(test_zigzag),
        cmocka_unit_test(test_sharp_features), cmocka_unit_test(test_scale),
        cmocka_unit_test(test_chains),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
