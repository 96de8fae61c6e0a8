/* Stage qc.field.smooth: thesis 5.2. */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stage.h>

#include <string.h>

typedef struct params {
    double lambda;
    int64_t rounds;
} params;

static qc_status smooth(const qc_run *run, const void *p) {
    const params *given = p;
    const qc_face_field *field = run->input(run, "field");
    const qc_mesh *mesh = field->mesh;
    size_t bytes = (size_t)mesh->n_faces * sizeof(qc_complex);
    qc_complex *x = qc__malloc(run->ctx, 1, bytes);
    if (!x) return QC_ERR_NOMEM;
    memcpy(x, field->x, bytes);
    qc_face_field *out = NULL;
    qc_status status = qc_field_smooth(run->ctx, mesh, field->weight, field->trusted, given->lambda,
                                       (int32_t)given->rounds, x);
    if (!status)
        status = qc_face_field_create(run->ctx, mesh, x, field->weight, field->trusted, &out);
    qc__free(x);
    return status ? status : run->output(run, "field", out);
}

static const qc_port inputs[] = {
    {"field", QC_TYPE_FACE_FIELD, 0, "cross field with stability weights and trusted faces"},
};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the smoothed field"}};
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.5, 0, 1, "",
                  "0 keeps the trusted directions, 1 ignores them and only smooths"),
    QC_PARAM_INT(params, rounds, 20, 0, 1000, "",
                 "at most so many times: solve, rotate, match again; ends when the matching stays"),
};

const qc_stage qc_stage_field_smooth = {
    QC_STAGE_SIZES,
    "qc.field.smooth",
    "1.0",
    "Rotate the crosses to reduce the curvature of the field",
    "Minimises lambda sum omega_e theta_e^2 + (1 - lambda) sum w_t A_t / l^2 alpha_t^2 over rotations "
    "alpha of the crosses, matches again and repeats. l = sqrt(area) / 100, so lambda means the same at "
    "every scale and resolution: detail below l sqrt(2 lambda / ((1 - lambda) w)) is smoothed away. The "
    "matrix does not depend on the matching and is factorised once.",
    "thesis 5.2, (5.3), (5.4)",
    inputs,
    outputs,
    1,
    1,
    table,
    2,
    sizeof(params),
    smooth,
};
