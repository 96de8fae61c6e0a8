/* Runs the default pipeline up to the extraction, before anything is moved, or to a later step, and
 * sees its features, its quads and what it warns of. */
#ifndef QC_TESTS_KEPT_H
#define QC_TESTS_KEPT_H

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

static inline void listen(void *user, int32_t level, const char *stage, const char *text) {
    (void)user, (void)stage;
    if (level != QC_LOG_WARNING || run_seen.n_warnings == MOST_WARNINGS) return;
    snprintf(run_seen.warning[run_seen.n_warnings++], MOST_TEXT, "%s", text);
}

static inline qc_status look(const qc_run *run, const void *params) {
    (void)params;
    const qc_features *features = run->input(run, "features");
    const qc_polygon_mesh *quads = run->input(run, "quads");
    seen *s = &run_seen;
    if (!s->first || s->first->mesh != features->mesh) {
        s->components++;
        qc_object_release(s->first);
        s->first = qc_object_retain(features);
    }
    if (!quads) return QC_OK;
    if (s->refusals-- > 0) return (run->fail)(run, QC_ERR_FAILED, -1, "not these quads");
    qc_object_release(s->last);
    qc_object_release(s->quads);
    s->last = qc_object_retain(features);
    s->quads = qc_object_retain(quads);
    return QC_OK;
}

static const qc_port in[] = {{"features", QC_TYPE_FEATURES, 0, "any"},
                             {"quads", QC_TYPE_POLYGON_MESH, QC_PORT_OPTIONAL, "any"}};
static const qc_stage looking = {QC_STAGE_SIZES,   .id = "org.test.look",
                                 .version = "1.0", .brief = "looks at features and quads",
                                 .doc = "",        .cite = "",
                                 .in = in,         .n_in = 2,
                                 .run = look};

static inline qc_ctx *begin(int refusals) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = 2;
    options.log = listen;
    run_seen = (seen){.refusals = refusals};
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

static inline void forget(void) {
    qc_object_release(run_seen.first);
    qc_object_release(run_seen.last);
    qc_object_release(run_seen.quads);
    run_seen = (seen){0};
}

static inline void end(qc_ctx *ctx, qc_polygon_mesh *soup) {
    forget();
    qc_object_release(soup);
    qc_ctx_free(ctx);
}

/* A look behind the step of a stage; returns its place. */
static inline uint32_t insert_look(qc_pipeline *pipeline, const char *name, const char *stage) {
    uint32_t at = 0;
    while (strcmp(qc_pipeline_step_stage(pipeline, at)->id, stage) != 0) at++;
    assert_int_equal(qc_pipeline_insert(pipeline, at + 1, name, "org.test.look"), QC_OK);
    assert_int_equal(qc_pipeline_wire(pipeline, name, "features", "features.features"), QC_OK);
    return at + 1;
}

/* Up to the step of a stage. */
static inline void remesh_to(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup,
                             double quads, const char *stage) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_remesh_result result = {0};
    options.quads = quads;
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_add(registry, &looking), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &options, &pipeline), QC_OK);
    insert_look(pipeline, "first", "qc.features");
    assert_int_equal(qc_pipeline_wire(pipeline, "first", "quads", ""), QC_OK);
    const uint32_t at = insert_look(pipeline, "last", stage);
    while (qc_pipeline_count(pipeline) > at + 1)
        assert_int_equal(qc_pipeline_remove(pipeline, at + 1), QC_OK);
    if (qc_remesh(ctx, pipeline, soup, NULL, &result) != QC_OK)
        fail_msg("%s, %g quads: %s", name, quads, qc_ctx_error(ctx)->text);
    golden_equal(name, "components", run_seen.components, 1);
    qc_remesh_result_clear(&result);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
}

/* Up to the extraction: nothing is moved after it. */
static inline void remesh(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup,
                          double quads) {
    remesh_to(ctx, name, soup, quads, "qc.extract");
}

static inline cover check_cover(const char *name, const uint8_t *edge, const int32_t *line,
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

static inline cover check_features(const char *name) {
    assert_true(run_seen.last->hard && run_seen.last->n_feature_edges > 0);
    return check_cover(name, run_seen.last->edge, run_seen.quads->line, run_seen.quads->n_lines);
}

static inline qc_polygon_mesh *shape(qc_ctx *ctx, const char *name, int32_t resolution) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    options.resolution = resolution;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    qc_polygon_mesh *soup = golden_soup(ctx, mesh);
    qc_object_release(mesh);
    return soup;
}

#endif
