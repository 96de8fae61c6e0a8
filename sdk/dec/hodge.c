/* Discrete Hodge decomposition (Theorem 1.12 of Kaelberer 2013) on a mesh or on its covering.
 *
 * Conforming: Z = grad F + J grad v + H, F at vertices, v at edges. Since J is an isometry with J J
 * = -1, the non-conforming version is the conforming one of J Z, turned back: J Z = grad F + J grad
 * v + H  =>  Z = grad v + J grad(-F) - J H. */
#include "sdk/dec/internal.h"

static qc_status potential_values(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                  qc_complex *F) {
    qc_stiffness *stiffness = NULL;
    qc_status status = qc_stiffness_vertices(ctx, cover, cotangent, NULL, &stiffness);
    if (status != QC_OK) return status;
    qc__system system;
    status = qc__system_create(ctx, NULL, stiffness, cover->mesh->n_vertices, "vertex", &system);
    if (status == QC_OK) {
        status = qc__system_solve(ctx, &system, F);
        qc__system_free(&system);
    }
    qc_stiffness_free(stiffness);
    return status;
}

/* p = grad F with L F = <grad phi, Z>. */
static qc_status project_gradient(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                  const qc_complex *z, qc_complex *p) {
    qc_complex *F = QC__NEW(ctx, qc_complex, cover->mesh->n_vertices);
    qc_status status = F ? qc_form_divergence(ctx, cover, cotangent, z, F) : QC_ERR_NOMEM;
    if (status == QC_OK) status = potential_values(ctx, cover, cotangent, F);
    if (status == QC_OK) status = qc_form_gradient(ctx, cover, F, p);
    qc__free(F);
    return status;
}

/* p = potential part, c = co-potential part. */
static qc_status decompose(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                           const qc_complex *z, qc_complex *p, qc_complex *c) {
    const int32_t n = 3 * cover->mesh->n_faces;
    qc__range outer = qc__range_begin(ctx, NULL, 0, 0.3);
    qc_status status = project_gradient(ctx, cover, cotangent, z, p);
    qc__range_end(ctx, outer);
    if (status != QC_OK) return status;
    outer = qc__range_begin(ctx, NULL, 0.3, 1);
    status = qc_hodge_remove_curl(ctx, cover, cotangent, NULL, z, c, NULL, NULL);
    qc__range_end(ctx, outer);
    for (int32_t h = 0; status == QC_OK && h < n; h++) c[h] = qc__sub(z[h], c[h]);
    return status;
}

static void turn_back(const qc_mesh *m, const double *cotangent, qc_complex *z) {
    qc__rotate(m, cotangent, z, z);
    for (int32_t h = 0; h < 3 * m->n_faces; h++) z[h] = qc__scale(-1, z[h]);
}

static void write_parts(int32_t n, const qc_complex *z, const qc_complex *p, const qc_complex *c,
                        qc_complex *potential, qc_complex *copotential, qc_complex *harmonic) {
    for (int32_t h = 0; h < n; h++) {
        const qc_complex rest = qc__sub(qc__sub(z[h], p[h]), c[h]);
        if (potential) potential[h] = p[h];
        if (copotential) copotential[h] = c[h];
        if (harmonic) harmonic[h] = rest;
    }
}

qc_status qc_hodge_decompose(qc_ctx *ctx, const qc_cover *cover, int32_t version,
                             const qc_complex *z, qc_complex *potential, qc_complex *copotential,
                             qc_complex *harmonic) {
    const qc_mesh *m = cover->mesh;
    const bool conforming = version == QC_HODGE_CONFORMING;
    if (!conforming && version != QC_HODGE_NONCONFORMING)
        return qc__fail(ctx, QC_ERR_ARGUMENT, version,
                        "version %d of the Hodge decomposition: 0 or 1", (int)version);
    const size_t n = 3 * (size_t)m->n_faces;
    double *cotangent = qc__cotangents(ctx, m);
    qc_complex *p = QC__NEW(ctx, qc_complex, n), *c = QC__NEW(ctx, qc_complex, n);
    qc_complex *turned = conforming ? NULL : QC__NEW(ctx, qc_complex, n);
    qc_status status = cotangent && p && c && (conforming || turned) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && !conforming) qc__rotate(m, cotangent, z, turned);
    if (status == QC_OK) status = decompose(ctx, cover, cotangent, conforming ? z : turned, p, c);
    if (status == QC_OK && !conforming) {
        turn_back(m, cotangent, p);
        turn_back(m, cotangent, c);
    }
    if (status == QC_OK)
        write_parts((int32_t)n, z, conforming ? p : c, conforming ? c : p, potential, copotential,
                    harmonic);
    qc__free(cotangent);
    qc__free(p);
    qc__free(c);
    qc__free(turned);
    return status;
}
