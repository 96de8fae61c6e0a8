/* qc/finish.h - after extraction: quads relaxed on the surface they were made from.
 *
 * Thread rule: that of qc/base.h; results do not depend on the number of threads. */
#ifndef QC_FINISH_H
#define QC_FINISH_H

#include <qc/closest_point.h>
#include <qc/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct qc_relax_options {
    uint32_t struct_size;
    int32_t rounds;    /* sweeps over all vertices                                              */
    double quality;    /* scaled Jacobian a quad may fall to, but no lower (nor below its own)  */
    double uniformity; /* 0: squares as large as their quad; 1: as large as the quads around it */
    const uint8_t *feature; /* edges of the mesh (n_edges flags, borrowed) which quad edges on them
                               are to stay on; NULL = none. The boundary always counts */
    const qc_closest_point *closest; /* borrowed; NULL = builtin */
    bool rectangles; /* towards rectangles of the proportions of the quads around; false: squares */
} qc_relax_options;
#define QC_RELAX_OPTIONS_INIT                                                                      \
    { sizeof(qc_relax_options), 10, 0.6, 1.0, NULL, NULL, false }

/* Moves the vertices of quads towards squares (rectangles) and keeps them on the surface: inner
 * vertices are projected to the closest point, those on the boundary and on features slide along
 * their curve, its ends and corners stay. No quad becomes worse than min(its start, quality), so
 * none is turned over; then the neighbours of the worst quads are moved where that makes the worst
 * better. Quads and their order stay; positions, source faces and barycentric coordinates (of
 * `mesh`) are new. Without sources the closest points of the vertices are taken. Errors: ARGUMENT
 * (a face which is no quad, a source which is no face of the mesh), NOMEM, CANCELLED, those of
 * `closest`. */
QC_API qc_status qc_quads_relax(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads,
                                const qc_relax_options *options, qc_polygon_mesh **out);

/* A copy of quads with what `input` has. Attributes of vertices are interpolated at the closest
 * place of the mesh: directions are unit vectors again, weights which sum to 1 still do, labels are
 * those of the nearest vertex; of "joint" with "weight" (or "joints", "weights"; as wide as each
 * other, 16 at most) the heaviest joints are kept. Attributes of corners are those on the side of
 * the quad, and so are directions of vertices which the repair has merged. Of faces and groups a
 * quad gets the mean, of labels and groups the one most of it lies in. uvs are at the corners of
 * quads which lie in one chart (the others get none). mesh is the surface repaired from the input,
 * its source numbers being those of `input`. What the quads have already is kept. Errors: ARGUMENT
 * (a face is no quad), NOMEM. */
QC_API qc_status qc_quads_transfer(qc_ctx *ctx, const qc_polygon_mesh *input, const qc_mesh *mesh,
                                   const qc_polygon_mesh *quads, qc_polygon_mesh **out);

#ifdef __cplusplus
}
#endif
#endif
