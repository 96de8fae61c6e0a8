/* Stage qc.field.smoothest: eigenvector of the connection Laplacian, or its aligned version. */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>

typedef struct params {
    double alignment, detail;
} params;

#define DEFAULT_QUADS 10000.0

static qc_status smoothest(const qc_run *run, const void *p) {
    const params *given = p;
    const qc_mesh *mesh = run->input(run, "mesh");
    const qc_face_field *guide = run->input(run, "guide");
    if (guide && guide->mesh != mesh)
        return run->fail(run, QC_ERR_ARGUMENT, -1, "the guide belongs to another mesh");
    qc_complex *x = QC__NEW(run->ctx, qc_complex, mesh->n_faces);
    if (!x) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < mesh->n_faces; t++) x[t] = guide ? guide->x[t] : (qc_complex){1, 0};
    const double *weight = guide ? guide->weight : NULL;
    const uint8_t *trusted = guide ? guide->trusted : NULL;
    const qc_sizing *sizing = run->input(run, "sizing");
    double quad = sizing ? sizing->edge_length : sqrt(mesh->area / DEFAULT_QUADS);
    qc_status status = qc_field_smoothest(run->ctx, mesh, weight, trusted,
                                          guide ? given->alignment : 0, given->detail * quad, x);
    qc_face_field *out = NULL;
    if (!status) status = qc_face_field_create(run->ctx, mesh, x, weight, trusted, &out);
    if (!status && guide && guide->aligned)
        status = qc_face_field_set_aligned(run->ctx, out, guide->aligned, guide->bend);
    qc__free(x);
    if (!status) return run->output(run, "field", out);
    qc_object_release(out);
    return status;
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "triangle mesh"},
    {"guide", QC_TYPE_FACE_FIELD, QC_PORT_OPTIONAL,
     "field with stability weights and trusted faces to align with"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL,
     "length of a quad, the unit of `detail`; without, that of 10000 quads"},
};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the smoothest field"}};
static const qc_param table[] = {
    QC_PARAM_REAL(
        params, alignment, 1, 0, 1e6, "",
        "pull of the guide's trusted faces against smoothness; 0, or no guide, ignores it; hard "
        "features of the guide are kept exactly"),
    QC_PARAM_REAL(
        params, detail, 0.5, 0, 100, "quad",
        "pairs of singularities nearer than about this many edge lengths of the quads are "
        "closed by a gradient flow with |x| = 1; 0 = leave them"),
};

const qc_stage qc_stage_field_smoothest = {
    QC_STAGE_SIZES,
    "qc.field.smoothest",
    "1.0",
    "Compute the smoothest cross field of the surface",
    "Minimises sum omega_e |z_t - rho^4 z_s|^2 over z = x^4 with |z| = 1 on average: an "
    "eigenvector of "
    "the connection Laplacian, by inverse iteration. With a guide: plus alignment sum w_t A_t / "
    "l^2 "
    "|z - guide^4|^2 over its trusted faces, one linear solve. No start field and no matching "
    "enters, so "
    "there are few singularities, placed by the surface.",
    "Knoeppel et al. 2013; weights of thesis (5.3)",
    inputs,
    outputs,
    3,
    1,
    table,
    2,
    sizeof(params),
    smoothest,
};
