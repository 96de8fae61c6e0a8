/* Frame fields with density as forms (see frame_form.h). */
#include "sdk/map/periods/frame_form.h"
#include <qc/dec.h>
#include "sdk/base/internal.h"
#include "sdk/field/stretch.h"

qc_status qc__frame_form(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                         qc_complex *z) {
    const qc_mesh *mesh = matching->field->mesh;
    const qc_complex *x = matching->field->x;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (int64_t)mesh->n_faces);
    double *scale = QC__NEW(ctx, double, mesh->n_faces);
    qc_status status = edge && scale ? qc_tangent_edges(ctx, mesh, edge) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t t = 0; t < mesh->n_faces; t++)
            scale[t] = 1.0 / (sizing->length ? sizing->length[t] : sizing->edge_length);
        status = qc_form_from_cross(ctx, mesh, edge, x, scale, z);
    }
    for (int32_t h = 0; status == QC_OK && sizing->stretch && h < 3 * mesh->n_faces; h++)
        z[h] = qc__stretched(z[h], qc__stretch_along(sizing->stretch[h / 3], x[h / 3]));
    qc__free(edge);
    qc__free(scale);
    return status;
}
