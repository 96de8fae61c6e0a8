/* Shortest paths and cut graphs: every component minus the cut is a disk which the base vertices
 * lie on, and the number of paths is that of the theory. */
#include "sdk/mesh/internal.h"
#include "unit/mesh/fixtures.h"

/* Corners of the mesh cut open are the classes of corners joined across uncut edges: chi per
 * component = vertices - edges + faces of the open mesh. */
static void check_disks(const qc_mesh *m, const uint8_t *cut, const int32_t *expected) {
    int32_t n = 3 * m->n_faces, *set = malloc((size_t)n * sizeof *set);
    int32_t *face = malloc((size_t)m->n_faces * sizeof *face);
    int32_t *chi = calloc((size_t)m->n_components, sizeof *chi), parts = 0;
    qc__sets_init(set, n);
    qc__sets_init(face, m->n_faces);
    for (int32_t e = 0; e < m->n_edges; e++) {
        int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        int32_t c = m->face_component[h / 3];
        assert_true(k >= 0 || !cut[e]);
        chi[c] -= cut[e] ? 2 : 1;
        if (k < 0 || cut[e]) continue;
        qc__sets_unite(set, qc_next(h), qc_prev(k));
        qc__sets_unite(set, qc_prev(h), qc_next(k));
        qc__sets_unite(face, h / 3, k / 3);
    }
    for (int32_t c = 0; c < n; c++) chi[m->face_component[c / 3]] += set[c] == c;
    for (int32_t f = 0; f < m->n_faces; f++) {
        chi[m->face_component[f]]++;
        parts += face[f] == f;
    }
    assert_int_equal(parts, m->n_components);
    for (int32_t i = 0; i < m->n_components; i++)
        assert_int_equal(chi[i], expected ? expected[i] : 1);
    free(set);
    free(face);
    free(chi);
}

/* Each base vertex is on the graph; every other end of the graph lies on the boundary. The first
 * Betti number of graph + boundary, base points identified, is the number of paths. */
static void check_graph(const qc_mesh *m, const uint8_t *cut, const uint8_t *base, int paths) {
    int32_t *degree = calloc((size_t)m->n_vertices, sizeof *degree), edges = 0, inner = 0;
    for (int32_t e = 0; e < m->n_edges; e++) {
        edges += cut[e];
        degree[m->edge_vertex[2 * e]] += cut[e];
        degree[m->edge_vertex[2 * e + 1]] += cut[e];
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        bool root = base[v] || qc_vertex_on_boundary(m, v);
        if (base[v] && paths > 0) assert_true(degree[v] > 0 || qc_vertex_on_boundary(m, v));
        if (!root) assert_true(degree[v] != 1);
        inner += !root && degree[v] > 0;
    }
    assert_int_equal(edges - inner, paths);
    free(degree);
}

static void check(qc_ctx *ctx, qc_mesh *m, int n_base, const double *weight) {
    uint8_t *base = calloc((size_t)m->n_vertices, 1), *cut = malloc((size_t)m->n_edges);
    int32_t inner = 0;
    for (int i = 0; i < n_base; i++) base[(i * 37 + 5) % m->n_vertices] = 1;
    for (int32_t v = 0; v < m->n_vertices; v++) inner += base[v] && !qc_vertex_on_boundary(m, v);
    assert_int_equal(qc_mesh_cut_graph(ctx, m, weight, base, cut), QC_OK);
    check_disks(m, cut, NULL);
    int paths = 2 * m->genus + m->n_boundary_loops + inner - 1;
    if (m->n_boundary_loops == 0 && inner == 0) {
        base[0] = 1; /* documented: the lowest vertex becomes the base */
        paths++;
    }
    check_graph(m, cut, base, paths);
    free(base);
    free(cut);
}

static void check_all(qc_ctx *ctx, qc_mesh *m, int least) {
    double *weight = malloc((size_t)m->n_edges * sizeof *weight);
    for (int32_t e = 0; e < m->n_edges; e++) weight[e] = 1 + e * 7 % 5;
    for (int n_base = least; n_base < 6; n_base++) {
        check(ctx, m, n_base, NULL);
        check(ctx, m, n_base, weight);
    }
    for (int32_t e = 0; e < m->n_edges; e++) weight[e] = 1; /* ties everywhere */
    check(ctx, m, 7, weight);
    free(weight);
    qc_object_release(m);
}

static void test_disks(void **state) {
    check_all(*state, grid(*state, 12, 9, 0, 1), 0);
    check_all(*state, grid(*state, 12, 9, 1, 1), 0);
    check_all(*state, grid(*state, 12, 9, 3, 1), 0);
    check_all(*state, voxels(*state, 3, 3, 3, "###########################", 1), 2);
    for (int genus = 1; genus < 5; genus++) check_all(*state, plate(*state, genus, 1), 0);
}

static void test_sphere_without_bases(void **state) {
    qc_mesh *m = voxels(*state, 3, 1, 1, "#.#", 1);
    uint8_t *cut = malloc((size_t)m->n_edges), base[64] = {0};
    for (int n = 0; n < 2; n++) {
        base[0] = (uint8_t)n;
        assert_int_equal(qc_mesh_cut_graph(*state, m, NULL, base, cut), QC_OK);
        for (int32_t e = 0; e < m->n_edges; e++) assert_int_equal(cut[e], 0);
        check_disks(m, cut, (int32_t[]){2, 2});
    }
    assert_int_equal(qc_mesh_cut_graph(*state, m, NULL, NULL, cut), QC_OK);
    free(cut);
    qc_object_release(m);
}

static void test_several_components(void **state) {
    qc_mesh *m = voxels(*state, 3, 3, 4,
                        "####.####" /* a ring, a gap, a block with a pit */
                        "........."
                        "#########"
                        "####.####",
                        1);
    assert_int_equal(m->n_components, 2);
    uint8_t *cut = malloc((size_t)m->n_edges), *base = calloc((size_t)m->n_vertices, 1);
    for (int32_t c = 0; c < 2; c++) {
        int given = 0;
        for (int32_t v = 0; v < m->n_vertices && given < 2; v++)
            if (m->face_component[m->vertex_corner[v] / 3] == c) given += base[v] = 1;
    }
    assert_int_equal(qc_mesh_cut_graph(*state, m, NULL, base, cut), QC_OK);
    check_disks(m, cut, NULL);
    free(cut);
    free(base);
    qc_object_release(m);
}

/* A cut graph of a torus with one base is not longer than twice its systole pair. */
static void test_short(void **state) {
    qc_mesh *m = grid(*state, 30, 15, 3, 1);
    uint8_t *cut = malloc((size_t)m->n_edges), *base = calloc((size_t)m->n_vertices, 1);
    double *length = malloc((size_t)m->n_edges * sizeof *length), total = 0;
    base[7] = 1; /* on the inner equator, radius 1 */
    assert_int_equal(qc_mesh_cut_graph(*state, m, NULL, base, cut), QC_OK);
    qc_mesh_geometry(*state, m, length, NULL, NULL, NULL, NULL, NULL);
    for (int32_t e = 0; e < m->n_edges; e++) total += cut[e] ? length[e] : 0;
    assert_true(total > 12 && total < 4 * PI * 1.03);
    free(cut);
    free(base);
    free(length);
    qc_object_release(m);
}

static void test_shortest_paths(void **state) {
    qc_mesh *m = grid(*state, 20, 10, 0, 1);
    double *d = malloc((size_t)m->n_vertices * sizeof *d);
    double *length = malloc((size_t)m->n_edges * sizeof *length);
    int32_t *p = malloc((size_t)m->n_vertices * sizeof *p);
    uint8_t *source = calloc((size_t)m->n_vertices, 1);
    source[0] = source[100] = 1;
    assert_int_equal(qc_mesh_shortest_paths(*state, m, NULL, source, d, p), QC_OK);
    qc_mesh_geometry(*state, m, length, NULL, NULL, NULL, NULL, NULL);
    for (int32_t e = 0; e < m->n_edges; e++) { /* the distance is 1-Lipschitz along edges */
        double gap = d[m->edge_vertex[2 * e]] - d[m->edge_vertex[2 * e + 1]];
        assert_true(fabs(gap) <= length[e] * (1 + 1e-12));
    }
    for (int32_t v = 0; v < m->n_vertices; v++) { /* and attained along the predecessor */
        assert_int_equal(p[v] < 0, source[v]);
        if (p[v] < 0) continue;
        int32_t w = m->edge_vertex[2 * p[v]] + m->edge_vertex[2 * p[v] + 1] - v;
        assert_near(d[v], d[w] + length[p[v]], 1e-15);
    }
    memset(source, 0, (size_t)m->n_vertices);
    assert_int_equal(qc_mesh_shortest_paths(*state, m, NULL, source, d, NULL), QC_OK);
    assert_true(isinf(d[3]));
    length[4] = 0;
    assert_int_equal(qc_mesh_shortest_paths(*state, m, length, source, d, p), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 4);
    free(d);
    free(length);
    free(p);
    free(source);
    qc_object_release(m);
}

static bool refuse(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return false;
}

static void test_cancel(void **state) {
    (void)state;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *calm = NULL, *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &calm), QC_OK);
    qc_mesh *m = grid(calm, 20, 10, 3, 1);
    qc_ctx_free(calm);
    options.progress = refuse;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    uint8_t *cut = malloc((size_t)m->n_edges);
    memset(cut, 9, (size_t)m->n_edges);
    assert_int_equal(qc_mesh_cut_graph(ctx, m, NULL, NULL, cut), QC_ERR_CANCELLED);
    assert_int_equal(cut[0], 9);
    free(cut);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_disks),
        cmocka_unit_test(test_sphere_without_bases),
        cmocka_unit_test(test_several_components),
        cmocka_unit_test(test_short),
        cmocka_unit_test(test_shortest_paths),
        cmocka_unit_test(test_cancel),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
