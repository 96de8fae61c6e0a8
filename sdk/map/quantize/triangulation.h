/* An intrinsic triangulation of a flat surface with cones which shrinks by flips and by removing
 * vertices (docs/theory/quantization.md). Internal to sdk/map/quantize.
 *
 * The halfedges 3t, 3t+1, 3t+2 of triangle t follow each other counter-clockwise; their vectors are
 * exact in the chart of t. Triangles may be glued to themselves, edges may be loops. Every face of
 * the mesh has a marker: a point inside, carried along with the quarter turns from the chart of
 * the face to that of the triangle which holds it. */
#ifndef QC_MAP_QUANTIZE_TRIANGULATION_H
#define QC_MAP_QUANTIZE_TRIANGULATION_H

#include "sdk/map/quantize/coarse.h"
#include "sdk/map/quantize/exact_map.h"
#include "sdk/map/quantize/exact_sign.h"

typedef struct qc__triangulation {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    int32_t n_triangles;
    /* 3 n_triangles each, as in qc__coarse */
    qc__point *vector, *image; /* image: other vectors, which are flipped along; NULL = none */
    int32_t *twin, *origin;
    int8_t *rotation, *axis;
    uint8_t *dead;  /* n_triangles: merged into another one                                       */
    int32_t *spoke; /* n_vertices: a halfedge which starts there, -1 = removed                    */
    /* markers of the faces: where they are from the origin of halfedge 3t, in the chart of t */
    int32_t *first_marker; /* n_triangles, -1 */
    int32_t *next_marker;  /* n_faces, -1 */
    qc__point *place;      /* n_faces */
    int8_t *turn;          /* n_faces */
} qc__triangulation;

/* The faces of an exact map, in units of 2^-(bits + 2). */
qc_status qc__triangulation_create(qc_ctx *ctx, const qc__exact_map *map, qc__triangulation **out);
/* The blocks alone; those which are NULL are skipped. */
void qc__triangulation_clear(qc__triangulation *T);
void qc__triangulation_free(qc__triangulation *T);

/* The origin of halfedge h from that of the first halfedge of its triangle. */
static inline qc__point qc__corner_place(const qc__point *vector, int32_t h) {
    switch (h % 3) {
    case 1:
        return vector[h - 1];
    case 2:
        return qc__turn_point(vector[h], 2);
    default:
        return (qc__point){0, 0};
    }
}

/* Next halfedge which starts at the same vertex, counter-clockwise or clockwise; -1 past the
 * boundary. */
static inline int32_t qc__spoke_ccw(const qc__triangulation *T, int32_t h) {
    return T->twin[qc_prev(h)];
}
static inline int32_t qc__spoke_cw(const qc__triangulation *T, int32_t h) {
    return T->twin[h] < 0 ? -1 : qc_next(T->twin[h]);
}
/* The spoke from which qc__spoke_ccw visits all. */
int32_t qc__first_spoke(const qc__triangulation *T, int32_t v);

/* The two triangles at inner halfedge h, which runs from p to q, with r on the left and w on the
 * right: places relative to p in the chart of h. */
typedef struct qc__flap {
    qc__point q, r, w;
} qc__flap;
qc__flap qc__flap_at(const qc__triangulation *T, const qc__point *vector, int32_t h);
/* Whether the other diagonal of the two triangles at h may take its place: no feature, and both new
 * triangles are positive. flat: the one at the origin of h may be flat. */
bool qc__can_flip(const qc__triangulation *T, int32_t h, bool flat);
/* Does so; h becomes an edge of the new triangle at its origin. */
void qc__flip(qc__triangulation *T, int32_t h);
/* Removes an inner vertex with three different triangles, one of which starts with spoke h. */
void qc__merge_star(qc__triangulation *T, int32_t h);
/* Removes a vertex at the end of halfedge h of a straight feature or boundary with one inner edge a
 * side. */
void qc__merge_line(qc__triangulation *T, int32_t h);

#endif
