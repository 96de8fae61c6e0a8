/* The default pipeline on a small sphere: insert, replace, reorder, cancel, bad wiring. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <qc/qc.h>
#include <stdlib.h>
#include <string.h>

typedef struct world {
    qc_ctx *ctx;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_bag *bag;
    double cancel_at;
    char trace[512];
} world;

static bool on_progress(void *user, const char *stage, double fraction) {
    world *w = user;
    const char *last = strrchr(w->trace, ' ');
    const size_t used = strlen(w->trace);
    if (strcmp(last ? last + 1 : w->trace, stage) != 0 &&
        used + strlen(stage) + 2 < sizeof w->trace)
        strcat(strcat(w->trace, used ? " " : ""), stage);
    return fraction < w->cancel_at;
}

/* A sphere of about 600 faces as a polygon mesh called "input". */
static qc_status put_sphere(world *w) {
    qc_shape_options o = QC_SHAPE_OPTIONS_INIT;
    o.resolution = 600;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *soup = NULL;
    qc_status status = qc_shape_create(w->ctx, "sphere", &o, &mesh);
    if (status != QC_OK) return status;
    status = qc_polygon_mesh_create(w->ctx, mesh->n_vertices, mesh->n_faces, 3 * mesh->n_faces, 0,
                                    0, 0, &soup);
    if (status == QC_OK) {
        memcpy(soup->position, mesh->position, 3 * sizeof(double) * (size_t)mesh->n_vertices);
        for (int32_t f = 0; f <= mesh->n_faces; f++) soup->face_offset[f] = 3 * f;
        memcpy(soup->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)mesh->n_faces);
        status = qc_bag_put(w->bag, "input", soup);
    }
    qc_object_release(soup);
    qc_object_release(mesh);
    return status;
}

static int setup(void **state) {
    world *w = calloc(1, sizeof *w);
    w->cancel_at = 2;
    *state = w;
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    o.progress = on_progress;
    o.user = w;
    o.threads = 2;
    qc_default_pipeline_options p = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    p.quads = 200;
    return qc_ctx_create(&o, &w->ctx) || qc_registry_create(w->ctx, &w->registry) ||
           qc_default_pipeline(w->ctx, w->registry, &p, &w->pipeline) ||
           qc_bag_create(w->ctx, &w->bag) || put_sphere(w);
}

static int teardown(void **state) {
    world *w = *state;
    qc_bag_free(w->bag);
    qc_pipeline_free(w->pipeline);
    qc_registry_free(w->registry);
    qc_ctx_free(w->ctx);
    free(w);
    return 0;
}

static uint32_t position_of(const world *w, const char *step) {
    uint32_t i = 0;
    while (i < qc_pipeline_count(w->pipeline) &&
           strcmp(qc_pipeline_step_name(w->pipeline, i), step) != 0)
        i++;
    assert_true(i < qc_pipeline_count(w->pipeline));
    return i;
}

static void run(world *w) {
    const qc_status status = qc_pipeline_run(w->pipeline, w->bag);
    if (status != QC_OK)
        print_error("%s: %s\n", qc_ctx_error(w->ctx)->stage, qc_ctx_error(w->ctx)->text);
    assert_int_equal(status, QC_OK);
}

static const qc_polygon_mesh *quads_of(const world *w) {
    const qc_polygon_mesh *quads = qc_bag_get(w->bag, "extract.quads");
    assert_non_null(quads);
    assert_true(quads->n_faces > 20 && quads->n_corners == 4 * quads->n_faces);
    return quads;
}

/* Hands its field on: a stage that changes nothing. */
static qc_status pass(const qc_run *r, const void *params) {
    (void)params;
    return r->output(r, "field", qc_object_retain(r->input(r, "field")));
}
static const qc_port field_port[] = {{"field", QC_TYPE_FACE_FIELD, 0, "a field"}};
static qc_stage passing(const char *id) {
    const qc_stage s = {QC_STAGE_SIZES,    .id = id,  .version = "1", .in = field_port,
                        .out = field_port, .n_in = 1, .n_out = 1,     .run = pass};
    return s;
}

static void it_runs_in_order(void **state) {
    world *w = *state;
    run(w);
    quads_of(w);
    char expected[512] = "";
    for (uint32_t i = 0; i < qc_pipeline_count(w->pipeline); i++)
        strcat(strcat(expected, i ? " " : ""), qc_pipeline_step_name(w->pipeline, i));
    assert_string_equal(w->trace, expected);
}

static void an_inserted_stage_that_changes_nothing_changes_nothing(void **state) {
    world *w = *state;
    const qc_stage mine = passing("org.test.pass");
    run(w);
    const qc_polygon_mesh *before = qc_object_retain(quads_of(w));
    assert_int_equal(qc_registry_add(w->registry, &mine), QC_OK);
    assert_int_equal(qc_pipeline_insert(w->pipeline, position_of(w, "matching"), "pass", mine.id),
                     QC_OK);
    run(w);
    const qc_polygon_mesh *after = quads_of(w);
    assert_ptr_equal(qc_bag_get(w->bag, "pass.field"), qc_bag_get(w->bag, "smooth.field"));
    assert_int_equal(after->n_vertices, before->n_vertices);
    assert_memory_equal(after->position, before->position,
                        3 * sizeof(double) * (size_t)before->n_vertices);
    qc_object_release(before);
}

static void a_built_in_stage_can_be_replaced(void **state) {
    world *w = *state;
    const qc_stage mine = passing("qc.field.smooth");
    const uint32_t at = position_of(w, "smooth");
    assert_int_equal(qc_registry_add(w->registry, &mine), QC_OK);
    assert_int_equal(qc_pipeline_remove(w->pipeline, at), QC_OK);
    assert_int_equal(qc_pipeline_insert(w->pipeline, at, "smooth", "qc.field.smooth"), QC_OK);
    const uint32_t last = position_of(w, "matching") + 1;
    assert_int_equal(qc_pipeline_run_range(w->pipeline, 0, last, w->bag), QC_OK);
    assert_ptr_equal(qc_bag_get(w->bag, "smooth.field"), qc_bag_get(w->bag, "curvature.field"));
}

static void move(world *w, const char *step, uint32_t to) {
    const uint32_t from = position_of(w, step);
    char id[64];
    strcpy(id, qc_pipeline_step_stage(w->pipeline, from)->id);
    assert_int_equal(qc_pipeline_remove(w->pipeline, from), QC_OK);
    assert_int_equal(qc_pipeline_insert(w->pipeline, to, step, id), QC_OK);
}

static void refused(world *w, const char *step, const char *type, const char *provider) {
    w->trace[0] = '\0';
    assert_int_equal(qc_pipeline_run(w->pipeline, w->bag), QC_ERR_WIRING);
    const qc_error *e = qc_ctx_error(w->ctx);
    assert_string_equal(e->stage, step);
    assert_int_equal(e->where, position_of(w, step));
    assert_non_null(strstr(e->text, type));
    assert_non_null(strstr(e->text, provider));
    assert_string_equal(w->trace, ""); /* nothing has run */
    assert_int_equal(qc_bag_count(w->bag), 1);
}

static void types_not_positions_decide_what_is_legal(void **state) {
    world *w = *state;
    move(w, "size", position_of(w, "split") - 1);
    assert_int_equal(qc_pipeline_check(w->pipeline, w->bag), QC_OK);
    move(w, "matching", position_of(w, "curvature"));
    refused(w, "matching", QC_TYPE_FACE_FIELD, "qc.field.curvature");
}

static void a_missing_step_is_named_with_its_providers(void **state) {
    world *w = *state;
    assert_int_equal(qc_pipeline_remove(w->pipeline, position_of(w, "round")), QC_OK);
    refused(w, "untangle", QC_TYPE_CORNER_MAP, "qc.round");
    qc_bag *empty;
    assert_int_equal(qc_bag_create(w->ctx, &empty), QC_OK);
    assert_int_equal(qc_pipeline_check(w->pipeline, empty), QC_ERR_WIRING);
    assert_string_equal(qc_ctx_error(w->ctx)->stage, "repair");
    qc_bag_free(empty);
}

static void cancelling_leaves_only_the_input(void **state) {
    world *w = *state;
    for (double at = 0; at < 1; at += 0.09) {
        w->cancel_at = at;
        assert_int_equal(qc_pipeline_run(w->pipeline, w->bag), QC_ERR_CANCELLED);
        assert_int_equal(qc_ctx_error(w->ctx)->status, QC_ERR_CANCELLED);
        assert_int_equal(qc_bag_count(w->bag), 1);
    }
    w->cancel_at = 2;
    run(w);
}

static void steps_can_be_run_one_at_a_time(void **state) {
    world *w = *state;
    for (uint32_t i = 0; i < qc_pipeline_count(w->pipeline); i++) {
        const qc_status status = qc_pipeline_run_range(w->pipeline, i, i + 1, w->bag);
        if (status != QC_OK) print_error("%s\n", qc_ctx_error(w->ctx)->text);
        assert_int_equal(status, QC_OK);
    }
    const qc_polygon_mesh *single = qc_object_retain(quads_of(w));
    run(w);
    assert_int_equal(quads_of(w)->n_vertices, single->n_vertices);
    assert_memory_equal(quads_of(w)->position, single->position,
                        3 * sizeof(double) * (size_t)single->n_vertices);
    qc_object_release(single);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(it_runs_in_order, setup, teardown),
        cmocka_unit_test_setup_teardown(an_inserted_stage_that_changes_nothing_changes_nothing,
                                        setup, teardown),
        cmocka_unit_test_setup_teardown(a_built_in_stage_can_be_replaced, setup, teardown),
        cmocka_unit_test_setup_teardown(types_not_positions_decide_what_is_legal, setup, teardown),
        cmocka_unit_test_setup_teardown(a_missing_step_is_named_with_its_providers, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(cancelling_leaves_only_the_input, setup, teardown),
        cmocka_unit_test_setup_teardown(steps_can_be_run_one_at_a_time, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
