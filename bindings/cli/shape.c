/* quadcover shape: the procedural surfaces of the papers. */
#include "bindings/cli/cli.h"
#include <string.h>

typedef struct settings {
    const char *output;
    bool list, retriangulate;
    long long resolution, genus, seed;
    double noise;
    cli_common common;
} settings;

static int print_list(void) {
    size_t n;
    const qc_shape_info *info = qc_shape_list(&n);
    for (size_t i = 0; i < n; i++) {
        char genus[16] = "--genus";
        if (info[i].genus >= 0) snprintf(genus, sizeof genus, "%d", (int)info[i].genus);
        printf("%-12s genus %-7s boundaries %d  %s\n", info[i].name, genus,
               (int)info[i].boundary_loops, info[i].doc);
    }
    return EXIT_DONE;
}

static qc_status to_polygons(qc_ctx *ctx, const qc_mesh *mesh, qc_polygon_mesh **out) {
    qc_polygon_mesh *p = NULL;
    const qc_status status = qc_polygon_mesh_create(ctx, mesh->n_vertices, mesh->n_faces,
                                                    3 * mesh->n_faces, 0, 0, 0, &p);
    if (status != QC_OK) return status;
    memcpy(p->position, mesh->position, 3 * sizeof(double) * (size_t)mesh->n_vertices);
    memcpy(p->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)mesh->n_faces);
    for (int32_t t = 0; t <= mesh->n_faces; t++) p->face_offset[t] = 3 * t;
    *out = p;
    return QC_OK;
}

static int create(cli_session *session, const char *name, const settings *s) {
    qc_ctx *ctx = session->ctx;
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = (int32_t)s->resolution;
    options.noise = s->noise;
    options.retriangulate = s->retriangulate;
    options.genus = (int32_t)s->genus;
    options.seed = (uint64_t)s->seed;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *polygons = NULL;
    int status = EXIT_DONE;
    if (qc_shape_create(ctx, name, &options, &mesh) != QC_OK)
        status = cli_session_error(session, NULL, EXIT_USAGE);
    else if (to_polygons(ctx, mesh, &polygons) != QC_OK ||
             qc_polygon_mesh_write(ctx, polygons, s->output, "quadcover " QC_VERSION_STRING) !=
                 QC_OK)
        status = cli_session_error(session, NULL, EXIT_FAILED);
    qc_object_release(mesh);
    qc_object_release(polygons);
    return status;
}

int cli_shape(int argc, const char **argv) {
    static const char about[] =
        "Writes one of the surfaces of the papers as a triangle mesh; --list names them.";
    settings s = {NULL, false, false, 0, 2, 1, 0, {0, 0, 0}};
    cli_arguments arguments;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &s.output, 0, 0, NULL, "OUT.obj", "the triangle mesh"},
        {"list", 0, CLI_FLAG, &s.list, 0, 0, NULL, NULL, "list all shapes"},
        {"resolution", 0, CLI_INTEGER, &s.resolution, 0, 1e8, NULL, "N", "about this many faces"},
        {"noise", 0, CLI_REAL, &s.noise, 0, 10, NULL, "S",
         "normal displacement, standard deviation in mean edge lengths"},
        {"retriangulate", 0, CLI_FLAG, &s.retriangulate, 0, 0, NULL, NULL,
         "random edge flips and tangential jitter"},
        {"genus", 0, CLI_INTEGER, &s.genus, 0, 50, NULL, "G", "of the shape genus (default 2)"},
        {"seed", 0, CLI_INTEGER, &s.seed, 0, 9007199254740992.0, NULL, "N", "of noise and flips"},
        CLI_COMMON_OPTIONS(s.common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status = cli_parse(argc, argv, options, 0, 1, "NAME -o OUT.obj [options] | --list", about,
                           &arguments);
    if (status >= 0) return status;
    cli_session session;
    memset(&session, 0, sizeof session);
    if (s.list)
        status = print_list();
    else if (arguments.n == 0 || !s.output)
        status = cli_error(EXIT_USAGE, "usage: quadcover shape NAME -o OUT.obj; --list names all");
    else
        status = cli_check_writable(s.output);
    if (status == EXIT_DONE && !s.list) {
        status = cli_session_open(&session, &s.common);
        if (status == EXIT_DONE) status = create(&session, arguments.positional[0], &s);
    }
    if (session.ctx) cli_session_close(&session);
    cli_arguments_free(&arguments);
    return status;
}
