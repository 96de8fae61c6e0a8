/* Loading of plugins: the only file with dlopen. The table qc_plugin_1 is read and checked before
 * any function of the plugin is called. */
#include "sdk/pipeline/internal.h"
#include <dlfcn.h>
#include <string.h>

enum { PLUGIN_MINIMUM = offsetof(qc_plugin, extension) };

void qc__library_close(qc__library library) {
    if (library.plugin->close) library.plugin->close();
    dlclose(library.handle);
}

/* A bare file name means the file in the working directory, never a search of system folders. */
static void *open_library(qc_ctx *ctx, const char *path) {
    char *local = NULL;
    if (!strchr(path, '/')) {
        local = QC__NEW(ctx, char, strlen(path) + 3);
        if (!local) return NULL;
        memcpy(local, "./", 2);
        memcpy(local + 2, path, strlen(path) + 1);
    }
    void *handle = dlopen(local ? local : path, RTLD_NOW | RTLD_LOCAL);
    qc__free(local);
    if (!handle) qc__fail(ctx, QC_ERR_IO, -1, "plugin %s: %s", path, dlerror());
    return handle;
}

bool qc__has_extension(const qc_plugin *plugin) {
    return plugin->struct_size >= PLUGIN_MINIMUM + sizeof plugin->extension && plugin->extension;
}

static qc_status check_table(qc_ctx *ctx, const char *path, const qc_plugin *plugin) {
    if (!plugin)
        return qc__fail(ctx, QC_ERR_ABI, -1,
                        "plugin %s: no symbol " QC_PLUGIN_SYMBOL "; built for another ABI version, "
                        "or no plugin",
                        path);
    if (plugin->struct_size < PLUGIN_MINIMUM || plugin->abi_major != QC_ABI_MAJOR)
        return qc__fail(ctx, QC_ERR_ABI, -1,
                        "plugin %s: ABI %u.%u with a table of %u bytes; this library has ABI %d.%d",
                        path, plugin->abi_major, plugin->abi_minor, plugin->struct_size,
                        QC_ABI_MAJOR, QC_ABI_MINOR);
    if (!plugin->id || (!plugin->stages && !qc__has_extension(plugin)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "plugin %s: no id, or neither stages nor extension", path);
    return QC_OK;
}

/* Imports every table first and registers them together. */
static qc_status add_stages(qc_registry *registry, const char *path, const qc_plugin *plugin) {
    const qc_stage *const *table = plugin->stages ? plugin->stages() : NULL;
    int64_t n = 0;
    while (table && table[n]) n++;
    if (n == 0 && qc__has_extension(plugin)) return QC_OK;
    if (n == 0)
        return qc__fail(registry->ctx, QC_ERR_ARGUMENT, -1, "plugin %s: offers no stage", path);
    const qc_stage **copy = QC__NEW(registry->ctx, const qc_stage *, n);
    qc_status status = copy ? QC_OK : QC_ERR_NOMEM;
    for (int64_t i = 0; status == QC_OK && i < n; i++)
        status = qc__table_import(registry->ctx, registry->arena, table[i], &copy[i]);
    if (status == QC_OK) status = qc__registry_commit(registry, copy, n);
    qc__free(copy);
    return status;
}

static bool is_loaded(const qc_registry *registry, const qc_plugin *plugin) {
    for (int64_t i = 0; i < registry->n_libraries; i++)
        if (registry->library[i].plugin == plugin) return true;
    return false;
}

qc_status qc_registry_load(qc_registry *registry, const char *plugin_path) {
    qc_ctx *ctx = registry->ctx;
    if (!plugin_path || !*plugin_path)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no plugin path given");
    if (!qc__reserve(ctx, (void **)&registry->library, &registry->library_capacity,
                     registry->n_libraries + 1, sizeof *registry->library))
        return QC_ERR_NOMEM;
    void *handle = open_library(ctx, plugin_path);
    if (!handle) return qc_ctx_error(ctx)->status;
    const qc_plugin *plugin = dlsym(handle, QC_PLUGIN_SYMBOL);
    if (plugin && is_loaded(registry, plugin)) {
        dlclose(handle);
        return QC_OK;
    }
    qc_status status = check_table(ctx, plugin_path, plugin);
    if (status == QC_OK && plugin->open && plugin->open(&registry->host) != QC_OK)
        status = qc__fail(ctx, QC_ERR_ABI, -1, "plugin %s: refuses this host (%s %s)", plugin_path,
                          registry->host.name, registry->host.version);
    if (status != QC_OK) {
        dlclose(handle);
        return status;
    }
    status = add_stages(registry, plugin_path, plugin);
    if (status != QC_OK)
        qc__library_close((qc__library){handle, plugin});
    else
        registry->library[registry->n_libraries++] = (qc__library){handle, plugin};
    return status;
}
