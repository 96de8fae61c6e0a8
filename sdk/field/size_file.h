/* Edge lengths from a text file. Not installed. */
#ifndef QC_FIELD_SIZE_FILE_H
#define QC_FIELD_SIZE_FILE_H

#include "internal.h"

/* The text at o->path: for each vertex or each face of the input one number, a length, or five: a
 * length along a direction, the length across it, and the direction in space. length and stretch
 * (n_faces, see qc_sizing_set_stretch) change where the file gives something; *directed becomes
 * true when it gives directions. Errors as qc_sizing_create_varying. */
qc_status qc__size_file(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o, double *length,
                        qc_complex *stretch, bool *directed);
/* Mean of the values of the corners of face t; value counts vertices of the input. -1 where no
 * corner has one. */
double qc__corner_mean(const qc_mesh *mesh, int32_t t, const double *value, int64_t n);

#endif
