/* Features and boundaries are kept: before finishing and after, every hard feature is a chain of
 * quad edges whose ends lie on it, and every boundary loop a loop of boundary edges; finishing
 * moves no vertex which lies at a corner of the features. */
#include "kept.h"

/* Cosine of 45 degrees: two edges which turn by more are a corner. */
static const double corner_cosine = 0.70710678118654752;

/* The boundary of the mesh as it was given against that of the quads. */
static void check_boundary(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup) {
    const qc_mesh *mesh = run_seen.last->mesh;
    qc_polygon_topology before, after;
    int32_t n = 0, *line = cover_boundary(run_seen.quads, &n);
    uint8_t *edge = calloc((size_t)mesh->n_edges, 1);
    for (int32_t e = 0; e < mesh->n_edges; e++) edge[e] = mesh->edge_halfedge[2 * e + 1] < 0;
    assert_int_equal(qc_polygon_mesh_topology(ctx, soup, &before), QC_OK);
    assert_int_equal(qc_polygon_mesh_topology(ctx, run_seen.quads, &after), QC_OK);
    golden_equal(name, "boundary loops", after.boundary_loops, before.boundary_loops);
    assert_true(before.boundary_loops > 0);
    check_cover(name, edge, line, n);
    free(edge);
    free(line);
}

static qc_polygon_mesh *model(qc_ctx *ctx, const char *name) {
    char path[TEST_DATA_PATH], file[64];
    qc_polygon_mesh *soup = NULL;
    snprintf(file, sizeof file, "meshes/%s", name);
    assert_int_equal(qc_polygon_mesh_read(ctx, test_data(file, path), &soup), QC_OK);
    return soup;
}

/* What the others rely on: a missing line and a vertex beside its feature break a chain. */
static void check_measure(void) {
    const qc_polygon_mesh *quads = run_seen.quads;
    const qc_features *f = run_seen.last;
    const double near = NEAR * f->mesh->diagonal;
    const int32_t n = quads->n_lines;
    double *x = quads->position + 3 * (size_t)quads->line[0];
    assert_int_equal(cover_measure(f->mesh, f->edge, quads, quads->line, n - 1, near).n_broken, 1);
    for (int k = 0; k < 3; k++) x[k] *= 1 + 1e-4;
    const cover moved = cover_measure(f->mesh, f->edge, quads, quads->line, n, near);
    for (int k = 0; k < 3; k++) x[k] /= 1 + 1e-4;
    assert_true(moved.n_broken > 0 && moved.n_used < n);
}

static void shapes_keep_features(void **state) {
    (void)state;
    static const char *const name[] = {"cube", "cylinder", "truncated-cone"};
    for (int i = 0; i < 6; i++) {
        qc_ctx *ctx = begin(0);
        qc_polygon_mesh *soup = shape(ctx, name[i / 2], 3000);
        remesh(ctx, name[i / 2], soup, i % 2 ? 3000 : 1000);
        const cover c = check_features(name[i / 2]);
        assert_int_equal(run_seen.n_warnings, 0);
        if (i < 2) {
            assert_true(c.sagitta <= NEAR * run_seen.last->mesh->diagonal);
            check_measure();
        }
        end(ctx, soup);
    }
}

static void models_keep_features(void **state) {
    (void)state;
    static const char *const name[] = {"fandisk.off", "botijo.obj"};
    if (test_data_missing()) skip();
    for (int i = 0; i < 4; i++) {
        qc_ctx *ctx = begin(0);
        qc_polygon_mesh *soup = model(ctx, name[i / 2]);
        remesh(ctx, name[i / 2], soup, i % 2 ? 3000 : 1000);
        check_features(name[i / 2]);
        assert_int_equal(run_seen.n_warnings, 0);
        end(ctx, soup);
    }
}

static void boundaries_are_kept(void **state) {
    (void)state;
    static const char *const name[] = {"planexy.off", "beetle.off", "camelhead.off",
                                       "stanford-bunny.obj"};
    if (test_data_missing()) skip();
    for (int i = 0; i < 4; i++) {
        qc_ctx *ctx = begin(0);
        qc_polygon_mesh *soup = model(ctx, name[i]);
        remesh(ctx, name[i], soup, i == 3 ? 3000 : 1000);
        check_features(name[i]);
        check_boundary(ctx, name[i], soup);
        end(ctx, soup);
    }
}

/* For each vertex of the mesh whether its features end, branch or turn there. */
static uint8_t *find_corners(const qc_features *f) {
    const qc_mesh *m = f->mesh;
    uint8_t *corner = calloc((size_t)m->n_vertices, 1);
    double(*first)[3] = calloc((size_t)m->n_vertices, sizeof *first);
    for (int32_t v = 0; v < m->n_vertices; v++) corner[v] = f->vertex[v] != 0 && f->vertex[v] != 2;
    for (int32_t i = 0; i < 2 * m->n_edges; i++) {
        const int32_t v = m->edge_vertex[i], w = m->edge_vertex[i ^ 1];
        double d[3], dot = 0, length[2] = {0, 0};
        if (!f->edge[i / 2]) continue;
        for (int k = 0; k < 3; k++) {
            d[k] = m->position[3 * w + k] - m->position[3 * v + k];
            dot -= d[k] * first[v][k];
            length[0] += d[k] * d[k];
            length[1] += first[v][k] * first[v][k];
        }
        if (length[1] == 0)
            memcpy(first[v], d, sizeof d);
        else if (dot < corner_cosine * sqrt(length[0] * length[1]))
            corner[v] = 1;
    }
    free(first);
    return corner;
}

static double apart(const double *a, const double *b) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Vertices of the quads before finishing which lie at corners are where they were; how many. */
static int check_corners(const qc_polygon_mesh *before) {
    const qc_mesh *m = run_seen.last->mesh;
    const qc_polygon_mesh *after = run_seen.quads;
    uint8_t *corner = find_corners(run_seen.last);
    int n = 0;
    assert_int_equal(after->n_vertices, before->n_vertices);
    assert_memory_equal(after->face_vertex, before->face_vertex, 4 * (size_t)after->n_corners);
    for (int32_t c = 0; c < m->n_vertices; c++)
        for (int32_t v = 0; corner[c] && v < before->n_vertices; v++) {
            const double *x = before->position + 3 * v;
            if (apart(x, m->position + 3 * c) > NEAR * m->diagonal) continue;
            assert_true(apart(after->position + 3 * v, x) == 0);
            n++;
        }
    free(corner);
    return n;
}

static int32_t count_moved(const qc_polygon_mesh *before) {
    int32_t n = 0;
    for (int32_t v = 0; v < before->n_vertices; v++)
        n += apart(before->position + 3 * v, run_seen.quads->position + 3 * v) > 0;
    return n;
}

/* Returns how many vertices finishing moves. */
static int32_t check_finished(const char *name, qc_ctx *ctx, qc_polygon_mesh *soup,
                              int32_t corners) {
    remesh(ctx, name, soup, 1000);
    qc_polygon_mesh *before = (void *)(uintptr_t)qc_object_retain(run_seen.quads);
    forget();
    remesh_to(ctx, name, soup, 1000, "qc.finish");
    check_features(name);
    golden_equal(name, "vertices at corners", check_corners(before), corners);
    const int32_t moved = count_moved(before);
    qc_object_release(before);
    end(ctx, soup);
    return moved;
}

static void finished_quads_keep_features(void **state) {
    (void)state;
    static const char *const name[] = {"cube", "cylinder", "truncated-cone"};
    static const int32_t corners[] = {8, 0, 0};
    for (int i = 0; i < 3; i++) {
        qc_ctx *ctx = begin(0);
        check_finished(name[i], ctx, shape(ctx, name[i], 3000), corners[i]);
    }
    if (test_data_missing()) skip();
    for (int i = 0; i < 2; i++) {
        static const char *const file[] = {"fandisk.off", "botijo.obj"};
        static const int32_t at_corners[] = {26, 4};
        qc_ctx *ctx = begin(0);
        assert_true(check_finished(file[i], ctx, model(ctx, file[i]), at_corners[i]) > 100);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_keep_features),
        cmocka_unit_test(models_keep_features),
        cmocka_unit_test(boundaries_are_kept),
        cmocka_unit_test(finished_quads_keep_features),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
