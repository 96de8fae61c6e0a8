/* Points of a cut surface: cones, corners of features, and poles (see seams.h). */
#include "sdk/map/seams/seam_builder.h"

static qc_status number_points(qc__seam_builder *b, const uint8_t *point) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    s->vertex_cone = QC__NEW(b->ctx, int32_t, mesh->n_vertices);
    if (!s->vertex_cone) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) s->vertex_cone[v] = point[v] ? s->n_cones++ : -1;
    s->cone_vertex = QC__NEW(b->ctx, int32_t, s->n_cones + mesh->n_poles);
    s->cone_turn = QC__ZERO(b->ctx, int8_t, s->n_cones + mesh->n_poles);
    s->cone_pole = QC__NEW(b->ctx, int32_t, mesh->n_poles);
    if (!s->cone_vertex || !s->cone_turn || !s->cone_pole) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (s->vertex_cone[v] >= 0) s->cone_vertex[s->vertex_cone[v]] = v;
    return QC_OK;
}

qc_status qc__seams_points(qc__seam_builder *b, const int32_t *index4,
                           const qc__features *features) {
    const qc_mesh *mesh = b->cover->mesh;
    int8_t *shift = QC__NEW(b->ctx, int8_t, mesh->n_vertices);
    uint8_t *point = QC__NEW(b->ctx, uint8_t, mesh->n_vertices);
    qc_status status = shift && point ? qc_cover_shifts(b->ctx, b->cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc__feature_corners(b->ctx, features, point);
    for (int32_t v = 0; v < mesh->n_vertices && status == QC_OK; v++)
        point[v] |= !qc_vertex_on_boundary(mesh, v) && (shift[v] != 0 || index4[v] != 0);
    if (status == QC_OK) status = number_points(b, point);
    qc__free(shift);
    qc__free(point);
    return status;
}

qc_status qc__seams_poles(qc__seam_builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    b->hole = QC__NEW(b->ctx, int32_t, mesh->n_vertices);
    if (!b->hole) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) b->hole[v] = -1;
    for (int32_t i = 0; i < mesh->n_poles; i++) {
        int32_t ends = 0;
        for (int32_t j = mesh->pole_start[i]; j < mesh->pole_start[i + 1]; j++) {
            const int32_t c = mesh->pole_corner[j];
            const int32_t tip = mesh->face_vertex[c], link = mesh->face_vertex[qc_prev(c)];
            b->hole[tip] = b->hole[link] = i;
            ends += b->degree[tip] + b->degree[link];
        }
        if (ends == 0) continue; /* the shift around it is zero whatever the map */
        const int32_t k = s->n_cones + s->n_poles;
        s->cone_vertex[k] = qc__pole_tip(mesh, i);
        s->cone_turn[k] = 1;
        s->cone_pole[s->n_poles++] = i;
    }
    return QC_OK;
}
