/* Catmull-Clark surfaces by OpenSubdiv behind a C interface: what the C++ files export to the C
 * files. No exception leaves these functions; they answer QC_ERR_NOMEM or QC_ERR_FAILED. */
#ifndef QO_SURFACE_H
#define QO_SURFACE_H

#include <qc/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The topology of a cage refined `levels` times. Sample i of it is a vertex of the last level; the
 * first n_vertices of the cage are those of its vertices. */
typedef struct qo_surface qo_surface;

/* Sharp creases: the lines of the cage which are edges of it, and its boundary; boundary vertices
 * with one face are sharp, too. The cage must be manifold. */
qc_status qo_surface_create(qc_ctx *ctx, const qc_polygon_mesh *cage, int32_t levels,
                            qo_surface **out);
void qo_surface_destroy(qo_surface *surface); /* NULL is fine */
/* Lines of the cage which are edges of it. */
int32_t qo_surface_creases(const qo_surface *surface);
int32_t qo_surface_samples(const qo_surface *surface);
int32_t qo_surface_faces(const qo_surface *surface); /* of the last level, all quads */
/* Vertices of the faces of the last level, 4 each. */
void qo_surface_quads(const qo_surface *surface, int32_t *vertex);
/* Vertices of the cage: number of edges, and whether on the boundary. */
void qo_surface_valences(const qo_surface *surface, int32_t *valence, uint8_t *boundary);
/* Edges of the cage as pairs of vertices; vertex may be NULL. Returns their number. */
int32_t qo_surface_edges(const qo_surface *surface, int32_t *vertex);
/* Vertices of the last level from control points (3 a cage vertex): 3 a sample. */
qc_status qo_surface_refine(qc_ctx *ctx, const qo_surface *surface, const double *control,
                            double *position);
/* The cage itself at the samples of one refinement: vertices, edge midpoints, face centres. */
qc_status qo_surface_midpoints(qc_ctx *ctx, const qo_surface *surface, const double *control,
                               double *position);
/* The limit surface at the samples: position and unit normal (3 each), and the smallest scaled
 * Jacobian of the corners there: the sine of the angle between the derivatives along neighbouring
 * edges. normal 0 where the surface has no tangent plane, or several: on creases, where
 * the Jacobian is that of one side. normal and jacobian may be NULL. */
qc_status qo_surface_limit(qc_ctx *ctx, const qo_surface *surface, const double *control,
                           double *position, double *normal, double *jacobian);

/* Limit positions as a matrix: sample i is the sum of weight[k] times control point column[k], for
 * k from offset[i] to offset[i + 1]. Columns of a row ascend. */
typedef struct qo_rows {
    int32_t n;
    int64_t *offset;
    int32_t *column;
    double *weight;
} qo_rows;
qc_status qo_surface_rows(qc_ctx *ctx, const qo_surface *surface, qo_rows *out);
void qo_rows_free(qo_rows *rows);

#ifdef __cplusplus
}
#endif
#endif
