/* Crowded singularities: indices which one vertex of a quad mesh should not carry alone, and
 * opposite singularities nearer than a quad, which leave no room for the quads between them. */
#ifndef QC_FIELD_CROWD_H
#define QC_FIELD_CROWD_H

#include "internal.h"

typedef struct qc__crowd {
    const qc_mesh *mesh;
    const int32_t *index4; /* n_vertices, kept by the caller                                  */
    const uint8_t *barred; /* optional, n_vertices, kept by the caller: no path leads through    */
    double *reach;    /* n_vertices, scratch: path length from the centre, infinite between calls */
    int32_t *ball;    /* n_vertices, scratch: the vertices found last                    */
    uint8_t *waiting; /* n_vertices, scratch: zero between calls                         */
    int32_t *queue;   /* n_vertices, scratch, a ring                                     */
} qc__crowd;
/* On error free as well. */
qc_status qc__crowd_create(qc_ctx *ctx, const qc_mesh *mesh, const int32_t *index4,
                           const uint8_t *barred, qc__crowd *out);
void qc__crowd_free(qc__crowd *crowd);

/* Fills ball with the vertices within `radius` of p along edges (p first), returns their number. */
int32_t qc__crowd_ball(qc__crowd *crowd, int32_t p, double radius);
/* How crowded p is: index4 above 1 or below -2 by how much, plus the number of opposite
 * singularities within `distance`, or within twice that on the same edge. */
int32_t qc__crowd_measure(qc__crowd *crowd, int32_t p, double distance);

/* Edges of a shortest path from p to the nearest opposite singularity within the same bounds,
 * listed from that singularity back to p, in ball; their number, 0 = none. */
int32_t qc__crowd_path(qc__crowd *crowd, int32_t p, double distance, int32_t *other);

/* Length of a path between the singularities of a torus which has two of them, 1/4 and -1/4, and so
 * no quad mesh (Izmestiev, Kusner, Rote, Springborn, Sullivan 2013); otherwise 0. */
double qc__crowd_lone_pair(qc__crowd *crowd);

/* Indices wanted: pairs cancel along a shortest path within the bounds, what is left of an excess
 * is shared with regular neighbours. theta (n_edges) turns by pi/2 where a quarter of index moves
 * over an edge; index4 is that of the crowd. (prescribe.c) */
void qc__crowd_prescribe(qc__crowd *crowd, double distance, double *theta, int32_t *index4);

static inline int32_t qc__index_excess(int32_t index4) {
    return index4 > 1 ? index4 - 1 : index4 < -2 ? -2 - index4 : 0;
}

#endif
