/* Counts of the covering: vertices, components, genus (Riemann-Hurwitz, Lemma 3.5 of Kaelberer
 * 2013).
 *
 * A vertex of shift 0 has four vertices above it, of shift 2 two, of odd shift one, hence
 *     chi~ = 4 chi - 2 b_even - 3 b_odd,   sum of genera = components - chi~ / 2,
 * so 4 g + b_even + 3/2 b_odd - 3 when the covering is connected. (The thesis prints 1/2 b_even
 * there; its own count of 4 g + b_odd - 2 asymmetric loops needs b_even.) */
#include <qc/cover.h>

#include "sdk/base/internal.h"

/* Subgroups of Z/4 as the smallest positive turn they contain, 4 for the trivial one: this is also
 * the number of components of the covering. */
static int32_t join(int32_t group, int32_t turn) {
    if (turn & 1) return 1;
    return turn == 2 && group == 4 ? 2 : group;
}

static qc_status count_components(qc_ctx *ctx, const qc_cover *cover, int32_t *components) {
    const qc_mesh *m = cover->mesh;
    int8_t *turn = QC__NEW(ctx, int8_t, m->n_faces), *residual = QC__NEW(ctx, int8_t, m->n_edges);
    int8_t *group = QC__NEW(ctx, int8_t, m->n_components);
    qc_status status = turn && residual && group ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_cover_comb(ctx, cover, NULL, turn, residual, NULL);
    if (status == QC_OK) {
        for (int32_t i = 0; i < m->n_components; i++) group[i] = 4;
        for (int32_t e = 0; e < m->n_edges; e++) {
            const int32_t i = m->face_component[m->edge_halfedge[2 * e] / 3];
            group[i] = (int8_t)join(group[i], residual[e]);
        }
        *components = 0;
        for (int32_t i = 0; i < m->n_components; i++) *components += group[i];
    }
    qc__free(turn);
    qc__free(residual);
    qc__free(group);
    return status;
}

qc_status qc_cover_get_info(qc_ctx *ctx, const qc_cover *cover, qc_cover_info *info) {
    const qc_mesh *m = cover->mesh;
    qc_cover_info c = {0};
    int8_t *shift = QC__NEW(ctx, int8_t, m->n_vertices);
    qc_status status = shift ? qc_cover_shifts(ctx, cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) status = count_components(ctx, cover, &c.components);
    if (status != QC_OK) {
        qc__free(shift);
        return status;
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        c.odd += shift[v] & 1;
        c.even += shift[v] == 2;
    }
    qc__free(shift);
    c.vertices = 4 * m->n_vertices - 3 * c.odd - 2 * c.even;
    c.edges = 4 * m->n_edges;
    c.faces = 4 * m->n_faces;
    c.euler = c.vertices - c.edges + c.faces;
    c.lemma_genus = c.symmetric_loops = -1;
    if (m->n_components == 1 && m->n_boundary_edges == 0) {
        const int32_t chi = 4 * (2 - 2 * m->genus) - 2 * c.even - 3 * c.odd;
        c.lemma_genus = c.components - chi / 2;
        if (c.even + c.odd > 0) c.symmetric_loops = 4 * m->genus + 2 * (c.even + c.odd) - 4;
    }
    *info = c;
    return QC_OK;
}
