/* Walking straight through the coarse complex, exactly (docs/theory/quantization.md). Internal to
 * sdk/map/quantize.
 *
 * A cursor is in a triangle and knows how its chart follows from the one where the walk began, for
 * the map (places from the origin of halfedge 3t) and for the integers alike. Walks run infinitely
 * little to the left of their line, so they meet no vertex. */
#ifndef QC_MAP_QUANTIZE_WALK_H
#define QC_MAP_QUANTIZE_WALK_H

#include "sdk/map/quantize/decimate.h"

typedef struct qc__cursor {
    const qc__coarse *coarse;
    const qc__point *x; /* integer vectors, parameter units */
    int32_t triangle;
    int turn; /* z_here = i^turn z_start + shift, the same for integers with integer_shift */
    qc__point shift, integer_shift;
} qc__cursor;

static inline qc__point qc__cursor_place(const qc__cursor *k, qc__point start) {
    return qc__plus(qc__turn_point(start, k->turn), k->shift);
}
/* Crosses halfedge h of its triangle, which is not on the boundary. */
void qc__cursor_cross(qc__cursor *k, int32_t h);
/* At a point z inside the triangle or on its edges (in the first chart): moves to the triangle
 * which holds what lies just ahead in direction d, a little to the left. */
void qc__cursor_face(qc__cursor *k, qc__point z, qc__point d);
/* The halfedge through which the line from a towards b, both in the first chart, leaves the
 * triangle before b; -1 = it does not. */
int32_t qc__cursor_exit(const qc__cursor *k, qc__point a, qc__point b);
/* At a on the boundary of the triangle: the halfedge whose ray from a lies clockwise of where the
 * cursor looks, but still counter-clockwise of d; -1 = none. */
int32_t qc__cursor_turn(const qc__cursor *k, qc__point a, qc__point d);
/* The point `share` of the way along halfedge h, or where z is, by the integers: in the integer
 * chart of the start. */
void qc__cursor_on_edge(const qc__cursor *k, int32_t h, double share, double uv[2]);
void qc__cursor_value(const qc__cursor *k, qc__point z, double uv[2]);

#endif
