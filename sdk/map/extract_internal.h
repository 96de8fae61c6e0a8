/* Parts of qc_map_extract (ROBUST 3): lattice vertices, ports, tracing, cells, quads. */
#ifndef QC_MAP_EXTRACT_INTERNAL_H
#define QC_MAP_EXTRACT_INTERNAL_H

#include "sdk/map/grid_internal.h"

/* --- lattice vertices (extract_lattice.c) -------------------------------------------------------
 */

/* Integer points of the map, each located once as mesh vertex, edge or face. Numbers: first those
 * at mesh vertices, then those inside edges (from start to end), then those inside faces (row by
 * row). */
typedef struct qc__lattice {
    const qc_grid_map *g;
    int32_t n, n_at_vertices, n_on_skeleton; /* skeleton: vertices and edges */
    int32_t *vertex_id;                      /* n_vertices: number, -1 = no lattice point                      */
    int32_t *edge_first;                     /* n_edges + 1: numbers of the points inside an edge                     */
    int32_t *face_first;                     /* n_faces + 1                     */
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

/* --- ports (extract_ports.c)
 * ---------------------------------------------------------------------- */

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

/* Fills in mate by exact tracing (extract_trace.c). On a mesh without boundary an unmatched port is
 * FAILED. */
qc_status qc__ports_trace(qc_ctx *ctx, qc__ports *ports);
/* The boundary halfedge at which the isoline of an unmatched port leaves the surface, -1 = none. */
int32_t qc__port_exit(const qc__ports *ports, int32_t port);

/* --- cells (extract_cells.c)
 * ----------------------------------------------------------------------- */

/* Unit squares bounded by four ports which lie in the surface as a whole. */
typedef struct qc__cells {
    int32_t n;
    int32_t *port; /* 4 n: ports along the sides, counter-clockwise, the lowest first */
    int32_t *left; /* ports->n: cell left of a port, -1 = none */
    int64_t n_refused;
    int32_t
        *refused; /* 2 n_refused: lowest port of a square with boundary inside, halfedge of it   */
} qc__cells;
/* The side after `port` of the cell on its left; -1 = the isoline or the sector ends at the
 * boundary. */
int32_t qc__next_side(const qc__ports *ports, int32_t port);
qc_status qc__cells_create(qc_ctx *ctx, const qc__ports *ports, qc__cells *out);
void qc__cells_free(qc__cells *cells);
/* On meshes with boundary: keeps the largest edge-connected set of cells of each component. FAILED
 * when the rest is no copy of the component (extract_keep.c). */
qc_status qc__cells_keep(qc_ctx *ctx, const qc__ports *ports, qc__cells *cells);
/* Two boundary loops which the kept cells do not separate, by a vertex of each; -1 = there are none
 * (extract_gaps.c). */
qc_status qc__cells_merged_loops(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                                 int32_t vertex[2]);

/* --- result (extract_quads.c)
 * ----------------------------------------------------------------------- */

/* Output vertex of the cell left of each port, at the port's lattice vertex: cells which follow
 * each other around a lattice vertex share it. vertex: ports->n, -1 = no cell. Returns the number
 * of vertices. */
int32_t qc__quad_vertices(const qc__ports *ports, const qc__cells *cells, int32_t *vertex);
qc_status qc__quads_create(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                           qc_polygon_mesh **out);

#endif
