/* Stage qc.field.curvature: principal directions, stability weights, trusted regions, extension
 * (thesis 5.1), and soft alignment to features. */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>

typedef struct params {
    int32_t estimator, weight;
    double radius, trusted, feature_weight, stretch_weight;
    bool extend;
} params;

enum { STABILITY, ANISOTROPY };
#define DEFAULT_QUADS 10000.0

/* The averaging disk: detail below the size of a quad is noise to the quad mesh; below two edges of
 * the triangle mesh it is noise of the triangulation. */
static double disk_radius(const qc_mesh *mesh, const qc_sizing *sizing, double radius) {
    double quad = sizing ? sizing->edge_length : sqrt(mesh->area / DEFAULT_QUADS);
    return fmax(2 * mesh->mean_edge_length, radius * quad);
}

typedef struct work {
    qc_complex *x;
    double *kappa, *weight;
    uint8_t *trusted;
} work;

static qc_status compute(const qc_run *run, const params *given, work *w) {
    qc_ctx *ctx = run->ctx;
    const qc_mesh *mesh = run->input(run, "mesh");
    const qc_features *features = run->input(run, "features");
    const qc_sizing *sizing = run->input(run, "sizing");
    double radius = disk_radius(mesh, sizing, given->radius);
    qc_status status = qc_field_curvature(ctx, mesh, given->estimator, radius, w->x, w->kappa);
    if (!status && given->weight == ANISOTROPY) qc_field_anisotropy(mesh, w->kappa, w->weight);
    if (!status && given->weight == STABILITY)
        status = qc_field_stability(ctx, mesh, w->x, w->kappa, w->weight);
    if (!status && sizing && sizing->mesh == mesh && given->stretch_weight > 0)
        qc_field_align_stretch(sizing, given->stretch_weight, w->x, w->weight, w->trusted);
    const double strength = features && features->hard ? INFINITY : given->feature_weight;
    if (!status && strength > 0)
        status = qc_field_align(ctx, mesh, features ? features->edge : NULL, strength, w->x,
                                w->weight, w->trusted);
    if (!status && given->extend)
        status = qc_field_extend(ctx, mesh, w->weight, given->trusted, w->x, w->trusted);
    for (int32_t t = 0; !given->extend && t < mesh->n_faces; t++) w->trusted[t] = 1;
    return status;
}

static qc_status curvature(const qc_run *run, const void *p) {
    const qc_mesh *mesh = run->input(run, "mesh");
    size_t F = (size_t)mesh->n_faces;
    const qc_features *features = run->input(run, "features");
    if (features && features->mesh != mesh)
        return run->fail(run, QC_ERR_ARGUMENT, -1, "the features belong to another mesh");
    work w = {QC__NEW(run->ctx, qc_complex, F), QC__NEW(run->ctx, double, 2 * F),
              QC__NEW(run->ctx, double, F), QC__ZERO(run->ctx, uint8_t, F)};
    qc_face_field *out = NULL;
    qc_status status = w.x && w.kappa && w.weight && w.trusted ? compute(run, p, &w) : QC_ERR_NOMEM;
    if (!status) status = qc_face_field_create(run->ctx, mesh, w.x, w.weight, w.trusted, &out);
    if (!status && features && features->hard)
        status = qc_face_field_set_aligned(run->ctx, out, features->edge, features->bend);
    qc__free(w.x);
    qc__free(w.kappa);
    qc__free(w.weight);
    qc__free(w.trusted);
    if (!status) return run->output(run, "field", out);
    qc_object_release(out);
    return status;
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "triangle mesh"},
    {"features", QC_TYPE_FEATURES, QC_PORT_OPTIONAL,
     "edges the field follows; without, the boundary edges"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL,
     "length of a quad, the unit of `radius`; without, that of 10000 quads; and directions in "
     "which "
     "edges are to be longer"},
};
static const qc_port outputs[] = {
    {"field", QC_TYPE_FACE_FIELD, 0,
     "principal directions with stability weights and trusted faces"},
};
static const char *const estimators[] = {"hildebrandt-polthier", "cohen-steiner-morvan", NULL};
static const char *const weights[] = {"stability", "anisotropy", NULL};
static const qc_param table[] = {
    QC_PARAM_ENUM(params, estimator, QC_CURVATURE_COHEN_STEINER_MORVAN, estimators,
                  "hildebrandt-polthier: average of the three vertex operators, for clean meshes; "
                  "cohen-steiner-morvan: average over a disk, for noisy ones"),
    QC_PARAM_ENUM(params, weight, STABILITY, weights,
                  "stability: |k1 - k2| l exp(-1/2 sum |theta|), thesis (5.2); anisotropy: |k1 - "
                  "k2| / sqrt(k1^2 + k2^2), 2007 paper 4.3"),
    QC_PARAM_REAL(params, radius, 1.5, 0, 100, "quad",
                  "radius of that disk in edge lengths of the quads; never below two mean edges"),
    QC_PARAM_REAL(params, trusted, 0.3, 0, 1, "",
                  "part of each component's area whose directions are kept, most stable first"),
    QC_PARAM_REAL(
        params, feature_weight, 2, 0, 1e6, "",
        "weight of faces on feature edges, which follow their edge; 0 = ignore features; hard "
        "features are followed exactly"),
    QC_PARAM_REAL(
        params, stretch_weight, 2, 0, 1e6, "",
        "weight of faces where one edge length is to be twice the other, which are trusted "
        "in these directions; less where the ratio is smaller; 0 = ignore them"),
    QC_PARAM_BOOL(params, extend, true,
                  "transport the trusted directions to the other faces; off: trust every face"),
};

const qc_stage qc_stage_field_curvature = {
    QC_STAGE_SIZES,
    "qc.field.curvature",
    "1.0",
    "Follow the directions of principal curvature where they are stable",
    "Estimates a shape operator per face, takes its eigenvectors and weighs them by "
    "|k1 - k2| l exp(-1/2 sum |theta|), l = sqrt(area) / 100. The most stable part of each "
    "component is "
    "trusted; its directions are transported breadth first to the rest. Faces on feature edges are "
    "trusted in the direction of their edge. qc.field.smooth or qc.field.smoothest come next.",
    "thesis 5.1, (5.2)",
    inputs,
    outputs,
    3,
    1,
    table,
    sizeof table / sizeof *table,
    sizeof(params),
    curvature,
};
