/* Pipelines as JSON text, read and escaped by jansson (MIT). */
#include "sdk/pipeline/internal.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

/* --- parse ------------------------------------------------------------------------------------ */

static qc_status check_keys(qc_ctx *ctx, json_t *object, const char *const *known, size_t n,
                            const char *where) {
    for (void *it = json_object_iter(object); it; it = json_object_iter_next(object, it)) {
        const char *key = json_object_iter_key(it);
        size_t k = 0;
        while (k < n && strcmp(known[k], key) != 0) k++;
        if (k == n)
            return qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "pipeline: unknown key '%.64s' in %s%s", key,
                            where,
                            qc__closest_hint(ctx, key, known, (int64_t)n, sizeof *known).text);
    }
    return QC_OK;
}

/* A JSON scalar as the text qc_pipeline_set takes; NULL for objects, arrays and null. */
static const char *scalar_text(json_t *value, char *number, size_t size) {
    switch (json_typeof(value)) {
    case JSON_STRING:
        return json_string_value(value);
    case JSON_TRUE:
        return "true";
    case JSON_FALSE:
        return "false";
    case JSON_REAL:
        qc__print_double(number, size, json_real_value(value));
        return number;
    case JSON_INTEGER:
        snprintf(number, size, "%lld", (long long)json_integer_value(value));
        return number;
    default:
        return NULL;
    }
}

static qc_status parse_params(qc_pipeline *pipeline, const char *step, json_t *params) {
    char number[64];
    for (void *it = json_object_iter(params); it; it = json_object_iter_next(params, it)) {
        const char *key = json_object_iter_key(it);
        const char *text = scalar_text(json_object_iter_value(it), number, sizeof number);
        if (!text)
            return qc__fail(pipeline->registry->ctx, QC_ERR_ARGUMENT, -1,
                            "pipeline: parameter '%.64s' of step '%s' must be a number, a text or "
                            "true/false",
                            key, step);
        const qc_status status = qc_pipeline_set(pipeline, step, key, text);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

static qc_status parse_wires(qc_pipeline *pipeline, const char *step, json_t *wires) {
    for (void *it = json_object_iter(wires); it; it = json_object_iter_next(wires, it)) {
        const char *source = json_string_value(json_object_iter_value(it));
        if (!source)
            return qc__fail(pipeline->registry->ctx, QC_ERR_ARGUMENT, -1,
                            "pipeline: input '%.64s' of step '%s' must name \"step.port\" or an "
                            "object",
                            json_object_iter_key(it), step);
        const qc_status status = qc_pipeline_wire(pipeline, step, json_object_iter_key(it), source);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

static qc_status parse_step(qc_pipeline *pipeline, json_t *object) {
    static const char *const known[] = {"stage", "as", "params", "in", "version"};
    qc_ctx *ctx = pipeline->registry->ctx;
    char where[64];
    snprintf(where, sizeof where, "step %lld", (long long)pipeline->n + 1);
    json_t *as = json_object_get(object, "as"), *params = json_object_get(object, "params");
    json_t *wires = json_object_get(object, "in"), *version = json_object_get(object, "version");
    const char *id = json_string_value(json_object_get(object, "stage"));
    if (!id || (as && !json_is_string(as)) || (params && !json_is_object(params)) ||
        (wires && !json_is_object(wires)) || (version && !json_is_string(version)))
        return qc__fail(ctx, QC_ERR_INPUT, -1,
                        "pipeline: %s must be { \"stage\": text, \"as\": text, \"params\": {}, "
                        "\"in\": {} }",
                        where);
    qc_status status = check_keys(ctx, object, known, sizeof known / sizeof *known, where);
    if (status == QC_OK)
        status = qc_pipeline_insert(pipeline, (uint32_t)pipeline->n, json_string_value(as), id);
    if (status != QC_OK) return status;

    const qc__step *step = &pipeline->step[pipeline->n - 1];
    if (version && strcmp(json_string_value(version), step->stage->version) != 0)
        qc__log(ctx, QC_LOG_WARNING,
                "step '%s' was written with version %s of stage %s; this is %s", step->name,
                json_string_value(version), step->stage->id, step->stage->version);
    status = parse_params(pipeline, step->name, params);
    return status == QC_OK ? parse_wires(pipeline, step->name, wires) : status;
}

static qc_status parse_root(qc_pipeline *pipeline, json_t *root) {
    static const char *const known[] = {"qc_pipeline", "stages"};
    qc_ctx *ctx = pipeline->registry->ctx;
    json_t *format = json_object_get(root, "qc_pipeline"),
           *stages = json_object_get(root, "stages");
    if (!json_is_object(root))
        return qc__fail(ctx, QC_ERR_INPUT, -1, "pipeline: the text must be a JSON object");
    const qc_status status = check_keys(ctx, root, known, 2, "the pipeline");
    if (status != QC_OK) return status;
    if (!json_is_integer(format) || json_integer_value(format) != 1 || !json_is_array(stages))
        return qc__fail(ctx, QC_ERR_INPUT, -1,
                        "pipeline: expected { \"qc_pipeline\": 1, \"stages\": [ ... ] }");
    for (size_t i = 0; i < json_array_size(stages); i++) {
        const qc_status s = parse_step(pipeline, json_array_get(stages, i));
        if (s != QC_OK) return s;
    }
    return QC_OK;
}

qc_status qc_pipeline_parse(qc_registry *registry, const char *json, qc_pipeline **out) {
    json_error_t error;
    json_t *root = json_loads(json, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        return qc__fail(registry->ctx, QC_ERR_INPUT, error.line, "pipeline: line %d, column %d: %s",
                        error.line, error.column, error.text);
    qc_pipeline *pipeline = NULL;
    qc_status status = qc_pipeline_create(registry, &pipeline);
    if (status == QC_OK) status = parse_root(pipeline, root);
    json_decref(root);
    if (status != QC_OK) {
        qc_pipeline_free(pipeline);
        return status;
    }
    *out = pipeline;
    return QC_OK;
}

/* --- print ------------------------------------------------------------------------------------ */

typedef struct text {
    qc_ctx *ctx;
    char *data;
    int64_t n, capacity;
    qc_status status; /* the first failure; later additions do nothing */
} text;

static void add(text *t, const char *piece) {
    const size_t n = strlen(piece);
    if (t->status != QC_OK) return;
    if (!qc__reserve(t->ctx, (void **)&t->data, &t->capacity, t->n + (int64_t)n + 1, 1)) {
        t->status = QC_ERR_NOMEM;
        return;
    }
    memcpy(t->data + t->n, piece, n + 1);
    t->n += (int64_t)n;
}

static void add_string(text *t, const char *s) {
    json_t *value = json_string(s);
    char *quoted = value ? json_dumps(value, JSON_ENCODE_ANY) : NULL;
    if (quoted)
        add(t, quoted);
    else if (t->status == QC_OK)
        t->status = qc__fail(t->ctx, QC_ERR_INPUT, -1, "pipeline: a text is not valid UTF-8");
    free(quoted);
    json_decref(value);
}

static void add_pair(text *t, const char *before, const char *key, const char *value) {
    add(t, before);
    add_string(t, key);
    add(t, ": ");
    add_string(t, value);
}

/* Numbers and bools go out bare; JSON has no literal for infinity. */
static bool is_literal(const qc_param *p, const char *value) {
    return p->type == QC_BOOL || p->type == QC_INT || (p->type == QC_REAL && !strstr(value, "inf"));
}

static void add_params(text *t, const qc__step *step) {
    const char *before = ",\n      \"params\": { ";
    char number[64];
    for (uint32_t i = 0; i < step->stage->n_params; i++) {
        const qc_param *p = &step->stage->params[i];
        const char *value = qc__param_print(p, step->params, number);
        if (!value) continue; /* a text which is not set */
        add(t, before);
        add_string(t, p->name);
        add(t, ": ");
        if (is_literal(p, value))
            add(t, value);
        else
            add_string(t, value);
        before = ", ";
    }
    if (before[1] == ' ') add(t, " }");
}

static void add_wires(text *t, const qc__step *step) {
    const char *before = ",\n      \"in\": { ";
    for (uint32_t i = 0; i < step->stage->n_in; i++) {
        if (!step->wire[i]) continue;
        add_pair(t, before, step->stage->in[i].name, step->wire[i]);
        before = ", ";
    }
    if (before[1] == ' ') add(t, " }");
}

qc_status qc_pipeline_print(const qc_pipeline *pipeline, char **json) {
    text t = {pipeline->registry->ctx, NULL, 0, 0, QC_OK};
    add(&t, "{ \"qc_pipeline\": 1, \"stages\": [");
    for (int64_t i = 0; i < pipeline->n; i++) {
        const qc__step *step = &pipeline->step[i];
        add_pair(&t, i ? ",\n    { " : "\n    { ", "stage", step->stage->id);
        add_pair(&t, ", ", "version", step->stage->version);
        add_pair(&t, ", ", "as", step->name);
        add_params(&t, step);
        add_wires(&t, step);
        add(&t, " }");
    }
    add(&t, " ] }\n");
    if (t.status != QC_OK) {
        qc__free(t.data);
        return t.status;
    }
    *json = t.data;
    return QC_OK;
}

void qc_text_free(char *text_to_free) {
    qc__free(text_to_free);
}
