/* Running stages: inputs by port, outputs held until success, progress shared among the steps. */
#include "sdk/pipeline/internal.h"
#include <string.h>

/* One call of a stage; what its qc_run's host_data points to. */
typedef struct call {
    qc_ctx *ctx;
    const qc_registry *registry; /* NULL = the stage runs on its own */
    const char *name;
    const qc_stage *stage;
    const qc_object **input;  /* [n_in] borrowed; NULL = unwired */
    const qc_object **output; /* [n_out] owned; NULL = not published */
} call;

static const void *run_input(const qc_run *run, const char *port) {
    const call *c = run->host_data;
    for (uint32_t i = 0; i < c->stage->n_in; i++)
        if (strcmp(c->stage->in[i].name, port) == 0) return c->input[i];
    return NULL;
}

static qc_status run_output(const qc_run *run, const char *port, void *object) {
    const call *c = run->host_data;
    const qc_object *o = object;
    uint32_t i = 0;
    while (i < c->stage->n_out && strcmp(c->stage->out[i].name, port) != 0) i++;
    if (!o || i == c->stage->n_out || !o->type || strcmp(o->type, c->stage->out[i].type) != 0) {
        const qc_status status =
            qc__fail(c->ctx, QC_ERR_ARGUMENT, -1, "stage '%s' publishes %s%s on output '%s'%s%s",
                     c->name, o ? "an object of type " : "nothing", o && o->type ? o->type : "",
                     port, i == c->stage->n_out ? ", which it does not have" : " of type ",
                     i == c->stage->n_out ? "" : c->stage->out[i].type);
        qc_object_release(o);
        return status;
    }
    qc_object_release(c->output[i]);
    c->output[i] = o;
    return QC_OK;
}

static bool run_progress(const qc_run *run, double fraction) {
    const call *c = run->host_data;
    return qc__progress(c->ctx, fraction);
}

static void run_log(const qc_run *run, int32_t level, const char *text) {
    const call *c = run->host_data;
    qc__log(c->ctx, level, "%s", text);
}

static qc_status run_fail(const qc_run *run, qc_status status, int64_t where, const char *text) {
    const call *c = run->host_data;
    return qc_ctx_fail(c->ctx, status, where, text);
}

static const qc_interface *run_find(const qc_run *run, const char *id, const char *name) {
    const call *c = run->host_data;
    const qc_interface *found = NULL;
    return qc__interface_find(c->ctx, c->registry, "", id, name, &found) == QC_OK ? found : NULL;
}

/* Runs the stage inside the current range; checks that it kept its promises. */
static qc_status invoke(const call *c, const void *params) {
    const qc_run run = {sizeof run, (void *)(uintptr_t)c, c->ctx,  run_input,
                        run_output, run_progress,         run_log, run_fail,
                        run_find};
    if (!qc__progress(c->ctx, 0.0)) return QC_ERR_CANCELLED;
    qc__clear_error(c->ctx);
    const qc_status status = c->stage->run(&run, params);
    if (status != QC_OK) {
        if (qc_ctx_error(c->ctx)->status == status) return status;
        return qc__fail(c->ctx, status, -1, "stage '%s' failed: %s", c->name,
                        qc_status_name(status));
    }
    for (uint32_t i = 0; i < c->stage->n_out; i++)
        if (!c->output[i] && !(c->stage->out[i].flags & QC_PORT_OPTIONAL))
            return qc__fail(c->ctx, QC_ERR_FAILED, -1,
                            "stage '%s' did not give its output '%s' (%s)", c->name,
                            c->stage->out[i].name, c->stage->out[i].type);
    return qc__progress(c->ctx, 1.0) ? QC_OK : QC_ERR_CANCELLED;
}

/* Runs a stage whose inputs are in c->input and moves its outputs to `held` as "prefix.port". */
static qc_status run_call(call *c, const void *params, const char *prefix, qc_bag *held) {
    qc_status status = invoke(c, params);
    for (uint32_t i = 0; i < c->stage->n_out; i++) {
        if (!c->output[i]) continue;
        if (status == QC_OK)
            status = qc__bag_take(held, prefix, c->stage->out[i].name, c->output[i]);
        else
            qc_object_release(c->output[i]);
    }
    return status;
}

static qc_status create_call(qc_ctx *ctx, const qc_registry *registry, const char *name,
                             const qc_stage *stage, call *out) {
    call c = {.ctx = ctx, .registry = registry, .name = name, .stage = stage};
    c.input = QC__ZERO(ctx, const qc_object *, stage->n_in);
    c.output = QC__ZERO(ctx, const qc_object *, stage->n_out);
    if (!c.input || !c.output) {
        qc__free(c.input);
        qc__free(c.output);
        return QC_ERR_NOMEM;
    }
    *out = c;
    return QC_OK;
}

static void free_call(call *c) {
    qc__free(c->input);
    qc__free(c->output);
}

static qc_status run_step(const qc__scope *scope, uint32_t s, qc_bag *held) {
    qc__step *step = &scope->pipeline->step[s];
    call c;
    const qc_registry *registry = scope->pipeline->registry;
    qc_status status = create_call(registry->ctx, registry, step->name, step->stage, &c);
    if (status != QC_OK) return status;
    for (uint32_t p = 0; p < step->stage->n_in && status == QC_OK; p++) {
        /* The check has passed; only a wire to an optional output can still be unmet. */
        const qc__fit fit = qc__port_resolve(scope, s, p, &c.input[p]);
        if (fit == QC__FIT_NONE && !(step->stage->in[p].flags & QC_PORT_OPTIONAL))
            status = qc__fail(c.ctx, QC_ERR_WIRING, s,
                              "step '%s': input '%s' needs %s, but '%s' was not given", step->name,
                              step->stage->in[p].name, step->stage->in[p].type,
                              step->wire[p] ? step->wire[p] : "");
    }
    const double start = qc__now();
    if (status == QC_OK) status = run_call(&c, step->params, step->name, held);
    step->seconds += qc__now() - start;
    free_call(&c);
    return status;
}

qc_status qc_pipeline_run_range(qc_pipeline *pipeline, uint32_t first, uint32_t last, qc_bag *io) {
    qc_ctx *ctx = pipeline->registry->ctx;
    if (!io) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "a run needs a bag for its results");
    qc_status status = qc__check_range(pipeline, first, last, io);
    if (status != QC_OK) return status;
    qc_bag *held;
    if ((status = qc_bag_create(ctx, &held)) != QC_OK) return status;
    const qc__scope scope = {pipeline, first, io, held};
    const double share = last > first ? 1.0 / (last - first) : 1.0;
    for (uint32_t s = first; s < last && status == QC_OK; s++) {
        const qc__range outer = qc__range_begin(ctx, pipeline->step[s].name, share * (s - first),
                                                share * (s - first + 1));
        const qc__time time = qc__time_begin_step(ctx);
        status = run_step(&scope, s, held);
        qc__time_end_step(ctx, time);
        qc__range_end(ctx, outer);
    }
    if (status == QC_OK) status = qc__bag_absorb(io, held);
    qc_bag_free(held);
    return status;
}

qc_status qc_pipeline_run(qc_pipeline *pipeline, qc_bag *io) {
    return qc_pipeline_run_range(pipeline, 0, (uint32_t)pipeline->n, io);
}

/* Without a pipeline: the object called like the port, else the latest of the port's type. */
static qc_status find_inputs(const call *c, const qc_bag *io) {
    for (uint32_t p = 0; p < c->stage->n_in; p++) {
        const qc_port *in = &c->stage->in[p];
        const qc_object *named = qc_bag_get(io, in->name);
        c->input[p] =
            named && strcmp(named->type, in->type) == 0 ? named : qc_bag_latest(io, in->type);
        if (!c->input[p] && !(in->flags & QC_PORT_OPTIONAL))
            return qc__fail(c->ctx, QC_ERR_WIRING, -1,
                            "stage '%s': input '%s' needs %s, which is not in the bag", c->name,
                            in->name, in->type);
    }
    return QC_OK;
}

static qc_status run_table(qc_ctx *ctx, const qc_stage *stage, const void *params, qc_bag *io) {
    call c;
    qc_status status = create_call(ctx, NULL, qc__short_id(stage->id), stage, &c);
    if (status != QC_OK) return status;
    qc_bag *held = NULL;
    void *defaults = NULL;
    const qc__range outer = qc__range_begin(ctx, c.name, 0, 1);
    status = find_inputs(&c, io);
    if (status == QC_OK && params) status = qc__params_check(ctx, stage, c.name, params);
    if (status == QC_OK && !params && !(params = defaults = qc__params_create(ctx, stage)))
        status = QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_bag_create(ctx, &held);
    if (status == QC_OK) status = run_call(&c, params, NULL, held);
    if (status == QC_OK) status = qc__bag_absorb(io, held);
    qc__range_end(ctx, outer);
    qc_bag_free(held);
    qc__free(defaults);
    free_call(&c);
    return status;
}

qc_status qc_stage_run(qc_ctx *ctx, const qc_stage *stage, const void *params, qc_bag *io) {
    qc__arena *arena = qc__arena_create(ctx);
    if (!arena) return QC_ERR_NOMEM;
    const qc_stage *table;
    qc_status status = qc__table_import(ctx, arena, stage, &table);
    if (status == QC_OK) status = run_table(ctx, table, params, io);
    qc__arena_free(arena);
    return status;
}
