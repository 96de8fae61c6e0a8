/* Frame fields with density as forms (see frame_form.h). */
#include "sdk/map/periods/frame_form.h"
#include <qc/dec.h>
#include "sdk/base/internal.h"

qc_status qc__frame_form(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                         qc_complex *z) {
    const qc_mesh *mesh = matching->field->mesh;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (int64_t)mesh->n_faces);
    double *scale = QC__NEW(ctx, double, mesh->n_faces);
    qc_status status = edge && scale ? qc_tangent_edges(ctx, mesh, edge) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t t = 0; t < mesh->n_faces; t++)
            scale[t] = 1.0 / (sizing->length ? sizing->length[t] : sizing->edge_length);
        status = qc_form_from_cross(ctx, mesh, edge, matching->field->x, scale, z);
    }
    qc__free(edge);
    qc__free(scale);
    return status;
}
