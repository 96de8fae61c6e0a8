/* A seamless map with real translations, exact: all values are multiples of one power of two, so
 * that transitions, levels and points hold to the last bit. Internal to sdk/map. */
#ifndef QC_MAP_SNAP_H
#define QC_MAP_SNAP_H

#include "sdk/map/periods/period_matrix.h"

/* Rounds the free variables y (n_free) and F of the map f (3 n_faces) to the finest multiples with
 * |value| < 2^40 units, both in place; f is what they give. *bits: the unit is 2^-bits. Faces which
 * this turns over are repaired by moving vertices by a few units; *folded counts the faces which
 * are not positive by the exact test. Errors: NOMEM, FAILED (values beyond 2^38). */
qc_status qc__snap(qc_ctx *ctx, const qc__seams *seams, qc_complex *f, double *y, int32_t *bits,
                   int32_t *folded);

#endif
