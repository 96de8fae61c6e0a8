/* A table that claims another major version: none of its functions may be called. */
#include <qc/plugin.h>

QC_EXPORT int called;

static qc_status open(const qc_host *host) {
    (void)host;
    called++;
    return QC_OK;
}
static const qc_stage *const *stages(void) {
    called++;
    return NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {sizeof(qc_plugin),
                                                QC_ABI_MAJOR + 1,
                                                0,
                                                "org.test.other_major",
                                                "1",
                                                "MIT",
                                                "",
                                                open,
                                                NULL,
                                                stages,
                                                NULL};
