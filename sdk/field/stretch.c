/* Direction-dependent lengths from the curvature (see stretch.h): of all quads of one area those
 * with edges in the ratio sqrt(k1 / k2), long along the direction of the smaller curvature k2, are
 * closest to the surface. */
#include "stretch.h"
#include "internal.h"

#include <string.h>

/* Curvature, in units of one over the root of the area, which counts as none. */
static const double flat = 0.1;
enum { ROUNDS_MAX = 50 };

typedef struct smoothing {
    const qc_mesh *mesh;
    const qc__connection *c;
    const qc_complex *old;
    qc_complex *out;
} smoothing;

/* The mean of a face and those around it by area, transported; squares of directions turn twice. */
static void average(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const smoothing *s = arg;
    (void)worker;
    for (int64_t t = begin; t < end; t++) {
        double area = s->c->area[t];
        qc__cplx sum = area * qc__c(s->old[t]);
        for (int64_t h = 3 * t; h < 3 * t + 3; h++) {
            const int32_t g = s->mesh->twin[h], e = s->mesh->halfedge_edge[h];
            if (g < 0) continue;
            qc__cplx rho = qc__c(s->c->rho[e]);
            if (s->mesh->edge_halfedge[2 * (int64_t)e] == h) rho = conj(rho);
            sum += s->c->area[g / 3] * rho * rho * qc__c(s->old[g / 3]);
            area += s->c->area[g / 3];
        }
        s->out[t] = area > 0 ? qc__z(sum / area) : s->old[t];
    }
}

/* Averages over about `radius`: what changes faster would be curl, and no quad could follow it. */
static qc_status smooth(qc_ctx *ctx, const qc_mesh *mesh, double radius, qc_complex *stretch) {
    const double wide = radius / mesh->mean_edge_length;
    const int rounds = (int)fmin(ceil(wide * wide), ROUNDS_MAX);
    qc__connection c = {NULL, NULL, NULL, NULL};
    qc_complex *work = QC__NEW(ctx, qc_complex, mesh->n_faces);
    qc_status status = work ? qc__connection_create(ctx, mesh, &c) : QC_ERR_NOMEM;
    for (int i = 0; i < rounds && status == QC_OK; i++) {
        smoothing s = {mesh, &c, stretch, work};
        qc__parallel_for(ctx, mesh->n_faces, 4096, average, &s);
        memcpy(stretch, work, (size_t)mesh->n_faces * sizeof *stretch);
        if (!qc__progress(ctx, (double)i / rounds)) status = QC_ERR_CANCELLED;
    }
    qc__connection_free(&c);
    qc__free(work);
    return status;
}

qc_status qc__curvature_stretch(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                const double *kappa, double most, double radius,
                                qc_complex *stretch) {
    const double least = flat / sqrt(mesh->area);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double k1 = fabs(kappa[2 * (int64_t)t]), k2 = fabs(kappa[2 * (int64_t)t + 1]);
        const double ratio = fmin(most, sqrt((k1 + least) / (k2 + least)));
        const qc__cplx along = I * qc__c(x[t]); /* x is the direction of k1 */
        stretch[t] = qc__z(0.5 * log(ratio) * along * along);
    }
    return smooth(ctx, mesh, radius, stretch);
}
