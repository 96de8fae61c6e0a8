/* Features and boundaries are kept: before finishing, every hard feature which no warning names is
 * a chain of quad edges whose ends lie on it, and every boundary loop a loop of boundary edges. */
#include "golden.h"

#include "cover.h"

/* Of the diagonal of the bounding box. */
#define NEAR 1e-6

enum { MOST_WARNINGS = 64, MOST_TEXT = 400 };

/* What a run was seen to do; the features and quads of a component which is tried again replace
 * those before. */
typedef struct seen {
    const qc_features *first, *last;
    const qc_polygon_mesh *quads;
    int components, refusals, n_warnings;
    char warning[MOST_WARNINGS][MOST_TEXT];
} seen;
static seen run_seen;

static void listen(void *user, int32_t level, const char *stage, const char *text) {
    (void)user, (void)stage;
    if (level != QC_LOG_WARNING || run_seen.n_warnings == MOST_WARNINGS) return;
    snprintf(run_seen.warning[run_seen.n_warnings++], MOST_TEXT, "%s", text);
}

static qc_status look(const qc_run *run, const void *params) {
    (void)params;
    const qc_features *features = run->input(run, "features");
    const qc_polygon_mesh *quads = run->input(run, "quads");
    seen *s = &run_seen;
    if (!s->first || s->first->mesh != features->mesh) {
        s->components++;
        qc_object_release(s->first);
        s->first = qc_object_retain(features);
    }
    if (s->refusals-- > 0) return (run->fail)(run, QC_ERR_FAILED, -1, "not these quads");
    qc_object_release(s->last);
    qc_object_release(s->quads);
    s->last = qc_object_retain(features);
    s->quads = qc_object_retain(quads);
    return QC_OK;
}

static const qc_port in[] = {{"features", QC_TYPE_FEATURES, 0, "any"},
                             {"quads", QC_TYPE_POLYGON_MESH, 0, "any"}};
static const qc_stage looking = {QC_STAGE_SIZES,   .id = "org.test.look",
                                 .version = "1.0", .brief = "looks at features and quads",
                                 .doc = "",        .cite = "",
                                 .in = in,         .n_in = 2,
                                 .run = look};

static qc_ctx *begin(int refusals) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = 2;
    options.log = listen;
    run_seen = (seen){.refusals = refusals};
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

static void end(qc_ctx *ctx, qc_polygon_mesh *soup) {
    qc_object_release(run_seen.first);
    qc_object_release(run_seen.last);
    qc_object_release(run_seen.quads);
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

/* Up to the extraction: nothing is moved after it. */
static void remesh(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup, double quads) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_remesh_result result = {0};
    options.quads = quads;
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_add(registry, &looking), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &options, &pipeline), QC_OK);
    uint32_t at = 0;
    while (strcmp(qc_pipeline_step_stage(pipeline, at)->id, "qc.extract") != 0) at++;
    while (qc_pipeline_count(pipeline) > at + 1)
        assert_int_equal(qc_pipeline_remove(pipeline, at + 1), QC_OK);
    assert_int_equal(qc_pipeline_insert(pipeline, at + 1, "look", "org.test.look"), QC_OK);
    assert_int_equal(qc_pipeline_wire(pipeline, "look", "features", "features.features"), QC_OK);
    if (qc_remesh(ctx, pipeline, soup, NULL, &result) != QC_OK)
        fail_msg("%s, %g quads: %s", name, quads, qc_ctx_error(ctx)->text);
    golden_equal(name, "components", run_seen.components, 1);
    qc_remesh_result_clear(&result);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
}

static cover check_cover(const char *name, const uint8_t *edge, const int32_t *line,
                         int32_t n_lines) {
    const qc_mesh *mesh = run_seen.last->mesh;
    const cover c = cover_measure(mesh, edge, run_seen.quads, line, n_lines, NEAR * mesh->diagonal);
    golden_equal(name, "lines which are no edges of quads", c.n_foreign, 0);
    golden_equal(name, "chains which are no chains of quad edges", c.n_broken, 0);
    golden_equal(name, "lines on features", c.n_used, c.n_lines);
    print_message(
        "%s, %d quads: %d chains of %d edges, ends off by %.1e, chords by %.1e of the diagonal\n",
        name, (int)run_seen.quads->n_faces, (int)c.n_chains, (int)c.n_lines, c.off / mesh->diagonal,
        c.sagitta / mesh->diagonal);
    return c;
}

static cover check_features(const char *name) {
    assert_true(run_seen.last->hard && run_seen.last->n_feature_edges > 0);
    return check_cover(name, run_seen.last->edge, run_seen.quads->line, run_seen.quads->n_lines);
}

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

static qc_polygon_mesh *shape(qc_ctx *ctx, const char *name, int32_t resolution) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    options.resolution = resolution;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    qc_object_release(mesh);
    return soup;
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

/* A disk of rings of triangles with strokes along spokes: the ends are points of the numbers given.
 */
enum { SPOKES = 72, RINGS = 10 };
static int32_t on_spoke(int32_t spoke, int32_t ring) {
    return ring == 0 ? 0 : 1 + (ring - 1) * SPOKES + spoke % SPOKES;
}

static qc_polygon_mesh *disk(qc_ctx *ctx, int n_strokes, const int32_t (*stroke)[2]) {
    const int32_t n_faces = SPOKES * (2 * RINGS - 1);
    int32_t n_lines = 0, f = 0, l = 0;
    qc_polygon_mesh *soup = NULL;
    for (int i = 0; i < n_strokes; i++) n_lines += stroke[i][1];
    assert_int_equal(
        qc_polygon_mesh_create(ctx, 1 + SPOKES * RINGS, n_faces, 3 * n_faces, 0, n_lines, 0, &soup),
        QC_OK);
    for (int32_t r = 1; r <= RINGS; r++)
        for (int32_t s = 0; s < SPOKES; s++) {
            const double angle = 2 * 3.14159265358979323846 * s / SPOKES;
            const int32_t v = on_spoke(s, r), w = on_spoke(s + 1, r);
            const int32_t a = on_spoke(s, r - 1), b = on_spoke(s + 1, r - 1);
            soup->position[3 * v] = r * cos(angle);
            soup->position[3 * v + 1] = r * sin(angle);
            memcpy(soup->face_vertex + 3 * f++, (int32_t[]){a, v, w}, 3 * sizeof v);
            if (r > 1) memcpy(soup->face_vertex + 3 * f++, (int32_t[]){a, w, b}, 3 * sizeof v);
        }
    for (f = 0; f <= n_faces; f++) soup->face_offset[f] = 3 * f;
    for (int i = 0; i < n_strokes; i++)
        for (int32_t r = 0; r < stroke[i][1]; r++) {
            soup->line[l++] = on_spoke(stroke[i][0], r);
            soup->line[l++] = on_spoke(stroke[i][0], r + 1);
        }
    return soup;
}

/* Of two strokes which meet in 5 degrees the shorter one is named, the others are kept. */
static void strokes_without_room_are_named(void **state) {
    (void)state;
    static const int32_t stroke[][2] = {{0, 7}, {1, 5}, {18, 7}};
    qc_ctx *ctx = begin(0);
    qc_polygon_mesh *soup = disk(ctx, 3, stroke);
    char text[64];
    remesh(ctx, "disk", soup, 1000);
    check_features("disk");
    golden_equal("disk", "edges of features", run_seen.last->n_feature_edges, SPOKES + 7 + 7);
    golden_equal("disk", "warnings", run_seen.n_warnings, 1);
    snprintf(text, sizeof text, "feature from vertex 0 to %d, of length 5, dropped",
             (int)on_spoke(1, 5));
    assert_non_null(strstr(run_seen.warning[0], text));
    assert_non_null(strstr(run_seen.warning[0], "at vertex 0 it meets another one in 5 degrees"));
    end(ctx, soup);
}

/* Whether a warning names a chain by its ends and its angle. */
static int is_named(const qc_feature_chain *chain) {
    for (int i = 0; i < run_seen.n_warnings; i++) {
        int a, b;
        double length, angle;
        if (sscanf(run_seen.warning[i],
                   "feature from vertex %d to %d, %lf quads long, %lf degrees, is no edge", &a, &b,
                   &length, &angle) == 4 &&
            a == chain->end[0] && b == chain->end[1] && length > 0 &&
            fabs(angle - chain->angle * 57.29577951308232) < 0.6)
            return 1;
    }
    return 0;
}

/* Where quads are refused features go one by one: those which are gone are named, all others kept.
 */
static void features_given_up_are_named(void **state) {
    (void)state;
    qc_ctx *ctx = begin(4);
    qc_polygon_mesh *soup = shape(ctx, "cube", 1000);
    remesh(ctx, "cube", soup, 300);
    const qc_features *first = run_seen.first, *last = run_seen.last;
    const size_t n_edges = (size_t)first->mesh->n_edges;
    int32_t n = 0, gone = 0, *of = malloc(n_edges * sizeof *of);
    qc_feature_chain *chain = malloc(n_edges * sizeof *chain);
    check_features("cube");
    assert_int_equal(qc_features_chains(ctx, first->mesh, first->edge, of, &n), QC_OK);
    assert_int_equal(qc_features_measure_chains(ctx, first->mesh, first->edge, chain), QC_OK);
    golden_equal("cube", "features", n, 12);
    for (int32_t i = 0; i < n; i++) {
        int32_t left = 0;
        for (size_t e = 0; e < n_edges; e++) left += of[e] == i && last->edge[e];
        assert_true(left == 0 || left == chain[i].n_edges);
        golden_equal("cube", "features which are gone and named", is_named(&chain[i]), left == 0);
        gone += left == 0;
    }
    assert_in_range(gone, 1, 3);
    free(chain);
    free(of);
    end(ctx, soup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_keep_features),
        cmocka_unit_test(models_keep_features),
        cmocka_unit_test(boundaries_are_kept),
        cmocka_unit_test(strokes_without_room_are_named),
        cmocka_unit_test(features_given_up_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
