/* Assembly and factorisation of the power field system, see power_system.h. */
#include "power_system.h"

#include <string.h>

/* A component whose alignment is weaker than this part of its trace is treated as unaligned. */
#define ALIGNMENT_MIN 1e-9

void qc__power_free(qc__power_system *s) {
    void *arrays[] = {s->value, s->mass, s->pull, s->stiff, s->heavy, s->aligned,
                      s->kept,  s->z,    s->work, s->norm,  s->mu,    s->old};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    qc__connection_free(&s->c);
    qc__face_pattern_free(&s->pattern);
    qc_symbolic_free(s->symbolic);
    qc_factor_free(s->factor);
}

static qc_status allocate(qc_ctx *ctx, qc__power_system *s) {
    int32_t F = s->mesh->n_faces, C = s->mesh->n_components;
    s->value = QC__NEW(ctx, qc_complex, s->pattern.colptr[F]);
    s->mass = QC__NEW(ctx, double, F);
    s->pull = QC__NEW(ctx, double, F);
    s->z = QC__NEW(ctx, qc__cplx, F);
    s->work = QC__NEW(ctx, qc__cplx, F);
    s->stiff = QC__ZERO(ctx, double, C);
    s->heavy = QC__ZERO(ctx, double, C);
    s->aligned = QC__ZERO(ctx, uint8_t, C);
    s->kept = QC__NEW(ctx, uint8_t, F);
    s->norm = QC__ZERO(ctx, double, C);
    s->mu = QC__ZERO(ctx, double, C);
    s->old = QC__ZERO(ctx, double, C);
    return s->value && s->mass && s->pull && s->z && s->work && s->stiff && s->heavy &&
                   s->aligned && s->kept && s->norm && s->mu && s->old
               ? QC_OK
               : QC_ERR_NOMEM;
}

/* Mass and alignment; decides which components are aligned. */
static void set_weights(qc__power_system *s, const double *weight, const uint8_t *trusted,
                        double alignment) {
    const qc_mesh *mesh = s->mesh;
    double l = qc__reference_length(mesh), *total = s->norm;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        int32_t i = mesh->face_component[t];
        bool pulled = (weight || trusted) && (!trusted || trusted[t]);
        s->kept[t] = qc__kept(weight, trusted, t);
        s->mass[t] = s->c.area[t] / (l * l);
        s->pull[t] = pulled && !s->kept[t] ? alignment * (weight ? weight[t] : 1) * s->mass[t] : 0;
        s->heavy[i] += s->mass[t];
        total[i] += s->kept[t] ? INFINITY : s->pull[t];
    }
    for (int32_t e = 0; e < mesh->n_edges; e++)
        s->stiff[mesh->face_component[mesh->edge_halfedge[2 * e] / 3]] += 2 * s->c.omega[e];
    for (int32_t i = 0; i < mesh->n_components; i++)
        s->aligned[i] = total[i] > ALIGNMENT_MIN * s->stiff[i];
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (!s->aligned[mesh->face_component[t]]) s->pull[t] = 0;
}

qc_status qc__power_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                           const uint8_t *trusted, double alignment, qc__power_system *s) {
    *s = (qc__power_system){.mesh = mesh};
    qc_status status = qc__connection_create(ctx, mesh, &s->c);
    if (!status) status = qc__face_pattern_create(ctx, mesh, &s->pattern);
    if (!status) status = allocate(ctx, s);
    if (!status) set_weights(s, weight, trusted, alignment);
    return status;
}

void qc__power_fill(qc__power_system *s, double shift, double inertia) {
    const qc_mesh *mesh = s->mesh;
    const int64_t *colptr = s->pattern.colptr;
    memset(s->value, 0, (size_t)colptr[mesh->n_faces] * sizeof *s->value);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        int32_t i = mesh->face_component[t];
        double m = s->aligned[i] ? 0 : shift * s->stiff[i] / s->heavy[i];
        s->value[colptr[t + 1] - 1].re = s->pull[t] + (m + inertia) * s->mass[t];
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        int32_t a = mesh->edge_halfedge[2 * e] / 3, b = mesh->edge_halfedge[2 * e + 1] / 3;
        qc__cplx off = s->c.omega[e] * conj(qc__fourth(qc__c(s->c.rho[e]))); /* row a, column b */
        s->value[colptr[a + 1] - 1].re += s->c.omega[e];
        s->value[colptr[b + 1] - 1].re += s->c.omega[e];
        if (s->kept[a] || s->kept[b]) continue;
        s->value[s->pattern.entry[e]].re -= creal(off);
        s->value[s->pattern.entry[e]].im -= cimag(off);
    }
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (s->kept[t]) s->value[colptr[t + 1] - 1].re = 1;
}

void qc__power_add_kept(qc__power_system *s, const qc_complex *guide) {
    const qc_mesh *mesh = s->mesh;
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (s->kept[t]) s->work[t] = qc__fourth(qc__unit(qc__c(guide[t])));
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (s->pattern.entry[e] < 0) continue;
        int32_t a = mesh->edge_halfedge[2 * e] / 3, b = mesh->edge_halfedge[2 * e + 1] / 3;
        qc__cplx turn = qc__fourth(qc__c(s->c.rho[e]));
        if (s->kept[a] && !s->kept[b]) s->work[b] += s->c.omega[e] * turn * s->work[a];
        if (s->kept[b] && !s->kept[a]) s->work[a] += s->c.omega[e] * conj(turn) * s->work[b];
    }
}

qc_status qc__power_factorise(qc_ctx *ctx, qc__power_system *s) {
    qc_hermitian A = {s->mesh->n_faces, s->pattern.colptr, s->pattern.row, s->value};
    qc_status status = QC_OK;
    if (!s->symbolic) status = qc_analyze(ctx, &A, NULL, &s->symbolic);
    if (status) return status;
    if (s->factor) return qc_refactorize(ctx, s->factor, &A);
    return qc_factorize(ctx, s->symbolic, &A, &s->factor);
}
