/* The network of feature edges, as chains between its nodes. Internal to sdk/mesh. */
#ifndef QC_MESH_FEATURE_CHAINS_H
#define QC_MESH_FEATURE_CHAINS_H

#include "sdk/mesh/internal.h"

/* Strengths above every crease angle; means of equal ones are equal up to rounding. */
#define QC__STRENGTH_DRAWN    10.0
#define QC__STRENGTH_BOUNDARY 1000.0

typedef struct qc__chain {
    int32_t end[2];          /* vertices; equal when it is closed */
    int32_t first, n;        /* edges in order: n from `first` in the network's list */
    double length, strength; /* strength: of the edges, on average */
    bool drop, lost, won;
} qc__chain;

typedef struct qc__feature_network {
    const qc_mesh *mesh;
    uint8_t *edge;                   /* n_edges flags                                            */
    double *crease, *length, *angle; /* n_edges, n_edges, 3 n_faces                             */
    int32_t *degree;                 /* n_vertices                                               */
    uint8_t *node;                   /* n_vertices: chains end there                             */
    int32_t *of;                     /* n_edges: chain, -1 = none                                */
    int32_t *list, n_list;           /* n_edges: edges by chain                                  */
    qc__chain *chain;                /* n_edges, n used                                          */
    int32_t n, named;
} qc__feature_network;

/* edge: n_edges QC_FEATURE_... flags, copied. Freed by the caller also when it fails. */
qc_status qc__feature_network_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                     qc__feature_network *w);
void qc__feature_network_free(qc__feature_network *w);
/* The chains of the edges flagged now, with degrees and nodes. */
void qc__find_chains(qc__feature_network *w);
/* The flagged edges at each vertex. */
void qc__count_feature_degrees(qc__feature_network *w);

/* Edges at v in order: start with *c = -1; -1 after the last. */
int32_t qc__next_edge(const qc_mesh *mesh, int32_t v, int32_t *c);
void qc__edge_direction(const qc_mesh *mesh, int32_t e, int32_t from, double out[3]);

/* Gaps of creases closed along edges of dihedral angle above `weak` (radians) which lead on from a
 * free end to another feature, then creases which zigzag straightened. */
qc_status qc__close_feature_gaps(qc_ctx *ctx, qc__feature_network *w, double weak);

#endif
