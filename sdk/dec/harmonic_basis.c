/* Harmonic fields with given jumps (Kaelberer 2013, section 1.2.6): H = Sigma - (Sigma)_P, where
 * Sigma is the gradient of a function which jumps by a conserved flow across the cut graph. Since
 * the two ends of an edge jump alike, Sigma has no curl*, whatever the values at single vertices
 * are (1.13). */
#include "sdk/dec/cut_cycles.h"

/* Values at the corners of v: 0 at vertex_corner, then the jumps met counter-clockwise. Crossing an
 * edge from its left to its right subtracts the flow. */
static void jump_around(const qc_mesh *m, const int32_t *flow, int32_t v, double *f) {
    const int32_t first = m->vertex_corner[v];
    int32_t c = first;
    double value = 0;
    do {
        f[c] = value;
        const int32_t h = qc_next(c), e = m->halfedge_edge[h];
        value += m->edge_halfedge[2 * e] == h ? -flow[e] : flow[e];
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != first);
}

static void jump_form(const qc_mesh *m, const int32_t *flow, double *f, qc_complex *z) {
    for (int32_t v = 0; v < m->n_vertices; v++) jump_around(m, flow, v, f);
    for (int32_t h = 0; h < 3 * m->n_faces; h++)
        z[h] = (qc_complex){f[qc_prev(h)] - f[qc_next(h)], 0};
}

typedef struct work {
    qc__cut_cycles cycles;
    double *cotangent, *f;
    int8_t *corner_turn;
    int32_t *flow;
    qc_complex *F, *gradient;
    qc_stiffness *stiffness;
    qc__system system;
} work;

static void work_free(work *w) {
    qc__cut_cycles_free(&w->cycles);
    qc__free(w->cotangent);
    qc__free(w->f);
    qc__free(w->corner_turn);
    qc__free(w->flow);
    qc__free(w->F);
    qc__free(w->gradient);
    qc__system_free(&w->system);
    qc_stiffness_free(w->stiffness);
}

static qc_status work_create(qc_ctx *ctx, const qc_mesh *m, work *w) {
    const qc_cover plain = {m, NULL};
    const size_t n = 3 * (size_t)m->n_faces;
    qc_status status = qc__cut_cycles_create(ctx, m, &w->cycles);
    if (status != QC_OK || w->cycles.count == 0) return status;
    w->cotangent = qc__cotangents(ctx, m);
    w->f = QC__NEW(ctx, double, n);
    w->corner_turn = QC__ZERO(ctx, int8_t, n);
    w->flow = QC__NEW(ctx, int32_t, m->n_edges);
    w->F = QC__NEW(ctx, qc_complex, m->n_vertices);
    w->gradient = QC__NEW(ctx, qc_complex, n);
    if (!w->cotangent || !w->f || !w->corner_turn || !w->flow || !w->F || !w->gradient)
        return QC_ERR_NOMEM;
    status = qc_stiffness_vertices(ctx, &plain, w->cotangent, NULL, &w->stiffness);
    if (status != QC_OK) return status;
    return qc__system_create(ctx, NULL, w->stiffness, m->n_vertices, "vertex", &w->system);
}

static qc_status basis_form(qc_ctx *ctx, const qc_mesh *m, work *w, int32_t i, qc_complex *z) {
    for (int32_t e = 0; e < m->n_edges; e++) w->flow[e] = 0;
    qc__cut_cycles_add(&w->cycles, i, 1, w->flow);
    jump_form(m, w->flow, w->f, z);
    qc__divergence(m, w->cotangent, w->corner_turn, NULL, z, w->F);
    const qc_status status = qc__system_solve(ctx, &w->system, w->F);
    if (status != QC_OK) return status;
    qc__gradient(m, w->corner_turn, w->F, w->gradient);
    for (int32_t h = 0; h < 3 * m->n_faces; h++) z[h] = qc__sub(z[h], w->gradient[h]);
    return QC_OK;
}

qc_status qc_hodge_harmonic_basis(qc_ctx *ctx, const qc_mesh *mesh, int32_t *count,
                                  qc_complex **basis) {
    const size_t size = 3 * (size_t)mesh->n_faces;
    work w = {0};
    qc_complex *z = NULL;
    qc_status status = work_create(ctx, mesh, &w);
    const int32_t n = w.cycles.count;
    if (status == QC_OK && n > 0) {
        z = QC__NEW(ctx, qc_complex, size * (size_t)n);
        if (!z) status = QC_ERR_NOMEM;
    }
    for (int32_t i = 0; status == QC_OK && i < n; i++) {
        status = qc__progress(ctx, (double)i / n) ? QC_OK : QC_ERR_CANCELLED;
        if (status == QC_OK) status = basis_form(ctx, mesh, &w, i, z + size * (size_t)i);
    }
    work_free(&w);
    if (status != QC_OK) {
        qc__free(z);
        return status;
    }
    *count = n;
    *basis = z;
    return QC_OK;
}
