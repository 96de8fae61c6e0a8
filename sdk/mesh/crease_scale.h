/* Creases at the length scale of a quad. Internal to sdk/mesh. */
#ifndef QC_MESH_CREASE_SCALE_H
#define QC_MESH_CREASE_SCALE_H

#include "sdk/mesh/internal.h"

typedef struct qc__crease_scale qc__crease_scale;

/* half: half a quad, the reach on either side of an edge; at least a few edges. */
qc_status qc__crease_scale_create(qc_ctx *ctx, const qc_mesh *mesh, double half,
                                  qc__crease_scale **out);
void qc__crease_scale_free(qc__crease_scale *s);
/* The angle by which the surface bends at edge e (not on the boundary) beyond the bending beside
 * it. chain: n_edges, number of the chain of creases, -1 = none. */
double qc__crease_scale_at(qc__crease_scale *s, const int32_t *chain, int32_t e);

#endif
