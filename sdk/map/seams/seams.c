/* Seams of a map on a cut surface, made in steps (see seams.h). */
#include "sdk/map/seams/seam_builder.h"

void qc__seams_free(qc__seams *s) {
    if (!s) return;
    void *const blocks[] = {s->edge_segment,
                            s->edge_left,
                            s->segment_turn,
                            s->segment_node,
                            s->cone_vertex,
                            s->vertex_cone,
                            s->cone_turn,
                            s->vertex_wedge,
                            s->corner_wedge,
                            s->wedge_turn,
                            s->wedge_start,
                            s->term_segment,
                            s->term_turn,
                            s->node_vertex,
                            s->closing_start,
                            s->node_cone,
                            s->cone_pole,
                            s->closing_segment,
                            s->closing_turn,
                            s->vertex_given,
                            s->given_start,
                            s->given_symbol,
                            s->given_value,
                            s->fixed_component,
                            s->level_coordinate,
                            s->level_relation_start,
                            s->level_relation_symbol,
                            s->level_relation_value};
    qc__rows_free(&s->symbol_row);
    qc__rows_free(&s->free_row);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(s);
}

static qc_status count_degrees(qc__seam_builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    b->degree = QC__ZERO(b->ctx, int32_t, mesh->n_vertices);
    if (!b->degree) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (qc__is_cut(b, mesh->edge_halfedge[2 * e])) {
            b->degree[mesh->edge_vertex[2 * e]]++;
            b->degree[mesh->edge_vertex[2 * e + 1]]++;
        }
    return QC_OK;
}

qc_status qc__seams_create(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                           const int8_t *face_turn, const int32_t *index4, const int8_t *axis,
                           qc__seams **out) {
    qc__seams *s = QC__ZERO(ctx, qc__seams, 1);
    if (!s) return QC_ERR_NOMEM;
    s->mesh = cover->mesh;
    const qc__features features = {cover, face_turn, axis};
    qc__seam_builder b = {.ctx = ctx, .cover = cover, .cut = cut, .face_turn = face_turn, .s = s};
    qc_status status = qc__seams_points(&b, index4, &features);
    if (status == QC_OK) status = count_degrees(&b);
    if (status == QC_OK) status = qc__seams_poles(&b);
    if (status == QC_OK) status = qc__seams_segments(&b);
    if (status == QC_OK) status = qc__seams_wedges(&b);
    if (status == QC_OK) status = qc__seams_find_given(ctx, s, &features);
    qc__free(b.degree);
    qc__free(b.hole);
    if (status != QC_OK) {
        qc__seams_free(s);
        return status;
    }
    *out = s;
    return QC_OK;
}
