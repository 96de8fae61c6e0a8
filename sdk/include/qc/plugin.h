/* qc/plugin.h - the one symbol a plugin exports. Everything optional is found by id.
 *
 * A plugin is a shared library which defines `const qc_plugin qc_plugin_1`, its only exported name.
 * The host reads the table before it calls any function, checks abi_major and the sizes, then calls
 * open and stages. Each registry which loads the library calls open once, and close when freed. A
 * plugin that calls functions of the SDK links QuadCover::quadcover; others need the headers only.
 * Thread rule: all functions are called on the thread of the registry's context. */
#ifndef QC_PLUGIN_H
#define QC_PLUGIN_H

#include <qc/stage.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_ABI_MAJOR 1 /* bump = new symbol name below; old plugins are not found, not crashed */
#define QC_ABI_MINOR 1 /* bump = members appended; struct_size says which exist */

typedef struct qc_host {
    uint32_t struct_size;
    uint16_t abi_major, abi_minor;
    const char *name, *version;
    void *host_data;
    /* The host's own table of an interface, a `const qc_interface *`; NULL = absent. */
    const void *(*get_interface)(const struct qc_host *host, const char *id);
} qc_host;

typedef struct qc_plugin {
    uint32_t struct_size;
    uint16_t abi_major, abi_minor;
    const char *id, *version, *license, *url;
    qc_status (*open)(const qc_host *host); /* NULL = nothing to do; may refuse (QC_ERR_ABI)      */
    void (*close)(void);                    /* NULL = nothing to do; not called after a refusal   */
    /* NULL-terminated, as long-lived as the library; may be NULL where extension is not. */
    const qc_stage *const *(*stages)(void);
    /* What the plugin offers by id, NULL = nothing (also for ids it does not know). For interfaces
     * such as QC_SOLVER_ID: a `const qc_interface *const *`, NULL-terminated, as long-lived as the
     * library. May be called at any time between open and close. */
    const void *(*extension)(const char *id);
} qc_plugin;

/* The definition in the plugin: QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = { ... }; */
#ifdef __cplusplus
#define QC_PLUGIN_EXPORT extern "C" QC_EXPORT
#else
#define QC_PLUGIN_EXPORT QC_EXPORT
#endif
#define QC_PLUGIN_SYMBOL "qc_plugin_1"

#ifdef __cplusplus
}
#endif
#endif
