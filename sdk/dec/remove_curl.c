/* The locally integrable field closest to a given one: Z^ = Z - J grad v with L* v = r (Kaelberer
 * 2013, (1.9) and (6.1)), and its energy E_D = 1/2 v^H L* v = 1/2 Re(v^H r).
 *
 * On slivers J grad v multiplies the rounding of v by their cotangents. What curl is left over is
 * therefore removed again with the same factor, which multiplies it by about eps * cot each time.
 */
#include <math.h>

#include "sdk/dec/internal.h"

enum { MAX_PASSES = 4 };
static const double NEGLIGIBLE = 1e-14, TOLERABLE = 1e-9; /* of the largest value of the form */

static double largest(int32_t n, const qc_complex *z) {
    double max = 0;
    for (int32_t i = 0; i < n; i++) max = fmax(max, fmax(fabs(z[i].re), fabs(z[i].im)));
    return max;
}

typedef struct work {
    qc_complex *form; /* 3 n_faces: Z, then Z^                                                   */
    qc_complex *r, *dv; /* n_edges */
    qc_complex *v; /* n_edges: sum of the dv                                                  */
} work;

static void work_free(work *w) {
    qc__free(w->form);
    qc__free(w->r);
    qc__free(w->dv);
    qc__free(w->v);
}

static bool work_create(qc_ctx *ctx, const qc_mesh *m, const qc_complex *z, work *w) {
    w->form = QC__NEW(ctx, qc_complex, 3 * (size_t)m->n_faces);
    w->r = QC__NEW(ctx, qc_complex, m->n_edges);
    w->dv = QC__NEW(ctx, qc_complex, m->n_edges);
    w->v = QC__ZERO(ctx, qc_complex, m->n_edges);
    if (!w->form || !w->r || !w->dv || !w->v) return false;
    for (int32_t h = 0; h < 3 * m->n_faces; h++) w->form[h] = z[h];
    return true;
}

/* The curl of w->form as right-hand side, where v is an unknown: at an edge fixed for the sake of
 * the constants it vanishes with all the others, if the values of each face sum to zero. */
static qc_status remaining_curl(qc_ctx *ctx, const qc_cover *cover, const qc__system *system,
                                const qc_complex *form, qc_complex *curl) {
    const qc_status status = qc_form_weak_curl_edges(ctx, cover, form, curl);
    for (int32_t e = 0; status == QC_OK && e < cover->mesh->n_edges; e++)
        if (system->stiffness->unknown[e] < 0) curl[e] = (qc_complex){0, 0};
    return status;
}

static qc_status check_curl(qc_ctx *ctx, const qc_mesh *m, const qc_complex *curl, double size) {
    for (int32_t e = 0; e < m->n_edges; e++)
        if (!(fmax(fabs(curl[e].re), fabs(curl[e].im)) <= TOLERABLE * size))
            return qc__fail(ctx, QC_ERR_FAILED, e,
                            "the curl at edge %d cannot be removed; repair the mesh (faces "
                            "almost without area)",
                            (int)e);
    return QC_OK;
}

/* Removes curl from w->form until it is negligible or no longer falls. */
static qc_status remove_passes(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                               const qc__system *system, work *w) {
    const qc_mesh *m = cover->mesh;
    const double size = largest(3 * m->n_faces, w->form);
    double last = INFINITY;
    for (int pass = 0;; pass++) {
        qc_status status = remaining_curl(ctx, cover, system, w->form, w->dv);
        if (status != QC_OK) return status;
        const double curl = largest(m->n_edges, w->dv);
        if (curl <= NEGLIGIBLE * size || curl > 0.5 * last || pass == MAX_PASSES)
            return check_curl(ctx, m, w->dv, size);
        last = curl;
        status = qc__system_solve(ctx, system, w->dv);
        if (status != QC_OK) return status;
        qc__subtract_rotation(cover, cotangent, w->dv, w->form, w->form);
        for (int32_t e = 0; e < m->n_edges; e++) w->v[e] = qc__add(w->v[e], w->dv[e]);
    }
}

void qc__curl_system_free(qc__curl_system *kept) {
    if (kept->stiffness) qc__system_free(&kept->system);
    qc_stiffness_free(kept->stiffness);
}

/* Makes the system, or gives it the values for other cotangents. */
static qc_status prepare(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                         const qc_solver *solver, qc__curl_system *kept) {
    qc_stiffness *stiffness = NULL, *old = kept->stiffness;
    qc_status status = qc_stiffness_edges(ctx, cover, cotangent, &stiffness);
    if (status != QC_OK) return status;
    status = old ? qc__system_update(ctx, &kept->system, stiffness, "edge")
                 : qc__system_create(ctx, solver, stiffness, cover->mesh->n_edges, "edge",
                                     &kept->system);
    if (status != QC_OK && !old) {
        qc_stiffness_free(stiffness);
        return status;
    }
    qc_stiffness_free(old);
    kept->stiffness = stiffness;
    return status;
}

qc_status qc__remove_curl(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                          const qc_solver *solver, qc__curl_system *kept, const qc_complex *z,
                          qc_complex *out, qc_complex *v, double *energy) {
    const qc_mesh *m = cover->mesh;
    work w = {0};
    qc_status status = work_create(ctx, m, z, &w) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_form_weak_curl_edges(ctx, cover, w.form, w.r);
    if (status == QC_OK) status = prepare(ctx, cover, cotangent, solver, kept);
    if (status == QC_OK) status = remove_passes(ctx, cover, cotangent, &kept->system, &w);
    if (status == QC_OK) {
        double sum = 0;
        for (int32_t e = 0; e < m->n_edges; e++)
            sum += w.v[e].re * w.r[e].re + w.v[e].im * w.r[e].im;
        if (energy) *energy = 0.5 * sum;
        for (int32_t h = 0; out && h < 3 * m->n_faces; h++) out[h] = w.form[h];
        for (int32_t e = 0; v && e < m->n_edges; e++) v[e] = w.v[e];
    }
    work_free(&w);
    return status;
}

qc_status qc_hodge_remove_curl(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                               const qc_solver *solver, const qc_complex *z, qc_complex *out,
                               qc_complex *v, double *energy) {
    qc__curl_system system = {0};
    const qc_status status =
        qc__remove_curl(ctx, cover, cotangent, solver, &system, z, out, v, energy);
    qc__curl_system_free(&system);
    return status;
}
