/* Shared inside sdk/field: complex numbers, matrices with one unknown per face, reference length.
 */
#ifndef QC_FIELD_INTERNAL_H
#define QC_FIELD_INTERNAL_H

#include "sdk/base/internal.h"
#include "sdk/mesh/internal.h"
#include <qc/field.h>

#include <complex.h>
#include <math.h>

typedef double _Complex qc__cplx;

static inline qc__cplx qc__c(qc_complex a) {
    return a.re + a.im * I;
}
static inline qc_complex qc__z(qc__cplx a) {
    return (qc_complex){creal(a), cimag(a)};
}
static inline qc__cplx qc__unit(qc__cplx a) {
    double square = creal(a) * creal(a) + cimag(a) * cimag(a), r = sqrt(square);
    if (!(square > 1e-280 && square < 1e280)) r = hypot(creal(a), cimag(a));
    return r > 0 ? a / r : 1.0;
}
static inline qc__cplx qc__fourth(qc__cplx a) {
    return (a * a) * (a * a);
}
static inline double qc__arg(qc__cplx a) {
    return atan2(cimag(a), creal(a));
}

#define QC__PI 3.14159265358979323846

/* Pattern of the upper triangle of a matrix coupling each face with its neighbours. The diagonal of
 * column f is entry colptr[f+1] - 1; entry[e] couples the faces s < t of interior edge e (row s,
 * column t), -1 on the boundary. Edges shared by the same two faces share an entry: add to it. */
typedef struct qc__face_pattern {
    int64_t *colptr; /* n_faces + 1 */
    int32_t *row;
    int64_t *entry; /* n_edges */
} qc__face_pattern;
qc_status qc__face_pattern_create(qc_ctx *ctx, const qc_mesh *mesh, qc__face_pattern *out);
void qc__face_pattern_free(qc__face_pattern *pattern);

/* What every energy of a cross field needs (thesis 5.2). */
typedef struct qc__connection {
    qc_complex *edge, *rho; /* 3 n_faces, n_edges: qc_tangent_edges, qc_tangent_transport       */
    double *area;           /* n_faces                                                          */
    double *omega;          /* n_edges: |e|^2 / A_e, A_e = (A_s + A_t) / 3; 0 on the boundary     */
} qc__connection;
qc_status qc__connection_create(qc_ctx *ctx, const qc_mesh *mesh, qc__connection *out);
void qc__connection_free(qc__connection *connection);

/* Length which makes curvatures and areas dimensionless: the edge of one quad when the surface has
 * 10000. It depends on the surface only, so weights mean the same at every scale and resolution. */
static inline double qc__reference_length(const qc_mesh *mesh) {
    return sqrt(mesh->area) / 100;
}

/* a_e = arg(x_t / (rho x_s)), m_e = round(2 a_e / pi), theta_e = a_e - m_e pi / 2
 * (docs/conventions.md). Either output may be NULL; 0 on the boundary. */
void qc__field_match(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *rho, const qc_complex *x,
                     int8_t *m, double *theta);

/* Angle of corner c between its two edges, from the same vectors as the transport, so that sums of
 * angles and theta are multiples of pi/2 up to rounding even in slivers. */
static inline double qc__corner_angle(const qc_complex *edge, int32_t c) {
    return fabs(qc__arg(-qc__c(edge[qc_next(c)]) * conj(qc__c(edge[qc_prev(c)]))));
}

/* Index of an interior vertex in quarters from the theta of its edges: an integer up to rounding.
 */
double qc__vertex_index4(const qc_mesh *mesh, const qc_complex *edge, const double *theta,
                         int32_t p);

/* The matrix (5.4) of the smoothing energy, factorised. It does not depend on the matching. */
typedef struct qc__smoother {
    const qc_mesh *mesh;
    qc__connection c;
    qc__face_pattern pattern;
    double lambda;
    double *pull;   /* n_faces: (1 - lambda) w A / l^2                                        */
    uint8_t *fixed; /* n_faces: 1 = alpha is 0: infinite weight, or one in want of alignment  */
    double *value;  /* of the matrix                                                          */
    double *theta, *alpha;   /* n_edges, n_faces: work space of the solves                    */
    double *matched;         /* n_edges: theta of the next round                              */
    const uint8_t *aligned;  /* n_edges, may be NULL: hard features                           */
    double bend;             /* as in qc_face_field */
    const qc_complex *guide; /* n_faces                                                       */
    qc_factor *factor;
} qc__smoother;
/* Faces whose cross is kept exactly: trusted, of infinite weight (hard features). */
static inline bool qc__kept(const double *weight, const uint8_t *trusted, int32_t t) {
    return weight && isinf(weight[t]) && (!trusted || trusted[t]);
}

qc_status qc__smoother_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                              const uint8_t *trusted, double lambda, qc__smoother *out);
void qc__smoother_free(qc__smoother *smoother);
/* The factor for the present weights c.omega. */
qc_status qc__smoother_factorise(qc_ctx *ctx, qc__smoother *smoother);

/* The energy of cosine_smoothing.c about a field, in units of l^2. */
typedef struct qc__cosine {
    qc__smoother smoother;         /* its omega are the curvatures of the model               */
    double *share;                 /* n_edges: A_e / l^2, 0 on the boundary                   */
    double *alpha, *trial, *slope; /* n_faces                                                 */
} qc__cosine;
qc_status qc__cosine_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                            const uint8_t *trusted, double lambda, const qc_complex *x,
                            qc__cosine *out);
void qc__cosine_free(qc__cosine *cosine);
/* E at the rotations alpha; slope: n_faces, its derivative, 0 at fixed faces. */
double qc__cosine_energy(const qc__cosine *cosine, const double *alpha, double *slope);
/* One step of cosine->alpha; the energy never rises. *changed: it fell by a relevant part
 * of itself. */
qc_status qc__cosine_round(qc_ctx *ctx, qc__cosine *cosine, bool *changed);

/* k in 0..3 such that edge vector e points nearest to i^k x, and how far it is off (radians). */
static inline int32_t qc__axis(qc_complex e, qc_complex x) {
    return (int32_t)lround(2 * qc__arg(qc__c(e) * conj(qc__c(x))) / QC__PI) & 3;
}
static inline double qc__axis_deviation(qc_complex e, qc_complex x) {
    return fabs(qc__arg(qc__fourth(qc__c(e) * conj(qc__c(x)))) / 4);
}

/* Shape operator of a face in its frame, [a b; b d]: larger |eigenvalue| first in kappa[2]. */
qc__cplx qc__principal(double a, double b, double d, double kappa[2]);

/* Signed angle between the normals at each interior edge, positive where convex; 0 on the boundary
 * and where it is rounding noise. normal: 3 n_faces; beta: n_edges. */
void qc__edge_bending(qc_ctx *ctx, const qc_mesh *mesh, const double *normal, double *beta);

/* The two estimators: shape operators as (a, b, d) per face, 3 n_faces. */
qc_status qc__curvature_hildebrandt_polthier(qc_ctx *ctx, const qc_mesh *mesh, const double *normal,
                                             const double *beta, const double *area,
                                             const double *real_axis, const double *imaginary_axis,
                                             double *shape);
qc_status qc__curvature_normal_cycle(qc_ctx *ctx, const qc_mesh *mesh, double radius,
                                     const double *beta, const double *area,
                                     const double *real_axis, const double *imaginary_axis,
                                     double *shape);

static inline void qc__sub(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

#endif
