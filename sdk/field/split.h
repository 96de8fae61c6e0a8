/* A mesh with some of its edges bisected, and where its faces and halfedges come from. Shared
 * inside sdk/field. */
#ifndef QC_FIELD_SPLIT_H
#define QC_FIELD_SPLIT_H

#include "internal.h"

/* Old vertices keep their numbers; the children of a face are consecutive and in the order of the
 * faces, so that s < t still holds for the same side of an edge. */
typedef struct qc__bisection {
    qc_mesh *mesh;
    int32_t *parent; /* faces of the new mesh: the old face                                  */
    int32_t *parent_halfedge; /* halfedges of the new mesh: the old one they are (half of); -1 =
                                 inside */
    qc_complex *turn; /* faces of the new mesh: x -> x turn takes crosses to the new frame     */
} qc__bisection;
/* split: n_edges flags. source_face and source_vertex of the new mesh are those of the old one, or
 * its numbers when it has none; -1 for midpoints. */
qc_status qc__bisect_edges(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *split,
                           qc__bisection *out);
void qc__bisection_free(qc__bisection *bisection);

/* The flags of the old edges on their halves (any bits), 0 inside the old faces. old: n_edges of
 * the old mesh, out: of the new one. */
void qc__bisection_flags(const qc__bisection *b, const qc_mesh *old_mesh, const uint8_t *old,
                         uint8_t *out);
/* The same lengths on the new mesh. */
qc_status qc__bisection_sizing(qc_ctx *ctx, const qc__bisection *b, const qc_sizing *old,
                               qc_sizing **out);

#endif
