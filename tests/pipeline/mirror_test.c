/* qc_remesh with a plane of symmetry: sources, attributes, map, field and figures are those of the
 * whole surface; where the halves do not fit together it is remeshed as a whole. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <qc/qc.h>
#include <stdlib.h>
#include <string.h>
#include "tests/counting.h"

/* Moves the vertices on x = 0 off it. */
static qc_status shift(const qc_run *run, const void *raw) {
    const qc_polygon_mesh *in = run->input(run, "quads");
    qc_polygon_mesh *q = NULL;
    (void)raw;
    const qc_status status = qc_polygon_mesh_merge(run->ctx, 1, &in, NULL, &q);
    if (status != QC_OK) return status;
    for (int32_t v = 0; v < q->n_vertices; v++)
        if (q->position[3 * v] == 0) q->position[3 * v] += 0.01;
    return run->output(run, "quads", q);
}

static const qc_port in[] = {{"quads", QC_TYPE_POLYGON_MESH, 0, "quads"}};
static const qc_port out[] = {{"quads", QC_TYPE_POLYGON_MESH, 0, "moved quads"}};
static const qc_stage stage = {
    QC_STAGE_SIZES, .id = "org.test.shift",
    .version = "1", .brief = "moves quads off a plane",
    .doc = "",      .cite = "",
    .in = in,       .out = out,
    .n_in = 1,      .n_out = 1,
    .run = shift,
};

/* A surface coloured by its position. */
static qc_polygon_mesh *coloured(qc_ctx *ctx, const char *name) {
    qc_shape_options o = QC_SHAPE_OPTIONS_INIT;
    o.resolution = 1000;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *soup = NULL;
    assert_int_equal(qc_shape_create(ctx, name, &o, &mesh), QC_OK);
    const int32_t n = mesh->n_faces;
    assert_int_equal(qc_polygon_mesh_create(ctx, mesh->n_vertices, n, 3 * n, 0, 0, 0, &soup),
                     QC_OK);
    memcpy(soup->position, mesh->position, 3 * sizeof(double) * (size_t)mesh->n_vertices);
    double *colour = NULL;
    assert_int_equal(qc_polygon_mesh_add_attribute(ctx, soup, "colour", QC_AT_VERTEX,
                                                   QC_ATTRIBUTE_LINEAR, 3, &colour),
                     QC_OK);
    for (int32_t i = 0; i < 3 * mesh->n_vertices; i++) colour[i] = 0.5 + 0.1 * soup->position[i];
    for (int32_t f = 0; f <= n; f++) soup->face_offset[f] = 3 * f;
    memcpy(soup->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)n);
    qc_object_release(mesh);
    return soup;
}

typedef struct setting {
    qc_ctx *ctx;
    qc_registry *registry;
    qc_pipeline *pipeline;
} setting;

static void open_setting(setting *s, const qc_ctx_options *options, double crease_angle) {
    qc_default_pipeline_options o = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    o.quads = 300;
    o.crease_angle = crease_angle;
    assert_int_equal(qc_ctx_create(options, &s->ctx), QC_OK);
    assert_int_equal(qc_registry_create(s->ctx, &s->registry), QC_OK);
    assert_int_equal(qc_registry_add(s->registry, &stage), QC_OK);
    assert_int_equal(qc_default_pipeline(s->ctx, s->registry, &o, &s->pipeline), QC_OK);
}

static void close_setting(setting *s) {
    qc_pipeline_free(s->pipeline);
    qc_registry_free(s->registry);
    qc_ctx_free(s->ctx);
}

static void check_sources(const qc_polygon_mesh *input, const qc_polygon_mesh *q) {
    const qc_attribute *colour = qc_polygon_mesh_attribute(q, QC_AT_VERTEX, "colour");
    assert_non_null(colour);
    for (int32_t v = 0; v < q->n_vertices; v++) {
        double off = 0;
        assert_true(q->source_face[v] >= 0 && q->source_face[v] < input->n_faces);
        for (int i = 0; i < 3; i++) {
            double x = 0;
            for (int k = 0; k < 3; k++) {
                const int32_t w = input->face_vertex[3 * q->source_face[v] + k];
                x += q->source_barycentric[3 * v + k] * input->position[3 * w + i];
            }
            off = fmax(off, fabs(x - q->position[3 * v + i]));
            assert_true(fabs(colour->value[3 * v + i] - 0.5 - 0.1 * x) < 1e-6);
        }
        assert_true(off < 2e-3); /* vertices beside the plane were moved onto it */
    }
}

/* Positive area of every triangle of a map: u and v change places in the mirror image. */
static void check_map(const qc_polygon_mesh *uv) {
    for (int32_t f = 0; f < uv->n_faces; f++) {
        const double *p[3];
        for (int k = 0; k < 3; k++) p[k] = uv->uv + 2 * uv->corner_uv[3 * f + k];
        assert_true((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                        (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]) >
                    0);
    }
}

static void results_are_of_the_whole(void **state) {
    (void)state;
    for (int soft = 0; soft < 3; soft++) { /* hard or soft features, or none at all */
        setting s;
        qc_remesh_result r = {0};
        qc_remesh_options o = QC_REMESH_OPTIONS_INIT;
        open_setting(&s, NULL, soft == 2 ? -1 : 0);
        if (soft < 2)
            assert_int_equal(
                qc_pipeline_set(s.pipeline, "features", "hard", soft ? "false" : "true"), QC_OK);
        qc_polygon_mesh *input = coloured(s.ctx, "torus");
        o.symmetry = "auto";
        assert_int_equal(qc_remesh(s.ctx, s.pipeline, input, &o, &r), QC_OK);
        if (soft < 2)
            assert_string_equal(qc_pipeline_get(s.pipeline, "features", "hard"),
                                soft ? "false" : "true");
        assert_int_equal(r.n_warnings, 0);
        const double *plane = r.report->mirror;
        assert_true(fmax(plane[0], fmax(plane[1], plane[2])) == 1 && plane[3] == 0);
        assert_int_equal(r.mesh->n_faces, input->n_faces);
        assert_true(r.field->mesh == r.mesh);
        assert_int_equal(r.report->quads.faces, r.quads->n_faces);
        assert_int_equal(r.report->quads.euler, 0);
        assert_int_equal(r.report->quads.boundaries, 0);
        assert_int_equal(r.report->input.faces, input->n_faces);
        assert_true(fabs(r.report->density.target_quads - 300) < 2);
        assert_true(fabs(r.quads->n_faces - 300.0) < 60);
        check_sources(input, r.quads);
        check_map(r.uv);
        qc_remesh_result_clear(&r);
        qc_object_release(input);
        close_setting(&s);
    }
}

static void halves_which_do_not_fit_are_not_joined(void **state) {
    setting s;
    qc_remesh_result r = {0};
    qc_remesh_options o = QC_REMESH_OPTIONS_INIT;
    (void)state;
    open_setting(&s, NULL, 0);
    assert_int_equal(qc_pipeline_insert(s.pipeline, qc_pipeline_count(s.pipeline) - 1, "shift",
                                        "org.test.shift"),
                     QC_OK);
    qc_polygon_mesh *input = coloured(s.ctx, "hyperboloid");
    o.symmetry = "x";
    assert_int_equal(qc_remesh(s.ctx, s.pipeline, input, &o, &r), QC_OK);
    assert_int_equal(r.n_warnings, 1);
    assert_non_null(strstr(r.warning[0], "do not fit together"));
    assert_true(r.report->mirror[0] == 0);
    assert_int_equal(r.report->quads.boundaries, 2);
    qc_remesh_result_clear(&r);
    o.symmetry = "sideways";
    assert_int_equal(qc_remesh(s.ctx, s.pipeline, input, &o, &r), QC_ERR_ARGUMENT);
    assert_int_equal(qc_remesh_check(s.ctx, &o), QC_ERR_ARGUMENT);
    assert_int_equal(qc_remesh_check(s.ctx, NULL), QC_OK);
    qc_object_release(input);
    close_setting(&s);
}

/* A sample of all allocations, among them the last ones, which are those of the mirror image. */
static void out_of_memory_anywhere_is_an_error(void **state) {
    enum { SAMPLES = 30, LAST = 80 };
    counter c = {0, -1, 0};
    setting s;
    qc_remesh_options o = QC_REMESH_OPTIONS_INIT;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    (void)state;
    options.resize = counting_resize;
    options.user = &c;
    options.threads = 1; /* the allocator is not thread-safe */
    open_setting(&s, &options, -1);
    qc_polygon_mesh *input = coloured(s.ctx, "ellipsoid");
    int64_t total = 0;
    o.symmetry = "x";
    for (int64_t i = -1; i < SAMPLES + LAST; i++) { /* -1: counts, nothing fails */
        qc_remesh_result r = {0};
        const int64_t before = c.blocks;
        c.made = 0;
        c.fail_at = i < 0 ? -1 : i < SAMPLES ? i * total / SAMPLES : total - 1 - (i - SAMPLES);
        const qc_status status = qc_remesh(s.ctx, s.pipeline, input, &o, &r);
        if (i < 0) total = c.made;
        assert_int_equal(status, i < 0 ? QC_OK : QC_ERR_NOMEM);
        qc_remesh_result_clear(&r);
        assert_int_equal(c.blocks, before);
    }
    c.fail_at = -1;
    qc_object_release(input);
    close_setting(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_are_of_the_whole),
        cmocka_unit_test(halves_which_do_not_fit_are_not_joined),
        cmocka_unit_test(out_of_memory_anywhere_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
