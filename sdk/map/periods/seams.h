/* Seams of a map on a cut surface: the combinatorics behind periods and rounding. Internal to
 * sdk/map.
 *
 * The combed map f' is continuous on the surface minus the cut graph. The cut graph falls into
 * segments: paths between nodes (branch points of the graph, cones, boundary vertices). Crossing
 * segment k from its left to its right side, f'_right = i^{rho_k} f'_left + tau_k with one
 * translation tau_k for the whole segment (2.5 of the 2007 paper). The corners about a vertex
 * between two cut edges form a wedge; all have one value. With F_v the value in the first wedge of
 * v, f'_w = i^{a_w} F_v + sum over symbols of i^{b} symbol, symbols being the tau_k and the
 * positions p_v of the cones. The symbols satisfy one linear relation over the Gaussian integers
 * per interior node; eliminating them leaves the free variables x, which are the periods to be
 * rounded: (4.1) counts them. */
#ifndef QC_MAP_SEAMS_H
#define QC_MAP_SEAMS_H

#include "sdk/base/internal.h"
#include <complex.h>
#include <qc/map.h>

typedef struct qc__seams {
    const qc_mesh *mesh;
    /* segments */
    int32_t n_segments;
    int32_t *edge_segment; /* n_edges, -1 = not on the cut graph */
    int32_t *edge_left; /* n_edges, the halfedge on the left side, along the segment              */
    int8_t *segment_turn;  /* rho_k  */
    int32_t *segment_node; /* 2 n_segments: start and end vertex */
    /* cones: interior vertices of non-zero index */
    int32_t n_cones;
    int32_t *cone_vertex; /* n_cones */
    int32_t *vertex_cone; /* n_vertices, -1 */
    int8_t *cone_turn; /* R: quarter turns once around, 0..3                                      */
    /* wedges, ordered by vertex and counter-clockwise */
    int32_t n_wedges;
    int32_t *vertex_wedge; /* n_vertices + 1 */
    int32_t *corner_wedge; /* 3 n_faces */
    int8_t *wedge_turn;    /* a_w */
    int64_t *wedge_start;  /* n_wedges + 1: terms of a wedge ...  */
    int32_t *term_symbol;  /* ... symbol number: segment k, or n_segments + cone  */
    int8_t *term_turn; /* ... b                                                                  */
    int64_t n_terms, term_capacity;
    /* relations: a closing walk about each interior node, terms as above plus the cone */
    int32_t n_nodes;
    int32_t *node_vertex;    /* n_nodes */
    int64_t *relation_start; /* n_nodes + 1, into relation_symbol/turn */
    int32_t *relation_symbol;
    int8_t *relation_turn;
    int64_t n_relation_terms, relation_capacity;
    /* symbols in terms of the free variables, made by qc__seams_solve */
    int32_t n_free;
    int32_t *free_symbol;   /* n_free */
    double _Complex *scale; /* n_symbols: free x = scale * Gaussian integer */
    int32_t *fixed_symbol;  /* n_components: symbol set to zero by a global shift, -1 = none  */
    int64_t *row_start;     /* n_symbols + 1 */
    int32_t *row_free;
    double _Complex *row_value; /* coefficient of the Gaussian integer */
} qc__seams;

static inline int32_t qc__seams_symbols(const qc__seams *s) {
    return s->n_segments + s->n_cones;
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

/* Change of a symbol when the whole combed component is shifted by 1: 1 for a cone, 1 - i^rho for a
 * translation. */
static inline double _Complex qc__seams_shift(const qc__seams *s, int32_t symbol) {
    return symbol >= s->n_segments ? 1.0 : 1.0 - qc__turn(1.0, s->segment_turn[symbol]);
}
/* Rotation of the combed map when halfedge h is crossed: f'_t = i^{c_t - m - c_s} f'_s + tau. */
static inline int32_t qc__combed_rotation(const qc_cover *cover, const int8_t *face_turn,
                                          int32_t h) {
    const int32_t g = cover->mesh->twin[h];
    return (face_turn[g / 3] - qc_cover_turn(cover, h) - face_turn[h / 3]) & 3;
}
int32_t qc__seams_component(const qc__seams *s, int32_t symbol);

/* Segments, cones and wedges of a cut, combed cover. index4: n_vertices. */
qc_status qc__seams_create(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                           const int8_t *face_turn, const int32_t *index4, qc__seams **out);
/* Expresses every symbol by free variables on the lattice QC_LATTICE_...; errors: NOMEM, FAILED. */
qc_status qc__seams_solve(qc_ctx *ctx, qc__seams *seams, int32_t lattice);
void qc__seams_free(qc__seams *seams);

/* A chart carried along a path of faces: f_here = i^turn f_start + sum of i^{symbol_turn} symbol.
 */
typedef struct qc__walk {
    int32_t turn, n, capacity;
    int32_t *symbol;
    int8_t *symbol_turn;
} qc__walk;
/* Crosses halfedge h from its own face to the other; false when memory runs out. */
bool qc__walk_cross(qc_ctx *ctx, const qc__seams *seams, qc__walk *walk, int32_t h);
void qc__walk_free(qc__walk *walk);

#endif
