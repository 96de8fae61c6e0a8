/* Principal curvature directions per face (thesis 5.1.1) from the shape operator of either
 * estimator. */
#include "internal.h"

/* Eigenvectors of [a b; b d]: with w = (a - d)/2 + i b the eigenvalue h + |w|, h = (a + d)/2,
 * belongs to sqrt(w/|w|), and h - |w| to i times that. Umbilics: the real axis. */
qc__cplx qc__principal(double a, double b, double d, double kappa[2]) {
    double h = (a + d) / 2, r = hypot((a - d) / 2, b), sign = h < 0 ? -1 : 1;
    kappa[0] = h + sign * r;
    kappa[1] = h - sign * r;
    if (!(r > 1e-12 * fabs(h))) return 1.0;
    qc__cplx x = csqrt(qc__unit((a - d) / 2 + b * I));
    return sign < 0 ? I * x : x;
}

typedef struct bending_job {
    const qc_mesh *mesh;
    const double *normal;
    double *beta;
} bending_job;

/* Angles below this are rounding noise of coordinates, not bending: flat regions stay exactly flat.
 */
#define BENDING_NOISE 1e-8

static void bend(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const bending_job *j = arg;
    (void)worker;
    for (int64_t e = begin; e < end; e++) {
        int32_t h = j->mesh->edge_halfedge[2 * e], g = j->mesh->edge_halfedge[2 * e + 1];
        const int32_t *v = j->mesh->edge_vertex + 2 * e;
        double axis[3], turn[3], angle = 0;
        if (g >= 0) {
            const double *n = j->normal + 3 * (size_t)(h / 3), *o = j->normal + 3 * (size_t)(g / 3);
            qc__sub(j->mesh->position + 3 * (size_t)v[1], j->mesh->position + 3 * (size_t)v[0],
                    axis);
            qc__cross3(n, o, turn);
            angle = atan2(sqrt(qc__dot3(turn, turn)), qc__dot3(n, o));
            if (qc__dot3(turn, axis) < 0) angle = -angle;
        }
        j->beta[e] = fabs(angle) > BENDING_NOISE ? angle : 0;
    }
}

void qc__edge_bending(qc_ctx *ctx, const qc_mesh *mesh, const double *normal, double *beta) {
    bending_job job = {mesh, normal, beta};
    qc__parallel_for(ctx, mesh->n_edges, 8192, bend, &job);
}

static qc_status shape_operators(qc_ctx *ctx, const qc_mesh *mesh, int32_t estimator, double radius,
                                 double *shape) {
    size_t F = (size_t)mesh->n_faces;
    double *normal = QC__NEW(ctx, double, 3 * F), *area = QC__NEW(ctx, double, F);
    double *beta = QC__NEW(ctx, double, mesh->n_edges);
    double *real = QC__NEW(ctx, double, 3 * F), *imaginary = QC__NEW(ctx, double, 3 * F);
    qc_status status = normal && area && beta && real && imaginary ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_mesh_geometry(ctx, mesh, NULL, area, NULL, NULL, normal, NULL);
    if (!status) status = qc__poll(ctx);
    if (!status) status = qc_tangent_frames(ctx, mesh, real, imaginary);
    if (!status) status = qc__poll(ctx);
    if (!status) {
        qc__edge_bending(ctx, mesh, normal, beta);
        status =
            estimator == QC_CURVATURE_COHEN_STEINER_MORVAN
                ? qc__curvature_normal_cycle(ctx, mesh, radius, beta, area, real, imaginary, shape)
                : qc__curvature_hildebrandt_polthier(ctx, mesh, normal, beta, area, real, imaginary,
                                                     shape);
    }
    qc__free(normal);
    qc__free(area);
    qc__free(beta);
    qc__free(real);
    qc__free(imaginary);
    return status;
}

qc_status qc_field_curvature(qc_ctx *ctx, const qc_mesh *mesh, int32_t estimator, double radius,
                             qc_complex *x, double *kappa) {
    bool cycle = estimator == QC_CURVATURE_COHEN_STEINER_MORVAN;
    if (!cycle && estimator != QC_CURVATURE_HILDEBRANDT_POLTHIER)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "there is no curvature estimator %d",
                        (int)estimator);
    if (cycle && !(radius > 0 && isfinite(radius)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the radius %g is not positive", radius);
    double *shape = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    if (!shape) return QC_ERR_NOMEM;
    qc_status status = shape_operators(ctx, mesh, estimator, radius, shape);
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        const double *s = shape + 3 * (size_t)t;
        double k[2];
        x[t] = qc__z(qc__principal(s[0], s[1], s[2], k));
        if (kappa) kappa[2 * t] = k[0], kappa[2 * t + 1] = k[1];
    }
    qc__free(shape);
    return status;
}
