/* qc_remesh: a pipeline run once on the input and then once per connected component. */
#include <string.h>

#include "sdk/finish/internal.h"
#include "sdk/remesh/internal.h"
#include "sdk/remesh/symmetry.h"

/* Share of the progress bar for the steps on the whole input. */
#define WHOLE 0.05

/* Everything a run of the components needs to know. */
typedef struct job {
    qc_ctx *ctx;
    qc_pipeline *pipeline;
    uint32_t split; /* first step which runs per component */
    qc_bag *whole;
    qc__parts parts;
    qc__collection all;
    qc__symmetry symmetry;
    qc_plane plane;
    qc_mesh *half; /* the part on one side of the plane, the components of which are remeshed; NULL:
                      those of the whole */
    bool torn;     /* the halves do not fit together */
    const qc_remesh_options *options;
    qc_remesh_result *result;
} job;

/* The step after the first one which outputs a mesh; 0 when there is none. */
static uint32_t split_after(const qc_pipeline *pipeline) {
    for (uint32_t i = 0; i < qc_pipeline_count(pipeline); i++) {
        const qc_stage *stage = qc_pipeline_step_stage(pipeline, i);
        for (uint32_t p = 0; p < stage->n_out; p++)
            if (strcmp(qc_stage_out(stage, p)->type, QC_TYPE_MESH) == 0) return i + 1;
    }
    return 0;
}

/* The step which finds features; NULL = none. */
static const char *features_step(const job *j) {
    for (uint32_t i = j->split; i < qc_pipeline_count(j->pipeline); i++)
        if (strcmp(qc_pipeline_step_stage(j->pipeline, i)->id, "qc.features") == 0)
            return qc_pipeline_step_name(j->pipeline, i);
    return NULL;
}

/* The bag of the whole input with the component in place of the mesh; where no step finds features,
 * the boundary of a half on the plane is one. */
static qc_status component_bag(const job *j, int32_t c, qc_bag **out) {
    qc_mesh *part = NULL;
    qc_bag *bag = NULL;
    qc_status status = qc__parts_mesh(j->ctx, &j->parts, c, &part);
    if (status == QC_OK) status = qc_bag_create(j->ctx, &bag);
    for (uint32_t i = 0; status == QC_OK && i < qc_bag_count(j->whole); i++) {
        const char *name = qc_bag_name(j->whole, i);
        const void *object = qc_bag_get(j->whole, name);
        status = qc_bag_put(bag, name, object == j->result->mesh ? part : object);
    }
    if (status == QC_OK && j->half && !features_step(j)) {
        qc_features *border = NULL;
        status = qc__border_features(j->ctx, part, &j->plane, &border);
        if (status == QC_OK) status = qc_bag_put(bag, "border", border);
        qc_object_release(border);
    }
    qc_object_release(part);
    if (status == QC_OK)
        *out = bag;
    else
        qc_bag_free(bag);
    return status;
}

static qc_status run_component(job *j, int32_t c) {
    qc_bag *bag = NULL;
    qc_mesh *mesh = NULL;
    qc_status status = component_bag(j, c, &bag);
    if (status == QC_OK) {
        mesh = qc_object_retain(qc_bag_latest(bag, QC_TYPE_MESH));
        status = qc__run_with_attempts(j->ctx, j->pipeline, j->split, bag);
    }
    if (status == QC_OK) status = qc__collection_add(j->ctx, &j->all, c, mesh, j->whole, bag);
    qc_object_release(mesh);
    qc_bag_free(bag);
    return status;
}

/* Whether the error is about this component alone. */
static bool is_local(qc_status status) {
    return status != QC_OK && status != QC_ERR_CANCELLED && status != QC_ERR_NOMEM &&
           status != QC_ERR_WIRING && status != QC_ERR_ABI;
}

/* The error a call ends with when no component has a result: that of the first one. */
typedef struct kept_error {
    qc_status status;
    int64_t where;
    char stage[64], text[512];
} kept_error;

static void keep(qc_ctx *ctx, qc_status status, kept_error *kept) {
    const qc_error *error = qc_ctx_error(ctx);
    if (kept->status != QC_OK) return;
    kept->status = status;
    kept->where = error->where;
    snprintf(kept->stage, sizeof kept->stage, "%s", error->stage);
    snprintf(kept->text, sizeof kept->text, "%s", error->text);
}

static qc_status raise_kept(qc_ctx *ctx, const kept_error *kept) {
    const qc__range outer = qc__range_begin(ctx, kept->stage, 0, 1);
    qc__fail(ctx, kept->status, kept->where, "%s", kept->text);
    qc__range_end(ctx, outer);
    return kept->status;
}

static qc_status run_components(job *j) {
    const int32_t n = j->parts.n;
    kept_error first = {QC_OK, -1, "", ""};
    qc__density density;
    const bool shared = (n > 1 || j->half) && qc__density_find(j->pipeline, j->split, &density);
    qc_status status = QC_OK;
    for (int32_t c = 0; c < n && status == QC_OK; c++) {
        const double faces = j->parts.mesh->n_faces;
        const qc__range outer =
            qc__range_begin(j->ctx, NULL, WHOLE + (1 - WHOLE) * j->parts.face_start[c] / faces,
                            WHOLE + (1 - WHOLE) * j->parts.face_start[c + 1] / faces);
        if (shared)
            status = qc__density_share(j->pipeline, &density, j->result->mesh, j->parts.area[c]);
        const double left = faces - j->parts.face_start[c];
        const double part = j->parts.face_start[c + 1] - j->parts.face_start[c];
        const qc__time time = qc__time_share(j->ctx, part / left);
        if (status == QC_OK) status = run_component(j, c);
        qc__time_end_share(j->ctx, time);
        qc__range_end(j->ctx, outer);
        if (!is_local(status) || j->options->strict || n == 1) continue;
        keep(j->ctx, status, &first);
        j->result->n_failed++;
        status = qc__warn_failure(j->ctx, &j->parts, c, j->result);
    }
    if (status == QC_OK && j->result->n_failed == n) status = raise_kept(j->ctx, &first);
    if (shared) {
        const qc_status restored = qc__density_restore(j->pipeline, &density);
        if (status == QC_OK) status = restored;
    }
    return status;
}

static qc_status run_whole(job *j, const qc_polygon_mesh *input) {
    qc_status status = qc_bag_put(j->whole, "input", input);
    if (status == QC_OK) status = qc_pipeline_check(j->pipeline, j->whole);
    if (status != QC_OK) return status;
    const qc__range outer = qc__range_begin(j->ctx, NULL, 0.0, WHOLE);
    status = qc_pipeline_run_range(j->pipeline, 0, j->split, j->whole);
    qc__range_end(j->ctx, outer);
    if (status != QC_OK) return status;
    j->result->repairs = qc_object_retain(qc_bag_latest(j->whole, QC_TYPE_REPAIR_REPORT));
    const qc_mesh *mesh = qc_bag_latest(j->whole, QC_TYPE_MESH);
    j->result->mesh = qc_object_retain(mesh);
    if (j->symmetry.wanted)
        status = qc__symmetry_cut(j->ctx, &j->symmetry, mesh, j->result, &j->plane, &j->half);
    return status == QC_OK ? qc__parts_create(j->ctx, j->half ? j->half : mesh, &j->parts) : status;
}

/* The components of a half, with quads along its boundary. */
static qc_status run_half(job *j) {
    const char *step = features_step(j);
    const char *text = step ? qc_pipeline_get(j->pipeline, step, "hard") : NULL;
    const bool soft = text && strcmp(text, "false") == 0;
    qc_status status = soft ? qc_pipeline_set(j->pipeline, step, "hard", "true") : QC_OK;
    if (status == QC_OK) status = run_components(j);
    if (!soft) return status;
    const qc_status restored = qc_pipeline_set(j->pipeline, step, "hard", "false");
    return status == QC_OK ? restored : status;
}

/* Whether borders of groups are hard features of some step. */
static bool borders_are_hard(const qc_pipeline *pipeline) {
    for (uint32_t i = 0; i < qc_pipeline_count(pipeline); i++) {
        const char *step = qc_pipeline_step_name(pipeline, i);
        if (strcmp(qc_pipeline_step_stage(pipeline, i)->id, "qc.features") == 0 &&
            strcmp(qc_pipeline_get(pipeline, step, "groups"), "true") == 0 &&
            strcmp(qc_pipeline_get(pipeline, step, "hard"), "true") == 0)
            return true;
    }
    return false;
}

static qc_status warn_mixed(job *j, const qc_polygon_mesh *quads, int32_t n, int32_t first) {
    if (n == 0 || !borders_are_hard(j->pipeline)) return QC_OK;
    const double *x = quads->position + 3 * (int64_t)quads->face_vertex[4 * (int64_t)first];
    return qc__warn(j->ctx, j->result,
                    "%d quads cross a border between groups, the first is face %d at (%g, %g, %g); "
                    "ask for more quads, or see the warnings about features",
                    (int)n, (int)first, x[0], x[1], x[2]);
}

/* Gives the quads the attributes, groups and uvs of the input. */
static qc_status keep_attributes(job *j, const qc_polygon_mesh *input) {
    qc_polygon_mesh *quads = NULL;
    if (!j->result->quads || (input->n_attributes == 0 && !input->face_group && !input->uv))
        return QC_OK;
    int32_t n_mixed = 0, first = -1;
    const qc_status status = qc__quads_transfer(j->ctx, input, j->result->mesh, j->result->quads,
                                                &quads, &n_mixed, &first);
    if (status != QC_OK) return status;
    qc_object_release(j->result->quads);
    j->result->quads = quads;
    return warn_mixed(j, quads, n_mixed, first);
}

static qc_status run_job(job *j, const qc_polygon_mesh *input) {
    qc_status status = qc_bag_create(j->ctx, &j->whole);
    if (status == QC_OK) status = run_whole(j, input);
    if (status == QC_OK) status = qc__collection_create(j->ctx, j->parts.n, &j->all);
    if (status == QC_OK) {
        status = j->half ? run_half(j) : run_components(j);
        if (status == QC_OK) status = qc__collection_merge(j->ctx, &j->all, &j->parts, j->result);
        qc__collection_clear(&j->all, j->parts.n);
        if (status == QC_OK && j->half) {
            status = qc__mirror_results(j->ctx, j->half, &j->plane, j->result);
            j->torn = status == QC_ERR_FAILED;
        }
        if (status == QC_OK) status = keep_attributes(j, input);
    }
    qc__parts_clear(&j->parts);
    qc_object_release(j->half);
    j->half = NULL;
    qc_bag_free(j->whole);
    j->whole = NULL;
    return status;
}

/* Once more, without symmetry, where the halves did not fit together. */
static qc_status run_again(job *j, const qc_polygon_mesh *input) {
    char reason[512];
    snprintf(reason, sizeof reason, "%s", qc_ctx_error(j->ctx)->text);
    qc__clear_error(j->ctx);
    qc_remesh_result_clear(j->result);
    j->symmetry.wanted = false;
    const qc_status status =
        qc__warn(j->ctx, j->result, "%s; the surface is remeshed as a whole", reason);
    return status == QC_OK ? run_job(j, input) : status;
}

static void read_options(const qc_remesh_options *given, qc_remesh_options *out) {
    const qc_remesh_options defaults = QC_REMESH_OPTIONS_INIT;
    *out = defaults;
    if (given)
        memcpy(out, given, given->struct_size < sizeof *out ? given->struct_size : sizeof *out);
}

qc_status qc_remesh_check(qc_ctx *ctx, const qc_remesh_options *options) {
    qc_remesh_options o;
    qc__symmetry symmetry;
    read_options(options, &o);
    return qc__symmetry_parse(ctx, o.symmetry, &symmetry);
}

qc_status qc_remesh(qc_ctx *ctx, qc_pipeline *pipeline, const qc_polygon_mesh *input,
                    const qc_remesh_options *options, qc_remesh_result *result) {
    qc_remesh_options o;
    qc_remesh_result r;
    read_options(options, &o);
    memset(&r, 0, sizeof r);
    job j = {.ctx = ctx, .pipeline = pipeline, .options = &o, .result = &r};
    j.split = split_after(pipeline);
    if (j.split == 0)
        return qc__fail(ctx, QC_ERR_WIRING, -1,
                        "no step of the pipeline outputs a %s; begin with qc.repair", QC_TYPE_MESH);
    qc_status status = qc__symmetry_parse(ctx, o.symmetry, &j.symmetry);
    if (status == QC_OK) status = run_job(&j, input);
    if (j.torn) status = run_again(&j, input);
    if (status == QC_OK)
        *result = r;
    else
        qc_remesh_result_clear(&r);
    return status;
}

void qc_remesh_result_clear(qc_remesh_result *result) {
    if (!result) return;
    qc_object_release(result->mesh);
    qc_object_release(result->repairs);
    qc_object_release(result->quads);
    qc_object_release(result->uv);
    qc_object_release(result->field);
    qc_object_release(result->report);
    for (int32_t i = 0; i < result->n_warnings; i++) qc__free(result->warning[i]);
    qc__free(result->warning);
    memset(result, 0, sizeof *result);
}
