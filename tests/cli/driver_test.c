/* qc_remesh: components stand or fall alone, sources are those of the input, density is shared. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <qc/qc.h>
#include <string.h>

/* A stage which refuses meshes with fewer than 500 faces and makes an empty report. (cmocka has a
 * macro called fail.) */
static qc_status fuss(const qc_run *run, const void *params) {
    const qc_mesh *mesh = run->input(run, "mesh");
    (void)params;
    if (mesh->n_faces < 500) return (run->fail)(run, QC_ERR_FAILED, 7, "too small for my taste");
    qc_report *report = NULL;
    const qc_status status = qc_report_create(run->ctx, &report);
    return status == QC_OK ? run->output(run, "report", report) : status;
}

static const qc_port fuss_in[] = {{"mesh", QC_TYPE_MESH, 0, ""}};
static const qc_port fuss_out[] = {{"report", QC_TYPE_REPORT, 0, ""}};
static const qc_stage fuss_stage = {QC_STAGE_SIZES, "test.fuss", "1.0", "fusses", "", "", fuss_in,
                                    fuss_out,       1,           1,     NULL,     0,  0,  fuss};

typedef struct fixture {
    qc_ctx *ctx;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_remesh_result result;
} fixture;

static int setup(void **state) {
    static fixture f;
    memset(&f, 0, sizeof f);
    assert_int_equal(qc_ctx_create(NULL, &f.ctx), QC_OK);
    assert_int_equal(qc_registry_create(f.ctx, &f.registry), QC_OK);
    assert_int_equal(qc_registry_add(f.registry, &fuss_stage), QC_OK);
    *state = &f;
    return 0;
}

static int teardown(void **state) {
    fixture *f = *state;
    qc_remesh_result_clear(&f->result);
    qc_pipeline_free(f->pipeline);
    qc_registry_free(f->registry);
    qc_ctx_free(f->ctx);
    return 0;
}

static qc_polygon_mesh *shape(qc_ctx *ctx, const char *name, int32_t faces, double shift) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = faces;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *p = NULL;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    assert_int_equal(qc_polygon_mesh_create(ctx, mesh->n_vertices, mesh->n_faces, 3 * mesh->n_faces,
                                            0, 0, 0, &p),
                     QC_OK);
    memcpy(p->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)mesh->n_faces);
    for (int32_t t = 0; t <= mesh->n_faces; t++) p->face_offset[t] = 3 * t;
    for (int32_t i = 0; i < 3 * mesh->n_vertices; i++)
        p->position[i] = mesh->position[i] + (i % 3 == 0 ? shift : 0.0);
    qc_object_release(mesh);
    return p;
}

/* A sphere of about 300 faces and a torus of about 2000, five units apart. */
static qc_polygon_mesh *two_parts(qc_ctx *ctx) {
    qc_polygon_mesh *part[2] = {shape(ctx, "sphere", 300, 0), shape(ctx, "torus", 2000, 5)};
    const qc_polygon_mesh *list[2] = {part[0], part[1]};
    qc_polygon_mesh *both = NULL;
    assert_int_equal(qc_polygon_mesh_merge(ctx, 2, list, NULL, &both), QC_OK);
    qc_object_release(part[0]);
    qc_object_release(part[1]);
    return both;
}

static void add(fixture *f, const char *step, const char *stage) {
    if (!f->pipeline) assert_int_equal(qc_pipeline_create(f->registry, &f->pipeline), QC_OK);
    assert_int_equal(qc_pipeline_insert(f->pipeline, qc_pipeline_count(f->pipeline), step, stage),
                     QC_OK);
}

static void a_failing_component_is_a_warning(void **state) {
    fixture *f = *state;
    add(f, "repair", "qc.repair");
    add(f, "fuss", "test.fuss");
    qc_polygon_mesh *input = two_parts(f->ctx);
    assert_int_equal(qc_remesh(f->ctx, f->pipeline, input, NULL, &f->result), QC_OK);
    assert_int_equal(f->result.n_failed, 1);
    assert_int_equal(f->result.n_warnings, 1);
    assert_non_null(strstr(f->result.warning[0], "component 1 of 2"));
    assert_non_null(strstr(f->result.warning[0], "fuss: too small for my taste"));
    assert_null(f->result.quads);
    assert_int_equal(f->result.report->input.components, 2);

    qc_remesh_options strict = QC_REMESH_OPTIONS_INIT;
    qc_remesh_result untouched;
    memset(&untouched, 0, sizeof untouched);
    strict.strict = 1;
    assert_int_equal(qc_remesh(f->ctx, f->pipeline, input, &strict, &untouched), QC_ERR_FAILED);
    assert_null(untouched.mesh);
    assert_string_equal(qc_ctx_error(f->ctx)->stage, "fuss");
    qc_object_release(input);
}

static void when_all_fail_the_call_fails(void **state) {
    fixture *f = *state;
    add(f, "repair", "qc.repair");
    add(f, "fuss", "test.fuss");
    qc_polygon_mesh *part[2] = {shape(f->ctx, "sphere", 200, 0), shape(f->ctx, "sphere", 200, 5)};
    const qc_polygon_mesh *list[2] = {part[0], part[1]};
    qc_polygon_mesh *both = NULL;
    assert_int_equal(qc_polygon_mesh_merge(f->ctx, 2, list, NULL, &both), QC_OK);
    assert_int_equal(qc_remesh(f->ctx, f->pipeline, both, NULL, &f->result), QC_ERR_FAILED);
    assert_string_equal(qc_ctx_error(f->ctx)->stage, "fuss");
    assert_string_equal(qc_ctx_error(f->ctx)->text, "too small for my taste");
    assert_int_equal(qc_ctx_error(f->ctx)->where, 7);
    qc_object_release(part[0]);
    qc_object_release(part[1]);
    qc_object_release(both);
}

static void a_pipeline_needs_a_mesh(void **state) {
    fixture *f = *state;
    add(f, "fuss", "test.fuss");
    qc_polygon_mesh *input = shape(f->ctx, "sphere", 600, 0);
    assert_int_equal(qc_remesh(f->ctx, f->pipeline, input, NULL, &f->result), QC_ERR_WIRING);
    qc_object_release(input);
}

/* Every quad vertex lies where its source face and barycentric coordinates say. */
static void check_sources(const qc_polygon_mesh *input, const qc_polygon_mesh *quads) {
    assert_non_null(quads->source_face);
    double worst = 0;
    for (int32_t v = 0; v < quads->n_vertices; v++) {
        const int32_t t = quads->source_face[v];
        assert_in_range(t, 0, input->n_faces - 1);
        for (int k = 0; k < 3; k++) {
            double x = 0;
            for (int c = 0; c < 3; c++)
                x += quads->source_barycentric[3 * v + c] *
                     input->position[3 * input->face_vertex[3 * t + c] + k];
            worst = fmax(worst, fabs(x - quads->position[3 * v + k]));
        }
    }
    assert_true(worst < 1e-9);
}

static void two_components_share_the_density(void **state) {
    fixture *f = *state;
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    options.quads = 1500;
    assert_int_equal(qc_default_pipeline(f->ctx, f->registry, &options, &f->pipeline), QC_OK);
    qc_polygon_mesh *input = two_parts(f->ctx);
    assert_int_equal(qc_remesh(f->ctx, f->pipeline, input, NULL, &f->result), QC_OK);
    assert_int_equal(f->result.n_failed, 0);
    qc_polygon_topology topology;
    assert_int_equal(qc_polygon_mesh_topology(f->ctx, f->result.quads, &topology), QC_OK);
    assert_int_equal(topology.components, 2);
    assert_int_equal(topology.euler, 2);
    assert_int_equal(topology.non_quads, 0);
    assert_true(fabs(f->result.quads->n_faces - 1500.0) < 75);
    assert_int_equal(f->result.uv->n_faces, input->n_faces);
    assert_int_equal(f->result.report->quads.faces, f->result.quads->n_faces);
    assert_true(fabs(f->result.report->density.target_quads - 1500) < 1.5);
    assert_string_equal(qc_pipeline_get(f->pipeline, "size", "quads"), "1500");
    check_sources(input, f->result.quads);
    qc_object_release(input);
}

static void densities_exclude_each_other(void **state) {
    fixture *f = *state;
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    options.quads = 100;
    options.edge_length = 1;
    assert_int_equal(qc_default_pipeline(f->ctx, f->registry, &options, &f->pipeline),
                     QC_ERR_ARGUMENT);
    assert_null(f->pipeline);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_failing_component_is_a_warning, setup, teardown),
        cmocka_unit_test_setup_teardown(when_all_fail_the_call_fails, setup, teardown),
        cmocka_unit_test_setup_teardown(a_pipeline_needs_a_mesh, setup, teardown),
        cmocka_unit_test_setup_teardown(two_components_share_the_density, setup, teardown),
        cmocka_unit_test_setup_teardown(densities_exclude_each_other, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
