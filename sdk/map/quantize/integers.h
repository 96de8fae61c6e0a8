/* Integer vectors of a coarse complex: what the parts of the search share (docs/theory/
 * quantization.md). Internal to integers*.c.
 *
 * A unit i^k of surplus in a triangle is pushed across halfedge h to the next one: x_h loses i^k
 * and its twin gains i^(k+r). A closed path of such crossings keeps every triangle closed, as does
 * one between two boundary edges. These are the closed paths of the dual graph of the four-sheeted
 * covering; features are crossed along their axis only. */
#ifndef QC_MAP_QUANTIZE_INTEGERS_H
#define QC_MAP_QUANTIZE_INTEGERS_H

#include "sdk/map/quantize/triangulation.h"
#include "sdk/mesh/internal.h"

typedef struct qc__crossing {
    int32_t halfedge, k; /* x_halfedge -= i^k, x_twin += i^(k+r) */
} qc__crossing;

typedef struct qc__integers {
    qc_ctx *ctx;
    qc__triangulation T; /* a copy of the complex; T.image = x is flipped along, no markers */
    qc__flips flips;     /* from the complex to T */
    qc__triangulation best;
    int64_t best_flips;
    int32_t bits;
    bool has_boundary;
    qc__point *x;   /* 3 n_triangles */
    double reach;   /* length of a path in gains of its first crossing, at most */
    double scale;   /* the present one, of the vectors of T */
    double *wanted; /* 6 n_triangles: the real vectors at the present scale */
    double *weight; /* 3 n_triangles: of the edges in the energy */
    /* winding: axis directions in the sectors about a vertex of the mesh */
    int32_t n_origins;
    int32_t *turns, *expected; /* n_origins; expected -1 = any */
    int64_t violation;         /* missing areas and wrong windings: 0 = feasible */
    double energy;
    /* search: state 4h + k is a unit i^k which has entered through h */
    double *distance;
    int32_t *parent; /* state, -1 = seed */
    qc__heap heap;
    int32_t *touched; /* states */
    int32_t n_touched;
    qc__crossing *path;
    int32_t n_path;
    int64_t path_capacity;
} qc__integers;

/* A unit may cross a feature along its axis only. */
static inline bool qc__may_cross(const qc__triangulation *c, int32_t h, int32_t k) {
    return c->axis[h] < 0 || ((k - c->axis[h]) & 1) == 0;
}

/* --- state (integers_state.c) */

/* The real vectors at this scale become what is wanted, and the energy is measured anew. */
void qc__integers_aim(qc__integers *q, double scale);
/* Weights of the edges and expected windings, from the real vectors. FAILED where these do not span
 * positive areas. */
qc_status qc__integers_weigh(qc__integers *q);
/* Violation and energy of all vectors. */
void qc__integers_measure(qc__integers *q);
/* w |x - i^k - wanted|^2 - w |x - wanted|^2 for one edge. */
double qc__integers_change(const qc__integers *q, int32_t h, int32_t k);
/* Twice the area of the triangle of a and b when a gains i^k and b, another halfedge, loses it. */
int64_t qc__integers_area_after(const qc__integers *q, int32_t a, int32_t b, int32_t k);
int64_t qc__integers_area(const qc__integers *q, int32_t t);
/* Flips an inner edge; violation stays up to date, energy does not. */
void qc__integers_flip(qc__integers *q, int32_t h);
/* Makes the crossings of the path `times` times; negative: back. */
void qc__integers_apply(qc__integers *q, int64_t times);

/* --- flips (integers_flips.c) */

/* Flips edges where fewer areas are missing then, or, those being positive, towards the Delaunay
 * triangulation of the integer vectors; the real triangles stay positive. Measures anew.
 * *flipped: whether any was. */
qc_status qc__integers_flip_all(qc__integers *q, bool *flipped);

/* --- moves (integers.c) */

/* Moves and flips until none helps, or until they mend next to nothing of what is violated: then a
 * finer scale is the better way. */
qc_status qc__integers_descend(qc__integers *q);

/* --- start (integers_start.c) */

/* Closed integer vectors near the wanted ones, of any areas. *closed: whether there are. */
qc_status qc__integers_start(qc__integers *q, bool *closed);

/* --- paths (integers_search.c) */

/* Where a unit may end: in the triangle of `loop` with direction k (loop >= 0), against a defect
 * (defect != NULL), or beyond the boundary. */
typedef struct qc__goal {
    int32_t loop, k;
    const qc__point *defect; /* n_triangles */
    bool keep_areas;         /* of the triangles on the way */
    double limit;            /* of the length */
} qc__goal;
typedef struct qc__found {
    double length;         /* infinite = none */
    int32_t state, outlet; /* the last state, and the boundary halfedge behind it, -1 = none */
} qc__found;
/* The shortest path of a unit i^k which has entered through one of the n halfedges `seed`: to the
 * goal inside (*inside) and to the boundary (*outside, NULL = of no interest). */
void qc__integers_search(qc__integers *q, const int32_t *seed, int32_t n, int32_t k,
                         const qc__goal *goal, qc__found *inside, qc__found *outside);
/* Appends the crossings of a path. Before the next search. */
bool qc__integers_append(qc__integers *q, const qc__found *found);
bool qc__integers_cross(qc__integers *q, int32_t h, int32_t k);

#endif
