/* Stability of principal curvature directions (thesis (5.2)):
 *     w_t = |kappa_max - kappa_min| l exp(-1/2 (|theta_1| + |theta_2| + |theta_3|)).
 * l = sqrt(area) / 100, the edge of one quad of 10000, makes it a pure number which depends on the
 * surface alone: w = 1 where the curvatures differ by that of a tube one quad in radius. */
#include "internal.h"

qc_status qc_field_stability(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                             const double *kappa, double *weight) {
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc_complex *rho = QC__NEW(ctx, qc_complex, mesh->n_edges);
    double *theta = QC__NEW(ctx, double, mesh->n_edges);
    qc_status status = edge && rho && theta ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_edges(ctx, mesh, edge);
    if (!status) status = qc_tangent_transport(ctx, mesh, edge, rho);
    if (!status) {
        double l = qc__reference_length(mesh);
        qc__field_match(ctx, mesh, rho, x, NULL, theta);
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            double turn = 0;
            for (int32_t h = 3 * t; h < 3 * t + 3; h++) turn += fabs(theta[mesh->halfedge_edge[h]]);
            weight[t] = fabs(kappa[2 * t] - kappa[2 * t + 1]) * l * exp(-turn / 2);
        }
    }
    qc__free(edge);
    qc__free(rho);
    qc__free(theta);
    return status;
}

/* 2007 paper, 4.3: how far the face is from being umbilic, whatever its curvature. */
void qc_field_anisotropy(const qc_mesh *mesh, const double *kappa, double *weight) {
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double a = kappa[2 * t], b = kappa[2 * t + 1], r = hypot(a, b);
        weight[t] = r > 0 ? fabs(a - b) / r : 0;
    }
}
