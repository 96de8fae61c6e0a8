/* A binary tree of bounding boxes over a list of triangles. Immutable when built. */
#ifndef QC_MESH_BOX_TREE_H
#define QC_MESH_BOX_TREE_H

#include "sdk/base/internal.h"

enum { QC__BOX_DEPTH = 64 }; /* bounds the stack of a walk which goes to the nearer child first */

typedef struct qc__box {
    double lo[3], hi[3];
    int32_t first, count; /* leaf: places first .. first + count - 1; inner: count = 0, children
                             first and first + 1 */
} qc__box;

typedef struct qc__box_tree {
    int32_t n_boxes;
    qc__box *box;   /* 0 = root                            */
    double *corner; /* 9 numbers for the triangle at a place */
    int32_t *order; /* number of the triangle at a place   */
    int32_t *place; /* inverse of order                    */
} qc__box_tree;

/* vertex: 3 n indices into position; n >= 1. Errors: NOMEM. */
qc_status qc__box_tree_build(qc_ctx *ctx, int32_t n, const double *position, const int32_t *vertex,
                             qc__box_tree *out);
void qc__box_tree_free(qc__box_tree *tree);

#endif
