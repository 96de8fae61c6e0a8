/* qc/field.h - cross fields on faces: curvature, smoothing, matching, indices, files.
 *
 * A cross is one unit complex number x per face in the frame of qc_tangent_edges; X = x, Y = J x. Signs and
 * rounding follow DESIGN 3. All objects are immutable and shared. */
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
    double edge_length;   /* target edge length of a quad, in the units of the mesh                  */
    double target_quads;  /* > 0: the number of quads to be met; 0: edge_length is meant literally    */
    const double *length; /* n_faces, target edge length in each face; NULL = edge_length everywhere  */
} qc_sizing;
QC_API qc_status qc_sizing_create(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                                  double target_quads, const double *length, qc_sizing **out);

typedef struct qc_face_field {
    qc_object object;
    const qc_mesh *mesh;
    const qc_complex *x;   /* n_faces, |x| = 1                                                       */
    const double *weight;  /* optional, n_faces: stability weights (5.2), dimensionless, >= 0          */
    const uint8_t *trusted; /* optional, n_faces: 1 where the direction is to be kept                 */
} qc_face_field;
/* Copies its arrays (weight, trusted may be NULL), normalises x, retains the mesh. ARGUMENT with where =
 * face when x is zero or not finite. */
QC_API qc_status qc_face_field_create(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                      const double *weight, const uint8_t *trusted,
                                      qc_face_field **out);

enum { QC_CURVATURE_HILDEBRANDT_POLTHIER = 0, QC_CURVATURE_COHEN_STEINER_MORVAN = 1 };
/* Principal curvature directions (thesis 5.1.1): x = direction of the larger |curvature|; kappa (2 n_faces,
 * may be NULL) = principal curvatures, that along x first. radius: of the averaging disk, in the units of
 * the mesh (Cohen-Steiner and Morvan only). */
QC_API qc_status qc_field_curvature(qc_ctx *ctx, const qc_mesh *mesh, int32_t estimator,
                                    double radius, qc_complex *x, double *kappa);
/* Stability weights (5.2), made dimensionless by the mean edge length; weight: n_faces. */
QC_API qc_status qc_field_stability(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                    const double *kappa, double *weight);
/* Keeps the `fraction` most stable faces of each component (flags in trusted) and extends their directions
 * to the others breadth first by parallel transport (thesis 5.1.2). x is changed in place. */
QC_API qc_status qc_field_extend(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                 double fraction, qc_complex *x, uint8_t *trusted);
/* Smoothing (5.3), (5.4): rotates each cross by the minimiser of lambda E_S + (1 - lambda) E_A for the
 * matching of x, then re-matches; `rounds` times or until the matching no longer changes. weight and
 * trusted may be NULL (then lambda acts as 1). x in place. */
QC_API qc_status qc_field_smooth(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                 const uint8_t *trusted, double lambda, int32_t rounds,
                                 qc_complex *x);
/* Smoothest field: eigenvector of the smallest eigenvalue of the connection Laplacian on fourth powers x^4 by
 * inverse iteration on its factor. With weight/trusted and alignment > 0: minimiser of the smoothness plus
 * alignment to the trusted directions in x (in: guide, out: field). */
QC_API qc_status qc_field_smoothest(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                    const uint8_t *trusted, double alignment, qc_complex *x);

/* Matching and indices of a cross field (DESIGN 3). */
typedef struct qc_matching {
    qc_object object;
    const qc_face_field *field; /* retained */
    const int8_t *m;            /* n_edges: a = arg(x_t / (rho x_s)), m = round(2 a / pi); 0 on boundary */
    const double *theta;        /* n_edges: a - m pi / 2                                            */
    const int32_t *index4;      /* n_vertices: index in quarters; 0 on the boundary                 */
    int32_t n_singular;         /* interior vertices with index4 != 0                                */
    int32_t index4_sum;         /* = 4 chi on a closed mesh (checked)                               */
} qc_matching;
/* m NULL: the straightest matching; otherwise the given one (n_edges; any turns). FAILED when the indices of
 * a closed mesh do not sum to 4 chi (cannot happen for finite fields). */
QC_API qc_status qc_matching_create(qc_ctx *ctx, const qc_face_field *field, const int8_t *m,
                                    qc_matching **out);

/* Directional's .rawfield (`N F`, then N vectors a face) and .rosy (F, N, one vector a face), recognised by
 * content. Vectors are projected to the face. Errors: IO; INPUT with the line or face (wrong counts, N not
 * 4 (or 2, 1 for .rosy with N = 4), zero or non-finite vector). field->mesh = mesh, whose source_face maps
 * its faces to those of the file when present. */
QC_API qc_status qc_face_field_read(qc_ctx *ctx, const qc_mesh *mesh, const char *path,
                                    qc_face_field **out);
/* Writes .rosy when the path ends so, else .rawfield, in the mesh's own face order, through a temporary. */
QC_API qc_status qc_face_field_write(qc_ctx *ctx, const qc_face_field *field, const char *path);

#ifdef __cplusplus
}
#endif
#endif
