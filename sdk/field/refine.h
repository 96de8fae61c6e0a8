/* A mesh whose faces lie in those of another one, and what a field on it needs to know about them.
 * Shared inside sdk/field. */
#ifndef QC_FIELD_REFINE_H
#define QC_FIELD_REFINE_H

#include "internal.h"

/* Old vertices keep their numbers; the children of a face are consecutive and in the order of the
 * faces, so that s < t still holds for the same side of an edge. */
typedef struct qc__refinement {
    qc_mesh *mesh;
    int32_t *parent; /* faces of the new mesh: the old face                                  */
    int32_t *parent_halfedge; /* halfedges of the new mesh: the old one they are (part of); -1 =
                                 inside */
    qc_complex *turn; /* faces of the new mesh: x -> x turn takes crosses to the new frame     */
} qc__refinement;
void qc__refinement_free(qc__refinement *refinement);

/* split: n_edges flags. source_face and source_vertex of the new mesh are those of the old one, or
 * its numbers when it has none; -1 for midpoints. */
qc_status qc__bisect_edges(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *split,
                           qc__refinement *out);

/* A mesh under construction whose faces are added one after the other, children of one face in a
 * row. position: 3 n_vertices and source_vertex: n_vertices are the caller's, old vertices filled
 * in. */
typedef struct qc__refiner {
    const qc_mesh *old;
    int32_t n_vertices, n_faces, capacity; /* faces so far; room */
    double *position;
    int32_t *source_vertex, *face_vertex, *source_face;
    qc__refinement out;
} qc__refiner;
qc_status qc__refiner_create(qc_ctx *ctx, const qc_mesh *old, int32_t n_vertices, int32_t n_faces,
                             qc__refiner *out);
void qc__refiner_free(qc__refiner *refiner);
/* A child of face t with the given vertices; halfedge: old ones as in parent_halfedge; direction:
 * from its corner 1 to its corner 2 in the frame of t (0: the child is t itself). Returns its
 * number. */
int32_t qc__refiner_add(qc__refiner *refiner, int32_t t, const int32_t vertex[3],
                        const int32_t halfedge[3], qc__cplx direction);
/* Makes the mesh; the refinement is the caller's then. */
qc_status qc__refiner_finish(qc_ctx *ctx, qc__refiner *refiner, qc__refinement *out);

/* The flags of the old edges on their parts (any bits), 0 inside the old faces. old: n_edges of
 * the old mesh, out: of the new one. */
void qc__refinement_flags(const qc__refinement *b, const qc_mesh *old_mesh, const uint8_t *old,
                          uint8_t *out);
/* The same lengths on the new mesh. */
qc_status qc__refinement_sizing(qc_ctx *ctx, const qc__refinement *b, const qc_sizing *old,
                                qc_sizing **out);
/* The sizing and the matching on the refined mesh. */
qc_status qc__refinement_carry(qc_ctx *ctx, const qc__refinement *refinement,
                               const qc_matching *matching, const qc_sizing *sizing,
                               qc_matching **matching_out, qc_sizing **sizing_out);

#endif
