/* The aligned seamless map: features on isolines, periods still real. Internal to sdk/map.
 *
 * Of all maps g whose features are isolines the one of least 1/2 int w |grad g - Z|^2, Z the frame
 * field (docs/theory/rounding.md): its periods are what is rounded. */
#ifndef QC_MAP_ALIGN_H
#define QC_MAP_ALIGN_H

#include "sdk/map/periods/period_matrix.h"

/* The seamless map f (3 n_faces) and its periods y (n_free, as read by qc__seams_read) become those
 * of g. z: the frame field in combed charts (3 n_faces); P: the period matrix, NULL = the periods
 * stay as they are. Errors: those of the solver, NOMEM. */
qc_status qc__align(qc_ctx *ctx, const qc__periods *periods, const double *P, const qc_complex *z,
                    qc_complex *f, double *y);

#endif
