/* The locally integrable field closest to a given one: Z^ = Z - J grad v with L* v = r (Kaelberer
 * 2013, (1.9) and (6.1)), and its energy E_D = 1/2 v^H L* v = 1/2 Re(v^H r). */
#include "sdk/dec/internal.h"

static qc_status co_potential(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                              qc_complex *v) {
    qc_stiffness *stiffness = NULL;
    qc_status status = qc_stiffness_edges(ctx, cover, cotangent, &stiffness);
    if (status != QC_OK) return status;
    qc__system system;
    status = qc__system_create(ctx, stiffness, cover->mesh->n_edges, "edge", &system);
    if (status == QC_OK) {
        status = qc__system_solve(ctx, &system, v);
        qc__system_free(&system);
    }
    qc_stiffness_free(stiffness);
    return status;
}

qc_status qc_hodge_remove_curl(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                               const qc_complex *z, qc_complex *out, qc_complex *v,
                               double *energy) {
    const int32_t n = cover->mesh->n_edges;
    qc_complex *r = QC__NEW(ctx, qc_complex, n), *x = QC__NEW(ctx, qc_complex, n);
    qc_status status = r && x ? qc_form_weak_curl_edges(ctx, cover, z, r) : QC_ERR_NOMEM;
    for (int32_t e = 0; status == QC_OK && e < n; e++) x[e] = r[e];
    if (status == QC_OK) status = co_potential(ctx, cover, cotangent, x);
    if (status == QC_OK) {
        double sum = 0;
        for (int32_t e = 0; e < n; e++) sum += x[e].re * r[e].re + x[e].im * r[e].im;
        if (energy) *energy = 0.5 * sum;
        if (out) qc__subtract_rotation(cover, cotangent, x, z, out);
        for (int32_t e = 0; v && e < n; e++) v[e] = x[e];
    }
    qc__free(r);
    qc__free(x);
    return status;
}
