/* Refusing a pipeline before anything runs: every input port must be met, every value in range. */
#include "sdk/pipeline/internal.h"
#include <string.h>

/* "; stages with it: qc.field, qc.hodge" - who could provide the type. */
static void list_providers(const qc_registry *registry, const char *type, char *text, size_t size) {
    size_t used = 0, found = 0;
    text[0] = '\0';
    for (int64_t i = 0; i < registry->n; i++) {
        const qc_stage *stage = registry->stage[i];
        for (uint32_t o = 0; o < stage->n_out; o++) {
            if (strcmp(stage->out[o].type, type) != 0) continue;
            const int more =
                snprintf(text + used, size - used, "%s%s", found++ ? ", " : "", stage->id);
            used = used + (size_t)more < size ? used + (size_t)more : size - 1;
            break;
        }
    }
    if (!found) snprintf(text, size, "none of the registered stages");
}

/* What `wire` names, when that is an object of another type; NULL = nothing of that name. */
static const char *type_at(const qc__scope *scope, uint32_t step, const char *wire) {
    const char *dot = strrchr(wire, '.');
    for (uint32_t s = scope->first; dot && s < step; s++) {
        const qc__step *from = &scope->pipeline->step[s];
        if (strlen(from->name) != (size_t)(dot - wire) ||
            strncmp(wire, from->name, (size_t)(dot - wire)) != 0)
            continue;
        for (uint32_t o = 0; o < from->stage->n_out; o++)
            if (strcmp(from->stage->out[o].name, dot + 1) == 0) return from->stage->out[o].type;
        return NULL;
    }
    const qc_object *object = scope->io ? qc_bag_get(scope->io, wire) : NULL;
    return object ? object->type : NULL;
}

static qc_status refuse(const qc__scope *scope, uint32_t step, uint32_t port, qc__fit fit) {
    const qc__step *s = &scope->pipeline->step[step];
    const qc_port *in = &s->stage->in[port];
    qc_registry *registry = scope->pipeline->registry;
    const char *wire = s->wire[port];
    char providers[256];
    list_providers(registry, in->type, providers, sizeof providers);
    if (wire && *wire) {
        const char *type = type_at(scope, step, wire);
        return qc__fail(registry->ctx, QC_ERR_WIRING, step,
                        "step '%s': input '%s' needs %s, but '%s' is %s%s; provided by: %s",
                        s->name, in->name, in->type, wire,
                        type ? "of type " : "not there before this step", type ? type : "",
                        providers);
    }
    return qc__fail(registry->ctx, QC_ERR_WIRING, step,
                    "step '%s': input '%s' needs %s, which %s; provided by: %s", s->name, in->name,
                    in->type,
                    wire                   ? "is wired to nothing"
                    : fit == QC__FIT_MAYBE ? "no earlier step is sure to give"
                                           : "no earlier step gives",
                    providers);
}

/* An optional input may be unmet, unless a wire names something which is not there. A required one
 * must be sure, except that a wire may name an optional output on purpose. */
static bool is_met(const qc__step *step, uint32_t port, qc__fit fit) {
    const bool wired = step->wire[port] && *step->wire[port];
    if (wired) return fit != QC__FIT_NONE;
    return fit == QC__FIT_SURE || (step->stage->in[port].flags & QC_PORT_OPTIONAL);
}

qc_status qc__check_range(const qc_pipeline *pipeline, uint32_t first, uint32_t last,
                          const qc_bag *io) {
    qc_ctx *ctx = pipeline->registry->ctx;
    if (first > last || last > pipeline->n)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no steps %u .. %u in a pipeline of %lld", first,
                        last, (long long)pipeline->n);
    const qc__scope scope = {pipeline, first, io, NULL};
    qc_status status = QC_OK;
    for (uint32_t s = first; s < last && status == QC_OK; s++) {
        const qc__step *step = &pipeline->step[s];
        const qc__range outer = qc__range_begin(ctx, step->name, 0, 1);
        for (uint32_t p = 0; p < step->stage->n_in && status == QC_OK; p++) {
            const qc_object *object;
            const qc__fit fit = qc__port_resolve(&scope, s, p, &object);
            if (!is_met(step, p, fit)) status = refuse(&scope, s, p, fit);
        }
        if (status == QC_OK) status = qc__params_check(ctx, step->stage, step->name, step->params);
        qc__range_end(ctx, outer);
    }
    return status;
}

qc_status qc_pipeline_check(const qc_pipeline *pipeline, const qc_bag *io) {
    return qc__check_range(pipeline, 0, (uint32_t)pipeline->n, io);
}
