/* Orderings through the elements of a pattern. Not installed.
 *
 * A cover writes the graph of A as a union of cliques, its elements: rows i, j are adjacent when
 * they share an element. For the non-conforming stiffness matrix the elements are the faces, and
 * the rows the edges of the face-dual graph. Seen from the elements a row is a net (a hyperedge):
 * the nets cut by a bisection of the elements are a vertex separator of A (Catalyurek, Aykanat,
 * Kayaaslan 2011). */
#ifndef QC_SPARSE_ORDER_INTERNAL_H
#define QC_SPARSE_ORDER_INTERNAL_H

#include "sdk/sparse/internal.h"

/* entry[begin..active) are rows; entry[active..end) rows of separators above, as ~(row of A).
 * Elements of one cluster are consecutive. */
typedef struct qc__element {
    int32_t begin, active, end, cluster;
} qc__element;

/* A row: element_of[begin..end) are its elements; name: its number in A. */
typedef struct qc__net {
    int32_t begin, end, name;
} qc__net;

/* Elements and rows of one piece, numbered from 0. */
typedef struct qc__cover {
    int32_t m, n;
    qc__element *element; /* m */
    qc__net *net;         /* n */
    int32_t *entry, *element_of;
} qc__cover;

/* Work space to cut one piece. */
typedef struct qc__cut_work {
    int32_t *distance, *border, *next, *path, *label; /* m */
    int32_t *queue, *list; /* 2 m: writing one place past the end keeps a branch out of loops */
    int32_t *heap;         /* 2 m + 2 per entry: graphs of clusters */
    int32_t *flow;         /* 2 n: elements from and to which a row carries flow, or -1 */
    uint8_t *side;         /* m */
} qc__cut_work;

enum { QC__SOURCE, QC__SINK, QC__FREE };

/* cover.c: every edge of A in exactly one clique. ARGUMENT never; NOMEM, CANCELLED. */
qc_status qc__cover_create(qc_ctx *ctx, qc__pattern A, qc__cover *out);
void qc__cover_free(qc__cover *cover);

/* Nets of more elements join nothing where clusters are made and graphs of them. */
enum { QC__WIDE_NET = 16 };

/* clusters.c: sets the clusters of all elements; order: m, elements by cluster.
 * Returns their number. */
int32_t qc__cluster_elements(qc__cover *C, int32_t size, int32_t *order);
/* center: 3 per cluster, in [0, QC__PLACES); position: of the rows. False: no memory. */
bool qc__cluster_centers(qc_ctx *ctx, const qc__cover *C, int32_t clusters, const double *position,
                         int16_t *center);

/* bisect.c: side[e] = QC__SOURCE or QC__SINK, both occur, such that few rows have elements on both
 * sides. C->m > 1; center: 3 coordinates of each cluster, or NULL. */
void qc__bisect(const qc__cover *C, const int16_t *center, qc__cut_work *work);
/* coarse.c: the same for whole clusters; false when there are too few. */
bool qc__bisect_clusters(const qc__cover *C, const int16_t *center, qc__cut_work *work);

/* A graph with weights, and the state of a cut of it. */
typedef struct qc__graph {
    int32_t n, arcs, capacity;
    int32_t *start, *size;                           /* n + 1; n: elements in a node */
    int32_t *distance, *next, *path, *queue, *order; /* n */
    int32_t *nearest;                                /* n */
    int32_t *arc, *weight, *reverse, *flow; /* arcs: other node, weight, the arc back, flow */
    int16_t *center;                        /* 3 n: in [0, QC__PLACES), or NULL */
    uint8_t *side, *best;                   /* n: terminals of the flow; sides of the best cut */
    int64_t value;                          /* of the flow */
} qc__graph;
enum { QC__PLACES = 1024 };

/* Space for graphs. */
typedef struct qc__heap {
    int32_t *next;
    int64_t free;
} qc__heap;

/* graph.c: of[k] = node which holds element (or node of G) k. False when this would not be much
 * smaller, or without space. */
bool qc__graph_of_clusters(const qc__cover *C, const int16_t *center, qc__heap *heap, int32_t *of,
                           qc__graph *G);
bool qc__graph_coarsen(const qc__graph *G, qc__heap *heap, int32_t *of, qc__graph *H);
/* graph_flow.c: adds flow from the nodes of side QC__SOURCE to those of side QC__SINK until there
 * is no more; then distance[k] >= 0 where a sink can still be reached: a smallest cut. */
void qc__graph_flow(qc__graph *G);

/* flow.c: moves the free elements to the sides so that the number of rows with elements on both is
 * smallest. element: those which are QC__FREE. */
void qc__min_cut(const qc__cover *C, qc__cut_work *work, int32_t count, const int32_t *element);

/* minimum_degree.c: order[0..n) = names in elimination order; C->n <= QC__SMALL_PIECE. */
enum { QC__SMALL_PIECE = 256 };
void qc__minimum_degree(const qc__cover *C, int32_t *order);

/* A piece lies in one of two buffers, [offset, offset + size) of each kind; its rows have the same
 * places in the final order. */
typedef struct qc__piece {
    int32_t buffer, m, n;
    int32_t element, row, entry, member;
} qc__piece;

typedef struct qc__dissection {
    qc__cover buffer[2];
    qc__cut_work work;
    int16_t *center; /* 3 per cluster, or NULL */
    int32_t *perm;   /* n */
    int32_t leaf;    /* pieces of at most so many rows are left to another method */
    bool *left;      /* n: perm[k..k + work.flow[2 k]) is left to another method */
} qc__dissection;

/* pieces.c */
qc__cover qc__piece_view(const qc__dissection *D, const qc__piece *P);
qc__cut_work qc__piece_work(const qc__dissection *D, const qc__piece *P);
/* Side of each row, QC__FREE for those with elements on both, into work->flow; size[3]. */
void qc__row_sides(const qc__cover *C, qc__cut_work *work, int32_t size[3]);
/* Copies the two sides into the other buffer, elements in the given order (NULL: as they are), and
 * appends the rows of side QC__FREE, the separator, to the order. */
void qc__piece_split(const qc__dissection *D, const qc__piece *P, const int32_t *order,
                     const int32_t size[3], qc__piece child[2]);

/* amd.c: AMD on a pattern; AMD on the rows perm[0..n) of A. place: A.n, -1 before and after. */
qc_status qc__amd(qc_ctx *ctx, qc__pattern A, int32_t *perm);
qc_status qc__amd_rows(qc_ctx *ctx, qc__pattern A, int32_t n, int32_t *perm, int32_t *place);

/* dissection.c; position: 3 n or NULL; leaf: pieces of at most so many rows are ordered by AMD. */
qc_status qc__order_dissection(qc_ctx *ctx, qc__pattern A, const double *position, int32_t leaf,
                               int32_t *perm);

/* quotient.c: group: n, out, from the caller's ids or of indistinguishable rows; *count groups. */
qc_status qc__find_groups(qc_ctx *ctx, qc__pattern A, const int32_t *given, int32_t *group,
                          int32_t *count);
/* Pattern of the groups; *colptr and *row belong to the caller, also on failure. */
qc_status qc__quotient(qc_ctx *ctx, qc__pattern A, const int32_t *group, int32_t count,
                       int64_t **colptr, int32_t **row);
/* Order of the rows from one of the groups. */
qc_status qc__expand_groups(qc_ctx *ctx, int32_t n, const int32_t *group, int32_t count,
                            const int32_t *order, int32_t *perm);

#endif
