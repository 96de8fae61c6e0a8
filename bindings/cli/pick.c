/* quadcover pick: what camera rays meet on a surface. */
#include "bindings/cli/cli.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static const char about[] =
    "Prints JSON: for each ray of the file, in order, the face of the input which it meets first,\n"
    "the point with its triangle and barycentric coordinates, the nearest corner and the nearest\n"
    "feature edge (creases and boundaries); null for a ray which misses. Numbers count from 0.\n"
    "RAYS.json: {\"strokes\": [[[ox, oy, oz, dx, dy, dz], ...], ...]}, origin and direction.";

typedef struct settings {
    const char *input, *rays;
    double sharp;
    cli_list plugin;
    cli_common common;
} settings;

typedef struct picking {
    cli_session session;
    qc_registry *registry;
    qc_polygon_mesh *soup;
    qc_mesh *mesh;
    qc_repair_report *repairs;
    qc_features *features;
    cli_rays rays;
    qc_pick *pick;
} picking;

static json_t *reals(const double *x) {
    return json_pack("[f,f,f]", x[0], x[1], x[2]);
}

static int input_vertex(const qc_mesh *mesh, int32_t v) {
    return mesh->source_vertex ? mesh->source_vertex[v] : v;
}

static json_t *one(const qc_mesh *mesh, const qc_pick *p) {
    if (p->face < 0) return json_null();
    const int32_t *v = mesh->face_vertex + 3 * (size_t)p->face;
    json_t *result =
        json_pack("{s:i,s:f,s:o,s:[i,i,i],s:o,s:i,s:f}", "face",
                  mesh->source_face ? mesh->source_face[p->face] : p->face, "t", p->t, "point",
                  reals(p->point), "triangle", input_vertex(mesh, v[0]), input_vertex(mesh, v[1]),
                  input_vertex(mesh, v[2]), "barycentric", reals(p->weight), "vertex",
                  input_vertex(mesh, p->vertex), "vertex_distance", p->vertex_distance);
    if (result && p->feature_edge >= 0) {
        const int32_t *ends = mesh->edge_vertex + 2 * (size_t)p->feature_edge;
        json_object_set_new(
            result, "feature_edge",
            json_pack("[i,i]", input_vertex(mesh, ends[0]), input_vertex(mesh, ends[1])));
        json_object_set_new(result, "feature_distance", json_real(p->feature_distance));
    }
    return result;
}

static int print(const picking *p) {
    json_t *list = json_array();
    for (int32_t i = 0; i < p->rays.n_rays; i++)
        json_array_append_new(list, one(p->mesh, &p->pick[i]));
    char *text = json_dumps(list, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    if (text) printf("%s\n", text);
    const int status = text ? EXIT_DONE : cli_error(EXIT_FAILED, "cannot print the result");
    free(text);
    json_decref(list);
    return status;
}

static int compute(picking *p, const settings *s) {
    qc_ctx *ctx = p->session.ctx;
    const double degree = 3.14159265358979323846 / 180;
    if (qc_mesh_repair(ctx, p->soup, &p->mesh, &p->repairs) != QC_OK)
        return cli_session_error(&p->session, s->input, EXIT_INPUT);
    p->pick = calloc((size_t)p->rays.n_rays, sizeof *p->pick);
    if (!p->pick) return cli_error(EXIT_FAILED, "out of memory");
    if (qc_features_detect(ctx, p->mesh, s->sharp * degree, 0, NULL, &p->features) == QC_OK &&
        qc_mesh_pick(ctx, p->mesh, p->features, cli_ray_caster(p->registry), NULL, p->rays.n_rays,
                     p->rays.ray, p->pick) == QC_OK)
        return EXIT_DONE;
    return cli_session_error(&p->session, s->input, EXIT_FAILED);
}

static int work(picking *p, const settings *s) {
    if (!s->rays) return cli_error(EXIT_USAGE, "pick: give the rays with --rays RAYS.json");
    int status = cli_registry(p->session.ctx, &s->plugin, &p->registry);
    if (status == EXIT_DONE) status = cli_read_rays(s->rays, &p->rays);
    if (status == EXIT_DONE) status = cli_read_mesh(&p->session, s->input, &p->soup);
    if (status == EXIT_DONE) status = compute(p, s);
    cli_session_quiet(&p->session);
    return status == EXIT_DONE ? print(p) : status;
}

int cli_pick(int argc, const char **argv) {
    settings s;
    picking p;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&p, 0, sizeof p);
    s.sharp = 35;
    const cli_option options[] = {
        {"rays", 0, CLI_TEXT, &s.rays, 0, 0, NULL, "RAYS.json", "origins and directions"},
        {"sharp", 0, CLI_REAL, &s.sharp, 1e-6, 180, NULL, "DEG",
         "edges sharper than this angle are features (default 35)"},
        {"plugin", 0, CLI_LIST, &s.plugin, 0, 0, NULL, "X.so", "load a plugin"},
        CLI_COMMON_OPTIONS(s.common),
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status = cli_parse(argc, argv, options, 1, 1, "IN --rays RAYS.json", about, &arguments);
    if (status >= 0) return status;
    s.input = arguments.positional[0];
    status = cli_session_open(&p.session, &s.common);
    if (status == EXIT_DONE) status = work(&p, &s);
    free(p.pick);
    cli_rays_free(&p.rays);
    qc_object_release(p.features);
    qc_object_release(p.repairs);
    qc_object_release(p.mesh);
    qc_object_release(p.soup);
    qc_registry_free(p.registry);
    if (p.session.ctx) cli_session_close(&p.session);
    cli_arguments_free(&arguments);
    return status;
}
