/* A seamless map by its free coordinates, and the inverse of its Dirichlet form (see free_map.h).
 */
#include "sdk/map/periods/free_map.h"
#include <string.h>

void qc__free_map_free(qc__free_map *m) {
    if (!m) return;
    qc__period_factor_free(&m->schur);
    void *const blocks[] = {m->base, m->symbol, m->slope, m->F, m->wedge, m->residual};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(m);
}

qc_status qc__free_map_create(qc_ctx *ctx, const qc__periods *periods, const double *P,
                              qc__free_map **out) {
    const qc__seams *s = periods->seams;
    qc__free_map *m = QC__ZERO(ctx, qc__free_map, 1);
    if (!m) return QC_ERR_NOMEM;
    m->periods = periods;
    m->n_F = periods->stiffness->n;
    m->n = m->n_F + s->n_free;
    m->base = QC__NEW(ctx, double _Complex, s->mesh->n_vertices);
    m->symbol = QC__NEW(ctx, double, qc__seams_symbols(s));
    m->slope = QC__NEW(ctx, double, s->n_free);
    m->F = QC__NEW(ctx, double _Complex, s->mesh->n_vertices);
    m->wedge = QC__NEW(ctx, double _Complex, s->n_wedges);
    m->residual = QC__NEW(ctx, double _Complex, s->n_wedges);
    qc_status status =
        m->base && m->symbol && m->slope && m->F && m->wedge && m->residual ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && P && s->n_free > 0)
        status = qc__period_factor_create(ctx, s->n_free, P, &m->schur);
    if (status != QC_OK) {
        qc__free_map_free(m);
        return status;
    }
    *out = m;
    return QC_OK;
}

void qc__free_map_read(qc__free_map *m, const qc_complex *f, const double *y, double *x) {
    const qc__seams *s = m->periods->seams;
    qc__periods_split(s, f, m->wedge, m->base);
    for (int32_t i = 0; i < 2 * s->mesh->n_vertices; i++) {
        const int32_t unknown = m->periods->stiffness->unknown[i];
        double *coordinate = (double *)(m->base + i / 2) + i % 2;
        if (unknown < 0) continue;
        x[unknown] = *coordinate;
        *coordinate = 0;
    }
    memcpy(x + m->n_F, y, sizeof *x * (size_t)s->n_free);
}

void qc__free_map_corners(qc__free_map *m, const double *x, qc_complex *f) {
    const qc__seams *s = m->periods->seams;
    qc__seams_symbol_values(s, x + m->n_F, m->symbol);
    qc__seams_wedge_values(s, m->symbol, m->wedge);
    qc__periods_spread(m->periods, x, m->F);
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) m->F[v] += m->base[v];
    qc__periods_corners(s, m->wedge, m->F, f);
}

void qc__free_map_gradient(qc__free_map *m, const qc_complex *g, double *gradient) {
    const qc__seams *s = m->periods->seams;
    memset(m->residual, 0, sizeof *m->residual * (size_t)s->n_wedges);
    for (int64_t c = 0; c < 3 * (int64_t)s->mesh->n_faces; c++)
        m->residual[s->corner_wedge[c]] += qc__complex(g[c]);
    qc__periods_pull_back(m->periods, m->residual, m->symbol, gradient, gradient + m->n_F);
    if (!m->schur.factor) memset(gradient + m->n_F, 0, sizeof *gradient * (size_t)s->n_free);
}

/* L a = p_F,  P dy = p_y - B^T a,  dF = a - L^-1 B dy. */
qc_status qc__free_map_precondition(qc_ctx *ctx, qc__free_map *m, double *p) {
    const qc__periods *periods = m->periods;
    const qc__seams *s = periods->seams;
    double *y = p + m->n_F;
    qc_status status = qc__map_stiffness_solve(ctx, periods->stiffness, 1, p);
    if (status != QC_OK || !m->schur.factor) return status;
    memset(m->wedge, 0, sizeof *m->wedge * (size_t)s->n_wedges);
    qc__periods_spread(periods, p, m->F);
    status = qc__periods_slope(ctx, periods, m->wedge, NULL, m->F, m->slope);
    if (status != QC_OK) return status;
    for (int32_t j = 0; j < s->n_free; j++) y[j] -= m->slope[j];
    status = qc_solve_real(ctx, m->schur.factor, 1, y);
    if (status != QC_OK) return status;
    qc__seams_symbol_values(s, y, m->symbol);
    qc__seams_wedge_values(s, m->symbol, m->wedge);
    return qc__periods_add_extension(ctx, periods, m->wedge, p);
}
