/* Internal services of sdk/shape: surfaces are made of parametric patches, welded afterwards. */
#ifndef QC_SHAPE_INTERNAL_H
#define QC_SHAPE_INTERNAL_H

#include <math.h>
#include <qc/shape.h>

#include "sdk/base/internal.h"

static const double QC__PI = 3.14159265358979323846;

/* --- triangle soup of patches (soup.c, weld.c) */

typedef struct qc__soup {
    qc_ctx *ctx;
    double *position;
    int32_t *face;
    int64_t n_vertices, n_faces, vertex_capacity, face_capacity;
    qc_status status; /* of the first failure; later calls do nothing */
} qc__soup;

typedef void qc__map(const void *data, double u, double v, double out[3]);

/* The image of [0,1]^2 in nu x nv cells, each cut along its shorter diagonal; counter-clockwise in
 * (u, v), or clockwise when `flip` is set. */
void qc__soup_patch(qc__soup *soup, int32_t nu, int32_t nv, bool flip, qc__map *map,
                    const void *data);
/* The image of the triangle u, v >= 0, u + v <= 1 in n^2 triangles. */
void qc__soup_triangle(qc__soup *soup, int32_t n, qc__map *map, const void *data);
/* Merges coincident vertices and builds the mesh; frees the soup's arrays in any case. */
qc_status qc__soup_mesh(qc__soup *soup, qc_mesh **out);

/* Number of segments so that n_patches (a n) x (b n) quads make about `faces` triangles. */
int32_t qc__segments(int32_t faces, double quads_per_n2, int32_t least);

/* --- deterministic random numbers (random.c): splitmix64 */

typedef struct qc__random {
    uint64_t state;
} qc__random;
double qc__random_unit(qc__random *r);   /* uniform in [0, 1)   */
double qc__random_normal(qc__random *r); /* standard normal */
int32_t qc__random_below(qc__random *r, int32_t n);

/* --- disturbances: each makes a new mesh of the same topology */

qc_status qc__shape_noise(qc_ctx *ctx, const qc_mesh *mesh, double sigma, uint64_t seed,
                          qc_mesh **out);
qc_status qc__shape_flip(qc_ctx *ctx, const qc_mesh *mesh, uint64_t seed, qc_mesh **out);
qc_status qc__shape_jitter(qc_ctx *ctx, const qc_mesh *mesh, uint64_t seed, qc_mesh **out);

/* --- the shapes */

typedef void qc__shape_make(qc__soup *soup, const qc_shape_options *options);
qc__shape_make qc__shape_sphere, qc__shape_ellipsoid, qc__shape_flat_torus, qc__shape_torus,
    qc__shape_cube, qc__shape_cylinder, qc__shape_truncated_cone, qc__shape_knot, qc__shape_trinoid,
    qc__shape_schwarz_p, qc__shape_hyperboloid, qc__shape_costa, qc__shape_graph, qc__shape_lawson,
    qc__shape_genus;
/* Rounds off the plate of "genus" by Laplacian smoothing; replaces *mesh. */
qc_status qc__shape_round_off(qc_ctx *ctx, const qc_shape_options *options, qc_mesh **mesh);

/* --- small vectors */

static inline double qc__dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void qc__cross(const double a[3], const double b[3], double out[3]) {
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    for (int i = 0; i < 3; i++) out[i] = c[i];
}
static inline void qc__scale(double s, double a[3]) {
    for (int i = 0; i < 3; i++) a[i] *= s;
}
static inline void qc__normalize(double a[3]) {
    qc__scale(1 / sqrt(qc__dot(a, a)), a);
}

#endif
