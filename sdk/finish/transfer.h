/* Parts of qc_quads_transfer. Not installed. */
#ifndef QC_FINISH_TRANSFER_H
#define QC_FINISH_TRANSFER_H

#include "sdk/finish/internal.h"

typedef struct qc__transfer_spot {
    int32_t face; /* of the mesh */
    double weight[3];
} qc__transfer_spot;

/* An attribute of the input and its array on the quads. */
typedef struct qc__transferred {
    const qc_attribute *from;
    int32_t at; /* of the quads: normals of vertices which repair has merged become those of corners
                 */
    double *to;
    double *weight;                  /* of joints: the array of their weights on the quads ... */
    const qc_attribute *weight_from; /* ... and on the input  */
} qc__transferred;

typedef struct qc__transfer {
    const qc_polygon_mesh *input;
    const qc_mesh *mesh;
    qc_polygon_mesh *quads; /* the copy which is filled */
    const qc_closest_point *closest;
    qc_closest_tree *tree;
    int32_t *chart; /* n_uvs of the input: parent in its chart (union-find); NULL = no uvs */
    int32_t *group; /* n_faces, NULL = no groups */
    uint8_t *mixed; /* n_faces: 1 where the samples of a quad are of more than one group */
    qc__transferred *attribute;
    int32_t n_attributes;
} qc__transfer;

/* The place of the mesh closest to x; `from`: a face near it. */
qc__transfer_spot qc__transfer_closest(const qc__transfer *t, const double x[3], int32_t from);
/* Corner of the input which became corner k of a face: repair welds vertices, so it is known by
 * its place. -1 = none. */
int32_t qc__transfer_corner(const qc__transfer *t, int32_t face, int k);
static inline const double *qc__quad_corner(const qc__transfer *t, int64_t f, int k) {
    return t->quads->position + 3 * (int64_t)t->quads->face_vertex[4 * f + k];
}
/* The point a share `way` of the way from corner k of quad f to its centre. */
static inline void qc__quad_inside(const qc__transfer *t, int64_t f, int k, double way,
                                   const double centre[3], double out[3]) {
    const double *x = qc__quad_corner(t, f, k);
    for (int i = 0; i < 3; i++) out[i] = x[i] + way * (centre[i] - x[i]);
}
/* Of the way from a corner to the centre of its quad: far enough to tell the side of a seam. */
#define QC__INWARDS 1e-3

/* transfer_uv.c: fills t->chart. */
qc_status qc__transfer_charts(qc_ctx *ctx, qc__transfer *t);
/* The uvs of quad f at the corners' own numbers, or -1 there. */
void qc__transfer_uvs(const qc__transfer *t, int64_t f, const double centre[3],
                      const qc__transfer_spot *middle);

/* transfer_attributes.c: finds what is transferred and adds the arrays to the quads. */
qc_status qc__transfer_attributes(qc_ctx *ctx, qc__transfer *t);
/* The value at a spot of the mesh of an attribute of vertices or corners. */
void qc__transfer_sample(const qc__transfer *t, const qc__transferred *a,
                         const qc__transfer_spot *spot, int64_t element);

#endif
