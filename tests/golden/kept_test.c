/* Features and boundaries are kept: before finishing, every hard feature is a chain of quad edges
 * whose ends lie on it, and every boundary loop a loop of boundary edges. */
#include "kept.h"

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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_keep_features),
        cmocka_unit_test(models_keep_features),
        cmocka_unit_test(boundaries_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
