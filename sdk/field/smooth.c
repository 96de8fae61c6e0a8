/* Smoothing of a cross field by rotations alpha_t (thesis 5.2.1): minimises
 *     lambda sum_e omega_e (theta_e - alpha_s + alpha_t)^2
 *       + (1 - lambda) sum_t w_t A_t / l^2 (alpha_t + d_t)^2 (5.3) where d_t is the angle by which
 * the face already differs from its guide. omega is a pure number, and so is w_t A_t / l^2 with l
 * of stability.c: lambda means the same at every scale and resolution. Features narrower than about
 * l sqrt(2 lambda / ((1 - lambda) w)) are smoothed away. Faces of infinite weight (hard features)
 * are no unknowns: their alpha is zero.
 *
 * The matrix (5.4) does not depend on the matching, so its factor serves all rounds: solve, rotate,
 * match again. Each step lowers the energy (a new matching makes |theta| smaller, and a turn of d
 * by pi/2 makes |d| smaller), so the rounds end. */
#include "sector.h"

#include <string.h>

/* Below this lambda the smoothing term only fills the gaps between kept directions. */
#define LAMBDA_MIN 1e-6
/* A component whose alignment is weaker than this part of its smoothing term is solved without
 * alignment, one face fixed: otherwise the matrix is singular to working precision. */
#define ALIGNMENT_MIN 1e-9

void qc__smoother_free(qc__smoother *s) {
    qc__connection_free(&s->c);
    qc__face_pattern_free(&s->pattern);
    qc__free(s->pull);
    qc__free(s->fixed);
    qc__free(s->value);
    qc__free(s->theta);
    qc__free(s->matched);
    qc__free(s->alpha);
    qc_factor_free(s->factor);
}

/* Weights of the alignment term and the faces which must be fixed for want of it. */
static qc_status set_pull(qc_ctx *ctx, qc__smoother *s, const double *weight,
                          const uint8_t *trusted) {
    const qc_mesh *mesh = s->mesh;
    double l = qc__reference_length(mesh);
    double *alignment = QC__ZERO(ctx, double, mesh->n_components);
    double *smoothing = QC__ZERO(ctx, double, mesh->n_components);
    qc_status status = alignment && smoothing ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            bool aligned = (weight || trusted) && (!trusted || trusted[t]);
            double w = aligned ? weight ? weight[t] : 1 : 0;
            s->fixed[t] = qc__kept(weight, trusted, t);
            s->pull[t] = s->fixed[t] ? 0 : (1 - s->lambda) * w * s->c.area[t] / (l * l);
            alignment[mesh->face_component[t]] += s->fixed[t] ? INFINITY : s->pull[t];
        }
        for (int32_t e = 0; e < mesh->n_edges; e++)
            smoothing[mesh->face_component[mesh->edge_halfedge[2 * e] / 3]] +=
                s->lambda * s->c.omega[e];
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            int32_t i = mesh->face_component[t];
            if (alignment[i] > ALIGNMENT_MIN * smoothing[i]) continue;
            s->pull[t] = 0;
            s->fixed[t] = alignment[i] >= 0;
            alignment[i] = -1; /* the first face only */
        }
    }
    qc__free(alignment);
    qc__free(smoothing);
    return status;
}

/* (5.4); a fixed face keeps its diagonal only. */
static void fill_matrix(qc__smoother *s) {
    const qc_mesh *mesh = s->mesh;
    const int64_t *colptr = s->pattern.colptr;
    memset(s->value, 0, (size_t)colptr[mesh->n_faces] * sizeof *s->value);
    for (int32_t t = 0; t < mesh->n_faces; t++)
        s->value[colptr[t + 1] - 1] = s->fixed[t] ? s->lambda : s->pull[t];
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        int32_t a = mesh->edge_halfedge[2 * e] / 3, b = mesh->edge_halfedge[2 * e + 1] / 3;
        double w = s->lambda * s->c.omega[e];
        s->value[colptr[a + 1] - 1] += w;
        s->value[colptr[b + 1] - 1] += w;
        if (!s->fixed[a] && !s->fixed[b]) s->value[s->pattern.entry[e]] -= w;
    }
}

qc_status qc__smoother_factorise(qc_ctx *ctx, qc__smoother *s) {
    qc_symmetric A = {s->mesh->n_faces, s->pattern.colptr, s->pattern.row, s->value};
    qc_symbolic *symbolic = NULL;
    fill_matrix(s);
    if (s->factor) return qc_refactorize_real(ctx, s->factor, &A);
    qc_status status = qc_analyze_real(ctx, &A, NULL, &symbolic);
    if (!status) status = qc_factorize_real(ctx, symbolic, &A, &s->factor);
    qc_symbolic_free(symbolic);
    return status;
}

static qc_status prepare(qc_ctx *ctx, qc__smoother *s, const double *weight,
                         const uint8_t *trusted) {
    const qc_mesh *mesh = s->mesh;
    qc_status status = qc__connection_create(ctx, mesh, &s->c);
    if (!status) status = qc__face_pattern_create(ctx, mesh, &s->pattern);
    if (status) return status;
    s->pull = QC__NEW(ctx, double, mesh->n_faces);
    s->fixed = QC__NEW(ctx, uint8_t, mesh->n_faces);
    s->value = QC__NEW(ctx, double, s->pattern.colptr[mesh->n_faces]);
    s->theta = QC__NEW(ctx, double, mesh->n_edges);
    s->matched = QC__NEW(ctx, double, mesh->n_edges);
    s->alpha = QC__NEW(ctx, double, mesh->n_faces);
    if (!s->pull || !s->fixed || !s->value || !s->theta || !s->matched || !s->alpha)
        return QC_ERR_NOMEM;
    status = set_pull(ctx, s, weight, trusted);
    return status ? status : qc__smoother_factorise(ctx, s);
}

qc_status qc__smoother_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                              const uint8_t *trusted, double lambda, qc__smoother *out) {
    qc__smoother s = {.mesh = mesh, .lambda = lambda < LAMBDA_MIN ? LAMBDA_MIN : lambda};
    const qc_status status = prepare(ctx, &s, weight, trusted);
    if (status)
        qc__smoother_free(&s);
    else
        *out = s;
    return status;
}

/* Angle of cross x against its guide, modulo pi/2. */
static double deviation(qc_complex x, qc_complex guide) {
    return qc__arg(qc__fourth(qc__c(x) * conj(qc__c(guide)))) / 4;
}

static void fill_right_hand_side(qc__smoother *s, const qc_complex *x) {
    const qc_mesh *mesh = s->mesh;
    for (int32_t t = 0; t < mesh->n_faces; t++)
        s->alpha[t] = s->pull[t] > 0 ? -s->pull[t] * deviation(x[t], s->guide[t]) : 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        double b = s->lambda * s->c.omega[e] * s->theta[e];
        s->alpha[mesh->edge_halfedge[2 * e] / 3] += b;
        s->alpha[mesh->edge_halfedge[2 * e + 1] / 3] -= b;
    }
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (s->fixed[t]) s->alpha[t] = 0;
}

/* theta of the straightest matching, with open sectors at the features. */
static qc_status match(qc_ctx *ctx, const qc__smoother *s, const qc_complex *x, double *theta) {
    qc__field_match(ctx, s->mesh, s->c.rho, x, NULL, theta);
    if (!s->aligned) return QC_OK;
    return qc__sectors_open(ctx, s->mesh, s->aligned, s->bend, s->c.edge, theta, NULL, NULL);
}

/* One round; *changed: the straightest matching differs from the one solved for. */
static qc_status smooth_round(qc_ctx *ctx, qc__smoother *s, qc_complex *x, bool *changed) {
    const qc_mesh *mesh = s->mesh;
    fill_right_hand_side(s, x);
    qc_status status = qc_solve_real(ctx, s->factor, 1, s->alpha);
    if (status) return status;
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (!s->fixed[t])
            x[t] = qc__z(qc__unit(qc__c(x[t]) * (cos(s->alpha[t]) + sin(s->alpha[t]) * I)));
    status = match(ctx, s, x, s->matched);
    *changed = false;
    for (int32_t e = 0; !status && e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        const double turned = s->theta[e] - s->alpha[mesh->edge_halfedge[2 * e] / 3] +
                              s->alpha[mesh->edge_halfedge[2 * e + 1] / 3];
        if (fabs(turned) > QC__PI / 4 * (1 + 1e-9) && fabs(turned - s->matched[e]) > 0.1)
            *changed = true;
    }
    double *swap = s->theta;
    s->theta = s->matched;
    s->matched = swap;
    return status;
}

qc_status qc_field_smooth(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *guide,
                          const double *weight, const uint8_t *trusted, const uint8_t *aligned,
                          double bend, double lambda, int32_t rounds, qc_complex *x) {
    if (!(lambda >= 0 && lambda <= 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "lambda = %g is not in [0, 1]", lambda);
    if (rounds < 1) return QC_OK;
    qc__smoother s = {.mesh = NULL};
    qc_complex *result = QC__NEW(ctx, qc_complex, mesh->n_faces);
    qc_status status =
        result ? qc__smoother_create(ctx, mesh, weight, trusted, lambda, &s) : QC_ERR_NOMEM;
    if (!status) {
        bool changed = true;
        s.guide = guide ? guide : x; /* x itself changes at the very end only */
        s.aligned = aligned;
        s.bend = bend;
        memcpy(result, x, (size_t)mesh->n_faces * sizeof *x);
        status = match(ctx, &s, x, s.theta);
        for (int32_t i = 0; !status && changed && i < rounds; i++) {
            status = smooth_round(ctx, &s, result, &changed);
            if (!status && !qc__progress(ctx, (i + 1.0) / rounds)) status = QC_ERR_CANCELLED;
        }
        if (!status) memcpy(x, result, (size_t)mesh->n_faces * sizeof *x);
    }
    qc__smoother_free(&s);
    qc__free(result);
    return status;
}
