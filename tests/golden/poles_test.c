/* Height functions from surface to quads (second paper, Figures 1 and 10): poles of index 1 are cut
 * open, solved and closed again. */
#include "tests/golden/golden.h"

static const char pipeline_text[] = "{\"qc_pipeline\": 1, \"stages\": ["
                                    "{\"stage\": \"qc.repair\", \"as\": \"repair\"},"
                                    "{\"stage\": \"qc.size\", \"as\": \"size\"},"
                                    "{\"stage\": \"qc.field.scalar\", \"as\": \"scalar\"},"
                                    "{\"stage\": \"qc.matching\", \"as\": \"matching\"},"
                                    "{\"stage\": \"qc.split\", \"as\": \"split\"},"
                                    "{\"stage\": \"qc.open\", \"as\": \"open\"},"
                                    "{\"stage\": \"qc.hodge\", \"as\": \"hodge\"},"
                                    "{\"stage\": \"qc.round\", \"as\": \"round\"},"
                                    "{\"stage\": \"qc.untangle\", \"as\": \"untangle\"},"
                                    "{\"stage\": \"qc.extract\", \"as\": \"extract\"},"
                                    "{\"stage\": \"qc.measure\", \"as\": \"measure\"}]}";

static qc_polygon_mesh *shape(qc_ctx *ctx, const char *name, int32_t resolution, double scale) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    options.resolution = resolution;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    for (int32_t i = 0; i < 3 * soup->n_vertices; i++) soup->position[i] *= scale;
    qc_object_release(mesh);
    return soup;
}

static void remesh(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup, double quads,
                   qc_remesh_result *result) {
    char number[32];
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    snprintf(number, sizeof number, "%g", quads);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_pipeline_parse(registry, pipeline_text, &pipeline), QC_OK);
    assert_int_equal(qc_pipeline_set(pipeline, "size", "quads", number), QC_OK);
    if (qc_remesh(ctx, pipeline, soup, NULL, result) != QC_OK)
        fail_msg("%s, %g quads: %s: %s", name, quads, qc_ctx_error(ctx)->stage,
                 qc_ctx_error(ctx)->text);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    /* the number of lines around a pole is even, that of rows up to it is whole */
    if (fabs(result->quads->n_faces / quads - 1) > 0.1)
        fail_msg("%s: %d quads instead of %g", name, (int)result->quads->n_faces, quads);
    golden_check(ctx, name, result->quads->n_faces, result);
}

/* Quads of the uv mesh: those at poles. */
static int32_t count_pole_quads(const qc_polygon_mesh *uv) {
    int32_t n = 0;
    for (int32_t f = 0; f < uv->n_faces; f++) n += uv->face_offset[f + 1] - uv->face_offset[f] == 4;
    return n;
}

static void every_density(void **state) {
    static const struct {
        const char *name;
        int32_t poles, saddles;
    } surfaces[] = {{"sphere", 2, 0}, {"ellipsoid", 2, 0}, {"sin-u-cos-v", 2, 2}};
    const double quads[] = {300, 1000, 10000};
    (void)state;
    qc_ctx *ctx = golden_context(2);
    for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++)
        for (int k = 0; k < 3; k++) {
            qc_remesh_result r = {0};
            qc_polygon_mesh *soup = shape(ctx, surfaces[i].name, 3000, 1);
            remesh(ctx, surfaces[i].name, soup, quads[k], &r);
            golden_equal(surfaces[i].name, "poles", r.report->field.index4[8 + 4],
                         surfaces[i].poles);
            golden_equal(surfaces[i].name, "saddles", r.report->field.index4[8 - 4],
                         surfaces[i].saddles);
            assert_true(count_pole_quads(r.uv) >= 3 * surfaces[i].poles);
            qc_remesh_result_clear(&r);
            qc_object_release(soup);
        }
    qc_ctx_free(ctx);
}

/* The 3-fold Lawson surface of Figure 10. Its inner points of the axis are maxima beside three
 * saddles each, lower by 1e-4 of the height and nearer than a quad: simplified to two vertices of
 * index -2.
 */
static void lawson(void **state) {
    const double quads[] = {300, 1000, 3000, 10000};
    (void)state;
    qc_ctx *ctx = golden_context(2);
    qc_polygon_mesh *soup = shape(ctx, "lawson", 10000, 1);
    for (int k = 0; k < 4; k++) {
        qc_remesh_result r = {0};
        remesh(ctx, "lawson", soup, quads[k], &r);
        golden_equal("lawson", "poles", r.report->field.index4[8 + 4], 2);
        golden_equal("lawson", "monkey saddles", r.report->field.index4[8 - 8], 2);
        golden_equal("lawson", "singularities", r.report->field.singularities, 4);
        golden_equal("lawson", "Euler characteristic", r.report->quads.euler, -2);
        qc_remesh_result_clear(&r);
    }
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

/* On the sphere all lines but the closing vertices are regular: 2 poles of k quads and 2 k vertices
 * of valence 3. */
static void closing_pattern(void **state) {
    (void)state;
    qc_ctx *ctx = golden_context(2);
    qc_remesh_result r = {0};
    qc_polygon_mesh *soup = shape(ctx, "sphere", 3000, 1);
    remesh(ctx, "sphere", soup, 900, &r);
    int32_t *valence = calloc((size_t)r.quads->n_vertices, sizeof *valence), three = 0, high = 0;
    assert_non_null(valence);
    for (int32_t c = 0; c < r.quads->n_corners; c++) valence[r.quads->face_vertex[c]]++;
    const int32_t n = r.quads->n_vertices, k = valence[n - 1];
    for (int32_t v = 0; v < n; v++) three += valence[v] == 3;
    for (int32_t v = 0; v < n; v++) high += valence[v] > 4;
    assert_int_equal(valence[n - 2], k);
    /* half of the lines of (N.6) */
    assert_true(fabs(k - 2 / sqrt(4 * acos(-1) / n)) < 2.5);
    assert_int_equal(three, 2 * k);
    assert_int_equal(high, 2);
    for (int i = 1; i <= 2; i++)
        assert_true(fabs(fabs(r.quads->position[3 * (n - i) + 2]) - 1) < 1e-12);
    free(valence);
    qc_remesh_result_clear(&r);
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

/* Both corners which two quads at a pole share differ by one transition: f' = i^r f + d with
 * integer d, which also takes the outer end of the common side along. */
static void uv_is_continuous(void **state) {
    (void)state;
    qc_ctx *ctx = golden_context(1);
    qc_remesh_result r = {0};
    qc_polygon_mesh *soup = shape(ctx, "sin-u-cos-v", 2000, 1);
    remesh(ctx, "sin-u-cos-v", soup, 1500, &r);
    const qc_polygon_mesh *uv = r.uv;
    int32_t sides = 0, quads = 0;
    for (int32_t f = 0; f < uv->n_faces; f++)
        for (int32_t g = 0; g < uv->n_faces; g++) {
            const int32_t *a = uv->face_vertex + uv->face_offset[f];
            const int32_t *b = uv->face_vertex + uv->face_offset[g];
            if (uv->face_offset[f + 1] - uv->face_offset[f] != 4) break;
            if (uv->face_offset[g + 1] - uv->face_offset[g] != 4 || a[1] != b[0] || a[2] != b[3])
                continue;
            const int32_t *s = uv->corner_uv + uv->face_offset[f];
            const int32_t *t = uv->corner_uv + uv->face_offset[g];
            bool found = false;
            for (int turn = 0; turn < 4; turn++) {
                double d[2][2];
                for (int end = 0; end < 2; end++) {
                    const double *p = uv->uv + 2 * s[1 + end], *q = uv->uv + 2 * t[3 * end];
                    const qc_complex z = qc_quarter_turn((qc_complex){p[0], p[1]}, turn);
                    d[end][0] = q[0] - z.re;
                    d[end][1] = q[1] - z.im;
                }
                found |= fabs(d[0][0] - rint(d[0][0])) < 1e-9 &&
                         fabs(d[0][1] - rint(d[0][1])) < 1e-9 && fabs(d[1][0] - d[0][0]) < 1e-9 &&
                         fabs(d[1][1] - d[0][1]) < 1e-9;
            }
            assert_true(found);
            sides++;
        }
    quads = count_pole_quads(uv);
    assert_true(quads >= 6);
    assert_int_equal(sides, quads);
    qc_remesh_result_clear(&r);
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

static void same_quads(const qc_polygon_mesh *a, const qc_polygon_mesh *b) {
    assert_int_equal(a->n_vertices, b->n_vertices);
    assert_int_equal(a->n_faces, b->n_faces);
    assert_memory_equal(a->face_vertex, b->face_vertex, sizeof(int32_t) * (size_t)a->n_corners);
}

/* A uv mesh with quads at the poles gives the same quads again; the tips are mapped elsewhere, so
 * that vertices inside a star, which is no larger than half a quad, may move there. */
static void uv_meshes_are_extracted(void **state) {
    (void)state;
    qc_ctx *ctx = golden_context(1);
    qc_remesh_result r = {0};
    qc_polygon_mesh *soup = shape(ctx, "sphere", 2000, 1), *quads = NULL;
    qc_corner_map *map = NULL;
    qc_grid_map *grid = NULL;
    remesh(ctx, "sphere", soup, 500, &r);
    assert_int_equal(qc_corner_map_from_polygons(ctx, r.uv, &map), QC_OK);
    assert_int_equal(map->mesh->n_poles, 2);
    assert_int_equal(qc_grid_map_create(ctx, map, 0, &grid), QC_OK);
    assert_int_equal(qc_map_extract(ctx, grid, &quads), QC_OK);
    same_quads(quads, r.quads);
    for (int32_t i = 0; i < 3 * quads->n_vertices; i++)
        assert_true(fabs(quads->position[i] - r.quads->position[i]) <
                    (fabs(quads->position[i / 3 * 3 + 2]) > 0.99 ? 0.05 : 1e-6));
    qc_object_release(quads);
    qc_object_release(grid);
    qc_object_release(map);
    qc_remesh_result_clear(&r);
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

static void scale_and_threads_change_nothing(void **state) {
    (void)state;
    const double scale[] = {1, 1, 1e-6, 1e6};
    qc_remesh_result first = {0};
    for (uint32_t i = 0; i < 4; i++) {
        qc_ctx *ctx = golden_context(1 + i % 3);
        qc_polygon_mesh *soup = shape(ctx, "ellipsoid", 2000, scale[i]);
        qc_remesh_result other = {0}, *result = i == 0 ? &first : &other;
        remesh(ctx, "ellipsoid", soup, 800, result);
        same_quads(result->quads, first.quads);
        if (scale[i] == 1)
            assert_memory_equal(result->quads->position, first.quads->position,
                                3 * sizeof(double) * (size_t)first.quads->n_vertices);
        qc_remesh_result_clear(&other);
        qc_object_release(soup);
        qc_ctx_free(ctx);
    }
    qc_remesh_result_clear(&first);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_density),
        cmocka_unit_test(lawson),
        cmocka_unit_test(closing_pattern),
        cmocka_unit_test(uv_is_continuous),
        cmocka_unit_test(uv_meshes_are_extracted),
        cmocka_unit_test(scale_and_threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
