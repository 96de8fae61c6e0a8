/* The field and sizing objects: checked copies which retain their mesh. */
#include "internal.h"

#include <string.h>

typedef struct field_object {
    qc_face_field field;
    qc_complex *x;
    double *weight;
    uint8_t *trusted, *aligned;
} field_object;

static void field_destroy(qc_object *object) {
    field_object *o = (field_object *)object;
    qc__free(o->x);
    qc__free(o->weight);
    qc__free(o->trusted);
    qc__free(o->aligned);
    qc_object_release(o->field.mesh);
    qc__free(o);
}

static qc_status copy_crosses(qc_ctx *ctx, int32_t n, const qc_complex *x, qc_complex *out) {
    for (int32_t t = 0; t < n; t++) {
        double r = hypot(x[t].re, x[t].im);
        if (!(r > 0) || !isfinite(r))
            return qc__fail(ctx, QC_ERR_ARGUMENT, t,
                            "the direction of face %d is zero or not finite", (int)t);
        out[t] = (qc_complex){x[t].re / r, x[t].im / r};
    }
    return QC_OK;
}

static qc_status check_weights(qc_ctx *ctx, int32_t n, const double *weight) {
    for (int32_t t = 0; weight && t < n; t++)
        if (!(weight[t] >= 0))
            return qc__fail(ctx, QC_ERR_ARGUMENT, t,
                            "the weight of face %d is negative or no number", (int)t);
    return QC_OK;
}

qc_status qc_face_field_create(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                               const double *weight, const uint8_t *trusted, qc_face_field **out) {
    size_t n = (size_t)mesh->n_faces;
    qc_status status = check_weights(ctx, mesh->n_faces, weight);
    if (status) return status;
    field_object *o = QC__ZERO(ctx, field_object, 1);
    if (!o) return QC_ERR_NOMEM;
    qc_object_init(&o->field.object, QC_TYPE_FACE_FIELD, field_destroy);
    o->field.mesh = qc_object_retain(mesh);
    o->x = QC__NEW(ctx, qc_complex, n);
    if (weight) o->weight = QC__NEW(ctx, double, n);
    if (trusted) o->trusted = QC__NEW(ctx, uint8_t, n);
    if (!o->x || (weight && !o->weight) || (trusted && !o->trusted)) {
        qc_object_release(&o->field);
        return QC_ERR_NOMEM;
    }
    status = copy_crosses(ctx, mesh->n_faces, x, o->x);
    if (status) {
        qc_object_release(&o->field);
        return status;
    }
    if (weight) memcpy(o->weight, weight, n * sizeof *weight);
    for (size_t t = 0; trusted && t < n; t++) o->trusted[t] = trusted[t] != 0;
    o->field.x = o->x;
    o->field.weight = o->weight;
    o->field.trusted = o->trusted;
    *out = &o->field;
    return QC_OK;
}

qc_status qc_face_field_set_aligned(qc_ctx *ctx, qc_face_field *field, const uint8_t *edge,
                                    double bend) {
    const qc_mesh *mesh = field->mesh;
    field_object *o = (field_object *)field;
    qc_complex *tangent = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    uint8_t *aligned = QC__NEW(ctx, uint8_t, mesh->n_edges);
    qc_status status = tangent && aligned ? qc_tangent_edges(ctx, mesh, tangent) : QC_ERR_NOMEM;
    for (int32_t i = 0; !status && i < 2 * mesh->n_edges; i++) {
        const int32_t h = mesh->edge_halfedge[i];
        aligned[i / 2] = edge[i / 2] != 0;
        if (h < 0 || !edge[i / 2]) continue;
        if (qc__axis_deviation(tangent[h], o->x[h / 3]) > 1e-6)
            status =
                qc__fail(ctx, QC_ERR_ARGUMENT, i / 2,
                         "the cross of face %d does not run along edge %d; turn it there first",
                         (int)(h / 3), (int)(i / 2));
    }
    qc__free(tangent);
    if (status) {
        qc__free(aligned);
        return status;
    }
    qc__free(o->aligned);
    o->field.aligned = o->aligned = aligned;
    o->field.bend = bend;
    return QC_OK;
}
