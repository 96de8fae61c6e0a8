/* A seamless map by its independent values: one complex number F_v a vertex, all corners following
 * by the transitions, f_c = i^{turn_c} F_v + offset_c. Internal to sdk/map. */
#ifndef QC_MAP_REDUCED_MAP_H
#define QC_MAP_REDUCED_MAP_H

#include "sdk/base/internal.h"
#include <qc/map.h>

typedef struct qc__reduced_map {
    const qc_mesh *mesh;
    qc_complex *value; /* n_vertices, in the chart of vertex_corner */
    uint8_t *pinned; /* n_vertices: cones, fixed on their lattice point                          */
    int8_t *turn;    /* 3 n_faces */
    qc_complex *offset; /* 3 n_faces */
} qc__reduced_map;

/* From corner values (6 n_faces) with known rotations; translations are measured, and rounded to
 * integers when `integer`. pinned: where holonomy (n_vertices) is not 0. */
qc_status qc__reduced_map_create(qc_ctx *ctx, const qc_mesh *mesh, const double *uv,
                                 const int8_t *rotation, const int8_t *holonomy, bool integer,
                                 qc__reduced_map **out);
void qc__reduced_map_free(qc__reduced_map *map);

static inline qc_complex qc__reduced_map_corner(const qc__reduced_map *m, qc_complex value,
                                                int64_t c) {
    const qc_complex z = qc_quarter_turn(value, m->turn[c]);
    const qc_complex f = {z.re + m->offset[c].re, z.im + m->offset[c].im};
    return f;
}

#endif
