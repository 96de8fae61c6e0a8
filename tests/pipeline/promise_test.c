/* A stage which spoils the quads makes the run fail; none of them is given out. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <qc/qc.h>
#include <stdlib.h>
#include <string.h>

typedef struct spoil_params {
    int32_t how;
} spoil_params;
static const char *const ways[] = {"nothing", "hole", "turn", "coincide", "infinite", NULL};

static qc_status spoil(const qc_run *run, const void *raw) {
    const qc_polygon_mesh *in = run->input(run, "quads");
    const int32_t how = ((const spoil_params *)raw)->how;
    qc_polygon_mesh *q = NULL;
    const qc_status status = qc_polygon_mesh_merge(run->ctx, 1, &in, NULL, &q);
    if (status != QC_OK) return status;
    if (how == 1) {
        q->n_faces--;
        q->n_corners -= 4;
    } else if (how == 2) {
        const int32_t swap = q->face_vertex[1];
        q->face_vertex[1] = q->face_vertex[3];
        q->face_vertex[3] = swap;
    } else if (how == 3) {
        memcpy(q->face_vertex, q->face_vertex + 4, 4 * sizeof *q->face_vertex);
    } else if (how == 4) {
        q->position[7] = 1e308 * 10;
    }
    return run->output(run, "quads", q);
}

static const qc_port in[] = {{"quads", QC_TYPE_POLYGON_MESH, 0, "quads"}};
static const qc_port out[] = {{"quads", QC_TYPE_POLYGON_MESH, 0, "spoilt quads"}};
static const qc_param params[] = {QC_PARAM_ENUM(spoil_params, how, 0, ways, "what is done")};
static const qc_stage stage = {
    QC_STAGE_SIZES,
    .id = "org.test.spoil",
    .version = "1",
    .brief = "spoils quads",
    .doc = "",
    .cite = "",
    .in = in,
    .out = out,
    .n_in = 1,
    .n_out = 1,
    .params = params,
    .n_params = 1,
    .params_size = sizeof(spoil_params),
    .run = spoil,
};

static qc_polygon_mesh *sphere(qc_ctx *ctx) {
    qc_shape_options o = QC_SHAPE_OPTIONS_INIT;
    o.resolution = 400;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *soup = NULL;
    assert_int_equal(qc_shape_create(ctx, "sphere", &o, &mesh), QC_OK);
    const int32_t n = mesh->n_faces;
    assert_int_equal(qc_polygon_mesh_create(ctx, mesh->n_vertices, n, 3 * n, 0, 0, 0, &soup), 0);
    memcpy(soup->position, mesh->position, 3 * sizeof(double) * (size_t)mesh->n_vertices);
    for (int32_t f = 0; f <= n; f++) soup->face_offset[f] = 3 * f;
    memcpy(soup->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)n);
    qc_object_release(mesh);
    return soup;
}

static void spoilt_quads_are_no_result(void **state) {
    (void)state;
    qc_ctx *ctx = NULL;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_default_pipeline_options o = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    o.quads = 100;
    assert_int_equal(qc_ctx_create(NULL, &ctx), QC_OK);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_registry_add(registry, &stage), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &o, &pipeline), QC_OK);
    assert_int_equal(
        qc_pipeline_insert(pipeline, qc_pipeline_count(pipeline) - 1, "spoil", "org.test.spoil"),
        QC_OK);
    qc_polygon_mesh *input = sphere(ctx);
    for (int how = 0; ways[how]; how++) {
        qc_remesh_result result = {0};
        assert_int_equal(qc_pipeline_set(pipeline, "spoil", "how", ways[how]), QC_OK);
        const qc_status status = qc_remesh(ctx, pipeline, input, NULL, &result);
        assert_int_equal(status, how == 0 ? QC_OK : QC_ERR_FAILED);
        assert_true((result.quads != NULL) == (how == 0));
        if (how > 0) assert_non_null(strstr(qc_ctx_error(ctx)->text, "nothing is written"));
        qc_remesh_result_clear(&result);
    }
    qc_object_release(input);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(spoilt_quads_are_no_result)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
