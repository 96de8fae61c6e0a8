/* The state of imprinting, shared by its parts. Internal to sdk/map/quantize. */
#ifndef QC_MAP_QUANTIZE_IMPRINTER_H
#define QC_MAP_QUANTIZE_IMPRINTER_H

#include "sdk/map/quantize/imprint.h"

typedef struct qc__piece_node { /* a vertex on the boundary of a piece */
    int32_t vertex;
    double weight[3]; /* barycentric coordinates in the face */
    double uv[2];
} qc__piece_node;

typedef struct qc__piece { /* opened, not yet closed */
    int32_t start;         /* of its nodes */
    int32_t way_back;      /* halfedge of the coarse complex through which it is left in the end */
} qc__piece;

typedef struct qc__imprinter {
    qc_ctx *ctx;
    const qc__exact_map *map;
    const qc__coarse_map *coarse;
    const qc__point *x;
    int32_t *edge_start; /* n_edges + 1: the crossings of an edge with coarse ones, ...  */
    double *share;       /* ... how far along edge_halfedge[2 e] they are, ... */
    int32_t *vertex;     /* ... and their vertices: near an end of the edge that one */
    double *place;       /* 2 each: their values */
    int32_t n_vertices;  /* of the refined mesh */
    qc_complex *edge;    /* 3 n_faces: tangent edges */
    qc__refiner refiner;
    double *uv;          /* 6 for each new face */
    double *weight;      /* 9 for each new face */
    double corner[3][2]; /* values of the corners of the face */
    qc__piece_node *node;
    qc__piece *piece;
    int64_t n_nodes, node_capacity, n_pieces, piece_capacity;
    bool short_of_memory;
    int32_t face; /* whose boundary is walked */
    qc__face_walk walk;
    qc__cursor cursor;
} qc__imprinter;

/* --- crossings.c: along the edges of a face, just inside --- */

/* Begins at corner k, looking along the edge to the next one. */
void qc__imprint_begin(qc__imprinter *q, int32_t face, int k);
/* The coarse halfedge through which the cursor leaves between corner k and the next one; -1 =
 * none. */
int32_t qc__imprint_exit(const qc__imprinter *q, int k);
/* From where the cursor looks at corner k: to the line towards the next corner. */
int32_t qc__imprint_turn(const qc__imprinter *q, int k);
/* Where the line from a to b meets halfedge h: share of the line and of the halfedge. */
void qc__imprint_meet(const qc__cursor *k, qc__point a, qc__point b, int32_t h, double share[2]);
/* Counts the crossings of all edges, and, with q->share, tells where they are. */
void qc__find_crossings(qc__imprinter *q);

/* --- cut_face.c --- */

/* The pieces of a face, triangulated; false: out of memory (short_of_memory), or it is not cut
 * along chords. */
bool qc__cut_face(qc__imprinter *q, int32_t face);

#endif
