/* qc/closest_point.h - closest points on a triangle list as a plugin point: "qc.closest_point/1".
 *
 * A backend is a constant table. `builtin` (a tree of bounding boxes) is always there; a plugin
 * offers more through qc_plugin.extension(QC_CLOSEST_POINT_ID), a program through
 * qc_registry_offer, and where a function takes a `const qc_closest_point *` any table will do,
 * NULL being `builtin`. Stages choose by name (qc_run.find).
 * Thread rule: tables and built trees are immutable, any number of threads may query. */
#ifndef QC_CLOSEST_POINT_H
#define QC_CLOSEST_POINT_H

#include <qc/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_CLOSEST_POINT_ID "qc.closest_point/1"

typedef struct qc_closest_tree qc_closest_tree; /* defined by each backend for itself */

typedef struct qc_closest_point {
    qc_interface head; /* struct_size = sizeof(qc_closest_point), flags 0, name, doc */
    void *user;        /* for the owner of the table */

    /* vertex: 3 n_triangles indices into position (3 numbers a point); both are copied as far as
     * needed. n_triangles >= 1. Errors, through qc_ctx_fail: NOMEM, CANCELLED, FAILED. */
    qc_status (*build)(const struct qc_closest_point *self, qc_ctx *ctx, int32_t n_triangles,
                       const double *position, const int32_t *vertex, qc_closest_tree **out);
    /* Returns the distance of a point to the closest triangle, its number and the barycentric
     * coordinates there (>= 0). *triangle enters as the number of a triangle which is likely to be
     * near; which of several equally close ones is returned may depend on it, and on nothing else.
     * Cannot fail. */
    double (*query)(const qc_closest_tree *tree, const double point[3], int32_t *triangle,
                    double weight[3]);
    void (*destroy)(qc_closest_tree *tree); /* NULL is fine */
} qc_closest_point;

QC_API extern const qc_closest_point qc_closest_point_builtin;

/* For backends: squared distance of a point to a triangle (3 corners of 3 numbers, which may
 * coincide), weight = barycentric coordinates of the closest point, >= 0. Same bits everywhere. */
QC_API double qc_triangle_distance2(const double corner[9], const double point[3],
                                    double weight[3]);

#ifdef __cplusplus
}
#endif
#endif
