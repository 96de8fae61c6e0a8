/* The frame field which a map is to follow, as a form. Internal to sdk/map. */
#ifndef QC_MAP_FRAME_FORM_H
#define QC_MAP_FRAME_FORM_H

#include <qc/map.h>

/* z = conj(x) e / length in each face, in its gauge: 3 n_faces. Errors: NOMEM. */
qc_status qc__frame_form(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                         qc_complex *z);

#endif
