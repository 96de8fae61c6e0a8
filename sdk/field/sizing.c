/* The sizing object: target edge length of the quads. */
#include "internal.h"

#include <string.h>

typedef struct sizing_object {
    qc_sizing sizing;
    double *length;
    qc_complex *stretch;
} sizing_object;

/* Largest ratio of two lengths. */
static const double most_ratio = 1e4;

static void sizing_destroy(qc_object *object) {
    sizing_object *o = (sizing_object *)object;
    qc__free(o->length);
    qc__free(o->stretch);
    qc_object_release(o->sizing.mesh);
    qc__free(o);
}

static bool positive(double a) {
    return a > 0 && isfinite(a);
}

qc_status qc_sizing_create(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                           double target_quads, const double *length, qc_sizing **out) {
    size_t n = (size_t)mesh->n_faces;
    if (!positive(edge_length))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the target edge length %g is not positive",
                        edge_length);
    if (!(target_quads >= 0) || !isfinite(target_quads))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the target number of quads %g is negative",
                        target_quads);
    for (size_t t = 0; length && t < n; t++)
        if (!positive(length[t]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, (int64_t)t,
                            "the target edge length of face %zu is not positive", t);
    sizing_object *o = QC__ZERO(ctx, sizing_object, 1);
    if (!o) return QC_ERR_NOMEM;
    qc_object_init(&o->sizing.object, QC_TYPE_SIZING, sizing_destroy);
    o->sizing.mesh = qc_object_retain(mesh);
    o->sizing.edge_length = edge_length;
    o->sizing.target_quads = target_quads;
    if (length) {
        o->length = QC__NEW(ctx, double, n);
        if (!o->length) {
            qc_object_release(&o->sizing);
            return QC_ERR_NOMEM;
        }
        memcpy(o->length, length, n * sizeof *length);
        o->sizing.length = o->length;
    }
    *out = &o->sizing;
    return QC_OK;
}

qc_status qc_sizing_set_stretch(qc_ctx *ctx, qc_sizing *sizing, const qc_complex *stretch) {
    sizing_object *o = (sizing_object *)sizing;
    const int32_t n = sizing->mesh->n_faces;
    for (int32_t t = 0; t < n; t++)
        if (!(2 * hypot(stretch[t].re, stretch[t].im) <= log(most_ratio)))
            return qc__fail(ctx, QC_ERR_ARGUMENT, t,
                            "the two edge lengths of face %d have a ratio beyond %g", (int)t,
                            most_ratio);
    qc_complex *copy = QC__NEW(ctx, qc_complex, n);
    if (!copy) return QC_ERR_NOMEM;
    memcpy(copy, stretch, (size_t)n * sizeof *copy);
    qc__free(o->stretch);
    o->stretch = copy;
    sizing->stretch = copy;
    return QC_OK;
}
