/* The default pipeline as a list of steps. */
#include <string.h>

#include "sdk/remesh/internal.h"

typedef struct step {
    const char *name, *stage;
} step;

static const step before_field[] = {{"repair", "qc.repair"}, {"size", "qc.size"}};
static const step feature_steps[] = {{"features", "qc.features"}, {"refine", "qc.split.features"}};
static const step computed_field[] = {{"curvature", "qc.field.curvature"},
                                      {"smooth", "qc.field.smooth"}};
static const step imported_field[] = {{"field", "qc.field.import"}};
static const step after_field[] = {{"matching", "qc.matching"}};
static const step optimisation[] = {{"cancel", "qc.optimize.cancel"},
                                    {"curl", "qc.optimize.curl"},
                                    {"balance", "qc.optimize.balance"}};
static const step after_matching[] = {{"split", "qc.split"},       {"open", "qc.open"},
                                      {"hodge", "qc.hodge"},       {"round", "qc.round"},
                                      {"untangle", "qc.untangle"}, {"extract", "qc.extract"},
                                      {"finish", "qc.finish"},     {"measure", "qc.measure"}};

#define APPEND(pipeline, steps) append(pipeline, steps, sizeof(steps) / sizeof *(steps))

static qc_status append(qc_pipeline *pipeline, const step *steps, size_t n) {
    qc_status status = QC_OK;
    for (size_t i = 0; i < n && status == QC_OK; i++)
        status = qc_pipeline_insert(pipeline, qc_pipeline_count(pipeline), steps[i].name,
                                    steps[i].stage);
    return status;
}

static qc_status set_real(qc_pipeline *pipeline, const char *step_name, const char *name,
                          double value) {
    char text[40];
    qc__print_double(text, sizeof text, value);
    return qc_pipeline_set(pipeline, step_name, name, text);
}

static qc_status set_density(qc_ctx *ctx, qc_pipeline *pipeline,
                             const qc_default_pipeline_options *o) {
    const int given = (o->quads > 0) + (o->edge_length > 0) + (o->edge_length_rel > 0);
    if (given > 1)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "give one density: quads, edge_length or edge_length_rel");
    if (o->edge_length > 0) return set_real(pipeline, "size", "edge_length", o->edge_length);
    if (o->edge_length_rel > 0)
        return set_real(pipeline, "size", "edge_length_rel", o->edge_length_rel);
    return set_real(pipeline, "size", "quads", o->quads > 0 ? o->quads : QC__DEFAULT_QUADS);
}

/* Moving only: without the last step. */
static qc_status append_optimisation(qc_pipeline *pipeline, int32_t mode) {
    if (mode == QC_MODE_RELOCATE) return append(pipeline, optimisation, 2);
    if (mode != QC_MODE_BEST) return QC_OK;
    const qc_status status = APPEND(pipeline, optimisation);
    return status == QC_OK ? qc_pipeline_set(pipeline, "curl", "create", "true") : status;
}

qc_status qc__set_seed(qc_pipeline *pipeline, const char *step_name, uint64_t seed) {
    char text[24];
    snprintf(text, sizeof text, "%llu", (unsigned long long)seed);
    return qc_pipeline_set(pipeline, step_name, "seed", text);
}

/* Every parameter called "seed" of any step. */
static qc_status set_seeds(qc_pipeline *pipeline, uint64_t seed) {
    for (uint32_t i = 0; i < qc_pipeline_count(pipeline); i++) {
        const qc_stage *stage = qc_pipeline_step_stage(pipeline, i);
        for (uint32_t p = 0; p < stage->n_params; p++) {
            if (strcmp(qc_stage_param(stage, p)->name, "seed") != 0) continue;
            const qc_status status =
                qc__set_seed(pipeline, qc_pipeline_step_name(pipeline, i), seed);
            if (status != QC_OK) return status;
        }
    }
    return QC_OK;
}

/* Borders of groups become hard features. */
static qc_status keep_groups(qc_ctx *ctx, qc_pipeline *pipeline,
                             const qc_default_pipeline_options *o) {
    if (o->crease_angle < 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "borders of groups are features: leave features on, with a crease angle of "
                        "180 for borders and boundaries only");
    const qc_status status = qc_pipeline_set(pipeline, "features", "groups", "true");
    return status == QC_OK ? qc_pipeline_set(pipeline, "features", "hard", "true") : status;
}

static qc_status fill(qc_ctx *ctx, qc_pipeline *pipeline, const qc_default_pipeline_options *o) {
    qc_status status = APPEND(pipeline, before_field);
    if (status == QC_OK && o->crease_angle >= 0) status = APPEND(pipeline, feature_steps);
    if (status == QC_OK)
        status =
            o->field_path ? APPEND(pipeline, imported_field) : APPEND(pipeline, computed_field);
    if (status == QC_OK) status = APPEND(pipeline, after_field);
    if (status == QC_OK) status = append_optimisation(pipeline, o->mode);
    if (status == QC_OK) status = APPEND(pipeline, after_matching);
    if (status == QC_OK) status = set_density(ctx, pipeline, o);
    if (status == QC_OK && o->field_path)
        status = qc_pipeline_set(pipeline, "field", "file", o->field_path);
    if (status == QC_OK && o->crease_angle > 0)
        status = set_real(pipeline, "features", "angle", o->crease_angle);
    if (status == QC_OK && o->keep_groups) status = keep_groups(ctx, pipeline, o);
    if (status == QC_OK && o->seed != 0) status = set_seeds(pipeline, o->seed);
    return status;
}

qc_status qc_default_pipeline(qc_ctx *ctx, qc_registry *registry,
                              const qc_default_pipeline_options *options, qc_pipeline **out) {
    qc_default_pipeline_options o = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    qc_pipeline *pipeline = NULL;
    qc_status status = qc_pipeline_create(registry, &pipeline);
    if (status == QC_OK) status = fill(ctx, pipeline, &o);
    if (status == QC_OK)
        *out = pipeline;
    else
        qc_pipeline_free(pipeline);
    return status;
}
