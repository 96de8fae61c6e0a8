/* Collapses, flips and removals of faces in a paired triangle list (qc__repair with twin). */
#ifndef QC_MESH_REPAIR_EDIT_H
#define QC_MESH_REPAIR_EDIT_H

#include "sdk/mesh/repair/internal.h"

typedef struct qc__edit {
    qc__repair *r;
    int32_t *corner;      /* per vertex: a corner of a live face, -1 = none */
    int32_t *mark, stamp; /* per vertex: scratch */
} qc__edit;

qc_status qc__edit_begin(qc__repair *r, qc__edit *e);
void qc__edit_end(qc__edit *e);

/* Quality of a triangle: area over squared longest edge; at most sqrt(3)/4. normal may be NULL. */
double qc__edit_quality(const qc__edit *e, int32_t a, int32_t b, int32_t c, double normal[3]);

/* Each changes the mesh and returns true, or leaves it as it is: when the result would not be a
 * manifold, when faces would turn over, or when a face would become worse than `least`. */
bool qc__edit_collapse(qc__edit *e, int32_t halfedge, double least);
bool qc__edit_flip(qc__edit *e, int32_t halfedge, double least);
bool qc__edit_remove_boundary(qc__edit *e, int32_t face);

#endif
