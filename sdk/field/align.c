/* Alignment to feature edges: the faces on both sides of one get its direction; and to the
 * directions in which edges are to be longest. */
#include "internal.h"

/* Direction of face t along its feature edges as a fourth power; edges which contradict each other
 * (at 45 degrees) leave it to the longest. 0 when the face has none. */
static qc__cplx feature_direction(const qc_mesh *mesh, const qc_complex *tangent,
                                  const uint8_t *edge, int32_t t) {
    qc__cplx sum = 0, longest = 0;
    double total = 0, length = 0;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        qc_complex e = tangent[h];
        double r = hypot(e.re, e.im);
        if (!(edge ? edge[mesh->halfedge_edge[h]] != 0 : mesh->twin[h] < 0) || !(r > 0)) continue;
        qc__cplx z = qc__fourth(qc__c(e) / r);
        sum += r * z;
        total += r;
        if (r > length) length = r, longest = z;
    }
    return cabs(sum) < total / 2 ? longest : sum;
}

qc_status qc_field_align(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge, double strength,
                         qc_complex *x, double *weight, uint8_t *trusted) {
    if (!(strength >= 0))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the strength %g is negative or no number",
                        strength);
    qc_complex *tangent = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc_status status = tangent ? qc_tangent_edges(ctx, mesh, tangent) : QC_ERR_NOMEM;
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        qc__cplx z = feature_direction(mesh, tangent, edge, t);
        if (creal(z) == 0 && cimag(z) == 0) continue;
        double angle = qc__arg(z) / 4;
        x[t] = (qc_complex){cos(angle), sin(angle)};
        weight[t] = fmax(weight[t], strength);
        trusted[t] = 1;
    }
    qc__free(tangent);
    return status;
}

void qc_field_align_stretch(const qc_sizing *sizing, double strength, qc_complex *x, double *weight,
                            uint8_t *trusted) {
    static const double least = 1.1, full = 2; /* ratios of the two lengths */
    for (int32_t t = 0; sizing->stretch && t < sizing->mesh->n_faces; t++) {
        const qc_complex s = sizing->stretch[t];
        const double ratio = 2 * hypot(s.re, s.im);
        if (!(ratio >= log(least))) continue;
        const double angle = atan2(s.im, s.re) / 2;
        x[t] = (qc_complex){cos(angle), sin(angle)};
        weight[t] = fmax(weight[t], strength * fmin(1, ratio / log(full)));
        trusted[t] = 1;
    }
}
