/* The plugin: no stage, one solver. */
#include <qc/plugin.h>
#include <string.h>
#include "solver.h"

/* Under a launcher the other processes wait in MPI_Init for this one, whether or not it will solve
 * anything. Alone, MPI starts with the first matrix. It ends when the process does (group.c), so
 * that any number of registries may load and close the plugin. */
static qc_status open(const qc_host *host) {
    (void)host;
    if (qm_has_launcher()) qm_start();
    return QC_OK;
}

static const qc_interface *const solvers[] = {&qm_solver.head, NULL};

static const void *extension(const char *id) {
    return strcmp(id, QC_SOLVER_ID) == 0 ? solvers : NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin), QC_ABI_MAJOR, QC_ABI_MINOR,     .id = "qc.mumps",
    .version = "1.0",  .open = open, .license = "MIT", .extension = extension,
};
