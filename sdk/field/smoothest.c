/* Smoothest cross fields (Knoeppel, Crane, Pinkall, Schroeder, "Globally optimal direction fields" (2013),
 * with the weights of thesis (5.3)): z = x^4 as a section of the fourth power of the tangent bundle,
 *     A = sum_e omega_e |z_t - rho^4 z_s|^2,   M = diag(A_t / l^2).
 * Without alignment: the eigenvector A z = mu M z of the smallest mu in each component, by inverse iteration
 * on one factor of A + shift M. With alignment t: (A + t W) z = t W g, W = diag(w_t A_t / l^2). */
#include "internal.h"

#include <string.h>

/* A component whose alignment is weaker than this part of its diagonal is treated as unaligned. */
#define ALIGNMENT_MIN 1e-9
#define TOLERANCE     1e-9 /* relative change of mu in one step */
enum { STEPS = 200 };

typedef struct system {
    const qc_mesh *mesh;
    qc__connection c;
    qc__face_pattern pattern;
    qc_complex *value;      /* of A + W + shift M                                            */
    double *mass, *pull;    /* n_faces: M, t W                                               */
    double *stiff, *heavy;  /* n_components: mean of the diagonals of A and of M              */
    uint8_t *aligned;       /* n_components                                                  */
    qc__cplx *z, *guide;    /* n_faces                                                       */
    double *norm, *mu, *old; /* n_components                                                 */
    qc_factor *factor;
} system;

static void system_free(system *s) {
    void *arrays[] = {s->value, s->mass,  s->pull, s->stiff, s->heavy, s->aligned,
                      s->z,     s->guide, s->norm, s->mu,    s->old};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    qc__connection_free(&s->c);
    qc__face_pattern_free(&s->pattern);
    qc_factor_free(s->factor);
}

static qc_status system_create(qc_ctx *ctx, const qc_mesh *mesh, system *s) {
    int32_t F = mesh->n_faces, C = mesh->n_components;
    qc_status status = qc__connection_create(ctx, mesh, &s->c);
    if (!status) status = qc__face_pattern_create(ctx, mesh, &s->pattern);
    if (status) return status;
    s->value = QC__NEW(ctx, qc_complex, s->pattern.colptr[F]);
    s->mass = QC__NEW(ctx, double, F);
    s->pull = QC__NEW(ctx, double, F);
    s->z = QC__NEW(ctx, qc__cplx, F);
    s->guide = QC__NEW(ctx, qc__cplx, F);
    s->stiff = QC__ZERO(ctx, double, C);
    s->heavy = QC__ZERO(ctx, double, C);
    s->aligned = QC__ZERO(ctx, uint8_t, C);
    s->norm = QC__ZERO(ctx, double, C);
    s->mu = QC__ZERO(ctx, double, C);
    s->old = QC__ZERO(ctx, double, C);
    return s->value && s->mass && s->pull && s->z && s->guide && s->stiff && s->heavy &&
                   s->aligned && s->norm && s->mu && s->old
               ? QC_OK
               : QC_ERR_NOMEM;
}

/* Mass and alignment; decides which components are aligned. */
static void set_weights(system *s, const double *weight, const uint8_t *trusted, double alignment) {
    const qc_mesh *mesh = s->mesh;
    double l = qc__reference_length(mesh);
    memset(s->mu, 0, (size_t)mesh->n_components * sizeof *s->mu);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        int32_t i = mesh->face_component[t];
        bool kept = (weight || trusted) && (!trusted || trusted[t]);
        s->mass[t] = s->c.area[t] / (l * l);
        s->pull[t] = kept ? alignment * (weight ? weight[t] : 1) * s->mass[t] : 0;
        s->heavy[i] += s->mass[t];
        s->mu[i] += s->pull[t];
    }
    for (int32_t e = 0; e < mesh->n_edges; e++)
        s->stiff[mesh->face_component[mesh->edge_halfedge[2 * e] / 3]] += 2 * s->c.omega[e];
    for (int32_t i = 0; i < mesh->n_components; i++)
        s->aligned[i] = s->mu[i] > ALIGNMENT_MIN * s->stiff[i];
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (!s->aligned[mesh->face_component[t]]) s->pull[t] = 0;
}

/* A + t W, and the shift where there is no alignment: a flat torus has a kernel. */
static void fill_matrix(system *s, double shift) {
    const qc_mesh *mesh = s->mesh;
    const int64_t *colptr = s->pattern.colptr;
    memset(s->value, 0, (size_t)colptr[mesh->n_faces] * sizeof *s->value);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        int32_t i = mesh->face_component[t];
        double m = s->aligned[i] ? 0 : shift * s->mass[t] * s->stiff[i] / s->heavy[i];
        s->value[colptr[t + 1] - 1].re = s->pull[t] + m;
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        int32_t a = mesh->edge_halfedge[2 * e] / 3, b = mesh->edge_halfedge[2 * e + 1] / 3;
        qc__cplx off = s->c.omega[e] * conj(qc__fourth(qc__c(s->c.rho[e]))); /* row a, column b */
        s->value[colptr[a + 1] - 1].re += s->c.omega[e];
        s->value[colptr[b + 1] - 1].re += s->c.omega[e];
        s->value[s->pattern.entry[e]].re -= creal(off);
        s->value[s->pattern.entry[e]].im -= cimag(off);
    }
}

/* The smallest shift which the pivot test of the factorisation accepts. */
static qc_status factorise(qc_ctx *ctx, system *s) {
    qc_hermitian A = {s->mesh->n_faces, s->pattern.colptr, s->pattern.row, s->value};
    qc_symbolic *symbolic = NULL;
    qc_status status = qc_analyze(ctx, &A, NULL, &symbolic);
    if (status) return status;
    for (double shift = 1e-9; shift < 1; shift *= 100) {
        fill_matrix(s, shift);
        status = qc_factorize(ctx, symbolic, &A, &s->factor);
        if (status != QC_ERR_NOT_POSDEF) break;
    }
    qc_symbolic_free(symbolic);
    return status;
}

/* Start vector: unit numbers with well-scattered phases (golden ratio), the same on every machine. */
static void start(system *s) {
    for (int32_t t = 0; t < s->mesh->n_faces; t++) {
        double phase = 2 * QC__PI * fmod(0.6180339887498949 * (t + 1.0), 1);
        s->z[t] = cos(phase) + sin(phase) * I;
    }
}

/* M-norms of the components of z; scales each to one (the aligned ones as well: they are not used). */
static void normalise(system *s) {
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
static bool settled(system *s) {
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

static qc_status inverse_iteration(qc_ctx *ctx, system *s) {
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

/* Solves with the guide and takes the result in the aligned components. */
static qc_status solve_aligned(qc_ctx *ctx, system *s, const qc_complex *x) {
    for (int32_t t = 0; t < s->mesh->n_faces; t++)
        s->guide[t] = s->pull[t] * qc__fourth(qc__unit(qc__c(x[t])));
    qc_status status = qc_solve(ctx, s->factor, 1, (qc_complex *)s->guide);
    for (int32_t t = 0; !status && t < s->mesh->n_faces; t++)
        if (s->aligned[s->mesh->face_component[t]]) s->z[t] = s->guide[t];
    return status;
}

static void take_roots(const system *s, qc_complex *x) {
    for (int32_t t = 0; t < s->mesh->n_faces; t++) {
        double angle = qc__arg(s->z[t]) / 4;
        x[t] = (qc_complex){cos(angle), sin(angle)};
    }
}

qc_status qc_field_smoothest(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                             const uint8_t *trusted, double alignment, qc_complex *x) {
    if (!(alignment >= 0) || !isfinite(alignment))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the alignment %g is negative or not finite",
                        alignment);
    system s = {.mesh = mesh};
    qc_status status = system_create(ctx, mesh, &s);
    if (!status) {
        bool eigen = false, guided = false;
        set_weights(&s, weight, trusted, alignment);
        for (int32_t i = 0; i < mesh->n_components; i++) *(s.aligned[i] ? &guided : &eigen) = true;
        status = factorise(ctx, &s);
        if (!status && eigen) status = inverse_iteration(ctx, &s);
        if (!status && guided) status = solve_aligned(ctx, &s, x);
        if (!status) take_roots(&s, x);
    }
    system_free(&s);
    return status;
}
