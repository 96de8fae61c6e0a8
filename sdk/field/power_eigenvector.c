/* Inverse iteration for the smoothest section, component by component, see power_system.h. */
#include "power_system.h"

#include <string.h>

#define TOLERANCE 1e-7 /* relative change of mu in one step */
enum { STEPS = 200 };

/* Start vector: unit numbers with well-scattered phases (golden ratio), the same on every machine.
 */
static void start(qc__power_system *s) {
    for (int32_t t = 0; t < s->mesh->n_faces; t++) {
        double phase = 2 * QC__PI * fmod(0.6180339887498949 * (t + 1.0), 1);
        s->z[t] = cos(phase) + sin(phase) * I;
    }
}

/* M-norms of the components of z; scales each to one (the aligned ones as well: they are not used).
 */
static void normalise(qc__power_system *s) {
    const qc_mesh *mesh = s->mesh;
    memset(s->norm, 0, (size_t)mesh->n_components * sizeof *s->norm);
    for (int32_t t = 0; t < mesh->n_faces; t++)
        s->norm[mesh->face_component[t]] += s->mass[t] * creal(s->z[t] * conj(s->z[t]));
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        double n = s->norm[mesh->face_component[t]];
        if (n > 0) s->z[t] /= sqrt(n);
    }
}

/* mu = z^H A z of the normalised z, per component; true when none has changed much. */
static bool settled(qc__power_system *s) {
    const qc_mesh *mesh = s->mesh;
    bool still = true;
    memset(s->mu, 0, (size_t)mesh->n_components * sizeof *s->mu);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        int32_t a = mesh->edge_halfedge[2 * e] / 3, b = mesh->edge_halfedge[2 * e + 1] / 3;
        qc__cplx d = s->z[b] - qc__fourth(qc__c(s->c.rho[e])) * s->z[a];
        s->mu[mesh->face_component[a]] += s->c.omega[e] * creal(d * conj(d));
    }
    for (int32_t i = 0; i < mesh->n_components; i++) {
        double zero = 1e-12 * s->stiff[i] / s->heavy[i];
        if (!s->aligned[i] && fabs(s->mu[i] - s->old[i]) > TOLERANCE * s->mu[i] + zero)
            still = false;
        s->old[i] = s->mu[i];
    }
    return still;
}

qc_status qc__power_eigenvector(qc_ctx *ctx, qc__power_system *s) {
    start(s);
    normalise(s);
    for (int step = 0; step < STEPS; step++) {
        for (int32_t t = 0; t < s->mesh->n_faces; t++) s->z[t] *= s->mass[t];
        qc_status status = qc_solve(ctx, s->factor, 1, (qc_complex *)s->z);
        if (status) return status;
        normalise(s);
        if (!qc__progress(ctx, (step + 1.0) / STEPS)) return QC_ERR_CANCELLED;
        if (settled(s)) break;
    }
    return QC_OK;
}
