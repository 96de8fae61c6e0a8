/* Smoothest cross fields, with or without a guide (power_system.h):
 *   no guide:  the eigenvector A z = mu M z of the smallest mu;
 *   guide g:   (A + t W) z = t W g^4;
 *   detail d:  then gradient flow on |z| = 1 in implicit steps of the time in which diffusion
 * reaches d (Merriman, Bence, Osher; for cross fields Viertel and Osting (2019)): solve (A + t W +
 * M / tau) z = M z_old / tau + t W g^4, tau = d^2 / (2 l^2), normalise, repeat. A linear solution
 * vanishes, and turns at random, where guides contradict each other; the flow closes pairs of
 * singularities nearer than about d. */
#include "power_system.h"

#include <string.h>

enum { FLOW_STEPS = 12 };
#define FLOW_END 1e-3 /* mean change of |z| = 1 in one step */

/* The smallest shift which the pivot test of the factorisation accepts: flat surfaces have a
 * kernel. */
static qc_status factorise_shifted(qc_ctx *ctx, qc__power_system *s) {
    qc_status status = QC_OK;
    for (double shift = 1e-9; shift < 1; shift *= 100) {
        qc__power_fill(s, shift, 0);
        status = qc__power_factorise(ctx, s);
        if (status != QC_ERR_NOT_POSDEF) break;
    }
    return status;
}

/* Solves with the guide and takes the result in the aligned components. */
static qc_status solve_aligned(qc_ctx *ctx, qc__power_system *s, const qc_complex *guide) {
    for (int32_t t = 0; t < s->mesh->n_faces; t++)
        s->work[t] = s->pull[t] * qc__fourth(qc__unit(qc__c(guide[t])));
    qc__power_add_kept(s, guide);
    qc_status status = qc_solve(ctx, s->factor, 1, (qc_complex *)s->work);
    for (int32_t t = 0; !status && t < s->mesh->n_faces; t++)
        if (s->aligned[s->mesh->face_component[t]]) s->z[t] = s->work[t];
    return status;
}

/* One step of the flow on |z| = 1; *change: mean of |z - z_old|. */
static qc_status flow_step(qc_ctx *ctx, qc__power_system *s, const qc_complex *guide,
                           double inertia, double *change) {
    int32_t F = s->mesh->n_faces;
    for (int32_t t = 0; t < F; t++) {
        s->work[t] = inertia * s->mass[t] * s->z[t];
        if (s->pull[t] > 0) s->work[t] += s->pull[t] * qc__fourth(qc__unit(qc__c(guide[t])));
    }
    qc__power_add_kept(s, guide);
    qc_status status = qc_solve(ctx, s->factor, 1, (qc_complex *)s->work);
    *change = 0;
    for (int32_t t = 0; !status && t < F; t++) {
        qc__cplx z = qc__unit(s->work[t]);
        *change += cabs(z - s->z[t]) / F;
        s->z[t] = z;
    }
    return status;
}

static qc_status flow(qc_ctx *ctx, qc__power_system *s, const qc_complex *guide, double detail) {
    double l = qc__reference_length(s->mesh), inertia = 2 * l * l / (detail * detail), change = 1;
    qc__power_fill(s, 0, inertia);
    qc_status status = qc__power_factorise(ctx, s);
    for (int32_t t = 0; t < s->mesh->n_faces; t++) s->z[t] = qc__unit(s->z[t]);
    for (int step = 0; !status && step < FLOW_STEPS && change > FLOW_END; step++) {
        status = flow_step(ctx, s, guide, inertia, &change);
        if (!status && !qc__progress(ctx, (step + 1.0) / FLOW_STEPS)) status = QC_ERR_CANCELLED;
    }
    return status;
}

static qc_status solve(qc_ctx *ctx, qc__power_system *s, const qc_complex *guide, double detail) {
    bool eigen = false, guided = false;
    for (int32_t i = 0; i < s->mesh->n_components; i++) *(s->aligned[i] ? &guided : &eigen) = true;
    qc_status status = factorise_shifted(ctx, s);
    if (!status && eigen) status = qc__power_eigenvector(ctx, s);
    if (!status && guided) status = solve_aligned(ctx, s, guide);
    if (!status && detail > 0) status = flow(ctx, s, guide, detail);
    return status;
}

qc_status qc_field_smoothest(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                             const uint8_t *trusted, double alignment, double detail,
                             qc_complex *x) {
    if (!(alignment >= 0) || !isfinite(alignment))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the alignment %g is negative or not finite",
                        alignment);
    if (!(detail >= 0) || !isfinite(detail))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the length of detail %g is negative or not finite", detail);
    qc__power_system s;
    qc_status status = qc__power_create(ctx, mesh, weight, trusted, alignment, &s);
    if (!status) status = solve(ctx, &s, x, detail);
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        if (s.kept[t]) continue;
        double angle = qc__arg(s.z[t]) / 4;
        x[t] = (qc_complex){cos(angle), sin(angle)};
    }
    qc__power_free(&s);
    return status;
}
