/* The plugin: one stage. */
#include <qc/plugin.h>

#include "parts.h"

static const qc_stage *const list[] = {&qo_stage, NULL};
static const qc_stage *const *stages(void) {
    return list;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin),     QC_ABI_MAJOR,     QC_ABI_MINOR,
    .id = "qc.opensubdiv", .version = "1.0", .license = "MIT (OpenSubdiv: modified Apache-2.0)",
    .stages = stages,
};
