/* Stage qc.field.cosine: 2007 paper, 4.3. */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stages.h>

#include <string.h>

typedef struct params {
    double lambda;
    int64_t rounds;
} params;

static qc_status cosine(const qc_run *run, const void *p) {
    const params *given = p;
    const qc_face_field *field = run->input(run, "field");
    const qc_mesh *mesh = field->mesh;
    qc_complex *x = QC__NEW(run->ctx, qc_complex, mesh->n_faces);
    if (!x) return QC_ERR_NOMEM;
    memcpy(x, field->x, (size_t)mesh->n_faces * sizeof *x);
    qc_face_field *out = NULL;
    qc_status status = qc_field_smooth_cosine(run->ctx, mesh, field->weight, field->trusted,
                                              given->lambda, (int32_t)given->rounds, x);
    if (!status)
        status = qc_face_field_create(run->ctx, mesh, x, field->weight, field->trusted, &out);
    if (!status && field->aligned)
        status = qc_face_field_set_aligned(run->ctx, out, field->aligned, field->bend);
    qc__free(x);
    if (!status) return run->output(run, "field", out);
    qc_object_release(out);
    return status;
}

static const qc_port inputs[] = {
    {"field", QC_TYPE_FACE_FIELD, 0, "cross field with weights and trusted faces"},
};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the smoothed field"}};
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "",
                  "0 keeps the trusted directions, 1 ignores them and only smooths"),
    QC_PARAM_INT(params, rounds, 100, 0, 10000, "",
                 "at most so many steps of descent; ends when no cross turns any more"),
};

const qc_stage qc_stage_field_cosine = {
    QC_STAGE_SIZES,
    .id = "qc.field.cosine",
    .version = "1.0",
    .brief = "Rotate the crosses by the nonlinear smoothing of 2007",
    .doc = "Minimises lambda sum A_e (1 - cos 4 (theta_e - alpha_s + alpha_t)) + (1 - lambda) sum "
           "w_t A_t alpha_t^2 over rotations alpha of the crosses, by Newton steps with a "
           "parabola above the cosine as the way out: the energy never rises. Needs no matching. "
           "Details of about 3 sqrt(lambda / ((1 - lambda) w)) edges of the mesh are smoothed "
           "away, so lambda depends on the resolution; qc.field.smooth does not. Made for "
           "qc.field.curvature with weight=anisotropy and extend=false.",
    .cite = "2007 paper, 4.3",
    .in = inputs,
    .out = outputs,
    .n_in = 1,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = cosine,
};
