/* The frame field which a map is to follow, as a form. Internal to sdk/map. */
#ifndef QC_MAP_FRAME_FORM_H
#define QC_MAP_FRAME_FORM_H

#include <qc/map.h>

/* z = <X, e> / h_u + i <Y, e> / h_v in each face, in its gauge: 3 n_faces; conj(x) e / length where
 * the lengths do not depend on the direction. Errors: NOMEM. */
qc_status qc__frame_form(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                         qc_complex *z);

#endif
