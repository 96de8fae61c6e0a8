/* The gradient of a piecewise linear function as a vector field on faces (second paper, section 6):
 * grad g = 1/(2A) sum g_k J e_k. */
#include "internal.h"

/* Gradients relative to the largest below this say nothing about the direction. */
#define FLAT 1e-6

static qc_status check(qc_ctx *ctx, const qc_mesh *mesh, const double *g) {
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (!isfinite(g[v]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, v, "the function is not finite at vertex %d",
                            (int)v);
    return QC_OK;
}

/* g is taken relative to one corner, so that its mean does not cost digits. */
static qc__cplx face_gradient(const qc_mesh *mesh, const qc_complex *edge, const double *g,
                              int32_t t) {
    const int32_t *v = mesh->face_vertex + 3 * (size_t)t;
    const qc__cplx e1 = qc__c(edge[3 * t + 1]), e2 = qc__c(edge[3 * t + 2]);
    const double twice_area = cimag(conj(e1) * e2);
    if (!(twice_area > 0)) return 0;
    return I * ((g[v[1]] - g[v[0]]) * e1 + (g[v[2]] - g[v[0]]) * e2) / twice_area;
}

qc_status qc_field_gradient(qc_ctx *ctx, const qc_mesh *mesh, const double *g, qc_complex *x,
                            double *weight, uint8_t *trusted) {
    qc_status status = check(ctx, mesh, g);
    qc_complex *edge = status ? NULL : QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    if (!status) status = edge ? qc_tangent_edges(ctx, mesh, edge) : QC_ERR_NOMEM;
    double largest = 0;
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        const qc__cplx gradient = face_gradient(mesh, edge, g, t);
        weight[t] = cabs(gradient);
        x[t] = qc__z(qc__unit(gradient));
        if (isfinite(weight[t])) largest = fmax(largest, weight[t]);
    }
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        weight[t] = largest > 0 && isfinite(weight[t]) ? weight[t] / largest : 0;
        if (!(weight[t] > FLAT)) weight[t] = 0;
        trusted[t] = weight[t] > 0;
    }
    qc__free(edge);
    return status ? status : qc_field_extend(ctx, mesh, weight, 0, x, trusted);
}
