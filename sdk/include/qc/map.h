/* qc/map.h - seamless and integer-grid maps: corner values, seams, exact grids, distortion.
 *
 * A map gives every corner of every face a parameter f = u + i v; integer isolines are the edges of
 * the quads. Across an interior edge from s (lower index) to t: f_t = i^r f_s + tau, with r = -m.
 */
#ifndef QC_MAP_H
#define QC_MAP_H

#include <qc/closest_point.h>
#include <qc/field.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_TYPE_SEAMLESS_MAP "qc.seamless_map/1"
#define QC_TYPE_CORNER_MAP   "qc.corner_map/1"
#define QC_TYPE_REPORT       "qc.report/1"

/* A locally integrable field and its integral on the cut surface: translations are still real. */
typedef struct qc_seamless_map {
    qc_object object;
    const qc_matching *matching; /* retained */
    const qc_sizing *sizing;     /* retained */
    const qc_complex *z;     /* 3 n_faces: curl-free form, gauge of the faces                   */
    const uint8_t *cut;      /* n_edges: 1 on the cut graph                                     */
    const int8_t *face_turn; /* n_faces: combing (qc_cover_comb) of the cut surface              */
    const qc_complex *f;     /* 3 n_faces: integral, combed gauge                                */
    const double *weight;    /* optional, n_faces: stiffness of the faces, >= 1                  */
    double field_energy;     /* 1/2 int |X|^2 + |Y|^2 of the frame field with density            */
    double curl_energy;      /* E_D                                                             */
} qc_seamless_map;

typedef struct qc_hodge_options {
    uint32_t struct_size;
    int32_t stiffening; /* rounds, at most, which raise the weight of folded faces and solve again
                           while a cone winds the wrong number of times; 0 = none */
    const qc_solver *solver; /* factorises L*; borrowed for the call, NULL = builtin */
} qc_hodge_options;
#define QC_HODGE_OPTIONS_INIT                                                                      \
    { sizeof(qc_hodge_options), 12, NULL }
/* The Hodge step (thesis 4.1): scales the cross field by 1/length, removes its curl with the
 * complex matrix L*, cuts the surface by the shortest cut graph based at the singularities and
 * integrates. Errors: NOMEM, CANCELLED, ARGUMENT (matching and sizing of different meshes), FAILED
 * (where = face: the factorisation or the integration broke down). */
QC_API qc_status qc_seamless_map_create(qc_ctx *ctx, const qc_matching *matching,
                                        const qc_sizing *sizing, const qc_hodge_options *options,
                                        qc_seamless_map **out);

/* Parameters at corners; after rounding an integer-seamless map. */
typedef struct qc_corner_map {
    qc_object object;
    const qc_mesh *mesh; /* retained */
    const double *uv; /* 6 n_faces: u, v of corner 3t+k                                          */
    double edge_length;      /* length in space of one parameter unit; 0 = unknown      */
    const qc_complex *cross; /* optional, n_faces: directions the map was to follow (tangent frame),
                                in the gauge of the map: grad u ~ cross / edge_length */
    const int8_t *rotation;  /* optional, n_edges: r of f_t = i^r f_s + tau where it is known  */
    const int8_t *axis;    /* optional, n_edges: -1, or on hard features k in 0..3: the image of the
                              halfedge edge_halfedge[2 e] in the chart of its face s runs along i^k,
                              on an isoline                                                        */
    const double *relaxed; /* optional, 6 n_faces: the map before rounding, in the same charts:
                              where   untangling starts from   */
    double field_energy, curl_energy; /* as in qc_seamless_map; 0 = unknown           */
    double harmonic_energy, harmonic_energy_direct; /* E_H reached, and by direct rounding */
    int64_t iterations, evaluations; /* of the rounding search                      */
} qc_corner_map;
/* Copies uv and cross (may be NULL), retains the mesh; energies are zero. */
QC_API qc_status qc_corner_map_create(qc_ctx *ctx, const qc_mesh *mesh, const double *uv,
                                      double edge_length, const qc_complex *cross,
                                      qc_corner_map **out);
/* Attaches the rotations of the transitions (n_edges, copied) to a map which is not yet shared:
 * collapsed edges do not tell them. */
QC_API qc_status qc_corner_map_set_rotation(qc_ctx *ctx, qc_corner_map *map,
                                            const int8_t *rotation);
/* Attaches the hard features (n_edges, copied) to a map which is not yet shared. */
QC_API qc_status qc_corner_map_set_axis(qc_ctx *ctx, qc_corner_map *map, const int8_t *axis);
/* Attaches the map before rounding (6 n_faces, copied) to a map which is not yet shared. */
QC_API qc_status qc_corner_map_set_relaxed(qc_ctx *ctx, qc_corner_map *map, const double *uv);
/* The map as a polygon mesh with one vt per corner, and back: faces of `soup` must be triangles
 * with uvs. Each face at a pole becomes a quad with two vertices there, in which the map is
 * bilinear (Fig. 6 and (3) of the second paper); back, its tip is mapped between the two. */
QC_API qc_status qc_corner_map_to_polygons(qc_ctx *ctx, const qc_corner_map *map,
                                           qc_polygon_mesh **out);
QC_API qc_status qc_corner_map_from_polygons(qc_ctx *ctx, const qc_polygon_mesh *soup,
                                             qc_corner_map **out);

/* --- rounding (thesis 4.2, 6.3) --------------------------------------------------------------- */

enum {
    QC_LATTICE_QUADS = 0,   /* cones on lattice points, translations any integers: only quads   */
    QC_LATTICE_INTEGER = 1, /* translations integers, cones may fall on half-integers (4.2.2 a) */
    QC_LATTICE_EVEN = 2 /* translations even integers (4.2.2 b)                                  */
};
enum {
    QC_QUANTIZE_NEVER = 0,
    QC_QUANTIZE_WHERE_NEEDED = 1, /* where rounding leaves points or features in one place, winds
                                     cones wrong, or folds over between features */
    QC_QUANTIZE_ALWAYS = 2
};
typedef struct qc_round_options {
    uint32_t struct_size;
    int32_t lattice; /* QC_LATTICE_... */
    int32_t start;  /* QC_ROUND_DIRECT or QC_ROUND_GREEDY                                         */
    int32_t radius; /* 0..3, see qc_lattice_options                                               */
    double tolerance;        /* of the number of quads when the sizing asks for one; 0 = 0.02 */
    const qc_solver *solver; /* factorises L; borrowed for the call, NULL = builtin    */
    uint64_t seed;           /* of the lattice search; another one may give other integers */
    int32_t trial;           /* 1: only the energies are of interest; logs no warnings */
    double refine;           /* quads wanted, in units of what the sizing asks for; 0 = 1 */
    int32_t quantize;        /* QC_QUANTIZE_...: integers for which an injective map exists */
} qc_round_options;
#define QC_ROUND_OPTIONS_INIT                                                                      \
    { sizeof(qc_round_options), 0, QC_ROUND_GREEDY, 3, 0.02, NULL, 0, 0, 1.0, 1 }
/* Rounds the periods to a lattice by the period matrix (Sigma trick, 6.3.2) and adds the harmonic
 * map with the missing periods. Hard features of the matching become integer isolines. When the
 * sizing asks for a number of quads the map is rescaled and rounded again until its area meets it,
 * or a larger number (a warning) where no integers keep cones and features apart. Quantization
 * (docs/theory/quantization.md) needs a map before rounding which is positive, QC_LATTICE_QUADS and
 * no poles; elsewhere `quantize` is without effect. Errors: NOMEM, CANCELLED, FAILED (where =
 * vertex: hard features leave no room), those of the solver. */
QC_API qc_status qc_map_round(qc_ctx *ctx, const qc_seamless_map *seamless,
                              const qc_round_options *options, qc_corner_map **out);

/* --- exact grid (docs/theory/exact-grid.md) */

/* An integer-seamless map on a fixed-point grid, exact: coordinates are integers in units of
 * 2^-bits, all transitions hold to the last bit, |coordinate| < 2^30 so that orientations fit
 * int64. */
typedef struct qc_grid_map {
    qc_object object;
    const qc_mesh *mesh;
    int32_t bits;           /* grid unit = 2^-bits                                              */
    const int32_t *uv;      /* 6 n_faces                                                        */
    const int8_t *rotation; /* n_edges: r in 0..3, f_t = i^r f_s + translation; 0 on the boundary */
    const int32_t *translation; /* 2 n_edges, integers (parameter units) */
    const int8_t *holonomy; /* n_vertices: quarter turns of the transitions met going once around
                               counter-clockwise; 0 on the boundary                              */
    int32_t n_flipped, n_degenerate; /* faces with negative / zero orientation */
    int32_t first_flipped; /* a face, -1 = none                                                */
    const int8_t *axis;    /* optional, n_edges: features as in qc_corner_map; their level, the
                              coordinate across i^k, is an integer, the same at both ends        */
} qc_grid_map;
#define QC_TYPE_GRID_MAP "qc.grid_map/1"
/* Finds the transition of every edge, rounds one representative a vertex, writes the other corners
 * through the transitions. Features keep their isoline; where they turn, branch or end is a lattice
 * point. A map which does not tell its features (axis NULL) gets the boundary loops which lie on
 * isolines. Errors: FAILED naming edge and amount when a seam or the level of a feature is not
 * integer to within `tolerance` (parameter units; 0 = 0.05), or naming the vertex when transitions
 * around it are inconsistent or its fixed point is not a lattice point. */
QC_API qc_status qc_grid_map_create(qc_ctx *ctx, const qc_corner_map *map, double tolerance,
                                    qc_grid_map **out);
/* The same map in doubles (exact), keeping cross, edge_length and energies of `like` (may be NULL).
 * Its rotation and axis are those of the grid. */
QC_API qc_status qc_grid_map_to_corner_map(qc_ctx *ctx, const qc_grid_map *grid,
                                           const qc_corner_map *like, qc_corner_map **out);
/* Twice the signed area of face t in grid units; exact. */
static inline int64_t qc_grid_map_orientation(const qc_grid_map *g, int32_t t) {
    const int32_t *p = g->uv + 6 * (int64_t)t;
    const int64_t ax = (int64_t)p[2] - p[0], ay = (int64_t)p[3] - p[1];
    const int64_t bx = (int64_t)p[4] - p[0], by = (int64_t)p[5] - p[1];
    return ax * by - ay * bx;
}

/* --- injectivity (docs/theory/untangling.md) */

typedef struct qc_untangle_options {
    uint32_t struct_size;
    int32_t max_rounds; /* outer rounds (epsilon)                                               */
    int32_t max_iterations; /* L-BFGS iterations a round */
    int32_t relax; /* steps which even out what was moved or is distorted, every face staying
                      positive; 0 = none */
} qc_untangle_options;
#define QC_UNTANGLE_OPTIONS_INIT                                                                   \
    { sizeof(qc_untangle_options), 20, 200, 50 }
/* Moves the parameters, keeping all transitions, features and lattice points, until every face is
 * positively oriented by the exact test or the work reaches a bound in proportion to the mesh. *out
 * is the best map found, its remaining fold-overs in n_flipped / n_degenerate of a
 * qc_grid_map_create. */
QC_API qc_status qc_map_untangle(qc_ctx *ctx, const qc_corner_map *map,
                                 const qc_untangle_options *options, qc_corner_map **out);

/* --- extraction (stages/extract/extract.md) */

/* Quads of an exact integer-grid map: manifold, oriented, only quads, Euler characteristic of the
 * mesh on closed surfaces and its number of boundary loops otherwise, the holes of poles closed
 * with quads (docs/theory/poles.md), no duplicate faces; or FAILED naming place and count. *out
 * carries source faces and barycentrics. */
QC_API qc_status qc_map_extract(qc_ctx *ctx, const qc_grid_map *grid, qc_polygon_mesh **out);

/* --- report ----------------------------------------------------------------------------------- */

/* Figures of a run as sums, so that the reports of components add up (qc_report_add). Ratios are
 * made when the report is printed. */
typedef struct qc_report {
    qc_object object;
    struct {
        int64_t vertices, faces, genus, boundaries, components;
    } input;
    struct {
        double edge_length, target_quads;
    } density;
    struct {
        int64_t singularities, index4[17];
    } field; /* index4[8 + i] counts index i/4          */
    struct {
        double field, curl, harmonic, harmonic_direct;
        int64_t iterations, evaluations;
    } energy;
    struct {
        int64_t flipped, degenerate;
        double max_seam_error, arap_sum, area;
    } uv;
    struct {
        int64_t vertices, faces, non_quads, irregular, euler, components, boundaries;
        double edges, edge_sum, edge_sum2, corners, angle_sum, angle_sum2; /* angles in radians */
        double hausdorff, distance_sum, distance_samples, diagonal; /* lengths                 */
        double min_scaled_jacobian;
        int64_t feature_edges;   /* lines of the quads                                           */
        double feature_distance; /* two-sided, of their ends and the vertices of the features    */
    } quads;
    double mirror[4]; /* normal and offset of the plane at which a half was mirrored; 0 = none */
} qc_report;
QC_API qc_status qc_report_create(qc_ctx *ctx, qc_report **out); /* zeroes */
QC_API void qc_report_add(qc_report *sum, const qc_report *part);
/* Fills in what the given objects tell; each may be NULL. quads against mesh gives the distances
 * (sampled at quad vertices, edge midpoints and face centres, and mesh vertices) by `closest` (NULL
 * = builtin). */
QC_API qc_status qc_report_measure(qc_ctx *ctx, const qc_mesh *mesh, const qc_sizing *sizing,
                                   const qc_matching *matching, const qc_corner_map *map,
                                   const qc_polygon_mesh *quads, const qc_closest_point *closest,
                                   qc_report *report);

#ifdef __cplusplus
}
#endif
#endif
