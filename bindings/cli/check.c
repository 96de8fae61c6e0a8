/* quadcover check: is a mesh a valid pure quad mesh, and how good is it? */
#include "bindings/cli/cli.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static const char about[] =
    "Exit status 0: every face has four corners, every edge one or two faces run in opposite\n"
    "directions, every vertex one fan, no face is degenerate or there twice. 1: something is not "
    "so;\n"
    "the first bad element is named.";

typedef struct settings {
    const char *input, *against;
    bool json;
    cli_common common;
} settings;

typedef struct figures {
    qc_polygon_topology topology;
    qc_report *report;
    bool valid, against;
} figures;

static bool is_valid(const qc_polygon_topology *t) {
    return t->non_quads + t->non_manifold_edges + t->non_manifold_vertices + t->inconsistent_edges +
               t->duplicate_faces + t->degenerate_faces ==
           0;
}

static int measure(cli_session *session, const settings *s, figures *out) {
    qc_ctx *ctx = session->ctx;
    qc_polygon_mesh *quads = NULL, *soup = NULL;
    qc_mesh *mesh = NULL;
    qc_repair_report *repairs = NULL;
    int status = cli_read_mesh(session, s->input, &quads);
    if (status == EXIT_DONE && s->against) status = cli_read_mesh(session, s->against, &soup);
    if (status == EXIT_DONE && soup && qc_mesh_repair(ctx, soup, &mesh, &repairs) != QC_OK)
        status = cli_session_error(session, s->against, EXIT_INPUT);
    if (status == EXIT_DONE &&
        (qc_polygon_mesh_topology(ctx, quads, &out->topology) != QC_OK ||
         qc_report_create(ctx, &out->report) != QC_OK ||
         qc_report_measure(ctx, mesh, NULL, NULL, NULL, quads, NULL, out->report) != QC_OK))
        status = cli_session_error(session, s->input, EXIT_FAILED);
    out->valid = is_valid(&out->topology);
    out->against = s->against != NULL;
    qc_object_release(quads);
    qc_object_release(soup);
    qc_object_release(mesh);
    qc_object_release(repairs);
    return status;
}

static int print_json(const figures *f) {
    const qc_polygon_topology *t = &f->topology;
    qc_figures r;
    qc_report_figures(f->report, &r);
    json_t *root = json_pack(
        "{s:b,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:i,s:f,s:f,s:f}", "valid",
        f->valid, "vertices", (int)f->report->quads.vertices, "faces", (int)f->report->quads.faces,
        "components", t->components, "boundaries", t->boundary_loops, "euler", t->euler,
        "non_quads", t->non_quads, "irregular", t->irregular, "non_manifold_edges",
        t->non_manifold_edges, "non_manifold_vertices", t->non_manifold_vertices,
        "inconsistent_edges", t->inconsistent_edges, "duplicate_faces", t->duplicate_faces,
        "degenerate_faces", t->degenerate_faces, "unreferenced_vertices", t->unreferenced_vertices,
        "first_bad_element", t->first_bad_element, "rsd_edge", r.rsd_edge, "rsd_angle", r.rsd_angle,
        "min_scaled_jacobian", f->report->quads.min_scaled_jacobian);
    if (root && f->against) {
        json_object_set_new(root, "hausdorff_rel", json_real(r.hausdorff_rel));
        json_object_set_new(root, "mean_dist_rel", json_real(r.mean_dist_rel));
    }
    char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) : NULL;
    if (text) printf("%s\n", text);
    const int status = text ? EXIT_DONE : cli_error(EXIT_FAILED, "cannot print the figures");
    free(text);
    json_decref(root);
    return status;
}

static void print_text(const figures *f) {
    const qc_polygon_topology *t = &f->topology;
    qc_figures r;
    qc_report_figures(f->report, &r);
    printf("vertices %d, faces %d, not quads %d, irregular %d\n", (int)f->report->quads.vertices,
           (int)f->report->quads.faces, (int)t->non_quads, (int)t->irregular);
    printf("components %d, boundary loops %d, Euler characteristic %d\n", (int)t->components,
           (int)t->boundary_loops, (int)t->euler);
    printf("non-manifold edges %d, vertices %d; inconsistent edges %d; duplicate faces %d, "
           "degenerate %d; unreferenced vertices %d\n",
           (int)t->non_manifold_edges, (int)t->non_manifold_vertices, (int)t->inconsistent_edges,
           (int)t->duplicate_faces, (int)t->degenerate_faces, (int)t->unreferenced_vertices);
    printf("RSD edge %.2f %%, RSD angle %.2f %%, smallest scaled Jacobian %.3f\n", r.rsd_edge,
           r.rsd_angle, f->report->quads.min_scaled_jacobian);
    if (f->against)
        printf("Hausdorff distance %.4f %%, mean distance %.4f %% of the diagonal\n",
               100 * r.hausdorff_rel, 100 * r.mean_dist_rel);
    printf("%s\n", f->valid ? "valid: a manifold of quads" : "NOT a manifold of quads");
}

static int print(const figures *f, const settings *s) {
    int status = EXIT_DONE;
    if (s->json)
        status = print_json(f);
    else
        print_text(f);
    if (status != EXIT_DONE || f->valid) return status;
    return cli_error(EXIT_FAILED, "%s: check: not a manifold of quads; first bad element: %d",
                     s->input, (int)f->topology.first_bad_element);
}

int cli_check(int argc, const char **argv) {
    settings s;
    figures f;
    cli_session session;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&f, 0, sizeof f);
    const cli_option options[] = {
        {"against", 0, CLI_TEXT, &s.against, 0, 0, NULL, "IN", "measure the distance to this mesh"},
        {"json", 0, CLI_FLAG, &s.json, 0, 0, NULL, NULL, "print JSON"},
        CLI_COMMON_OPTIONS(s.common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status = cli_parse(argc, argv, options, 1, 1, "QUADS.obj [options]", about, &arguments);
    if (status >= 0) return status;
    s.input = arguments.positional[0];
    status = cli_session_open(&session, &s.common);
    if (status == EXIT_DONE) status = measure(&session, &s, &f);
    cli_session_quiet(&session);
    if (status == EXIT_DONE) status = print(&f, &s);
    qc_object_release(f.report);
    cli_session_close(&session);
    cli_arguments_free(&arguments);
    return status;
}
