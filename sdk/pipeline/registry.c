/* The registry: built-in stages, stages of the host program and those of plugins, by id. */
#include "sdk/pipeline/internal.h"
#include <string.h>

static const void *get_interface(const qc_host *host, const char *id) {
    return qc_registry_interface(host->host_data, id, 0);
}

qc_status qc_registry_create(qc_ctx *ctx, qc_registry **out) {
    qc_registry *r = QC__ZERO(ctx, qc_registry, 1);
    if (!r) return QC_ERR_NOMEM;
    r->ctx = ctx;
    r->host = (qc_host){sizeof r->host, QC_ABI_MAJOR, QC_ABI_MINOR, "quadcover", qc_version(), r,
                        get_interface};
    r->arena = qc__arena_create(ctx);
    qc_status status = r->arena ? QC_OK : QC_ERR_NOMEM;
    for (size_t i = 0; status == QC_OK && qc__builtin_stages[i]; i++)
        status = qc_registry_add(r, qc__builtin_stages[i]);
    if (status != QC_OK) {
        qc_registry_free(r);
        return status;
    }
    *out = r;
    return QC_OK;
}

void qc_registry_free(qc_registry *registry) {
    if (!registry) return;
    while (registry->n_libraries > 0) qc__library_close(registry->library[--registry->n_libraries]);
    qc__free(registry->library);
    qc__free(registry->offer);
    qc__free(registry->stage);
    qc__arena_free(registry->arena);
    qc__free(registry);
}

static int64_t find(const qc_registry *registry, const char *id) {
    for (int64_t i = 0; i < registry->n; i++)
        if (strcmp(registry->stage[i]->id, id) == 0) return i;
    for (int64_t i = 0; i < registry->n; i++)
        if (strcmp(qc__short_id(registry->stage[i]->id), id) == 0) return i;
    return -1;
}

static int64_t find_exact(const qc_registry *registry, const char *id) {
    const int64_t i = find(registry, id);
    return i >= 0 && strcmp(registry->stage[i]->id, id) == 0 ? i : -1;
}

qc_status qc__registry_commit(qc_registry *registry, const qc_stage *const *stage, int64_t n) {
    if (!qc__reserve(registry->ctx, (void **)&registry->stage, &registry->capacity, registry->n + n,
                     sizeof *registry->stage))
        return QC_ERR_NOMEM;
    for (int64_t i = 0; i < n; i++) {
        const int64_t old = find_exact(registry, stage[i]->id);
        registry->stage[old >= 0 ? old : registry->n++] = stage[i];
    }
    return QC_OK;
}

qc_status qc_registry_add(qc_registry *registry, const qc_stage *stage) {
    const qc_stage *copy;
    const qc_status status = qc__table_import(registry->ctx, registry->arena, stage, &copy);
    return status == QC_OK ? qc__registry_commit(registry, &copy, 1) : status;
}

uint32_t qc_registry_count(const qc_registry *registry) {
    return (uint32_t)registry->n;
}

const qc_stage *qc_registry_stage(const qc_registry *registry, uint32_t i) {
    return i < registry->n ? registry->stage[i] : NULL;
}

qc_status qc_registry_find(qc_registry *registry, const char *id, const qc_stage **out) {
    const int64_t i = find(registry, id);
    if (i >= 0) {
        *out = registry->stage[i];
        return QC_OK;
    }
    const char **names = QC__NEW(registry->ctx, const char *, registry->n);
    for (int64_t k = 0; names && k < registry->n; k++) names[k] = registry->stage[k]->id;
    const qc__hint hint =
        qc__closest_hint(registry->ctx, id, names, names ? registry->n : 0, sizeof *names);
    qc__free(names);
    return qc__fail(registry->ctx, QC_ERR_NOT_FOUND, -1, "unknown stage '%.100s'%s", id, hint.text);
}
