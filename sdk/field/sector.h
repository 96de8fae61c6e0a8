/* Sectors between consecutive hard features at a vertex. Shared inside sdk/field. */
#ifndef QC_FIELD_SECTOR_H
#define QC_FIELD_SECTOR_H

#include "internal.h"

/* Counter-clockwise from one feature edge at the vertex to the next, which may be the same. */
typedef struct qc__sector {
    int32_t vertex, first; /* first: corner of its first face                                   */
    int32_t n;             /* faces                                                             */
    int32_t turns;         /* k: the angle of its image in quarter turns                        */
    int32_t wanted;        /* k it ought to have; 0: no opinion */
    double angle;          /* sum of the corners                                                */
} qc__sector;

/* Sorted by vertex, counter-clockwise. Where the boundary is no feature, what lies between it and
 * the next feature is no sector. */
typedef struct qc__sectors {
    int32_t n;
    qc__sector *sector;
} qc__sectors;

/* aligned: n_edges flags; edge: of qc_tangent_edges; theta: n_edges. FAILED with where = vertex
 * when the crosses do not run along the features. */
qc_status qc__sectors_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *aligned,
                             const qc_complex *edge, const double *theta, qc__sectors *out);
void qc__sectors_free(qc__sectors *sectors);

/* Sets `wanted` to 2 - q, q > 0 where a feature turns towards the sector by q quarters within the
 * length `bend`, each turn in one place of it (corners.c). edge: of qc_tangent_edges. */
qc_status qc__sectors_find_corners(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                                   double bend, qc__sectors *all);

/* Gives every sector the quarter turns it wants with bend > 0; with 0 at least one, and within one
 * of its angle: where the straightest matching does not, the nearest number, by turns at edges
 * inside the sector. The difference goes to the index of the other ends of these edges, which are
 * on no feature. theta and m (may be NULL) in place; *changed (may be NULL) counts such sectors. */
qc_status qc__sectors_open(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *aligned, double bend,
                           const qc_complex *edge, double *theta, int8_t *m, int32_t *changed);

#endif
