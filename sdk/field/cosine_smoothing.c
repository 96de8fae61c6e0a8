/* Nonlinear smoothing of a cross field (2007 paper, 4.3): rotations alpha_t which minimise
 *     lambda sum_e A_e (1 - cos 4 (theta_e - alpha_s + alpha_t)) + (1 - lambda) sum_t A_t w_t
 * alpha_t^2,    A_e = (A_s + A_t) / 3. The paper prints the cosine with the sign of an energy to be
 * maximised; Hertzmann and Zorin 2000, whom it follows, minimise -cos. The period of the cosine
 * makes matchings irrelevant, but alpha_t is a real number: the distance to the field at the start.
 *
 * Each round solves with a quadratic model and the pattern of (5.4). Where edges turn by little the
 * Hessian is the model, and rounds converge quadratically; its negative terms are floored. When
 * that step does not pay, the model is the parabola of curvature sin(x)/x, x = 4 (theta_e - ...) in
 * [-pi, pi], which touches 1 - cos at x and lies above it everywhere (1 - cos sqrt(s) is concave in
 * s there, and both sides are bounded by its value at pi beyond). Its minimiser never raises E. */
#include "internal.h"

#include <string.h>

/* Least curvature of an edge: keeps the matrix positive definite. More curvature than that of the
 * parabola above leaves it a bound. */
#define CURVATURE_MIN 1e-3
/* Part of the decrease at first order which a Newton step has to reach. */
#define SUFFICIENT 0.1
/* Rounds end when the energy falls by no more than this part of it. */
#define FALL_MIN 1e-10

void qc__cosine_free(qc__cosine *c) {
    qc__smoother_free(&c->smoother);
    qc__free(c->share);
    qc__free(c->alpha);
    qc__free(c->trial);
    qc__free(c->slope);
}

qc_status qc__cosine_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                            const uint8_t *trusted, double lambda, const qc_complex *x,
                            qc__cosine *out) {
    qc__cosine c = {.share = QC__ZERO(ctx, double, mesh->n_edges),
                    .alpha = QC__ZERO(ctx, double, mesh->n_faces),
                    .trial = QC__NEW(ctx, double, mesh->n_faces),
                    .slope = QC__NEW(ctx, double, mesh->n_faces)};
    qc_status status = c.share && c.alpha && c.trial && c.slope ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc__smoother_create(ctx, mesh, weight, trusted, lambda, &c.smoother);
    if (status) {
        qc__cosine_free(&c);
        return status;
    }
    const double *area = c.smoother.c.area, l = qc__reference_length(mesh);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t *h = mesh->edge_halfedge + 2 * (size_t)e;
        if (h[1] >= 0) c.share[e] = (area[h[0] / 3] + area[h[1] / 3]) / (3 * l * l);
    }
    qc__field_match(ctx, mesh, c.smoother.c.rho, x, NULL, c.smoother.theta);
    *out = c;
    return QC_OK;
}

/* x = 4 (theta_e - alpha_s + alpha_t) of an interior edge. */
static double fourfold_turn(const qc__smoother *s, const double *alpha, int32_t e) {
    const int32_t *h = s->mesh->edge_halfedge + 2 * (size_t)e;
    return 4 * (s->theta[e] - alpha[h[0] / 3] + alpha[h[1] / 3]);
}

double qc__cosine_energy(const qc__cosine *c, const double *alpha, double *slope) {
    const qc__smoother *s = &c->smoother;
    const qc_mesh *mesh = s->mesh;
    double energy = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        energy += s->pull[t] * alpha[t] * alpha[t];
        slope[t] = 2 * s->pull[t] * alpha[t];
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t *h = mesh->edge_halfedge + 2 * (size_t)e;
        if (h[1] < 0) continue;
        const double x = fourfold_turn(s, alpha, e), half = sin(x / 2);
        const double weight = s->lambda * c->share[e], by_turn = 4 * weight * sin(x);
        energy += 2 * weight * half * half;
        slope[h[0] / 3] -= by_turn;
        slope[h[1] / 3] += by_turn;
    }
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (s->fixed[t]) slope[t] = 0;
    return energy;
}

/* The quadratic model at alpha: half of its Hessian is the matrix (5.4) with these weights. */
static void set_model(qc__cosine *c, bool bound) {
    qc__smoother *s = &c->smoother;
    for (int32_t e = 0; e < s->mesh->n_edges; e++) {
        if (!(c->share[e] > 0)) continue;
        const double x = remainder(fourfold_turn(s, c->alpha, e), 2 * QC__PI);
        const double curvature = !bound ? cos(x) : fabs(x) > 1e-4 ? sin(x) / x : 1;
        s->c.omega[e] = 8 * c->share[e] * fmax(curvature, CURVATURE_MIN);
    }
}

/* trial = alpha + the step to the minimiser of the model; *expected: slope times step, < 0. */
static qc_status step(qc_ctx *ctx, qc__cosine *c, bool bound, double *expected) {
    qc__smoother *s = &c->smoother;
    const int32_t n = s->mesh->n_faces;
    set_model(c, bound);
    qc_status status = qc__smoother_factorise(ctx, s);
    if (status) return status;
    for (int32_t t = 0; t < n; t++) s->alpha[t] = -c->slope[t] / 2;
    status = qc_solve_real(ctx, s->factor, 1, s->alpha);
    if (status) return status;
    *expected = 0;
    for (int32_t t = 0; t < n; t++) {
        *expected += c->slope[t] * s->alpha[t];
        c->trial[t] = c->alpha[t] + s->alpha[t];
    }
    return QC_OK;
}

qc_status qc__cosine_round(qc_ctx *ctx, qc__cosine *c, bool *changed) {
    double expected;
    const double before = qc__cosine_energy(c, c->alpha, c->slope);
    *changed = false;
    for (int bound = 0; bound < 2; bound++) {
        const qc_status status = step(ctx, c, bound, &expected);
        if (status) return status;
        /* the slope is needed again for the second model */
        const double after = qc__cosine_energy(c, c->trial, c->smoother.alpha);
        if (!(after < before + (bound ? 0 : SUFFICIENT * expected))) continue;
        memcpy(c->alpha, c->trial, (size_t)c->smoother.mesh->n_faces * sizeof *c->alpha);
        *changed = before - after > FALL_MIN * before;
        return QC_OK;
    }
    return QC_OK;
}

qc_status qc_field_smooth_cosine(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                 const uint8_t *trusted, double lambda, int32_t rounds,
                                 qc_complex *x) {
    if (!(lambda >= 0 && lambda <= 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "lambda = %g is not in [0, 1]", lambda);
    if (rounds < 1) return QC_OK;
    qc__cosine c;
    qc_status status = qc__cosine_create(ctx, mesh, weight, trusted, lambda, x, &c);
    if (status) return status;
    bool changed = true;
    for (int32_t i = 0; !status && changed && i < rounds; i++) {
        status = qc__cosine_round(ctx, &c, &changed);
        if (!status && !qc__progress(ctx, (i + 1.0) / rounds)) status = QC_ERR_CANCELLED;
    }
    for (int32_t t = 0; !status && t < mesh->n_faces; t++)
        if (!c.smoother.fixed[t])
            x[t] = qc__z(qc__unit(qc__c(x[t]) * (cos(c.alpha[t]) + sin(c.alpha[t]) * I)));
    qc__cosine_free(&c);
    return status;
}
