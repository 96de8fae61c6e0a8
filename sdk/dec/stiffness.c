/* The two stiffness matrices of Kaelberer 2013, (1.5) and (3.7), as Hermitian matrices on the mesh
 * below (3.8): which values are unknowns, and their gauge. */
#include "sdk/dec/assemble.h"

void qc_stiffness_free(qc_stiffness *s) {
    if (!s) return;
    qc__free((void *)s->A.colptr);
    qc__free((void *)s->A.row);
    qc__free((void *)s->A.val);
    qc__free(s->unknown);
    qc__free(s);
}

/* One flag per component: 1 when the constants (in the combed gauge) are functions on it. */
static qc_status trivial_components(qc_ctx *ctx, const qc_cover *cover, uint8_t **out) {
    const qc_mesh *m = cover->mesh;
    int8_t *turn = QC__NEW(ctx, int8_t, m->n_faces);
    uint8_t *trivial = QC__NEW(ctx, uint8_t, m->n_components);
    qc_status status = turn && trivial ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_cover_comb(ctx, cover, NULL, turn, NULL, trivial);
    qc__free(turn);
    if (status == QC_OK)
        *out = trivial;
    else
        qc__free(trivial);
    return status;
}

/* Boundary edges are fixed, and the first edge of a closed component with trivial holonomy. */
static qc_status number_edges(qc_ctx *ctx, const qc_cover *cover, int32_t *unknown, int32_t *n) {
    const qc_mesh *m = cover->mesh;
    uint8_t *free_constant = NULL;
    const qc_status status = trivial_components(ctx, cover, &free_constant);
    if (status != QC_OK) return status;
    for (int32_t e = 0; e < m->n_edges; e++)
        if (m->edge_halfedge[2 * e + 1] < 0)
            free_constant[m->face_component[m->edge_halfedge[2 * e] / 3]] = 0;
    *n = 0;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t i = m->face_component[m->edge_halfedge[2 * e] / 3];
        const bool fixed = m->edge_halfedge[2 * e + 1] < 0 || free_constant[i];
        free_constant[i] = 0;
        unknown[e] = fixed ? -1 : (*n)++;
    }
    qc__free(free_constant);
    return QC_OK;
}

/* Branch points and pinned vertices are fixed, and the first vertex of a component with trivial
 * holonomy where nothing else is. */
static qc_status number_vertices(qc_ctx *ctx, const qc_cover *cover, const uint8_t *pinned,
                                 int32_t *unknown, int32_t *n) {
    const qc_mesh *m = cover->mesh;
    uint8_t *free_constant = NULL;
    int8_t *shift = QC__NEW(ctx, int8_t, m->n_vertices);
    qc_status status = shift ? qc_cover_shifts(ctx, cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) status = trivial_components(ctx, cover, &free_constant);
    if (status != QC_OK) {
        qc__free(shift);
        return status;
    }
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (pinned && pinned[v]) free_constant[m->face_component[m->vertex_corner[v] / 3]] = 0;
    *n = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const int32_t i = m->face_component[m->vertex_corner[v] / 3];
        const bool fixed = shift[v] != 0 || (pinned && pinned[v]) || free_constant[i];
        free_constant[i] = 0;
        unknown[v] = fixed ? -1 : (*n)++;
    }
    qc__free(shift);
    qc__free(free_constant);
    return QC_OK;
}

qc_status qc_stiffness_edges(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                             qc_stiffness **out) {
    const qc_mesh *m = cover->mesh;
    int32_t n = 0;
    qc_stiffness *s = QC__ZERO(ctx, qc_stiffness, 1);
    int8_t *turn = QC__NEW(ctx, int8_t, 3 * (size_t)m->n_faces);
    qc_status status = s && turn ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        s->unknown = QC__NEW(ctx, int32_t, m->n_edges);
        status = s->unknown ? number_edges(ctx, cover, s->unknown, &n) : QC_ERR_NOMEM;
    }
    if (status == QC_OK) {
        for (int32_t h = 0; h < 3 * m->n_faces; h++)
            turn[h] = (int8_t)(qc__edge_turn(cover, h) & 3);
        status = qc__assemble(ctx, m->n_faces, cotangent, 2, m->halfedge_edge, turn, n, s);
    }
    qc__free(turn);
    if (status != QC_OK)
        qc_stiffness_free(s);
    else
        *out = s;
    return status;
}

qc_status qc_stiffness_vertices(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                const uint8_t *pinned, qc_stiffness **out) {
    const qc_mesh *m = cover->mesh;
    int32_t n = 0;
    qc_stiffness *s = QC__ZERO(ctx, qc_stiffness, 1);
    int8_t *turn = QC__NEW(ctx, int8_t, 3 * (size_t)m->n_faces);
    qc_status status = s && turn ? qc_cover_corner_turns(ctx, cover, turn) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        s->unknown = QC__NEW(ctx, int32_t, m->n_vertices);
        status = s->unknown ? number_vertices(ctx, cover, pinned, s->unknown, &n) : QC_ERR_NOMEM;
    }
    if (status == QC_OK)
        status = qc__assemble(ctx, m->n_faces, cotangent, 0.5, m->face_vertex, turn, n, s);
    qc__free(turn);
    if (status != QC_OK)
        qc_stiffness_free(s);
    else
        *out = s;
    return status;
}
