/* Parts of qc_quads_relax, one file each. Not installed. */
#ifndef QC_FINISH_INTERNAL_H
#define QC_FINISH_INTERNAL_H

#include <math.h>
#include <qc/finish.h>

#include "sdk/base/internal.h"
#include "sdk/mesh/internal.h"

/* qc_quads_transfer which also counts the quads with samples in more than one group; *first: the
 * lowest of them, -1 = none. */
qc_status qc__quads_transfer(qc_ctx *ctx, const qc_polygon_mesh *input, const qc_mesh *mesh,
                             const qc_polygon_mesh *quads, qc_polygon_mesh **out, int32_t *n_mixed,
                             int32_t *first);

/* --- neighbours ------------------------------------------------------------------------------ */

/* At most; members of the last class may share faces. */
enum { QC__CLASSES = 64 };

/* Corners around each vertex, and classes of vertices of which no two share a face. */
typedef struct qc__neighbours {
    int32_t *face_start, *face; /* n_vertices + 1, 4 n_faces: corners f * 4 + k at the vertex */
    int32_t n_classes;
    int32_t *class_start, *vertex; /* n_classes + 1, n_vertices: by class, in increasing order */
} qc__neighbours;
qc_status qc__neighbours_create(qc_ctx *ctx, const qc_polygon_mesh *quads, qc__neighbours *out);
void qc__neighbours_clear(qc__neighbours *n);

/* --- curves ---------------------------------------------------------------------------------- */

/* Feature edges of the mesh chained to curves which end at corners: vertices where not two feature
 * edges meet, or two at a sharp angle. Curve c has the halfedges start[c] .. start[c+1]-1 in order,
 * begun at arc length 0. */
typedef struct qc__curves {
    const qc_mesh *mesh;
    int32_t n;
    int32_t *start;      /* n + 1 */
    int32_t *halfedge;   /* each runs along the curve, or against it: then it is ~h        */
    double *arc;         /* arc length where the halfedge begins                            */
    double *length;      /* n: whole length */
    uint8_t *closed;     /* n: ends where it begins, at no corner */
    int32_t *edge_at;    /* n_edges: place in `halfedge`, -1 = no feature     */
    int32_t *edge_curve; /* n_edges: curve, -1 */
    uint8_t *corner;     /* n_vertices of the mesh: 1 at corners */
} qc__curves;
/* feature: n_edges flags, NULL = none; boundary edges are always taken. */
qc_status qc__curves_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *feature,
                            qc__curves *out);
void qc__curves_clear(qc__curves *curves);
/* Mesh vertex at the beginning (end = 0) or end (1) of an open curve. */
int32_t qc__curve_end(const qc__curves *curves, int32_t c, int end);
/* Mesh edge at arc length s of curve c. */
int32_t qc__curve_edge(const qc__curves *curves, int32_t c, double s);
/* The point at arc length s: face, barycentric coordinates there, unit tangent (may be NULL). s is
 * clamped to the curve, or taken modulo its length when it is closed; the value used is returned.
 */
double qc__curve_point(const qc__curves *curves, int32_t c, double s, int32_t *face,
                       double weight[3], double tangent[3]);

/* --- the relaxation -------------------------------------------------------------------------- */

/* Where a vertex is on the surface. */
typedef struct qc__spot {
    double x[3];
    int32_t face;
    double weight[3];
    double arc; /* on a curve: place along it */
} qc__spot;

/* Of a rectangle with edges in the ratio e^{2r}: tanh(2r), 1 / cosh(2r), and half a diagonal over
 * the mean of its edges. */
typedef struct qc__rectangle {
    double skew, turn, half;
} qc__rectangle;

enum { QC__FREE = -1, QC__FIXED = -2 }; /* anchor of a vertex which is on no curve */

typedef struct qc__relaxation {
    const qc_mesh *mesh;
    const qc_polygon_mesh *quads; /* of which only the faces are read */
    double quality, uniformity;
    bool rectangles, angles;
    const qc_closest_point *closest;
    qc_closest_tree *tree;
    qc__neighbours around;
    qc__curves curves;
    double *normal;           /* 3 n_faces of the mesh */
    double *position;         /* 3 n_vertices, spot.x of every vertex */
    qc__spot *spot;           /* n_vertices; x not used */
    int32_t *anchor;          /* n_vertices: curve it slides on, QC__FREE or QC__FIXED */
    double *size;             /* n_faces: edge length of the quads about each quad */
    double *ratio;            /* n_faces: half the logarithm of that of the edges 0 1 and 1 2 of the
                                 rectangle wanted, 0 = a square */
    qc__rectangle *rectangle; /* n_faces: of that ratio */
    double *scratch;          /* n_faces */
    double least;             /* scaled Jacobian below which improvements make no quad */
    uint8_t *pinned;          /* n_vertices: 1 next to the largest gaps between quads and surface */
} qc__relaxation;

/* Which vertices slide on which curve. */
qc_status qc__find_anchors(qc_ctx *ctx, qc__relaxation *r);

/* Largest distance of each quad to the surface, and of the surface to it; gap: n_faces; nearest:
 * the quad nearest to each vertex of the mesh. */
qc_status qc__measure_gaps(qc_ctx *ctx, const qc__relaxation *r, double *gap, int32_t *nearest);
/* That of a quad to the surface. */
double qc__quad_gap(const qc__relaxation *r, int32_t f);
/* Mends the quads which are worse than 0.3 quality, where distances stay within the limit; nearest:
 * of qc__measure_gaps. */
qc_status qc__quads_untangle(qc_ctx *ctx, double limit, const int32_t *nearest, qc__relaxation *r);
/* Moves n vertices to better places in turn; angles: quads may be long; step: n lengths, for its
 * use. */
void qc__quads_descend(qc__relaxation *r, bool angles, int32_t n, const int32_t *vertex,
                       double *step);

/* r->size: mean edge lengths, averaged over neighbours a few times; r->ratio, with r->rectangles,
 * likewise. */
void qc__measure_sizes(qc_ctx *ctx, qc__relaxation *r);
/* The size of the first quad at v. */
static inline double qc__size_at(const qc__relaxation *r, int32_t v) {
    return r->size[r->around.face[r->around.face_start[v]] / 4];
}
/* Mean of the places which the squares (rectangles) closest to its quads give a vertex. */
void qc__square_target(const qc__relaxation *r, int32_t v, double target[3]);

/* Scaled Jacobian. */
static inline double qc__quad_quality(const qc__relaxation *r, int32_t f) {
    return qc__scaled_jacobian(r->position, r->quads->face_vertex + 4 * (int64_t)f, 4);
}
/* Least scaled Jacobian of the quads at v, were v at x. Thread: any, nothing is written. */
double qc__ring_quality(const qc__relaxation *r, int32_t v, const double x[3]);
/* Sum over the quads at v of (1 - scaled Jacobian)^8, likewise. */
double qc__ring_badness(const qc__relaxation *r, int32_t v, const double x[3]);
/* Whether quad f would face away from the surface, with its corner k at x. */
bool qc__quad_turned(const qc__relaxation *r, int32_t f, int k, const double *x);
/* Whether a quad at v would face away from the surface, and more than now, were v at x. */
bool qc__ring_turns(const qc__relaxation *r, int32_t v, const double x[3]);
/* Whether no quad at v gets worse than min(quality, what it is now), and none turns, were v at x.
 */
bool qc__ring_allows(const qc__relaxation *r, int32_t v, const double x[3]);
/* The spot nearest to v's own moved by d; false where the surface there faces away. */
bool qc__step(const qc__relaxation *r, int32_t v, const double d[3], qc__spot *out);
void qc__place(qc__relaxation *r, int32_t v, const qc__spot *spot);
/* Calls body for the vertices of each class in turn, in parallel inside a class. */
typedef void qc__visit(qc__relaxation *r, int32_t v);
qc_status qc__visit_all(qc_ctx *ctx, qc__relaxation *r, qc__visit *visit);

/* Visits: one step towards the squares; searches for a better place next to bad quads, with regard
 * to all quads there, or to the worst. */
void qc__towards_squares(qc__relaxation *r, int32_t v);
void qc__improve_all(qc__relaxation *r, int32_t v);
void qc__improve_worst(qc__relaxation *r, int32_t v);
/* Direction i of n of the search for better places; false where a curve has fewer. */
bool qc__direction(const qc__relaxation *r, int32_t v, int i, int n, double d[3]);

#endif
