/* Parts of qc_map_extract (stages/extract/extract.md): lattice vertices, ports, tracing, cells,
 * quads. */
#ifndef QC_MAP_EXTRACT_INTERNAL_H
#define QC_MAP_EXTRACT_INTERNAL_H

#include "sdk/map/grid/internal.h"

/* --- lattice vertices (lattice.c) ------------------------------------------------------------- */

/* Integer points of the map, each located once as mesh vertex, edge or face. Numbers: first those
 * at mesh vertices, then those inside edges (from start to end), then those inside faces (row by
 * row). */
typedef struct qc__lattice {
    const qc_grid_map *g;
    int32_t n, n_at_vertices, n_on_skeleton; /* skeleton: vertices and edges */
    bool open;                               /* a part of the boundary does not follow isolines */
    int32_t *vertex_id;  /* n_vertices: number, -1 = no lattice point                      */
    int32_t *edge_first; /* n_edges + 1: numbers of the points inside an edge                     */
    int32_t *face_first; /* n_faces + 1                     */
    int32_t *home; /* n: mesh vertex, edge or face                                             */
    int32_t *uv;   /* 2 n: parameters, in the chart of qc__lattice_face                        */
} qc__lattice;
qc_status qc__lattice_create(qc_ctx *ctx, const qc_grid_map *g, qc__lattice *out);
void qc__lattice_free(qc__lattice *lattice);
/* The face in whose chart lattice->uv is given: that of the first corner, the lower face, the face.
 */
int32_t qc__lattice_face(const qc__lattice *lattice, int32_t id);
bool qc__lattice_on_boundary(const qc__lattice *lattice, int32_t id);

/* Where a point lies in the closed face t: *k = corner, halfedge (k in 0..2) or unused. */
typedef enum qc__place { QC__OUTSIDE, QC__INSIDE, QC__ON_EDGE, QC__AT_CORNER } qc__place;
qc__place qc__locate(const qc_grid_map *g, int32_t t, qc__point p, int *k);
/* Number of the lattice vertex at p (grid units, chart of t), -1 = outside or none. */
int32_t qc__lattice_find(const qc__lattice *lattice, int32_t t, qc__point p);

/* --- ports (ports.c) */

/* Directions in which isolines leave the lattice vertices, counter-clockwise at each. */
typedef struct qc__ports {
    const qc__lattice *lattice;
    int32_t n;
    int32_t *first;  /* lattice->n + 1  */
    int32_t *vertex; /* n: lattice vertex */
    int32_t *face;   /* n: face it starts in   */
    int32_t *uv; /* 2 n: parameters of the lattice vertex in the chart of that face              */
    int8_t *dir; /* n: 0..3 in that chart                                                        */
    int32_t *mate; /* n: port at the other end, -1 = the isoline leaves the surface */
} qc__ports;
qc_status qc__ports_create(qc_ctx *ctx, const qc__lattice *lattice, qc__ports *out);
void qc__ports_free(qc__ports *ports);
/* Port of lattice vertex id in direction d of face t; -1 when the direction starts in another face.
 */
int32_t qc__port_find(const qc__ports *ports, int32_t id, int32_t t, int d);
static inline qc__point qc__port_point(const qc__ports *p, int32_t port) {
    const int64_t unit = (int64_t)1 << p->lattice->g->bits;
    return (qc__point){p->uv[2 * (int64_t)port] * unit, p->uv[2 * (int64_t)port + 1] * unit};
}

/* Fills in mate by exact tracing (trace.c). Where all of the boundary follows isolines, or there is
 * none, an unmatched port is FAILED. */
qc_status qc__ports_trace(qc_ctx *ctx, qc__ports *ports);
/* The feature edge which the port starts along, -1 = none (features.c). */
int32_t qc__port_feature(const qc__ports *ports, int32_t port);
/* The boundary halfedge at which the isoline of an unmatched port leaves the surface, -1 = none. */
int32_t qc__port_exit(const qc__ports *ports, int32_t port);

/* --- pieces of cells (pieces.c) --------------------------------------------------------- */

/* A face as seen from a piece: the square has its first corner at `at` and its first side in
 * direction d of the face's chart. */
typedef struct qc__visit {
    int32_t face, piece;
    qc__point at;
    int d;
} qc__visit;

/* The part of an open unit square of the parameters which is reached from one face. */
typedef struct qc__piece {
    int64_t first; /* visits up to those of the next piece */
    int32_t code;  /* 4 cell + side of the cell which is the first side of the piece, -1 = none */
    bool disk;     /* simply connected: no hole inside */
    bool middle;   /* holds the centre of the square */
    double area;   /* of the square, 0..1 */
} qc__piece;

typedef struct qc__pieces {
    const qc__ports *ports;
    int32_t n;
    int64_t n_visits, n_slots;
    qc__piece *piece;
    qc__visit *visit;
    int32_t *slot; /* hash table of the visits by face and square */
    int64_t piece_capacity, visit_capacity;
} qc__pieces;
void qc__pieces_free(qc__pieces *pieces);
/* Index of the visit of this face and square, -1 = none. */
int32_t qc__pieces_find(const qc__pieces *pieces, qc__visit v);
/* Adds the piece of the square of v, reached from its face. */
qc_status qc__pieces_flood(qc_ctx *ctx, qc__pieces *pieces, qc__visit v);
static inline int64_t qc__piece_end(const qc__pieces *p, int32_t i) {
    return i + 1 < p->n ? p->piece[i + 1].first : p->n_visits;
}
/* Corner k = 0..3 of the square of v in the chart of its face. */
static inline qc__point qc__square_corner(const qc__visit *v, int k, int64_t unit) {
    const qc__point corner = {k == 1 || k == 2 ? unit : 0, k >= 2 ? unit : 0};
    return qc__plus(v->at, qc__turn_point(corner, v->d));
}
/* A point of the face in the square's frame [0, unit]^2. */
static inline qc__point qc__in_square(const qc__visit *v, qc__point p) {
    return qc__turn_point(qc__minus(p, v->at), 4 - v->d);
}
/* Whether the segment a b, or the triangle, meets the open square with lower left corner o. */
bool qc__meets_square(qc__point a, qc__point b, qc__point o, int64_t unit);
bool qc__triangle_meets_square(const qc__point c[3], qc__point o, int64_t unit);

/* --- cells (cells.c, open.c) ---------------------------------------------------- */

/* Unit squares of the grid: first the complete ones, bounded by four ports and wholly in the
 * surface; then the open ones, which the boundary of the surface cuts (piece i is cell
 * n_complete + i). Side k runs from corner k to corner k + 1; sides have codes 4 cell + k. */
typedef struct qc__cells {
    int32_t n, n_complete;
    int32_t *corner;        /* 4 n: lattice vertex at the corner, -1 = outside the surface */
    int32_t *across;        /* 4 n: code of the side on the other side of it, -1 = boundary */
    int32_t *face;          /* n: a face of the cell */
    int32_t *left;          /* ports->n: side along a port, of a complete cell; -1 = none */
    uint8_t *keep;          /* n: becomes a quad */
    int32_t *rim_pole;      /* 4 n: the pole whose hole is across a side of a kept cell, -1; NULL
                               without poles */
    int32_t *contact_first; /* open cells + 1 */
    int32_t *contact;       /* 2 each: side of the open cell, side of the other cell   */
    int64_t n_contacts, contact_capacity; /* pairs */
    qc__pieces pieces;
} qc__cells;
/* The next side of the same cell, which begins at the corner where side a ends. */
static inline int32_t qc__side_end(int32_t a) {
    return (a & ~3) | ((a + 1) & 3);
}
/* The boundary side counter-clockwise after the boundary side a of the kept cells. */
static inline int32_t qc__next_boundary_side(const qc__cells *c, int32_t a) {
    int32_t b = qc__side_end(a);
    while (c->across[b] >= 0) b = (c->across[b] & ~3) | ((c->across[b] + 1) & 3);
    return b;
}
/* The side after `port` of the cell on its left; -1 = the isoline or the sector ends at the
 * boundary. */
int32_t qc__next_side(const qc__ports *ports, int32_t port);
qc_status qc__cells_create(qc_ctx *ctx, const qc__ports *ports, qc__cells *out);
void qc__cells_free(qc__cells *cells);
/* The pieces of the open cells; their corners and contacts (after the complete cells). */
qc_status qc__open_pieces(qc_ctx *ctx, const qc__ports *ports, qc__pieces *out);
qc_status qc__open_cells(qc_ctx *ctx, const qc__ports *ports, qc__cells *cells);

/* --- choice of the open cells (keep.c, choice.c, gaps.c) ----------------- */

/* On meshes with boundary: which open cells are kept and how cells are joined. FAILED when the kept
 * cells are no copy of each component. */
qc_status qc__cells_keep(qc_ctx *ctx, const qc__ports *ports, qc__cells *cells);

/* The boundary loops of the mesh and the open cells they meet. */
typedef struct qc__loops {
    int32_t n;
    int32_t *of_edge; /* n_edges: loop, -1 = interior */
    int32_t *start;   /* n: first vertex */
    int32_t *first;   /* open cells + 1 */
    int32_t *met;     /* loops met by each open cell */
    double *limit;    /* n: least coverage of cells on the loop which are kept */
    uint8_t *bridge;  /* n: cells which hang on a vertex are to be joined */
    int32_t *pole;    /* open cells: a pole whose hole the cell meets, which is not kept then; -1 */
} qc__loops;
qc_status qc__loops_create(qc_ctx *ctx, const qc__cells *cells, qc__loops *out);
void qc__loops_free(qc__loops *loops);
/* gap[loop] = lowest loop in the same gap of the kept cells. */
qc_status qc__loops_gaps(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                         const qc__loops *loops, int32_t *gap);
/* Sets keep and across from the limits of the loops. set: 4 n, corners joined (sets). */
qc_status qc__choose(qc_ctx *ctx, qc__cells *cells, const qc__loops *loops, int32_t *set);

/* --- result (vertices.c, place.c, pole_rings.c, close.c, quads.c) --------------- */

/* Output vertex of each corner of the kept cells: corners which cells share across their sides.
 * vertex: 4 n, -1 = not kept. *n_lattice of the *n_vertices, the first ones, are lattice vertices.
 */
qc_status qc__quad_vertices(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                            int32_t *vertex, int32_t *n_lattice, int32_t *n_vertices);
/* Puts the vertices outside the surface on its boundary and moves those next to it. */
qc_status qc__place_rim(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                        int32_t n_lattice, qc_polygon_mesh *q);
/* Sides of kept cells along features and the feature edges they start on, each isoline once; NULL =
 * count only. FAILED where a feature is no chain of sides, unless a boundary which does not follow
 * isolines may cut it. */
qc_status qc__feature_sides(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                            int32_t *side, int32_t *source, int32_t *n);
/* Closes the holes of poles with quads; vertex: as above. */
qc_status qc__close_poles(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                          qc_polygon_mesh **quads);
qc_status qc__quads_create(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                           qc_polygon_mesh **out);

#endif
