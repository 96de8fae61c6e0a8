/* Registry and pipeline from command line options. */
#include "bindings/cli/cli.h"
#include <stdlib.h>
#include <string.h>

static int load_path(qc_ctx *ctx, qc_registry *registry, const char *list) {
    char *copy = strdup(list), *rest = NULL;
    int status = copy ? EXIT_DONE : cli_error(EXIT_FAILED, "out of memory");
    for (char *path = copy ? strtok_r(copy, ":", &rest) : NULL; path && status == EXIT_DONE;
         path = strtok_r(NULL, ":", &rest))
        if (qc_registry_load(registry, path) != QC_OK) status = cli_usage_error(ctx, path);
    free(copy);
    return status;
}

int cli_registry(qc_ctx *ctx, const cli_list *plugins, qc_registry **out) {
    qc_registry *registry = NULL;
    if (qc_registry_create(ctx, &registry) != QC_OK)
        return cli_context_error(ctx, NULL, EXIT_FAILED);
    const char *path = getenv("QC_PLUGIN_PATH");
    int status = path ? load_path(ctx, registry, path) : EXIT_DONE;
    for (int i = 0; i < plugins->n && status == EXIT_DONE; i++)
        if (qc_registry_load(registry, plugins->item[i]) != QC_OK)
            status = cli_usage_error(ctx, plugins->item[i]);
    if (status == EXIT_DONE)
        *out = registry;
    else
        qc_registry_free(registry);
    return status;
}

/* A whole text file; NULL after a message. */
static char *read_text(const char *path) {
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, got = 1;
    while (file && got > 0) {
        char *grown = realloc(text, used + 65537);
        if (!grown) break;
        text = grown;
        used += got = fread(text + used, 1, 65536, file);
        text[used] = '\0';
    }
    if (file && file != stdin) fclose(file);
    if (used > 0) return text;
    free(text);
    cli_error(EXIT_USAGE, "%s: cannot read a pipeline from it; name a JSON file", path);
    return NULL;
}

static int read_pipeline(qc_ctx *ctx, qc_registry *registry, const char *file, qc_pipeline **out) {
    char *json = read_text(file);
    if (!json) return EXIT_USAGE;
    const qc_status status = qc_pipeline_parse(registry, json, out);
    free(json);
    return status == QC_OK ? EXIT_DONE : cli_usage_error(ctx, file);
}

/* "step.param=value": the step's name may hold dots, the parameter's not. */
static int apply(qc_ctx *ctx, qc_pipeline *pipeline, const char *setting) {
    char step[128];
    const size_t length = strcspn(setting, "=");
    size_t dot = length;
    while (dot > 0 && setting[dot - 1] != '.') dot--;
    if (setting[length] != '=' || dot < 2 || dot == length || length >= sizeof step)
        return cli_error(EXIT_USAGE, "--set %s: use step.param=value", setting);
    memcpy(step, setting, length);
    step[length] = '\0';
    step[dot - 1] = '\0';
    if (qc_pipeline_set(pipeline, step, step + dot, setting + length + 1) == QC_OK)
        return EXIT_DONE;
    return cli_usage_error(ctx, "--set");
}

int cli_pipeline_settings(qc_ctx *ctx, qc_pipeline *pipeline, const cli_list *settings) {
    int status = EXIT_DONE;
    for (int i = 0; i < settings->n && status == EXIT_DONE; i++)
        status = apply(ctx, pipeline, settings->item[i]);
    return status;
}

int cli_pipeline(qc_ctx *ctx, qc_registry *registry, const char *file,
                 const qc_default_pipeline_options *options, const cli_list *settings,
                 qc_pipeline **out) {
    qc_pipeline *pipeline = NULL;
    int status = EXIT_DONE;
    if (file)
        status = read_pipeline(ctx, registry, file, &pipeline);
    else if (qc_default_pipeline(ctx, registry, options, &pipeline) != QC_OK)
        status = cli_usage_error(ctx, NULL);
    if (status == EXIT_DONE) status = cli_pipeline_settings(ctx, pipeline, settings);
    if (status == EXIT_DONE)
        *out = pipeline;
    else
        qc_pipeline_free(pipeline);
    return status;
}
