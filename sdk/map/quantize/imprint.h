/* The refined mesh of quantization. Internal to sdk/map/quantize. */
#ifndef QC_MAP_QUANTIZE_IMPRINT_H
#define QC_MAP_QUANTIZE_IMPRINT_H

#include "sdk/field/refine.h"
#include "sdk/map/quantize/values.h"

/* Errors: NOMEM, CANCELLED, FAILED (where = face). */
qc_status qc__imprint_create(qc_ctx *ctx, const qc__exact_map *map, const qc__coarse_map *coarse,
                             const qc__point *x, qc__imprint *out);

#endif
