/* quadcover remesh: triangle mesh to pure quad mesh. */
#include "bindings/cli/cli.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char about[] =
    "Reads a triangle mesh (OBJ, OFF, PLY, STL; polygons are triangulated), computes a cross "
    "field, a\n"
    "seamless parameterization on its four-sheeted covering and the integer grid map, and writes "
    "the\n"
    "quads of its integer isolines. Several components are remeshed one by one at one density; "
    "one\n"
    "that fails is reported and left out.\n\n"
    "Density: --quads N (default 10000), --edge-length L or --edge-length-rel R.\n"
    "--set step.param=value changes any parameter of any step; `quadcover stages` lists them.";
static const char synopsis[] = "IN -o OUT [options]";

enum { MODE_NONE = 0, MODE_FAST, MODE_RELOCATE, MODE_BEST }; /* none = best */
static const char *const modes[] = {"", "fast", "relocate", "best", NULL};

typedef struct settings {
    const char *input, *output, *field, *symmetry, *stroke_rays, *save_field, *uv, *pipeline,
        *stats, *report;
    char *command; /* as given; owned */
    double quads, edge_length, edge_length_rel, sharp;
    bool no_features, keep_materials, strict;
    int mode, format;
    long long seed;
    cli_list set, plugin;
    cli_common common;
} settings;

/* The parts of a run which have to be freed. */
typedef struct run {
    cli_session session;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_polygon_mesh *input;
    qc_remesh_result result;
    qc_stats_options stats;
} run;

/* Hands the table of options, which set *s, to a user. */
static int with_options(settings *s, cli_options_user *use, void *user) {
    const double huge = 1e300, tiny = 1e-300;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &s->output, 0, 0, NULL, "OUT",
         "the quad mesh: .obj, .ply or .off"},
        CLI_FORMAT_OPTION(s->format),
        {"quads", 0, CLI_REAL, &s->quads, 1, 1e9, NULL, "N", "target number of quads"},
        {"edge-length", 0, CLI_REAL, &s->edge_length, tiny, huge, NULL, "L",
         "target edge length, in the units of the mesh"},
        {"edge-length-rel", 0, CLI_REAL, &s->edge_length_rel, tiny, 1, NULL, "R",
         "target edge length, relative to the bounding box diagonal"},
        {"mode", 0, CLI_CHOICE, &s->mode, 0, 0, modes, "fast|relocate|best",
         "branch point optimisation: none, move only, Algorithm 6.1"},
        {"field", 0, CLI_TEXT, &s->field, 0, 0, NULL, "FILE",
         "use this cross field (.rawfield or .rosy)"},
        {"symmetry", 0, CLI_TEXT, &s->symmetry, 0, 0, NULL, "auto|x|y|z|off|nx,ny,nz,d",
         "remesh one half and mirror it at this plane (default off)"},
        {"save-field", 0, CLI_TEXT, &s->save_field, 0, 0, NULL, "F.rawfield",
         "write the cross field"},
        {"stroke-rays", 0, CLI_TEXT, &s->stroke_rays, 0, 0, NULL, "RAYS.json",
         "the field follows strokes seen by these camera rays"},
        {"sharp", 0, CLI_REAL, &s->sharp, 1e-6, 180, NULL, "DEG",
         "align to creases sharper than this angle (default 35)"},
        {"no-features", 0, CLI_FLAG, &s->no_features, 0, 0, NULL, NULL,
         "align neither to creases nor to boundaries"},
        {"keep-materials", 0, CLI_FLAG, &s->keep_materials, 0, 0, NULL, NULL,
         "no quad crosses a border between groups or materials; makes all features hard"},
        {"uv", 0, CLI_TEXT, &s->uv, 0, 0, NULL, "OUT_UV.obj",
         "write the parameterization, one vt per corner"},
        {"pipeline", 0, CLI_TEXT, &s->pipeline, 0, 0, NULL, "P.json", "run these stages"},
        {"set", 0, CLI_LIST, &s->set, 0, 0, NULL, "step.param=value", "set a parameter of a step"},
        {"plugin", 0, CLI_LIST, &s->plugin, 0, 0, NULL, "X.so", "load a plugin"},
        {"stats", 0, CLI_TEXT, &s->stats, 0, 0, NULL, "S.json", "write statistics"},
        {"report", 0, CLI_TEXT, &s->report, 0, 0, NULL, "R.html",
         "write a page with pictures and figures"},
        {"strict", 0, CLI_FLAG, &s->strict, 0, 0, NULL, NULL, "fail when a single component fails"},
        {"seed", 0, CLI_INTEGER, &s->seed, 0, 9007199254740992.0, NULL, "N",
         "seed of randomised searches"},
        CLI_COMMON_OPTIONS(s->common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    return use(options, user);
}

int cli_remesh_with_options(cli_options_user *use, void *user) {
    settings s;
    memset(&s, 0, sizeof s);
    return with_options(&s, use, user);
}

typedef struct parsing {
    int argc;
    const char **argv;
    settings *settings;
    cli_arguments *arguments;
} parsing;

static int parse(const cli_option *options, void *user) {
    parsing *p = user;
    const int status = cli_parse(p->argc, p->argv, options, 1, 1, synopsis, about, p->arguments);
    if (status < 0) p->settings->input = p->arguments->positional[0];
    return status;
}

/* The arguments as a line for a shell; free() it. */
static char *command_line(int argc, const char **argv) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("quadcover", out);
    for (int i = 0; i < argc; i++) {
        const bool plain =
            argv[i][0] && strcspn(argv[i], " \t\n'\"\\$&|;<>()*?[]#~`!{}") == strlen(argv[i]);
        fputs(plain ? " " : " '", out);
        for (const char *c = argv[i]; *c; c++) fputs(*c == '\'' ? "'\\''" : (char[]){*c, 0}, out);
        if (!plain) fputc('\'', out);
    }
    return fclose(out) == 0 ? text : NULL;
}

static int check_outputs(const settings *s) {
    const char *const outputs[] = {s->output, s->uv, s->save_field, s->stats, s->report};
    int n_given = 0, n_stdout = 0, status = EXIT_DONE;
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs && status == EXIT_DONE; i++) {
        if (!outputs[i]) continue;
        n_given++;
        n_stdout += strcmp(outputs[i], "-") == 0;
        status = cli_check_writable(outputs[i]);
    }
    if (status != EXIT_DONE) return status;
    if (n_given == 0) return cli_error(EXIT_USAGE, "nothing to write; give -o OUT.obj");
    if (n_stdout > 1) return cli_error(EXIT_USAGE, "only one output can go to '-'");
    return EXIT_DONE;
}

static int check_settings(const settings *s) {
    if (s->pipeline && s->mode != MODE_NONE)
        return cli_error(EXIT_USAGE, "--pipeline brings its own steps; leave --mode out");
    if ((s->quads > 0) + (s->edge_length > 0) + (s->edge_length_rel > 0) > 1)
        return cli_error(EXIT_USAGE, "give one of --quads, --edge-length and --edge-length-rel");
    if (s->no_features && s->keep_materials)
        return cli_error(EXIT_USAGE,
                         "--keep-materials and --no-features exclude each other; --sharp 180 "
                         "leaves creases out");
    if (s->no_features && s->sharp > 0)
        return cli_error(EXIT_USAGE, "--sharp and --no-features exclude each other");
    const bool step_flags = s->quads > 0 || s->edge_length > 0 || s->edge_length_rel > 0 ||
                            s->sharp > 0 || s->no_features || s->keep_materials || s->field;
    if (s->pipeline && step_flags)
        return cli_error(EXIT_USAGE,
                         "--pipeline brings its own density, features and field; change "
                         "them with --set step.param=value");
    if (s->field && access(s->field, R_OK) != 0)
        return cli_error(EXIT_INPUT, "%s: cannot read the field; name a .rawfield or .rosy file",
                         s->field);
    return check_outputs(s);
}

static int mode_of(const settings *s) {
    return s->mode == MODE_NONE ? MODE_BEST : s->mode;
}

static int build_pipeline(run *r, const settings *s) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    options.quads = s->quads;
    options.edge_length = s->edge_length;
    options.edge_length_rel = s->edge_length_rel;
    options.crease_angle = s->no_features ? -1 : s->sharp;
    options.field_path = s->field;
    options.keep_groups = s->keep_materials;
    options.seed = (uint64_t)s->seed;
    options.mode = mode_of(s) - MODE_FAST + QC_MODE_FAST;
    const int status = cli_registry(r->session.ctx, &s->plugin, &r->registry);
    if (status != EXIT_DONE) return status;
    return cli_pipeline(r->session.ctx, r->registry, s->pipeline, &options, &s->set, &r->pipeline);
}

static qc_remesh_options remesh_options(const settings *s) {
    qc_remesh_options options = QC_REMESH_OPTIONS_INIT;
    options.strict = s->strict;
    options.symmetry = s->symmetry;
    return options;
}

static int check_options(run *r, const settings *s) {
    const qc_remesh_options options = remesh_options(s);
    return qc_remesh_check(r->session.ctx, &options) == QC_OK
               ? EXIT_DONE
               : cli_session_error(&r->session, "--symmetry", EXIT_USAGE);
}

static int compute(run *r, const settings *s) {
    const qc_remesh_options options = remesh_options(s);
    if (qc_remesh(r->session.ctx, r->pipeline, r->input, &options, &r->result) != QC_OK)
        return cli_run_error(&r->session, s->input);
    for (int32_t i = 0; i < r->result.n_warnings; i++)
        cli_session_warn(&r->session, "%s", r->result.warning[i]);
    return EXIT_DONE;
}

static int write_mesh(run *r, const qc_polygon_mesh *mesh, const char *path, int format,
                      const char *what) {
    if (!path) return EXIT_DONE;
    if (!mesh) return cli_error(EXIT_FAILED, "%s: no step of the pipeline makes %s", path, what);
    if (qc_polygon_mesh_write_as(r->session.ctx, mesh, path, format,
                                 "quadcover " QC_VERSION_STRING) != QC_OK)
        return cli_session_error(&r->session, path, EXIT_FAILED);
    return EXIT_DONE;
}

static int write_field(run *r, const char *path) {
    if (!path) return EXIT_DONE;
    if (!r->result.field)
        return cli_error(EXIT_FAILED, "%s: no step of the pipeline makes a field", path);
    if (r->result.mesh->n_faces != r->input->n_faces)
        cli_session_warn(
            &r->session,
            "the field written has one cross for each face of the repaired mesh, not of the "
            "input");
    if (qc_face_field_write(r->session.ctx, r->result.field, path) != QC_OK)
        return cli_session_error(&r->session, path, EXIT_FAILED);
    return EXIT_DONE;
}

static int write_report(run *r, const settings *s, const char *stats) {
    char *page = cli_report_page(&r->session, &r->result, stats, s->command);
    if (!page) return cli_error(EXIT_FAILED, "%s: cannot make the report", s->report);
    const int status = cli_write_text(s->report, page);
    free(page);
    return status;
}

static int write_figures(run *r, const settings *s) {
    if (!s->stats && !s->report) return EXIT_DONE;
    char *text = NULL;
    if (!cli_stats(&r->session, r->result.report, r->pipeline, s->input,
                   s->pipeline ? "pipeline" : modes[mode_of(s)], &r->stats, &text))
        return cli_run_error(&r->session, s->input);
    int status = s->stats ? cli_write_text(s->stats, text) : EXIT_DONE;
    if (status == EXIT_DONE && s->report) status = write_report(r, s, text);
    qc_text_free(text);
    return status;
}

static void check_density(run *r) {
    const qc_report *report = r->result.report;
    const double target = report->density.target_quads;
    if (r->result.n_failed == 0 && target > 0 && report->quads.faces > 0 &&
        fabs((double)report->quads.faces - target) > 0.05 * target)
        cli_session_warn(&r->session, "made %lld quads, more than 5 %% off the target of %g",
                         (long long)report->quads.faces, target);
}

static int write_all(run *r, const settings *s) {
    cli_session_quiet(&r->session);
    r->session.progress = CLI_PROGRESS_NONE; /* the bar is full; what follows would begin another */
    if (cli_interrupted()) return cli_error(EXIT_INTERRUPTED, "interrupted");
    const double start = cli_seconds();
    check_density(r);
    int status = write_mesh(r, r->result.quads, s->output, s->format, "quads");
    if (status == EXIT_DONE)
        status = write_mesh(r, r->result.uv, s->uv, s->format, "a parameterization");
    if (status == EXIT_DONE) status = write_field(r, s->save_field);
    r->stats.write = cli_seconds() - start;
    return status == EXIT_DONE ? write_figures(r, s) : status;
}

static int work(run *r, const settings *s) {
    const double start = cli_seconds();
    int status = check_options(r, s);
    if (status == EXIT_DONE) status = build_pipeline(r, s);
    if (status == EXIT_DONE) status = cli_read_mesh(&r->session, s->input, &r->input);
    if (status == EXIT_DONE && s->stroke_rays)
        status = cli_add_strokes(&r->session, r->registry, s->stroke_rays, &r->input);
    r->stats.read = cli_seconds() - start;
    if (status == EXIT_DONE) status = compute(r, s);
    if (status == EXIT_DONE) status = write_all(r, s);
    return status;
}

int cli_remesh(int argc, const char **argv) {
    settings s;
    run r;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&r, 0, sizeof r);
    parsing p = {argc, argv, &s, &arguments};
    int status = with_options(&s, parse, &p);
    if (status >= 0) return status;
    status = check_settings(&s);
    if (status == EXIT_DONE && s.report && !(s.command = command_line(argc, argv)))
        status = cli_error(EXIT_FAILED, "out of memory");
    if (status == EXIT_DONE) status = cli_session_open(&r.session, &s.common);
    if (status == EXIT_DONE) status = work(&r, &s);
    qc_remesh_result_clear(&r.result);
    qc_object_release(r.input);
    qc_pipeline_free(r.pipeline);
    qc_registry_free(r.registry);
    if (r.session.ctx) cli_session_close(&r.session);
    free(s.command);
    cli_arguments_free(&arguments);
    return status;
}
