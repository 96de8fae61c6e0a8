/* Fundamental cycles of the cut graph of a mesh, as flows. */
#ifndef QC_DEC_CUT_CYCLES_H
#define QC_DEC_CUT_CYCLES_H

#include "sdk/dec/internal.h"

/* A spanning forest of the cut graph in which the boundary of each component is one node. Every cut
 * edge outside the forest closes one cycle: 2 g on a closed component, 2 g + b - 1 with b boundary
 * loops. */
typedef struct qc__cut_cycles {
    const qc_mesh *mesh;
    int32_t *node; /* n_vertices: node of a vertex                                           */
    int32_t *parent_edge; /* by node, -1 at roots */
    int32_t count;      /* number of cycles                                                       */
    int32_t *generator; /* count: the edge which closes the cycle                                 */
} qc__cut_cycles;
qc_status qc__cut_cycles_create(qc_ctx *ctx, const qc_mesh *mesh, qc__cut_cycles *out);
void qc__cut_cycles_free(qc__cut_cycles *cycles);
/* Adds cycle i times `amount` to flow (n_edges; positive along edge_vertex). Flows are conserved at
 * every vertex off the boundary. */
void qc__cut_cycles_add(const qc__cut_cycles *cycles, int32_t i, int32_t amount, int32_t *flow);

#endif
