/* Making a real-valued seamless map injective before its integers are chosen. Internal to sdk/map.
 *
 * Vertices, transitions and levels move together to the least regularised distortion energy of
 * ROBUST.md 6 (docs/theory/untangling.md, U.6), the faces of the frame field being the target
 * shapes, until every face is positive and every vertex winds as the field does. */
#ifndef QC_MAP_UNFOLD_H
#define QC_MAP_UNFOLD_H

#include "sdk/map/seams/features.h"
#include "sdk/map/periods/period_matrix.h"

typedef struct qc__unfolding {
    int32_t folded, wrong; /* faces with det <= 0; vertices which wind otherwise than the field
                              and features which run backwards */
    int32_t where;         /* vertex at one of them, -1 = none */
    int32_t folded_before, wrong_before;
    int32_t evaluations; /* of the energy of the whole map */
} qc__unfolding;

/* The map f (3 n_faces) and its free variables y (n_free, as read by qc__seams_read) become those
 * of the best map found, or stay when that is not better. z: the frame field in combed charts (3
 * n_faces); P: the period matrix, NULL = y stays. A map which does not fold is not touched. Errors:
 * NOMEM, CANCELLED, those of the factorisation. */
qc_status qc__unfold(qc_ctx *ctx, const qc__periods *periods, const double *P,
                     const qc__features *features, const qc_complex *z, qc_complex *f, double *y,
                     qc__unfolding *result);

#endif
