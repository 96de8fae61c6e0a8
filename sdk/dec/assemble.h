/* Assembly of both stiffness matrices from the same element matrix. */
#ifndef QC_DEC_ASSEMBLE_H
#define QC_DEC_ASSEMBLE_H

#include "sdk/dec/internal.h"

/* A = sum over the faces of W^H (scale K) W, where K is the cotangent matrix of the face,
 *     K_ij = -c_k (i, j, k different),   K_ii = c_j + c_k,
 * and W maps unknowns to the three local values, local value of c = i^{turn[c]} * value of
 * entity[c] (arrays of 3 n_faces). stiffness->unknown is given and numbers the unknowns 0..n-1; A
 * is filled. turn may be NULL. */
qc_status qc__assemble(qc_ctx *ctx, int32_t n_faces, const double *cotangent, double scale,
                       const int32_t *entity, const int8_t *turn, int32_t n, qc_stiffness *out);

#endif
