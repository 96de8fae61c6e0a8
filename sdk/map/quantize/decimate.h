/* From an exact map to its coarse complex (docs/theory/quantization.md). Internal to
 * sdk/map/quantize. */
#ifndef QC_MAP_QUANTIZE_DECIMATE_H
#define QC_MAP_QUANTIZE_DECIMATE_H

#include "sdk/map/quantize/triangulation.h"

/* Removes vertex v, which is no point, by flips and one merge; false when it is held by loops or by
 * a triangle glued to itself. What flips were made then stay. */
bool qc__remove_vertex(qc__triangulation *T, int32_t v);
/* Flips towards the intrinsic Delaunay triangulation; features stay. */
qc_status qc__flip_to_delaunay(qc__triangulation *T);
/* Flags the vertices which have to stay (n_vertices): points, ends and corners of features, and
 * boundaries which are no features. Errors: FAILED (where = vertex: another one has other than a
 * full turn about it, or than half a turn on a side of a feature). */
qc_status qc__find_fixed(const qc__triangulation *T, const uint8_t *point, uint8_t *fixed);

/* The coarse complex, and a point inside every face of the mesh: its triangle, its place from the
 * origin of halfedge 3t in the chart of t, and the quarter turns from the chart of the face. */
typedef struct qc__coarse_map {
    const qc_mesh *mesh; /* borrowed */
    qc__coarse coarse;
    int32_t *triangle; /* n_faces each */
    qc__point *place;
    int8_t *turn;
} qc__coarse_map;

/* One vertex stays where a feature loop or a component has no point. Errors: NOMEM, CANCELLED,
 * FAILED as in qc__quantize. */
qc_status qc__coarse_map_create(qc_ctx *ctx, const qc__exact_map *map, qc__coarse_map **out);
void qc__coarse_map_free(qc__coarse_map *map);

#endif
