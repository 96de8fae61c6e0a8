/* Working state of qc_mesh_repair: a triangle list which the steps edit one after the other.
 *
 * Vertices never move: a vertex stands where the input vertex source_vertex[v] stands. Steps before
 * the pairing know only `triangle`; later ones also `twin` (numbers as in qc_mesh). */
#ifndef QC_MESH_REPAIR_INTERNAL_H
#define QC_MESH_REPAIR_INTERNAL_H

#include "sdk/mesh/internal.h"

typedef struct qc__repair {
    qc_ctx *ctx;
    const qc_polygon_mesh *soup;
    qc_repair_report *report;
    int32_t n_vertices, n_faces;
    int32_t *triangle;      /* 3 n_faces; the first entry of a removed face is -1 */
    int32_t *source_face;   /* n_faces */
    int32_t *source_vertex; /* n_vertices */
    int32_t *twin;          /* 3 n_faces, -1 = boundary */
    uint8_t *merged;        /* per input vertex: it lives on as another one */
    uint8_t *cut;           /* n_vertices: at the end of an edge which was cut open */
} qc__repair;

static inline const double *qc__repair_point(const qc__repair *r, int32_t v) {
    return r->soup->position + 3 * (size_t)r->source_vertex[v];
}

/* Counts a change and keeps the first elements. */
void qc__repair_note(qc__repair *r, int32_t kind, int32_t element);
/* Drops the faces with keep[f] == 0; before the pairing. */
void qc__repair_keep(qc__repair *r, const uint8_t *keep);
/* "face 12 (line 40)": for messages. */
#define QC__FACE_NAME 64
const char *qc__repair_face_name(const qc__repair *r, int32_t face, char buffer[QC__FACE_NAME]);

/* Halfedges grouped by their end points: group i is order[start[i]] .. order[start[i+1]-1],
 * ascending in each group; vertex[h] is the vertex at corner h. Both arrays are freed by the
 * caller. */
typedef struct qc__edge_groups {
    int32_t n;
    int32_t *order, *start;
} qc__edge_groups;
qc_status qc__edge_groups_create(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces,
                                 const int32_t *vertex, qc__edge_groups *out);
void qc__edge_groups_free(qc__edge_groups *g);

/* Undirected edges; room for `most` different ones. slot is freed by the caller. */
typedef struct qc__edge_set {
    uint64_t *slot; /* 0 = free */
    size_t mask;
} qc__edge_set;
qc_status qc__edge_set_create(qc_ctx *ctx, int64_t most, qc__edge_set *out);
bool qc__edge_set_has(const qc__edge_set *s, int32_t a, int32_t b);
void qc__edge_set_add(qc__edge_set *s, int32_t a, int32_t b);

/* Triangles of a polygon, its corners being vertices vertex[0..n) at point[0..3n). Diagonals avoid
 * the edges in `taken` where they can (two polygons may share two consecutive edges; the same
 * diagonal in both would close a pocket) and are added to it. */
typedef struct qc__polygon {
    int32_t n;
    int32_t *vertex;    /* n */
    double *point;      /* 3 n */
    int32_t *triangles; /* result: 3 (n - 2) corner numbers */
    int32_t *ring;      /* scratch, n */
    double *flat;       /* scratch, 2 n */
    qc__edge_set *taken;
} qc__polygon;
void qc__triangulate_polygon(qc__polygon *p);

/* Sets the twins of the halfedges side[0..n) of one edge, n > 2; those left -1 are cut open. */
void qc__repair_pair_best(qc__repair *r, const int32_t *side, int32_t n);

/* The steps, in the order in which they are made. */
qc_status qc__repair_triangulate(qc__repair *r);
qc_status qc__repair_weld(qc__repair *r);
qc_status qc__repair_degenerate(qc__repair *r);
qc_status qc__repair_duplicate(qc__repair *r);
qc_status qc__repair_pair(qc__repair *r);
qc_status qc__repair_orient(qc__repair *r);
qc_status qc__repair_split(qc__repair *r);
qc_status qc__repair_zero_area(qc__repair *r);
qc_status qc__repair_finish(qc__repair *r, qc_mesh **mesh);

#endif
