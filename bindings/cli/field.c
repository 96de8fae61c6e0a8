/* quadcover field: the field stages alone. */
#include "bindings/cli/cli.h"
#include <string.h>

static const char about[] =
    "Computes the smooth cross field that remesh would use and writes it: .rawfield "
    "(Directional's\n"
    "format, the default) or .rosy by the name of the output; one cross for each face of the "
    "repaired\n"
    "mesh. --smoothest: the smoothest field instead of curvature directions.";

typedef struct settings {
    const char *input, *output;
    bool smoothest;
    cli_list set, plugin;
    cli_common common;
} settings;

typedef struct run {
    cli_session session;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_polygon_mesh *input;
    qc_remesh_result result;
} run;

/* The first steps of the default pipeline. */
static int build(run *r, const settings *s) {
    static const char *const curvature[][2] = {{"repair", "qc.repair"},
                                               {"size", "qc.size"},
                                               {"features", "qc.features"},
                                               {"refine", "qc.split.features"},
                                               {"curvature", "qc.field.curvature"},
                                               {"smooth", "qc.field.smooth"},
                                               {NULL, NULL}};
    static const char *const smoothest[][2] = {{"repair", "qc.repair"},
                                               {"features", "qc.features"},
                                               {"smoothest", "qc.field.smoothest"},
                                               {NULL, NULL}};
    qc_ctx *ctx = r->session.ctx;
    const int status = cli_registry(ctx, &s->plugin, &r->registry);
    if (status != EXIT_DONE) return status;
    if (qc_pipeline_create(r->registry, &r->pipeline) != QC_OK)
        return cli_context_error(ctx, NULL, EXIT_FAILED);
    const char *const(*step)[2] = s->smoothest ? smoothest : curvature;
    for (uint32_t i = 0; step[i][0]; i++)
        if (qc_pipeline_insert(r->pipeline, i, step[i][0], step[i][1]) != QC_OK)
            return cli_context_error(ctx, NULL, EXIT_FAILED);
    return cli_pipeline_settings(ctx, r->pipeline, &s->set);
}

static int work(run *r, const settings *s) {
    int status = build(r, s);
    if (status == EXIT_DONE) status = cli_read_mesh(&r->session, s->input, &r->input);
    if (status != EXIT_DONE) return status;
    qc_remesh_options options = QC_REMESH_OPTIONS_INIT;
    options.strict = 1;
    if (qc_remesh(r->session.ctx, r->pipeline, r->input, &options, &r->result) != QC_OK)
        return cli_run_error(&r->session, s->input);
    cli_session_quiet(&r->session);
    if (cli_interrupted()) return cli_error(EXIT_INTERRUPTED, "interrupted");
    if (qc_face_field_write(r->session.ctx, r->result.field, s->output) != QC_OK)
        return cli_session_error(&r->session, s->output, EXIT_FAILED);
    return EXIT_DONE;
}

int cli_field(int argc, const char **argv) {
    settings s;
    run r;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&r, 0, sizeof r);
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &s.output, 0, 0, NULL, "F.rawfield", "the cross field"},
        {"smoothest", 0, CLI_FLAG, &s.smoothest, 0, 0, NULL, NULL, "the smoothest field"},
        {"set", 0, CLI_LIST, &s.set, 0, 0, NULL, "step.param=value", "set a parameter of a step"},
        {"plugin", 0, CLI_LIST, &s.plugin, 0, 0, NULL, "X.so", "load a plugin"},
        CLI_COMMON_OPTIONS(s.common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status =
        cli_parse(argc, argv, options, 1, 1, "IN -o F.rawfield [options]", about, &arguments);
    if (status >= 0) return status;
    s.input = arguments.positional[0];
    status = s.output ? cli_check_writable(s.output)
                      : cli_error(EXIT_USAGE, "nothing to write; give -o F.rawfield");
    if (status == EXIT_DONE) status = cli_session_open(&r.session, &s.common);
    if (status == EXIT_DONE) status = work(&r, &s);
    qc_remesh_result_clear(&r.result);
    qc_object_release(r.input);
    qc_pipeline_free(r.pipeline);
    qc_registry_free(r.registry);
    if (r.session.ctx) cli_session_close(&r.session);
    cli_arguments_free(&arguments);
    return status;
}
