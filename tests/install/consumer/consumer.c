/* A program that knows only the installed SDK: loads a plugin and lists all stages. */
#include <qc/qc.h>
#include <stdio.h>

int main(int argc, char **argv) {
    qc_ctx *ctx = NULL;
    qc_registry *registry = NULL;
    qc_status status = qc_ctx_create(NULL, &ctx);
    if (status == QC_OK) status = qc_registry_create(ctx, &registry);
    if (status == QC_OK && argc > 1) status = qc_registry_load(registry, argv[1]);
    if (status != QC_OK) {
        fprintf(stderr, "%s\n", ctx ? qc_ctx_error(ctx)->text : "no context");
        return 1;
    }
    if (registry && qc_stage_hodge.n_out != 1) return 2; /* the tables are exported */
    printf("%s\n", qc_version());
    for (uint32_t i = 0; i < qc_registry_count(registry); i++)
        printf("%s %s\n", qc_registry_stage(registry, i)->id,
               qc_registry_stage(registry, i)->version);
    qc_registry_free(registry);
    qc_ctx_free(ctx);
    return 0;
}
