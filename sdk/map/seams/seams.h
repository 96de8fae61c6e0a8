/* Seams of a map on a cut surface: the combinatorics behind periods and rounding. Internal to
 * sdk/map.
 *
 * The combed map f' is continuous on the surface minus the cut graph. The cut graph falls into
 * segments: paths between nodes (branch points of the graph, cones, boundary vertices). Crossing
 * segment k from its left to its right side, f'_right = i^{rho_k} f'_left + tau_k with one
 * translation tau_k for the whole segment (2.5 of the 2007 paper). The corners about a vertex
 * between two cut edges form a wedge; all have one value. With F_v the value in the first wedge of
 * v, f'_w = i^{a_w} F_v + sum of i^{b} tau_k.
 *
 * Some coordinates of some F_v are no unknowns. Points (cones, and the corners and ends of hard
 * features) lie on lattice points, and the coordinate across a feature has one value, the level, on
 * the whole chain. The translations and positions, real and imaginary parts apart, and the levels
 * are the symbols. They satisfy integer relations; solving them (relations.h) leaves the free
 * variables y, which are the periods to be rounded: (4.1) counts them.
 *
 * A pole (qc_mesh) is a node, too. Going once around it the chart is shifted by d, the sum of the
 * translations of the segments which end there; quads close it when d_u + d_v is even, which is to
 * say d = (1 - i) p with a Gaussian integer p. So p joins the symbols like the position of a cone
 * of one quarter turn, which no vertex has and no shift changes (docs/theory/poles.md). */
#ifndef QC_MAP_SEAMS_H
#define QC_MAP_SEAMS_H

#include "sdk/base/internal.h"
#include <complex.h>
#include <qc/map.h>
#include "sdk/map/seams/relations.h"

typedef struct qc__seams {
    const qc_mesh *mesh;
    /* segments */
    int32_t n_segments;
    int32_t *edge_segment; /* n_edges, -1 = not on the cut graph */
    int32_t *edge_left; /* n_edges, the halfedge on the left side, along the segment              */
    int8_t *segment_turn;  /* rho_k  */
    int32_t *segment_node; /* 2 n_segments: start and end vertex; of a pole its first tip */
    /* points: cones, interior vertices of non-zero index, and corners of features; after them the
     * poles where segments end */
    int32_t n_cones, n_poles;
    int32_t *cone_vertex; /* n_cones + n_poles */
    int32_t *vertex_cone; /* n_vertices, -1 */
    int8_t *cone_turn;    /* n_cones + n_poles: R, quarter turns once around, 0..3; 0 on the
                             boundary, 1 for poles */
    int32_t *cone_pole;   /* n_poles: number in the mesh */
    /* levels: one coordinate x = 2 v + c (c = 0 re, 1 im of F_v) of each, and relations between
     * them and the other symbols, sum value * symbol = 0 */
    int32_t n_levels;
    int32_t *level_coordinate;
    int32_t n_level_relations;
    int64_t *level_relation_start;
    int32_t *level_relation_symbol, *level_relation_value;
    /* wedges, ordered by vertex and counter-clockwise */
    int32_t n_wedges;
    int32_t *vertex_wedge; /* n_vertices + 1 */
    int32_t *corner_wedge; /* 3 n_faces */
    int8_t *wedge_turn;    /* a_w */
    int64_t *wedge_start;  /* n_wedges + 1: terms of a wedge ...  */
    int32_t *term_segment; /* ... segment k */
    int8_t *term_turn; /* ... b                                                                  */
    int64_t n_terms, term_capacity;
    /* a closing walk about each interior node and then each pole, terms as above: sum = (1 - i^R) p
     */
    int32_t n_nodes;
    int32_t *node_vertex;   /* n_nodes */
    int32_t *node_cone;     /* n_nodes: cone or pole there, -1 */
    int64_t *closing_start; /* n_nodes + 1, into closing_segment/turn */
    int32_t *closing_segment;
    int8_t *closing_turn;
    int64_t n_closing_terms, closing_capacity;
    /* coordinates which are given by symbols: row 2 i + c of coordinate c (0 re, 1 im) of F_v, i =
     * vertex_given[v]; an empty row is an unknown coordinate */
    int32_t n_given;
    int32_t *vertex_given; /* n_vertices, -1 */
    int64_t *given_start;  /* 2 n_given + 1 */
    int32_t *given_symbol;
    int32_t *given_value;
    /* symbols by free variables, and back; made by qc__seams_solve */
    int32_t n_free, n_fixed;  /* the n_fixed ones after the free ones are set to zero by a shift */
    int32_t *fixed_component; /* n_fixed */
    qc__rows symbol_row;      /* n_symbols: symbol = sum of value * y_column, units included */
    qc__rows free_row;        /* n_free + n_fixed: y = sum of value * symbol */
} qc__seams;

/* Real symbols: parts re, im of the translations, then of the positions of the points, then of
 * the p of the poles, then the levels. */
static inline int32_t qc__seams_symbols(const qc__seams *s) {
    return 2 * (s->n_segments + s->n_cones + s->n_poles) + s->n_levels;
}
static inline int32_t qc__level_symbol(const qc__seams *s, int32_t level) {
    return 2 * (s->n_segments + s->n_cones + s->n_poles) + level;
}
static inline int32_t qc__translation_symbol(int32_t segment, int32_t part) {
    return 2 * segment + part;
}
static inline int32_t qc__position_symbol(const qc__seams *s, int32_t cone, int32_t part) {
    return 2 * (s->n_segments + cone) + part;
}

static inline double _Complex qc__complex(qc_complex z) {
    return z.re + z.im * I;
}
static inline qc_complex qc__pair(double _Complex z) {
    const qc_complex p = {creal(z), cimag(z)};
    return p;
}
static inline double _Complex qc__turn(double _Complex z, int32_t k) {
    return qc__complex(qc_quarter_turn(qc__pair(z), k));
}

/* Rotation of the combed map when halfedge h is crossed: f'_t = i^{c_t - m - c_s} f'_s + tau. */
static inline int32_t qc__combed_rotation(const qc_cover *cover, const int8_t *face_turn,
                                          int32_t h) {
    const int32_t g = cover->mesh->twin[h];
    return (face_turn[g / 3] - qc_cover_turn(cover, h) - face_turn[h / 3]) & 3;
}
int32_t qc__seams_component(const qc__seams *s, int32_t symbol);
/* Change of a symbol when its whole combed component is shifted by w. */
double qc__seams_shift(const qc__seams *s, int32_t symbol, double _Complex w);
/* Change of free variable y (fixed ones too) when its component is shifted by 1, real part, and by
 * i, imaginary part. */
double _Complex qc__seams_response(const qc__seams *s, int32_t y);
static inline bool qc__seams_is_given(const qc__seams *s, int32_t v, int32_t coordinate) {
    const int32_t row = 2 * s->vertex_given[v] + coordinate;
    return row >= 0 && s->given_start[row] < s->given_start[row + 1];
}
/* Values of all symbols (n_symbols) for free variables y (n_free), and what a map has in every
 * wedge besides i^{a_w} times the unknown coordinates of F_v: i^{a_w} times the given ones and the
 * translations. wedge: n_wedges. */
void qc__seams_symbol_values(const qc__seams *s, const double *y, double *symbol);
void qc__seams_wedge_values(const qc__seams *s, const double *symbol, double _Complex *wedge);
/* The transpose of the latter. */
void qc__seams_wedge_duals(const qc__seams *s, const double _Complex *wedge, double *symbol);
/* F_v of a map with corner values f. */
double _Complex qc__seams_value_at(const qc__seams *s, const qc_complex *f, int32_t v);
/* Shifts each component of a map so that its fixed variables are zero, then reads the free ones: y
 * (n_free). Errors: NOMEM. */
qc_status qc__seams_read(qc_ctx *ctx, const qc__seams *s, qc_complex *f, double *y);

/* Coordinate c of F_v in the part `part` (0 re, 1 im) of i^turn F_v: c = (part + turn) mod 2, with
 * this sign. */
static inline double qc__part_sign(int32_t part, int32_t turn) {
    return ((turn + (part == 0)) & 3) >= 2 ? -1.0 : 1.0;
}

/* Segments, points, wedges and levels of a cut, combed cover. index4: n_vertices; axis: n_edges,
 * the features as in qc_matching, NULL = none. */
qc_status qc__seams_create(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                           const int8_t *face_turn, const int32_t *index4, const int8_t *axis,
                           qc__seams **out);
/* Expresses every symbol by free variables on the lattice QC_LATTICE_...; errors: NOMEM, FAILED. */
qc_status qc__seams_solve(qc_ctx *ctx, qc__seams *seams, int32_t lattice);
void qc__seams_free(qc__seams *seams);

/* A chart carried along a path of faces: f_here = i^turn f_start + sum of i^{term_turn} tau.
 */
typedef struct qc__walk {
    int32_t turn, n, capacity;
    int32_t *segment;
    int8_t *term_turn;
} qc__walk;
/* Crosses halfedge h from its own face to the other; false when memory runs out. */
bool qc__walk_cross(qc_ctx *ctx, const qc__seams *seams, qc__walk *walk, int32_t h);
void qc__walk_free(qc__walk *walk);

#endif
