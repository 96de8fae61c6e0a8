/* Stage qc.field.smooth: thesis 5.2. */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>
#include <string.h>

typedef struct params {
    double lambda, detail, separate;
    int64_t rounds;
    bool relax;
} params;

#define DEFAULT_QUADS 10000.0

/* Start: the field itself, or the minimiser of the same energy over x^4, which is convex. */
static qc_status smooth_field(qc_ctx *ctx, const qc_face_field *field, const qc_sizing *sizing,
                              const params *given, uint8_t *trusted, qc_complex *x) {
    const qc_mesh *mesh = field->mesh;
    double lambda = given->lambda, t = (1 - lambda) / fmax(lambda, 1e-6);
    double quad = sizing ? sizing->edge_length : sqrt(mesh->area / DEFAULT_QUADS);
    qc_status status = QC_OK;
    memcpy(x, field->x, (size_t)mesh->n_faces * sizeof *x);
    if (given->relax)
        status = qc_field_smoothest(ctx, mesh, field->weight, field->trusted, t,
                                    given->detail * quad, x);
    if (!status)
        status = qc_field_smooth(ctx, mesh, field->x, field->weight, field->trusted, field->aligned,
                                 field->bend, lambda, (int32_t)given->rounds, x);
    if (!status && given->separate > 0)
        status =
            qc_field_separate(ctx, mesh, given->separate * quad, field->aligned, trusted, x, NULL);
    return status;
}

static qc_status smooth(const qc_run *run, const void *p) {
    const qc_face_field *field = run->input(run, "field");
    const qc_mesh *mesh = field->mesh;
    size_t F = (size_t)mesh->n_faces;
    qc_complex *x = QC__NEW(run->ctx, qc_complex, F);
    uint8_t *trusted = field->trusted ? QC__NEW(run->ctx, uint8_t, F) : NULL;
    qc_face_field *out = NULL;
    qc_status status = x && (trusted || !field->trusted) ? QC_OK : QC_ERR_NOMEM;
    if (!status && trusted) memcpy(trusted, field->trusted, F);
    if (!status) status = smooth_field(run->ctx, field, run->input(run, "sizing"), p, trusted, x);
    if (!status) status = qc_face_field_create(run->ctx, mesh, x, field->weight, trusted, &out);
    if (!status && field->aligned)
        status = qc_face_field_set_aligned(run->ctx, out, field->aligned, field->bend);
    qc__free(x);
    qc__free(trusted);
    if (!status) return run->output(run, "field", out);
    qc_object_release(out);
    return status;
}

static const qc_port inputs[] = {
    {"field", QC_TYPE_FACE_FIELD, 0, "cross field with stability weights and trusted faces"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL,
     "length of a quad, the unit of `detail` and `separate`; without, that of 10000 quads"},
};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the smoothed field"}};
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "",
                  "0 keeps the trusted directions, 1 ignores them and only smooths"),
    QC_PARAM_REAL(
        params, detail, 0.5, 0, 100, "quad",
        "with relax: pairs of singularities nearer than about this many edge lengths of the "
        "quads are closed; 0 = leave them"),
    QC_PARAM_REAL(
        params, separate, 0.7, 0, 100, "quad",
        "faces about opposite singularities nearer than this many edge lengths of the quads, or "
        "about an index above 1/4 or below -2/4, are solved again without alignment; 0 = off"),
    QC_PARAM_INT(params, rounds, 20, 0, 1000, "",
                 "at most so many times: solve, rotate, match again; ends when the matching stays"),
    QC_PARAM_BOOL(
        params, relax, true,
        "start from the minimiser over x^4, which has far fewer singularities; off: from the "
        "field itself, whose singularities mostly stay"),
};

const qc_stage qc_stage_field_smooth = {
    QC_STAGE_SIZES,
    "qc.field.smooth",
    "1.0",
    "Rotate the crosses to reduce the curvature of the field",
    "Minimises lambda sum omega_e theta_e^2 + (1 - lambda) sum w_t A_t / l^2 alpha_t^2 over "
    "rotations "
    "alpha of the crosses, matches again and repeats. l = sqrt(area) / 100, so lambda means the "
    "same at "
    "every scale and resolution: detail below l sqrt(2 lambda / ((1 - lambda) w)) is smoothed "
    "away. The "
    "matrix does not depend on the matching and is factorised once.",
    "thesis 5.2, (5.3), (5.4)",
    inputs,
    outputs,
    2,
    1,
    table,
    5,
    sizeof(params),
    smooth,
};
