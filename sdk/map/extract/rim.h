/* The vertices on the rim of the quads and the cells around them. */
#ifndef QC_MAP_EXTRACT_RIM_H
#define QC_MAP_EXTRACT_RIM_H

#include "sdk/map/extract/internal.h"

typedef struct qc__rim {
    const qc__cells *cells;
    const qc_grid_map *g;
    const int32_t *vertex; /* of the corners of kept cells */
    qc_polygon_mesh *q;
    int32_t *kept_first, *kept; /* vertices + 1: kept corners at each vertex which is to be moved */
    int32_t *open_first, *open; /* vertices + 1: its corners in open cells, kept or not           */
    uint8_t *placed;            /* vertices: position is known */
    bool by_shape;              /* places are judged by the quads around, not by the vertices */
} qc__rim;
/* The vertices to be moved are those outside the surface and, inside it, those on the rim with one
 * fan of quads. */
qc_status qc__rim_create(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                         int32_t n_lattice, qc_polygon_mesh *q, qc__rim *out);
void qc__rim_free(qc__rim *rim);

#endif
