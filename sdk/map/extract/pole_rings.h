/* Rings of vertices around the holes of poles (docs/theory/poles.md). Internal to sdk/map. */
#ifndef QC_MAP_EXTRACT_POLE_RINGS_H
#define QC_MAP_EXTRACT_POLE_RINGS_H

#include "sdk/map/extract/internal.h"

typedef struct qc__pole_rings {
    qc_ctx *ctx;
    const qc__cells *cells;
    const int32_t *vertex; /* 4 cells: of the corners of kept cells */
    const qc_polygon_mesh *q;
    uint8_t *drop;  /* cells: 1 = in a row which is left out */
    int32_t *ring;  /* vertices on the loops, one pole after the other, the quads on the left */
    int32_t *start; /* n_poles + 1 */
} qc__pole_rings;

/* The loop of the complete cells around each hole, without its innermost rows where those are
 * nearer to the pole than half a quad. FAILED where that is no simple loop of an even number of
 * sides. On error free as well. */
qc_status qc__pole_rings_create(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                                const qc_polygon_mesh *q, qc__pole_rings *out);
void qc__pole_rings_free(qc__pole_rings *rings);

static inline const qc_mesh *qc__rings_mesh(const qc__pole_rings *r) {
    return r->cells->pieces.ports->lattice->g->mesh;
}
static inline const double *qc__ring_position(const qc__pole_rings *r, int32_t v) {
    return r->q->position + 3 * (int64_t)v;
}
static inline const double *qc__pole_position(const qc__pole_rings *r, int32_t pole) {
    const qc_mesh *m = qc__rings_mesh(r);
    return m->position + 3 * (int64_t)m->face_vertex[m->pole_corner[m->pole_start[pole]]];
}

#endif
