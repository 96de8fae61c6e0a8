/* Hard features and aligned boundaries: edges whose image runs along an isoline. Internal to
 * sdk/map.
 *
 * The combed direction of the image of an edge is axis + face_turn quarter turns. Where it runs
 * along u, v has one value at both ends, and the other way round. */
#ifndef QC_MAP_FEATURES_H
#define QC_MAP_FEATURES_H

#include "sdk/map/seams/seams.h"

typedef struct qc__features {
    const qc_cover *cover;
    const int8_t *face_turn;
    const int8_t *axis; /* n_edges, -1 or k as in qc_matching; NULL = no features */
} qc__features;

static inline bool qc__is_feature(const qc__features *f, int32_t h) {
    return f->axis && f->axis[f->cover->mesh->halfedge_edge[h]] >= 0;
}
/* Direction of halfedge h of a feature in the combed chart of its face: i^result. */
int32_t qc__feature_direction(const qc__features *f, int32_t h);

/* Flags the vertices (n_vertices) at which features end, cross, branch or turn: all where they do
 * not just go straight on. Errors: NOMEM. */
qc_status qc__feature_corners(qc_ctx *ctx, const qc__features *f, uint8_t *corner);

/* Finds which coordinates of the F_v are given: those of points by their positions, those across a
 * feature by its level. Fills the levels, their relations and the given coordinates of s, whose
 * wedges and points are known. Errors: NOMEM. */
qc_status qc__seams_find_given(qc_ctx *ctx, qc__seams *s, const qc__features *f);

#endif
