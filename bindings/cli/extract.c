/* quadcover extract: the quads of an integer-seamless parameterization. */
#include "bindings/cli/cli.h"
#include <stdlib.h>
#include <string.h>

static const char about[] =
    "Reads triangles with a texture coordinate at every corner whose transitions across edges are\n"
    "quarter turns and integer shifts, and writes the quads of the integer isolines: manifold, "
    "only\n"
    "quads, Euler characteristic of the input; or names the place where the map breaks a rule.";

typedef struct settings {
    const char *input, *output, *stats;
    int format;
    cli_list set, plugin;
    cli_common common;
} settings;

typedef struct run {
    cli_session session;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_polygon_mesh *soup;
    qc_corner_map *map;
    qc_bag *bag;
    qc_stats_options stats;
} run;

static int build(run *r, const settings *s) {
    qc_ctx *ctx = r->session.ctx;
    qc_pipeline *empty = NULL;
    int status = cli_registry(ctx, &s->plugin, &r->registry);
    if (status != EXIT_DONE) return status;
    if (qc_pipeline_create(r->registry, &empty) != QC_OK)
        return cli_context_error(ctx, NULL, EXIT_FAILED);
    r->pipeline = empty;
    if (qc_pipeline_insert(empty, 0, "extract", "qc.extract") != QC_OK ||
        qc_pipeline_insert(empty, 1, "measure", "qc.measure") != QC_OK)
        return cli_context_error(ctx, NULL, EXIT_FAILED);
    return cli_pipeline_settings(ctx, empty, &s->set);
}

static int compute(run *r, const settings *s) {
    qc_ctx *ctx = r->session.ctx;
    const double start = cli_seconds();
    const int status = cli_read_mesh(&r->session, s->input, &r->soup);
    if (status != EXIT_DONE) return status;
    if (qc_corner_map_from_polygons(ctx, r->soup, &r->map) != QC_OK)
        return cli_session_error(&r->session, s->input, EXIT_INPUT);
    r->stats.read = cli_seconds() - start;
    if (qc_bag_create(ctx, &r->bag) != QC_OK || qc_bag_put(r->bag, "map", r->map) != QC_OK ||
        qc_bag_put(r->bag, "mesh", r->map->mesh) != QC_OK ||
        qc_pipeline_run(r->pipeline, r->bag) != QC_OK)
        return cli_session_error(&r->session, s->input, EXIT_FAILED);
    return EXIT_DONE;
}

static int write_stats(run *r, const settings *s) {
    char *text = NULL;
    if (!cli_stats(&r->session, qc_bag_latest(r->bag, QC_TYPE_REPORT), r->pipeline, s->input,
                   "extract", &r->stats, &text))
        return cli_session_error(&r->session, s->stats, EXIT_FAILED);
    const int status = cli_write_text(s->stats, text);
    qc_text_free(text);
    return status;
}

static int work(run *r, const settings *s) {
    int status = build(r, s);
    if (status == EXIT_DONE) status = compute(r, s);
    cli_session_quiet(&r->session);
    if (status != EXIT_DONE) return status;
    if (cli_interrupted()) return cli_error(EXIT_INTERRUPTED, "interrupted");
    const double start = cli_seconds();
    const qc_polygon_mesh *quads = qc_bag_latest(r->bag, QC_TYPE_POLYGON_MESH);
    if (qc_polygon_mesh_write_as(r->session.ctx, quads, s->output, s->format,
                                 "quadcover " QC_VERSION_STRING) != QC_OK)
        return cli_session_error(&r->session, s->output, EXIT_FAILED);
    r->stats.write = cli_seconds() - start;
    return s->stats ? write_stats(r, s) : EXIT_DONE;
}

int cli_extract(int argc, const char **argv) {
    settings s;
    run r;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&r, 0, sizeof r);
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &s.output, 0, 0, NULL, "OUT",
         "the quad mesh: .obj, .ply or .off"},
        CLI_FORMAT_OPTION(s.format),
        {"stats", 0, CLI_TEXT, &s.stats, 0, 0, NULL, "S.json", "write statistics"},
        {"set", 0, CLI_LIST, &s.set, 0, 0, NULL, "step.param=value", "set a parameter of a step"},
        {"plugin", 0, CLI_LIST, &s.plugin, 0, 0, NULL, "X.so", "load a plugin"},
        CLI_COMMON_OPTIONS(s.common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status = cli_parse(argc, argv, options, 1, 1, "UV -o OUT [options]", about, &arguments);
    if (status >= 0) return status;
    s.input = arguments.positional[0];
    status = s.output ? cli_check_writable(s.output)
                      : cli_error(EXIT_USAGE, "nothing to write; give -o OUT.obj");
    if (status == EXIT_DONE) status = cli_check_writable(s.stats);
    if (status == EXIT_DONE) status = cli_session_open(&r.session, &s.common);
    if (status == EXIT_DONE) status = work(&r, &s);
    qc_bag_free(r.bag);
    qc_object_release(r.map);
    qc_object_release(r.soup);
    qc_pipeline_free(r.pipeline);
    qc_registry_free(r.registry);
    if (r.session.ctx) cli_session_close(&r.session);
    cli_arguments_free(&arguments);
    return status;
}
