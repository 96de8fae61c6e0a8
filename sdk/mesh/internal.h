/* Internal services of sdk/mesh: ordering edges, union-find, the heap of Dijkstra's algorithm. */
#ifndef QC_MESH_INTERNAL_H
#define QC_MESH_INTERNAL_H

#include <qc/mesh.h>
#include <math.h>

#include "sdk/base/internal.h"

/* --- sorting (sort.c); linear time, stable, so results never depend on anything but the input */

/* order[0..n): the permutation which sorts the pairs (a[i], b[i]), all of them in [0, n_keys). */
qc_status qc__sort_pairs(qc_ctx *ctx, int32_t n_keys, int32_t n, const int32_t *a, const int32_t *b,
                         int32_t *order);
/* Sorts index[] by increasing key[]; both arrays are permuted. */
qc_status qc__sort_keys(qc_ctx *ctx, int32_t n, uint64_t *key, int32_t *index);
/* A key which orders non-negative doubles (infinity included) like the numbers themselves. */
uint64_t qc__sort_key(double x);

/* --- edges */

/* The end of edge e which is not v. */
static inline int32_t qc__other_end(const qc_mesh *mesh, int32_t e, int32_t v) {
    const int32_t *end = mesh->edge_vertex + 2 * (int64_t)e;
    return end[end[0] == v];
}

/* --- union-find (union_find.c): parent[i] = i initially; the lowest member is the root */

void qc__sets_init(int32_t *parent, int32_t n);
int32_t qc__sets_find(int32_t *parent, int32_t i);
/* False when a and b already are in one set. */
bool qc__sets_unite(int32_t *parent, int32_t a, int32_t b);

/* --- indexed binary heap (heap.c): least key first, ties by lowest index */

typedef struct qc__heap {
    int32_t n;
    int32_t *item;  /* heap order -> element                                                      */
    int32_t *place; /* element -> heap order, -1 = not in the heap */
    const double *key; /* of every element, kept by the caller */
} qc__heap;
/* Room for the elements 0..n-1; key is borrowed. */
qc_status qc__heap_create(qc_ctx *ctx, int32_t n, const double *key, qc__heap *out);
void qc__heap_free(qc__heap *heap);
/* Inserts element i, or moves it up after key[i] became smaller. */
void qc__heap_push(qc__heap *heap, int32_t i);
int32_t qc__heap_pop(qc__heap *heap); /* heap->n > 0 */

/* --- parts of qc_mesh_create */

/* Each fills its arrays of a mesh under construction; what was allocated before a failure is
 * released with the mesh. */
qc_status qc__mesh_pair(qc_ctx *ctx, qc_mesh *mesh);       /* twin                              */
qc_status qc__mesh_edges(qc_ctx *ctx, qc_mesh *mesh);      /* edge arrays and counts             */
qc_status qc__mesh_fans(qc_ctx *ctx, qc_mesh *mesh);       /* vertex_corner                     */
qc_status qc__mesh_components(qc_ctx *ctx, qc_mesh *mesh); /* face_component, n_components       */

/* The destructor of meshes; arrays not there yet are NULL. */
void qc__mesh_destroy(qc_object *object);

/* Calls with both outputs NULL only count. */
qc_status qc__mesh_walk_boundary(qc_ctx *ctx, const qc_mesh *mesh, int32_t *n_loops,
                                 int32_t *loop_offset, int32_t *loop_vertex);

/* Angle between the normals of the two faces (n_edges); 0 on the boundary and beside needles. */
qc_status qc__crease_angles(qc_ctx *ctx, const qc_mesh *mesh, double *angle);

static inline double qc__norm3(const double a[3]) {
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static inline double qc__dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void qc__cross3(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}
static inline double qc__distance3(const double a[3], const double b[3]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}
/* The point of a face with barycentric coordinates w. */
static inline void qc__face_point(const qc_mesh *m, int32_t t, const double w[3], double x[3]) {
    for (int i = 0; i < 3; i++) {
        x[i] = 0;
        for (int k = 0; k < 3; k++)
            x[i] += w[k] * m->position[3 * (int64_t)m->face_vertex[3 * (int64_t)t + k] + i];
    }
}
/* Barycentric coordinates of the projection of x to the plane of a face; false without area. */
bool qc__face_coordinates(const qc_mesh *mesh, int32_t face, const double x[3], double w[3]);

/* out = end - start of halfedge h. */
static inline void qc__halfedge_vector(const qc_mesh *m, int32_t h, double out[3]) {
    const double *p = m->position + 3 * (size_t)qc_halfedge_start(m, h);
    const double *q = m->position + 3 * (size_t)qc_halfedge_end(m, h);
    for (int i = 0; i < 3; i++) out[i] = q[i] - p[i];
}

/* --- polygon meshes (polygon_mesh.c) */

/* Names the groups 1..n of a mesh which is not yet shared; texts are copied, materials may be NULL.
 */
qc_status qc__polygon_name_groups(qc_ctx *ctx, qc_polygon_mesh *mesh, int32_t n,
                                  const char *const *name, const char *materials);

void qc__polygon_free_attributes(qc_polygon_mesh *mesh);
/* Numbers the different values (width numbers for each corner) at each vertex. index (n_corners):
 * on entry -1 at corners without a value, which stay so; distinct (width n_corners, may be value):
 * the *n values, in the order of their first corners. */
qc_status qc__number_corner_values(qc_ctx *ctx, int32_t n_vertices, int32_t n_corners,
                                   const int32_t *corner_vertex, int32_t width, const double *value,
                                   int32_t *index, double *distinct, int32_t *n);

/* --- polygon quality (polygon_quality.c) */

/* Smallest sine of a corner angle against the normal of the polygon with the given n vertices: 1
 * for a rectangle, <= 0 where a corner is reflex, -1 where an edge or the area vanishes. */
double qc__scaled_jacobian(const double *position, const int32_t *vertex, int32_t n);

/* --- polygon topology (polygon_topology.c, polygon_defects.c) */

/* The sides of the faces (side i runs from corner i to the next one of its face), grouped by edge:
 * sides with equal end points are neighbours in `order`. */
typedef struct qc__sides {
    int32_t n, n_groups;
    int32_t *next;  /* n: next corner of the face  */
    int32_t *face;  /* n: face of the side  */
    int32_t *order; /* n: sides by edge */
    int32_t *group; /* n_groups + 1: start of each edge in `order` */
} qc__sides;
/* sides: zeros before; to be freed in any case. The arrays of the mesh have to be in range. */
qc_status qc__sides_create(qc_ctx *ctx, const qc_polygon_mesh *mesh, qc__sides *sides);
void qc__sides_free(qc__sides *sides);

qc_status qc__polygon_duplicates(qc_ctx *ctx, const qc_polygon_mesh *mesh, int32_t *count,
                                 int32_t *first);
qc_status qc__polygon_vertices(qc_ctx *ctx, const qc_polygon_mesh *mesh, const qc__sides *sides,
                               qc_polygon_topology *out, int32_t *first_non_manifold);

#endif
