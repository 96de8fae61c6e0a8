/* qc/ray.h - rays against a triangle list as a plugin point: "qc.ray_caster/1"; picking with them,
 * and guide strokes from the rays of a camera.
 *
 * `builtin` (a tree of bounding boxes) is always there; a plugin offers more through
 * qc_plugin.extension(QC_RAY_CASTER_ID), a program through qc_registry_offer. Where a function
 * takes a `const qc_ray_caster *`, NULL is `builtin`. All tables give the same answers.
 * Thread rule: tables and scenes are immutable, any number of threads may query. */
#ifndef QC_RAY_H
#define QC_RAY_H

#include <qc/closest_point.h>
#include <qc/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_RAY_CASTER_ID "qc.ray_caster/1"

typedef struct qc_ray_scene qc_ray_scene; /* defined by each backend for itself */

typedef struct qc_ray_caster {
    qc_interface head; /* struct_size = sizeof(qc_ray_caster), flags 0, name, doc */
    void *user;        /* for the owner of the table */

    /* vertex: 3 n_triangles indices into position (3 numbers a point); both are copied as far as
     * needed. n_triangles >= 1. Errors, through qc_ctx_fail: NOMEM, CANCELLED, FAILED. */
    qc_status (*build)(const struct qc_ray_caster *self, qc_ctx *ctx, int32_t n_triangles,
                       const double *position, const int32_t *vertex, qc_ray_scene **out);
    /* Returns the least t >= 0 with origin + t direction on a triangle, either side of it, the
     * number of that triangle (the lowest of several) and the barycentric coordinates there (>= 0);
     * INFINITY and -1 when nothing is hit. direction need not be a unit vector; nothing is hit by
     * the zero vector and by numbers which are not finite. Cannot fail. */
    double (*query)(const qc_ray_scene *scene, const double origin[3], const double direction[3],
                    int32_t *triangle, double weight[3]);
    void (*destroy)(qc_ray_scene *scene); /* NULL is fine */
} qc_ray_caster;

QC_API extern const qc_ray_caster qc_ray_caster_builtin;

/* For backends: the triangle (3 corners of 3 numbers) met by a ray, t >= 0 and barycentric
 * coordinates >= 0; false when it is missed, edge-on or degenerate. Two triangles with a common
 * edge leave no gap there. Same bits everywhere. */
QC_API bool qc_triangle_ray(const double corner[9], const double origin[3],
                            const double direction[3], double *t, double weight[3]);

/* --- picking ---------------------------------------------------------------------------------- */

typedef struct qc_pick {
    int32_t face;         /* -1 = the ray meets nothing; then the rest says nothing, either     */
    int32_t vertex;       /* corner of that face nearest to the point                           */
    int32_t feature_edge; /* feature edge nearest to the point, -1 = there are no features      */
    int32_t reserved;
    double t; /* the point is origin + t direction                                  */
    double point[3], weight[3]; /* on the face; barycentric coordinates there                   */
    double vertex_distance, feature_distance; /* from the point                                 */
} qc_pick;
/* What n rays (6 numbers each: origin, direction) meet. features: those of the mesh, or NULL.
 * casts, closest: NULL = builtin. pick: n entries. Errors: ARGUMENT (features of another mesh),
 * those of the tables. */
QC_API qc_status qc_mesh_pick(qc_ctx *ctx, const qc_mesh *mesh, const qc_features *features,
                              const qc_ray_caster *casts, const qc_closest_point *closest,
                              int32_t n, const double *ray, qc_pick *pick);

/* --- strokes ---------------------------------------------------------------------------------- */

/* Guide strokes from rays: stroke i has rays stroke_offset[i] .. stroke_offset[i+1]-1 (6 numbers
 * each). Between two rays of a stroke their interpolation is cast, bisected until neighbouring
 * points are at most `step` apart (in the units of the mesh; 0 = mean edge length of the surface),
 * so that the stroke runs on the surface as it was seen; it is broken where the rays miss and where
 * they jump to another part of the surface. *out: a polygon mesh without faces whose lines are the
 * strokes; joined to the surface by qc_polygon_mesh_merge they become features (stage qc.features,
 * parameter `lines`). Errors: INPUT (a number which is not finite, a zero direction: where = ray;
 * no ray meets the surface), ARGUMENT (no faces), CANCELLED, those of the table. */
QC_API qc_status qc_ray_strokes(qc_ctx *ctx, const qc_polygon_mesh *surface,
                                const qc_ray_caster *casts, int32_t n_strokes,
                                const int32_t *stroke_offset, const double *ray, double step,
                                qc_polygon_mesh **out);

#ifdef __cplusplus
}
#endif
#endif
