/* The coarse complex of a seamless map: what is left of the mesh when every vertex which need not
 * be a lattice point is removed in the parameter domain (docs/theory/quantization.md; after
 * Coudert-Osmont et al. 2024). Internal to sdk/map/quantize.
 *
 * An intrinsic triangulation: triangles may be glued to themselves and share more than one edge.
 * Every halfedge has a vector in the chart of its own triangle, exact in units of 2^-bits. */
#ifndef QC_MAP_QUANTIZE_COARSE_H
#define QC_MAP_QUANTIZE_COARSE_H

#include "sdk/map/grid/internal.h"

typedef struct qc__coarse {
    int32_t n_triangles;
    int32_t bits;
    /* 3 n_triangles each; halfedge 3t+k is followed by 3t+(k+1)%3 */
    qc__point *vector; /* counter-clockwise; those of a triangle add up to zero                   */
    int32_t *twin;     /* -1 = boundary                                                           */
    int8_t *rotation;  /* r with vector[twin] = -i^r vector: the other chart is turned by i^r     */
    int8_t *axis;      /* -1, or on features k in 0..3: the vector runs along i^k and has to      */
    int32_t *origin;   /* vertex of the mesh at its start                                         */
} qc__coarse;

/* One more than the largest origin. */
int32_t qc__coarse_origins(const qc__coarse *coarse);

/* Flips of a complex, one after the other: qc__coarse_flip. */
typedef struct qc__flips {
    int32_t *halfedge;
    int64_t n, capacity;
} qc__flips;

/* Makes the flips. The triangle, place and turn of n markers (as in qc__coarse_map) follow. */
qc_status qc__coarse_flip(qc_ctx *ctx, qc__coarse *coarse, const qc__flips *flips, int32_t n,
                          int32_t *triangle, qc__point *place, int8_t *turn);

/* Integer vectors x (3 n_triangles, parameter units) of the complex after the flips, which the
 * caller frees and makes with qc__coarse_flip, near scale 2^-bits vector: opposite halfedges
 * are negatives up to the rotation, those of a triangle add up to zero and span a positive area,
 * those of features run along their axis. quads > 0: then the scale is changed until they span
 * about so many units, which is the number of quads; where so few leave no such vectors it is the
 * least number found. *made is the number they span. Errors: NOMEM, CANCELLED, FAILED (the given
 * vectors do not span positive areas; no scale up to 2^20 times as fine works). */
qc_status qc__coarse_integers(qc_ctx *ctx, const qc__coarse *coarse, double scale, double quads,
                              qc__point *x, double *made, qc__flips *flips);

#endif
