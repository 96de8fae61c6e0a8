/* A seamless map by its independent values: one complex number F_v a vertex, all corners following
 * by the transitions, f_c = i^{turn_c} F_v + offset_c. Internal to sdk/map. */
#ifndef QC_MAP_REDUCED_MAP_H
#define QC_MAP_REDUCED_MAP_H

#include "sdk/base/internal.h"
#include <qc/map.h>

typedef struct qc__reduced_map {
    const qc_mesh *mesh;
    qc_complex *value; /* n_vertices, in the chart of vertex_corner */
    uint8_t *fixed;    /* n_vertices: coordinates of value which stay: bit 0 = u, bit 1 = v; both at
                          cones and feature corners, one on a feature, which the vertex slides along */
    int8_t *turn;      /* 3 n_faces */
    qc_complex *offset; /* 3 n_faces */
} qc__reduced_map;

/* From corner values (6 n_faces) with the transitions and features of grid; translations are
 * measured, and rounded to integers when `integer`. */
qc_status qc__reduced_map_create(qc_ctx *ctx, const qc_grid_map *grid, const double *uv,
                                 bool integer, qc__reduced_map **out);
void qc__reduced_map_free(qc__reduced_map *map);

enum { QC__FIXED = 3 };
static inline bool qc__pinned(const qc__reduced_map *m, int32_t v) {
    return m->fixed[v] == QC__FIXED;
}
/* z with the fixed coordinates of vertex v as they are. */
static inline qc_complex qc__keep_fixed(const qc__reduced_map *m, int32_t v, qc_complex z) {
    const qc_complex old = m->value[v];
    return (qc_complex){m->fixed[v] & 1 ? old.re : z.re, m->fixed[v] & 2 ? old.im : z.im};
}

static inline qc_complex qc__reduced_map_corner(const qc__reduced_map *m, qc_complex value,
                                                int64_t c) {
    const qc_complex z = qc_quarter_turn(value, m->turn[c]);
    const qc_complex f = {z.re + m->offset[c].re, z.im + m->offset[c].im};
    return f;
}

#endif
