/* Distance from points to a triangle list, by a tree of bounding boxes. Internal. */
#ifndef QC_MAP_CLOSEST_POINT_H
#define QC_MAP_CLOSEST_POINT_H

#include "sdk/base/internal.h"

typedef struct qc__triangle_tree qc__triangle_tree;

/* Copies what it needs. vertex: 3 n_triangles indices into position; n_triangles >= 1. */
qc_status qc__triangle_tree_create(qc_ctx *ctx, int32_t n_triangles, const double *position,
                                   const int32_t *vertex, qc__triangle_tree **out);
void qc__triangle_tree_free(qc__triangle_tree *tree); /* NULL is fine */

/* distance[i] from point i (3 n_points coordinates) to the nearest triangle, on all threads.
 * CANCELLED when the callback says so. */
qc_status qc__triangle_tree_distances(qc_ctx *ctx, const qc__triangle_tree *tree, int64_t n_points,
                                      const double *point, double *distance);

#endif
