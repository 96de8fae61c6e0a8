/* qc/field.h - cross fields on faces: curvature, smoothing, matching, indices, files.
 *
 * A cross is one unit complex number x per face in the frame of qc_tangent_edges; X = x, Y = J x.
 * Signs and rounding follow docs/conventions.md. All objects are immutable and shared. */
#ifndef QC_FIELD_H
#define QC_FIELD_H

#include <qc/dec.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_TYPE_SIZING     "qc.sizing/1"
#define QC_TYPE_FACE_FIELD "qc.face_field/1"
#define QC_TYPE_MATCHING   "qc.matching/1"

/* How dense the quads are to be. */
typedef struct qc_sizing {
    qc_object object;
    const qc_mesh *mesh;
    double edge_length;  /* target edge length of a quad, in the units of the mesh  */
    double target_quads; /* > 0: the number of quads to be met; 0: edge_length is meant literally */
    const double
        *length; /* n_faces, target edge length in each face; NULL = edge_length everywhere  */
    const qc_complex *stretch; /* optional, n_faces: lengths depend on the direction, see below */
} qc_sizing;
QC_API qc_status qc_sizing_create(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                                  double target_quads, const double *length, qc_sizing **out);
/* Gives a sizing which is not yet shared two lengths in each face: with stretch[t] = 1/2 log(a/b)
 * d^2, d a unit complex number in the frame of qc_tangent_edges, edges along d are to have length
 * a, those across it length b, and `length` is sqrt(a b). A cross x has the lengths h e^s along x
 * and h e^-s across, s = Re(stretch conj(x)^2): a quarter turn of x swaps them, and the area of a
 * quad is h^2 whatever x is. Copied. Errors: ARGUMENT (where = face: not finite, or a ratio above
 * 1e4), NOMEM. */
QC_API qc_status qc_sizing_set_stretch(qc_ctx *ctx, qc_sizing *sizing, const qc_complex *stretch);

typedef struct qc_size_options {
    uint32_t struct_size;
    double edge_length; /* where nothing else is said, in the units of the mesh                 */
    double turn;        /* radians; > 0: edges shrink so that the surface turns by at most so much
                           along them                                                           */
    double range;       /* factor, >= 1, by which curvature and paint change a length at most   */
    double gradation; /* lengths grow by at most this times the way on the surface; 0 = no limit */
    bool painted;     /* the vertex attribute "quality" multiplies the number of quads on an area */
    const char *path; /* text: a length for each vertex, or for each face, of the input, or five
                         numbers: a length along a direction, that across, the direction; NULL =
                         none */
    const qc_polygon_mesh
        *input;        /* which the mesh's source numbers count; NULL = the mesh itself */
    double anisotropy; /* >= 1: the most by which edges in the direction of least curvature are
                          longer than those across */
} qc_size_options;
#define QC_SIZE_OPTIONS_INIT                                                                       \
    { sizeof(qc_size_options), 0, 0, 4, 0.25, false, NULL, NULL, 1 }
/* A sizing whose length changes over the surface or depends on the direction
 * (stages/size/size.md). With target_quads > 0 all lengths are scaled to ask for that many. Errors:
 * ARGUMENT (a number out of range, no paint), IO, INPUT (where = line: not a positive number, no
 * direction; a number of lengths which fits neither vertices nor faces), NOMEM, CANCELLED. */
QC_API qc_status qc_sizing_create_varying(qc_ctx *ctx, const qc_mesh *mesh, double target_quads,
                                          const qc_size_options *options, qc_sizing **out);

typedef struct qc_face_field {
    qc_object object;
    const qc_mesh *mesh;
    const qc_complex *x;    /* n_faces, |x| = 1    */
    const double *weight;   /* optional, n_faces: stability weights (5.2), dimensionless, >= 0;
                               infinite = the direction is kept exactly (in trusted faces)   */
    const uint8_t *trusted; /* optional, n_faces: 1 where the direction is to be kept */
    const uint8_t *aligned; /* optional, n_edges: 1 on hard features, which isolines have to follow;
                               a direction of the cross runs along such an edge on either side */
    int32_t
        is_vector; /* 1: x of one face goes with x of its neighbours (the gradient of a function),
                      so that no edge has a quarter turn; set it before the field is shared */
    double bend;   /* of the features it is aligned to (qc_features) */
} qc_face_field;
/* Copies its arrays (weight, trusted may be NULL), normalises x, retains the mesh. ARGUMENT with
 * where = face when x is zero or not finite. */
QC_API qc_status qc_face_field_create(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                      const double *weight, const uint8_t *trusted,
                                      qc_face_field **out);
/* Declares the flagged edges (n_edges, copied) hard features of a field which is not yet shared.
 * ARGUMENT with where = edge when the cross of a face beside it is more than 1e-6 off the edge. */
QC_API qc_status qc_face_field_set_aligned(qc_ctx *ctx, qc_face_field *field, const uint8_t *edge,
                                           double bend);

enum { QC_CURVATURE_HILDEBRANDT_POLTHIER = 0, QC_CURVATURE_COHEN_STEINER_MORVAN = 1 };
/* Principal curvature directions (thesis 5.1.1): x = direction of the larger |curvature|; kappa (2
 * n_faces, may be NULL) = principal curvatures, that along x first. radius: of the averaging disk,
 * in the units of the mesh (Cohen-Steiner and Morvan only); it shrinks where the disk would hold
 * more than 200 faces. */
QC_API qc_status qc_field_curvature(qc_ctx *ctx, const qc_mesh *mesh, int32_t estimator,
                                    double radius, qc_complex *x, double *kappa);
/* Changes the function g (n_vertices) on its low hills and hollows, where the way from the extremum
 * to the saddle beside it is less than `persistence` (0..1) times the range of g: they are filled
 * by a function with the mean value property and lose their extremum. *removed (may be NULL) counts
 * them; what stays is a warning. Elsewhere g keeps its values. Errors: ARGUMENT (where = vertex: g
 * is not finite; persistence), NOMEM, CANCELLED. */
QC_API qc_status qc_scalar_simplify(qc_ctx *ctx, const qc_mesh *mesh, double persistence, double *g,
                                    int32_t *removed);
/* The gradient of the piecewise linear function g (n_vertices): x = grad g / |grad g|, weight =
 * |grad g| over its maximum (each n_faces). Where it is below 1e-6 the weight is 0, trusted
 * (n_faces) too, and x is transported from the faces around. ARGUMENT with where = vertex when g is
 * not finite. */
QC_API qc_status qc_field_gradient(qc_ctx *ctx, const qc_mesh *mesh, const double *g, qc_complex *x,
                                   double *weight, uint8_t *trusted);
/* Stability weights (5.2): |k1 - k2| l exp(-1/2 sum |theta|) with l = sqrt(mesh->area) / 100, the
 * edge of one quad of 10000: pure numbers which depend on the surface, not on its scale or
 * resolution. weight: n_faces; kappa: 2 n_faces. */
QC_API qc_status qc_field_stability(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                    const double *kappa, double *weight);
/* Weights of the 2007 paper (4.3): |k1 - k2| / sqrt(k1^2 + k2^2), 0 where both vanish; between 0
 * and sqrt(2) at every scale, however weak the curvature. weight: n_faces; kappa: 2 n_faces. */
QC_API void qc_field_anisotropy(const qc_mesh *mesh, const double *kappa, double *weight);
/* Turns the cross of each face with a feature edge along that edge, trusts it and raises its weight
 * to `strength`: soft alignment to creases and boundaries; INFINITY = hard alignment, which
 * smoothing, separation and optimisation keep exactly. edge: n_edges flags as in qc_features,
 * nonzero = feature; NULL = the boundary. x, weight, trusted (n_faces each) are changed in place at
 * these faces. A face with several feature edges follows one of them or their mean: split the mesh
 * first (qc_features_split). */
QC_API qc_status qc_field_align(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                double strength, qc_complex *x, double *weight, uint8_t *trusted);
/* Turns the cross of each face whose lengths depend on the direction, by a ratio of 1.1 and more,
 * to these directions, trusts it and raises its weight to strength log2(ratio), at most
 * `strength`. x, weight, trusted (n_faces each) are changed in place at these faces. */
QC_API void qc_field_align_stretch(const qc_sizing *sizing, double strength, qc_complex *x,
                                   double *weight, uint8_t *trusted);
/* A copy of a given field with hard features: of the flagged edges (n_edges) those whose chain
 * (qc_features_chains) the field follows within `tolerance` (radians) on nine tenths of its length;
 * the crosses beside them are turned the rest of the way. How many chains were left out is a
 * warning. */
QC_API qc_status qc_field_follow(qc_ctx *ctx, const qc_face_field *field, const uint8_t *edge,
                                 double tolerance, qc_face_field **out);
/* Keeps the most stable faces of each component which make up `fraction` of its area, and those
 * already flagged in trusted (in and out: clear it first), and extends their directions to the
 * other faces breadth first by parallel transport (thesis 5.1.2). Faces of weight < 1e-6 are flat
 * and never kept; a component without any kept face starts from its boundary edges, else from its
 * first edge. x is changed in place. */
QC_API qc_status qc_field_extend(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                 double fraction, qc_complex *x, uint8_t *trusted);
/* Smoothing (5.3), (5.4): rotates each cross by the minimiser of lambda E_S + (1 - lambda) E_A for
 * the matching of x, then re-matches; `rounds` times or until the matching no longer changes. E_A
 * pulls the trusted faces towards guide (NULL = the x given) with w_t A_t / l^2 (l as in
 * qc_field_stability). weight NULL = 1; trusted NULL = all faces; both NULL: lambda acts as 1. x in
 * place. Faces of infinite weight are no unknowns and stay to the last bit. aligned (n_edges
 * flags, may be NULL): hard features, beside which faces have infinite weight; the matching then is
 * that of qc_matching_create with open sectors and corners within `bend`, as in qc_face_field. The
 * result is a local minimum: start from qc_field_smoothest with alignment (1 - lambda) / lambda for
 * few singularities. Errors: ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_field_smooth(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *guide,
                                 const double *weight, const uint8_t *trusted,
                                 const uint8_t *aligned, double bend, double lambda, int32_t rounds,
                                 qc_complex *x);
/* Nonlinear smoothing (2007 paper, 4.3): rotates the crosses by real alpha_t which minimise lambda
 * sum A_e (1 - cos 4 (theta_e - alpha_s + alpha_t)) + (1 - lambda) sum w_t A_t alpha_t^2, the
 * second sum over the trusted faces; at most so many rounds, in none of which the energy rises.
 * Unlike qc_field_smooth lambda acts per edge of the mesh: details of about 3 sqrt(lambda / ((1 -
 * lambda) w)) edges are smoothed away. weight, trusted NULL as there; both NULL: lambda acts as 1.
 * x in place; a local minimum. Errors: ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_field_smooth_cosine(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                        const uint8_t *trusted, double lambda, int32_t rounds,
                                        qc_complex *x);
/* Smoothest field: in each component the eigenvector of the smallest eigenvalue of the connection
 * Laplacian on fourth powers x^4, by inverse iteration on its factor. With alignment > 0 and weight
 * or trusted given: minimiser of E_S(x^4) + alignment sum w_t A_t / l^2 |x^4 - guide^4|^2 over the
 * trusted faces (in: guide, out: field); components without any trusted face get the eigenvector.
 * Faces of infinite weight stay to the last bit, whatever alignment is.
 * detail > 0, a length in the units of the mesh: then gradient flow with |x| = 1 kept, which closes
 * pairs of singularities nearer than about that; 0 = off. Errors: ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_field_smoothest(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                    const uint8_t *trusted, double alignment, double detail,
                                    qc_complex *x);

/* Solves again without alignment around crowded vertices: those of index4 >= 2 or <= -3, and
 * opposite singularities nearer than `distance` (units of the mesh; 0 = none) or, within twice
 * that, on one edge. Region by region a result is kept when it is less crowded; its faces lose
 * their flag in trusted (n_faces, in and out, may be NULL). Then indices which stayed are shared
 * at the price of such pairs, and a pair of 1/4 and -1/4 which is alone on a torus cancels.
 * Vertices whose index stays are named by a warning; *left (may be NULL) counts them. Faces beside
 * hard features (aligned: n_edges flags, may be NULL) stay, and the vertices on these do not count.
 * x in place. Errors: ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_field_separate(qc_ctx *ctx, const qc_mesh *mesh, double distance,
                                   const uint8_t *aligned, uint8_t *trusted, qc_complex *x,
                                   int32_t *left);

/* Matching and indices of a cross field (docs/conventions.md). */
typedef struct qc_matching {
    qc_object object;
    const qc_face_field *field; /* retained */
    const int8_t *m;     /* n_edges: a = arg(x_t / (rho x_s)), m = round(2 a / pi); 0 on boundary */
    const double *theta; /* n_edges: a - m pi / 2                                            */
    const int32_t *index4; /* n_vertices: index in quarters; 0 on the boundary                 */
    const int8_t *axis;    /* optional, n_edges: -1, or on hard features k in 0..3: the halfedge
                              edge_halfedge[2 e] runs along i^k x_s in its face s              */
    int32_t n_singular;    /* interior vertices with index4 != 0, and poles                     */
    int32_t index4_sum;    /* = 4 chi on a closed mesh (checked)                               */
    const int32_t *pole_index4; /* mesh->n_poles: their indices; NULL = unknown */
} qc_matching;
/* m NULL: the straightest matching, without quarter turns for a vector field; otherwise the given
 * one (n_edges; any turns). Where the field has hard features, each sector between two of them at a
 * vertex gets at least one quarter turn, and a number within one of its angle, if need be by turns
 * at edges inside the sector beyond pi/4 (m NULL only); FAILED with where = vertex when it has no
 * such edge. FAILED when the indices of a closed mesh do not sum to 4 chi (cannot happen for finite
 * fields). */
QC_API qc_status qc_matching_create(qc_ctx *ctx, const qc_face_field *field, const int8_t *m,
                                    qc_matching **out);

/* Makes room for fields. Where features are hard, bisects every other edge both of whose ends are
 * on them, and all edges of faces with three feature edges, until there is none; then no face has
 * two feature edges, and each side of a feature has a row of faces which are free to turn. Bisects
 * the edges opposite interior vertices off hard features whose index, by curvature and valence,
 * could not come to lie from -2/4 to 1/4, until there is none. Halves of features are features;
 * source_face and source_vertex as in qc_matching_split. Nothing to split: the same objects,
 * retained. sizing, sizing_out may both be NULL. Errors:
 * ARGUMENT (sizing of another mesh), NOMEM, CANCELLED. */
QC_API qc_status qc_features_split(qc_ctx *ctx, const qc_features *features,
                                   const qc_sizing *sizing, qc_mesh **mesh,
                                   qc_features **features_out, qc_sizing **sizing_out);

/* Bisects every edge between two cones (vertices of index4 != 0) which is no hard feature, or
 * between a cone and a hard feature, and the link of interior vertices whose triangles are too few
 * for their angle (valence <= (4 - index4) / 2); of vertices on hard features that of the sectors
 * which have too few for theirs: a piecewise linear map with the cones on lattice points and the
 * features on isolines would have to fold there. Faces stay in their plane with their cross,
 * weight, flag and length; old vertices keep their numbers and indices, midpoints have index 0.
 * source_face and source_vertex as of the old mesh (its own numbers when it has none), -1 at
 * midpoints. Nothing to split: the same objects, retained. Errors: ARGUMENT (sizing of another
 * mesh), NOMEM, CANCELLED. */
QC_API qc_status qc_matching_split(qc_ctx *ctx, const qc_matching *matching,
                                   const qc_sizing *sizing, qc_mesh **mesh, qc_sizing **sizing_out,
                                   qc_matching **matching_out);

/* Cuts the star of every vertex of positive integer index open (Algorithm 1 of the second paper,
 * lines 1 to 7): each of its faces gets a tip of its own there (mesh->n_poles, pole_corner). Rings
 * of vertices on the edges of the star are inserted before, so that poles share no vertex with
 * another one or the boundary and the star is not larger than half a quad: mesh lies on the same
 * surface. Old vertices keep their numbers, a pole that of its first tip. source_face as of the old
 * mesh; source_vertex of tips is that of the pole, of ring vertices -1. No pole: the same objects,
 * retained. largest: index that is opened, usually 1 (docs/theory/poles.md). Errors: ARGUMENT
 * (sizing of another mesh; where = vertex: two poles are neighbours, run qc_matching_split before),
 * FAILED (where = vertex: of larger index), NOMEM, CANCELLED. */
QC_API qc_status qc_matching_open(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                                  int32_t largest, qc_mesh **mesh, qc_sizing **sizing_out,
                                  qc_matching **matching_out);

/* Directional's .rawfield (`N F`, then N vectors a face) and .rosy (F, N, then one vector a face),
 * recognised by content; N = 4 (N = 1 or 2 also make a cross). Vectors are projected to the face;
 * four of them are averaged as fourth powers. F and the order are those of the file the mesh came
 * from: faces are looked up through mesh->source_face when present. path "-" = stdin. Errors: IO;
 * INPUT with where = line: wrong counts, other N, not a number, a vector which is zero in its face.
 */
QC_API qc_status qc_face_field_read(qc_ctx *ctx, const qc_mesh *mesh, const char *path,
                                    qc_face_field **out);
/* Writes .rosy when the path ends so, else .rawfield, in the mesh's own face order, through a
 * temporary. */
QC_API qc_status qc_face_field_write(qc_ctx *ctx, const qc_face_field *field, const char *path);

#ifdef __cplusplus
}
#endif
#endif
