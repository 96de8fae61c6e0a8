/* Interfaces by id and name: built-in tables, tables of the host program, tables of plugins. Those
 * of plugins are asked for when they are needed, so that nothing here knows an id. */
#include "sdk/pipeline/internal.h"
#include <string.h>

static bool is_usable(const qc_interface *table) {
    return table->struct_size >= sizeof *table && table->name && *table->name;
}

static const qc_interface *const *of_plugin(const qc_plugin *plugin, const char *id) {
    return qc__has_extension(plugin) ? plugin->extension(id) : NULL;
}

/* Table i under an id; registry NULL = built-in tables only. */
static const qc_interface *at(const qc_registry *registry, const char *id, uint32_t i) {
    for (const qc__offer *o = qc__builtin_interfaces; o->id; o++)
        if (strcmp(o->id, id) == 0 && i-- == 0) return o->table;
    for (int64_t k = 0; registry && k < registry->n_offers; k++)
        if (strcmp(registry->offer[k].id, id) == 0 && i-- == 0) return registry->offer[k].table;
    for (int64_t k = 0; registry && k < registry->n_libraries; k++) {
        const qc_interface *const *list = of_plugin(registry->library[k].plugin, id);
        for (; list && *list; list++)
            if (is_usable(*list) && i-- == 0) return *list;
    }
    return NULL;
}

/* " (closest: 'mumps')", or what there is to choose from. */
static void suggest(const qc_registry *registry, const char *id, const char *name, char *text,
                    size_t size) {
    const char *names[64];
    uint32_t n = 0;
    for (const qc_interface *t; n < 64 && (t = at(registry, id, n)); n++) names[n] = t->name;
    const char *closest = qc_closest_name(name, names, n);
    if (closest) {
        snprintf(text, size, " (closest: '%.64s')", closest);
        return;
    }
    size_t used = (size_t)snprintf(text, size, "; load the plugin which has it; there is:");
    for (uint32_t i = 0; i < n && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, " %.64s", names[i]);
}

qc_status qc__interface_find(qc_ctx *ctx, const qc_registry *registry, const char *subject,
                             const char *id, const char *name, const qc_interface **out) {
    const qc_interface *found = NULL, *table;
    const bool first = !name || !*name;
    for (uint32_t i = 0; (table = at(registry, id, i)) && !(first && found); i++)
        if (first || strcmp(table->name, name) == 0) found = table;
    if (found) {
        *out = found;
        return QC_OK;
    }
    if (first) return qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "%snothing offers %.64s", subject, id);
    char hint[256];
    suggest(registry, id, name, hint, sizeof hint);
    return qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "%sno %.64s is called '%.64s'%s", subject, id, name,
                    hint);
}

qc_status qc_registry_offer(qc_registry *registry, const char *id, const qc_interface *table) {
    if (!id || !*id || !table)
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1, "an interface needs an id and a table");
    if (table->struct_size < sizeof *table)
        return qc__fail(registry->ctx, QC_ERR_ABI, -1, "a table of %u bytes for %.64s is too short",
                        table->struct_size, id);
    if (!is_usable(table))
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1, "a table for %.64s has no name", id);
    char *copy = qc__arena_alloc(registry->arena, strlen(id) + 1);
    if (!copy) return qc__nomem(registry->ctx);
    memcpy(copy, id, strlen(id) + 1);
    if (!qc__reserve(registry->ctx, (void **)&registry->offer, &registry->offer_capacity,
                     registry->n_offers + 1, sizeof *registry->offer))
        return QC_ERR_NOMEM;
    registry->offer[registry->n_offers++] = (qc__offer){copy, table};
    return QC_OK;
}

const qc_interface *qc_registry_interface(const qc_registry *registry, const char *id, uint32_t i) {
    return at(registry, id, i);
}

qc_status qc_registry_find_interface(qc_registry *registry, const char *id, const char *name,
                                     const qc_interface **out) {
    return qc__interface_find(registry->ctx, registry, "", id, name, out);
}
