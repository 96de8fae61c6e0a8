/* Pipelines: an editable list of steps, each a stage with its parameters and wires. */
#include "sdk/pipeline/internal.h"
#include <string.h>

qc_status qc_pipeline_create(qc_registry *registry, qc_pipeline **out) {
    qc_pipeline *p = QC__ZERO(registry->ctx, qc_pipeline, 1);
    if (!p) return QC_ERR_NOMEM;
    p->registry = registry;
    p->number = QC__NEW(registry->ctx, char, 64);
    if (!p->number) {
        qc__free(p);
        return QC_ERR_NOMEM;
    }
    *out = p;
    return QC_OK;
}

static void free_step(qc__step *step) {
    for (uint32_t i = 0; step->text && i < step->stage->n_params; i++) qc__free(step->text[i]);
    for (uint32_t i = 0; step->wire && i < step->stage->n_in; i++) qc__free(step->wire[i]);
    qc__free(step->text);
    qc__free(step->wire);
    qc__free(step->params);
    qc__free(step->name);
}

void qc_pipeline_free(qc_pipeline *pipeline) {
    if (!pipeline) return;
    for (int64_t i = 0; i < pipeline->n; i++) free_step(&pipeline->step[i]);
    qc__free(pipeline->step);
    qc__free(pipeline->number);
    qc__free(pipeline);
}

int64_t qc__pipeline_find(const qc_pipeline *pipeline, const char *step) {
    for (int64_t i = 0; i < pipeline->n; i++)
        if (strcmp(pipeline->step[i].name, step) == 0) return i;
    return -1;
}

static qc_status create_step(qc_ctx *ctx, const char *name, const qc_stage *stage, qc__step *out) {
    qc__step s = {.stage = stage};
    s.name = qc__copy_text(ctx, name);
    s.params = qc__params_create(ctx, stage);
    s.text = QC__ZERO(ctx, char *, stage->n_params);
    s.wire = QC__ZERO(ctx, char *, stage->n_in);
    if (!s.name || !s.params || !s.text || !s.wire) {
        free_step(&s);
        return QC_ERR_NOMEM;
    }
    *out = s;
    return QC_OK;
}

qc_status qc_pipeline_insert(qc_pipeline *pipeline, uint32_t at, const char *step,
                             const char *stage_id) {
    qc_registry *registry = pipeline->registry;
    const qc_stage *stage;
    qc_status status = qc_registry_find(registry, stage_id, &stage);
    if (status != QC_OK) return status;
    const char *name = step ? step : qc__short_id(stage->id);
    if (at > pipeline->n)
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1,
                        "position %u in a pipeline of %lld steps", at, (long long)pipeline->n);
    if (!qc__is_name(name, "._-"))
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1,
                        "step name '%.64s': use up to 63 letters, digits and . _ -", name);
    if (qc__pipeline_find(pipeline, name) >= 0)
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1,
                        "step name '%s' is taken; give the new step another one", name);
    if (!qc__reserve(registry->ctx, (void **)&pipeline->step, &pipeline->capacity, pipeline->n + 1,
                     sizeof *pipeline->step))
        return QC_ERR_NOMEM;
    qc__step made;
    if ((status = create_step(registry->ctx, name, stage, &made)) != QC_OK) return status;
    memmove(pipeline->step + at + 1, pipeline->step + at,
            (size_t)(pipeline->n - at) * sizeof *pipeline->step);
    pipeline->step[at] = made;
    pipeline->n++;
    return QC_OK;
}

qc_status qc_pipeline_remove(qc_pipeline *pipeline, uint32_t at) {
    if (at >= pipeline->n)
        return qc__fail(pipeline->registry->ctx, QC_ERR_ARGUMENT, -1,
                        "no step %u in a pipeline of %lld", at, (long long)pipeline->n);
    free_step(&pipeline->step[at]);
    pipeline->n--;
    memmove(pipeline->step + at, pipeline->step + at + 1,
            (size_t)(pipeline->n - at) * sizeof *pipeline->step);
    return QC_OK;
}

static qc__step *need_step(qc_pipeline *pipeline, const char *step) {
    const int64_t i = qc__pipeline_find(pipeline, step);
    if (i >= 0) return &pipeline->step[i];
    qc_ctx *ctx = pipeline->registry->ctx;
    qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "the pipeline has no step '%.100s'%s", step,
             qc__closest_hint(ctx, step, pipeline->step, pipeline->n, sizeof(qc__step)).text);
    return NULL;
}

/* A text which names an interface must name one that is there. */
static qc_status check_interface(const qc_registry *registry, const qc__step *step,
                                 const qc_param *p, const char *text) {
    const qc_interface *found;
    char subject[160];
    if (!p->choices || !p->choices[0]) return QC_OK;
    snprintf(subject, sizeof subject, "parameter '%s' of stage '%s': ", p->name, step->name);
    return qc__interface_find(registry->ctx, registry, subject, p->choices[0], text, &found);
}

/* A copy of the text, owned by the step, replaces the old one once the value has been accepted. */
static qc_status set_param(const qc_registry *registry, qc__step *step, const char *param,
                           const char *text) {
    qc_ctx *ctx = registry->ctx;
    const int32_t i = qc__params_find(ctx, step->stage, step->name, param);
    if (i < 0) return qc_ctx_error(ctx)->status;
    const qc_param *p = &step->stage->params[i];
    if (p->type != QC_TEXT) return qc__param_set(ctx, p, step->name, step->params, text);
    const qc_status status = check_interface(registry, step, p, text);
    if (status != QC_OK) return status;
    char *copy = qc__copy_text(ctx, text);
    if (!copy) return QC_ERR_NOMEM;
    qc__free(step->text[i]);
    step->text[i] = copy;
    return qc__param_set(ctx, p, step->name, step->params, copy);
}

qc_status qc_pipeline_set(qc_pipeline *pipeline, const char *step, const char *param,
                          const char *text) {
    qc_ctx *ctx = pipeline->registry->ctx;
    qc__step *s = need_step(pipeline, step);
    if (!s) return qc_ctx_error(ctx)->status;
    const qc__range outer = qc__range_begin(ctx, s->name, 0, 1);
    const qc_status status = set_param(pipeline->registry, s, param, text);
    qc__range_end(ctx, outer);
    return status;
}

static qc_status set_wire(qc_ctx *ctx, qc__step *step, const char *port, const char *source) {
    const qc_stage *stage = step->stage;
    uint32_t i = 0;
    while (i < stage->n_in && strcmp(stage->in[i].name, port) != 0) i++;
    if (i == stage->n_in)
        return qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "step '%s' has no input '%.64s'%s", step->name,
                        port,
                        qc__closest_hint(ctx, port, stage->in, stage->n_in, sizeof(qc_port)).text);
    char *copy = source ? qc__copy_text(ctx, source) : NULL;
    if (source && !copy) return QC_ERR_NOMEM;
    qc__free(step->wire[i]);
    step->wire[i] = copy;
    return QC_OK;
}

qc_status qc_pipeline_wire(qc_pipeline *pipeline, const char *step, const char *port,
                           const char *source) {
    qc_ctx *ctx = pipeline->registry->ctx;
    qc__step *s = need_step(pipeline, step);
    if (!s) return qc_ctx_error(ctx)->status;
    const qc__range outer = qc__range_begin(ctx, s->name, 0, 1);
    const qc_status status = set_wire(ctx, s, port, source);
    qc__range_end(ctx, outer);
    return status;
}

uint32_t qc_pipeline_count(const qc_pipeline *pipeline) {
    return (uint32_t)pipeline->n;
}

const char *qc_pipeline_step_name(const qc_pipeline *pipeline, uint32_t i) {
    return i < pipeline->n ? pipeline->step[i].name : NULL;
}

const qc_stage *qc_pipeline_step_stage(const qc_pipeline *pipeline, uint32_t i) {
    return i < pipeline->n ? pipeline->step[i].stage : NULL;
}

double qc_pipeline_seconds(const qc_pipeline *pipeline, uint32_t i) {
    return i < pipeline->n ? pipeline->step[i].seconds : 0.0;
}

const char *qc_pipeline_get(const qc_pipeline *pipeline, const char *step, const char *param) {
    const int64_t s = qc__pipeline_find(pipeline, step);
    if (s < 0) return NULL;
    const qc_stage *stage = pipeline->step[s].stage;
    for (uint32_t i = 0; i < stage->n_params; i++) {
        if (strcmp(stage->params[i].name, param) != 0) continue;
        const char *text =
            qc__param_print(&stage->params[i], pipeline->step[s].params, pipeline->number);
        return text ? text : "";
    }
    return NULL;
}
