/* Low hills and hollows of a function on the vertices (docs/theory/poles.md). */
#ifndef QC_FIELD_HILLS_H
#define QC_FIELD_HILLS_H

#include "internal.h"

/* A hill or hollow: its extremum, and the saddle where it meets a larger one. */
typedef struct qc__hill {
    int32_t extremum, saddle;
    double floor; /* values around it, but for the saddle, count as no farther away than this */
} qc__hill;

typedef struct qc__hills {
    const qc_mesh *mesh;
    double *g, height;     /* n_vertices: the function, kept by the caller; hills below are low   */
    int32_t *order, *rank; /* n_vertices: by value, then by number; and the inverse        */
    uint64_t *key;         /* n_vertices, scratch                                          */
    int32_t *set, *oldest; /* n_vertices: components of the sweep, extremum of each         */
    int32_t *queue;        /* n_vertices, scratch                                          */
    qc__hill *hill;        /* n: lower than `height`, in the order of the sweep             */
    int32_t n;
    uint8_t *keep;    /* n_vertices: extremum to be kept                                    */
    uint8_t *extreme; /* n_vertices: extremum of this sweep which is not low                */
    int32_t *hill_of; /* n_vertices: the hill whose values are to be replaced, -1           */
    int sign;         /* 1: hollows, sweep from below; -1: hills                             */
    bool flat;        /* floors at the level of the shore                                   */
} qc__hills;

/* g: n_vertices, borrowed. Errors: NOMEM; free as well then. */
qc_status qc__hills_create(qc_ctx *ctx, const qc_mesh *mesh, double *g, double height,
                           qc__hills *out);
void qc__hills_free(qc__hills *h);

/* Sorts the vertices by g: order and rank. */
qc_status qc__hills_sort(qc_ctx *ctx, qc__hills *h);
/* Finds the low hills, or hollows, by their persistence: hill and extreme. */
void qc__hills_sweep(qc__hills *h);
/* Frees the vertices of all low hills, hill_of, and chooses their floors. Returns how many there
 * were. */
int32_t qc__hills_release(qc__hills *h);

/* Gives the free vertices values with the mean value property, weight (n_edges, positive): each is
 * a weighted mean of those around, so none is an extremum. */
qc_status qc__hills_fill(qc_ctx *ctx, const qc__hills *h, const double *weight);

/* The vertices next to v, one after the other, -1 after the last; *corner runs around v, from -1.
 */
int32_t qc__next_neighbour(const qc_mesh *mesh, int32_t v, int32_t *corner, int32_t *edge);

#endif
