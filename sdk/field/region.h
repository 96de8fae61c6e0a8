/* A part of the faces, on which z = x^4 is solved for again without alignment while the rest is
 * kept. */
#ifndef QC_FIELD_REGION_H
#define QC_FIELD_REGION_H

#include "internal.h"

typedef struct qc__region {
    const qc_mesh *mesh;
    const qc__connection *c;
    int32_t *local; /* n_faces: number in the region, -1 outside                                 */
    int32_t *face;  /* n faces, ascending                                                       */
    int32_t *patch; /* n_faces (first n used): patch of each; patches have no common vertex       */
    int32_t *stack; /* n_faces, scratch                                                         */
    int32_t n, n_patches;
} qc__region;
/* The empty region. On error free as well. */
qc_status qc__region_create(qc_ctx *ctx, const qc_mesh *mesh, const qc__connection *c,
                            qc__region *out);
void qc__region_free(qc__region *region);

/* The faces whose flag in `inside` (n_faces) is set, and their patches. */
void qc__region_set(qc__region *region, const uint8_t *inside);

/* New z (region->n) for the faces of the region between the z = x^4 of the other faces: implicit
 * steps of the flow on |z| = 1 (smoothest.c). transported false: one long step, that is the
 * harmonic section; true: short steps of time length^2 / 2 from the parallel transport of one cross
 * over each patch, which leaves symmetric traps. */
qc_status qc__region_solve(qc_ctx *ctx, const qc__region *region, const qc_complex *x,
                           bool transported, double length, qc__cplx *z);

/* Rotations alpha (region->n, real) of the crosses of the region which minimise sum omega (theta_e
 * - alpha_s + alpha_t)^2, (5.3), with alpha = 0 outside. theta (n_edges) may exceed pi/4: this
 * prescribes indices. */
qc_status qc__region_rotate(qc_ctx *ctx, const qc__region *region, const double *theta,
                            qc__cplx *alpha);

#endif
