/* What the steps that find the seams share (see seams.h). Internal to sdk/map. */
#ifndef QC_MAP_SEAM_BUILDER_H
#define QC_MAP_SEAM_BUILDER_H

#include "sdk/map/seams/features.h"

typedef struct qc__seam_builder {
    qc_ctx *ctx;
    const qc_cover *cover;
    const uint8_t *cut;
    const int8_t *face_turn;
    int32_t *degree; /* cut edges at each vertex */
    int32_t *hole;   /* n_vertices: the pole whose hole a boundary vertex is on, -1 */
    qc__seams *s;
} qc__seam_builder;

static inline bool qc__is_cut(const qc__seam_builder *b, int32_t h) {
    return b->cut[b->cover->mesh->halfedge_edge[h]] && b->cover->mesh->twin[h] >= 0;
}

static inline bool qc__is_node(const qc__seam_builder *b, int32_t v) {
    return b->degree[v] > 0 && (b->degree[v] != 2 || b->s->vertex_cone[v] >= 0 ||
                                qc_vertex_on_boundary(b->cover->mesh, v));
}

/* The first tip of a pole (mesh->pole_corner). */
static inline int32_t qc__pole_tip(const qc_mesh *mesh, int32_t pole) {
    return mesh->face_vertex[mesh->pole_corner[mesh->pole_start[pole]]];
}

/* The points: cones and corners of features. index4: n_vertices. */
qc_status qc__seams_points(qc__seam_builder *b, const int32_t *index4,
                           const qc__features *features);
/* The poles at which segments end, and the vertices of their holes; needs the degrees. */
qc_status qc__seams_poles(qc__seam_builder *b);
/* The segments between nodes. */
qc_status qc__seams_segments(qc__seam_builder *b);
/* The wedges, and the closing walks about the nodes. */
qc_status qc__seams_wedges(qc__seam_builder *b);

#endif
