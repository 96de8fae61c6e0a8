/* A plugin that wants another host: its open refuses, so its close is never called. */
#include <qc/plugin.h>

QC_EXPORT int closed;

static qc_status open(const qc_host *host) {
    (void)host;
    return QC_ERR_ABI;
}
static void close(void) {
    closed++;
}
static const qc_stage *const *stages(void) {
    return NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {sizeof(qc_plugin),
                                                QC_ABI_MAJOR,
                                                QC_ABI_MINOR,
                                                "org.test.refusing",
                                                "1",
                                                "MIT",
                                                "",
                                                open,
                                                close,
                                                stages,
                                                NULL};
