/* Stage qc.features: creases, boundaries, borders of groups and strokes. */
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sdk/base/internal.h"

#define PI            3.14159265358979323846
#define DEFAULT_QUADS 10000.0
/* Quads within which a hard feature has to turn to have a corner there. */
#define BEND 1.25

typedef struct params {
    double angle, weak, blunt, shortest, sharpest, reach;
    const char *strokes;
    bool hard, groups, lines;
} params;

static qc_status add_groups(const qc_run *run, const qc_mesh *mesh, uint8_t *edge) {
    const qc_polygon_mesh *soup = run->input(run, "soup");
    if (!soup || !soup->face_group) return QC_OK;
    int32_t *group = QC__NEW(run->ctx, int32_t, mesh->n_faces);
    if (!group) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < mesh->n_faces; t++)
        group[t] = soup->face_group[mesh->source_face ? mesh->source_face[t] : t];
    qc_features_add_groups(mesh, group, edge);
    qc__free(group);
    return QC_OK;
}

static qc_status add_lines(const qc_run *run, const qc_mesh *mesh, const qc_polygon_mesh *curves,
                           double reach, uint8_t *edge) {
    if (!curves || !curves->line) return QC_OK;
    return qc_features_add_strokes(run->ctx, mesh, curves->n_vertices, curves->position,
                                   curves->n_lines, curves->line, reach, edge);
}

static qc_status add_strokes(const qc_run *run, const qc_mesh *mesh, const char *path, double reach,
                             uint8_t *edge) {
    qc_polygon_mesh *curves = NULL;
    qc_status status = qc_polygon_mesh_read(run->ctx, path, &curves);
    if (status) return status;
    status = curves->line
                 ? add_lines(run, mesh, curves, reach, edge)
                 : (run->fail)(run, QC_ERR_INPUT, -1, "the file of strokes has no `l` statements");
    qc_object_release(curves);
    return status;
}

static qc_status find(const qc_run *run, const params *given, const qc_mesh *mesh, double quad,
                      uint8_t *edge) {
    const double degree = PI / 180, reach = fmax(mesh->mean_edge_length, given->reach * quad);
    qc_features *found = NULL;
    qc_status status = qc_features_detect(run->ctx, mesh, given->angle * degree, 0, NULL, &found);
    if (status) return status;
    memcpy(edge, found->edge, (size_t)mesh->n_edges);
    qc_object_release(found);
    if (given->groups) status = add_groups(run, mesh, edge);
    if (!status && given->lines)
        status = add_lines(run, mesh, run->input(run, "soup"), reach, edge);
    if (!status && given->strokes && *given->strokes)
        status = add_strokes(run, mesh, given->strokes, reach, edge);
    if (status || !given->hard) return status;
    qc_prune_options o = QC_PRUNE_OPTIONS_INIT;
    o.weak = fmin(given->weak, given->angle) * degree;
    o.half = 0.5 * quad;
    o.blunt = given->blunt * degree;
    o.least = given->shortest * quad;
    o.sharp = given->sharpest * degree;
    return qc_features_prune(run->ctx, mesh, &o, edge);
}

static qc_status features(const qc_run *run, const void *p) {
    const params *given = p;
    const qc_mesh *mesh = run->input(run, "mesh");
    const qc_sizing *sizing = run->input(run, "sizing");
    const double quad = sizing ? sizing->edge_length : sqrt(mesh->area / DEFAULT_QUADS);
    uint8_t *edge = QC__NEW(run->ctx, uint8_t, mesh->n_edges);
    qc_features *out = NULL;
    qc_status status = edge ? find(run, given, mesh, quad, edge) : QC_ERR_NOMEM;
    if (!status) status = qc_features_create(run->ctx, mesh, edge, given->hard, &out);
    qc__free(edge);
    if (status) return status;
    out->hard = given->hard && out->n_feature_edges > 0;
    out->bend = BEND * quad;
    char text[96];
    snprintf(text, sizeof text, "%d feature edges, %d corners", (int)out->n_feature_edges,
             (int)out->n_corners);
    run->log(run, QC_LOG_INFO, text);
    return run->output(run, "features", out);
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "triangle mesh"},
    {"soup", QC_TYPE_POLYGON_MESH, QC_PORT_OPTIONAL,
     "the polygons it was made from: their groups and lines"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL,
     "length of a quad, the unit of `shortest` and `reach`; without, that of 10000 quads"},
};
static const qc_port outputs[] = {
    {"features", QC_TYPE_FEATURES, 0, "flags of the feature edges"},
};
static const qc_param table[] = {
    QC_PARAM_REAL(params, angle, 35, 0, 180, "deg",
                  "edges whose faces' normals differ by more are creases; 180 = boundaries only"),
    QC_PARAM_BOOL(params, hard, true,
                  "isolines have to follow the features; off: they guide the field only"),
    QC_PARAM_BOOL(params, lines, true, "`l` statements of the input are strokes"),
    QC_PARAM_BOOL(params, groups, false, "borders between groups or materials are features"),
    QC_PARAM_TEXT(params, strokes,
                  "OBJ file with `l` statements near the surface, more strokes; none by default"),
    QC_PARAM_REAL(params, reach, 1, 0, 1000, "quad",
                  "how far from the surface a stroke may be; at least one mean edge"),
    QC_PARAM_REAL(params, weak, 20, 0, 180, "deg",
                  "hard creases go on along edges above this angle where these join two features"),
    QC_PARAM_REAL(params, blunt, 30, 0, 180, "deg",
                  "hard creases at which the surface, seen at half a quad on either side, bends by "
                  "less on average are noise or rounded"),
    QC_PARAM_REAL(params, shortest, 2, 0, 1e6, "quad",
                  "hard creases with a free end which are shorter are noise; closed ones below "
                  "twice this"),
    QC_PARAM_REAL(params, sharpest, 30, 0, 90, "deg",
                  "of two hard features which meet in a smaller angle the weaker one is dropped"),
};

const qc_stage qc_stage_features = {
    QC_STAGE_SIZES,
    "qc.features",
    "1.0",
    "Find creases, boundaries, borders of groups and strokes",
    "An edge is a crease when the angle between the normals of its two faces exceeds `angle`. "
    "Boundary edges are features always; lines of the input and of a file become paths of edges. "
    "Later stages turn the cross field along features. Hard ones are cleaned first: gaps closed, "
    "short ends and features without room for quads dropped, each of these named.",
    "thesis 2.1, 5.1.2; Nieser 2012",
    inputs,
    outputs,
    3,
    1,
    table,
    sizeof table / sizeof *table,
    sizeof(params),
    features,
};
