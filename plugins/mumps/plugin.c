/* The plugin: no stage, one solver. */
#include <qc/plugin.h>
#include <stdio.h>
#include <string.h>
#include "qc_mumps.h"
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

static qc_status answer(qc_ctx *ctx, const char *reason) {
    char text[160];
    if (!reason) return QC_OK;
    snprintf(text, sizeof text, "plugin qc.mumps: %s", reason);
    return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, -1, text);
}
static qc_status use(qc_ctx *ctx, int comm) {
    return answer(ctx, qm_join(comm));
}
static qc_status serve(qc_ctx *ctx, int comm) {
    return answer(ctx, qm_join_and_serve(comm));
}
static qc_status release(qc_ctx *ctx) {
    return answer(ctx, qm_leave());
}

static const qc_mumps control = {
    .head = {sizeof(qc_mumps), 0, "mumps", "processes of a program which runs under MPI itself"},
    .use = use,
    .serve = serve,
    .release = release,
};
static const qc_interface *const controls[] = {&control.head, NULL};

static const void *extension(const char *id) {
    if (strcmp(id, QC_SOLVER_ID) == 0) return solvers;
    return strcmp(id, QC_MUMPS_ID) == 0 ? controls : NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin),
    QC_ABI_MAJOR,
    QC_ABI_MINOR,
    .id = "qc.mumps",
    .version = "1.0",
    .open = open,
    .license = "MIT (MUMPS: CeCILL-C)",
    .extension = extension,
};
