/* Cross fields as sections z = x^4 of the fourth power of the tangent bundle (Knoeppel, Crane,
 * Pinkall, Schroeder, "Globally optimal direction fields" (2013)) with the weights of thesis (5.3):
 *     A = sum_e omega_e |z_t - rho^4 z_s|^2,   M = diag(A_t / l^2),   W = diag(w_t A_t / l^2). */
#ifndef QC_FIELD_POWER_SYSTEM_H
#define QC_FIELD_POWER_SYSTEM_H

#include "internal.h"

typedef struct qc__power_system {
    const qc_mesh *mesh;
    qc__connection c;
    qc__face_pattern pattern;
    qc_complex *value;       /* of the matrix last filled                                      */
    double *mass, *pull;     /* n_faces: M, t W                                                */
    double *stiff, *heavy;   /* n_components: traces of A and of M                             */
    uint8_t *aligned;        /* n_components: enough alignment to make A + t W definite         */
    uint8_t *kept;           /* n_faces: infinite weight, z = guide^4 is no unknown             */
    qc__cplx *z, *work;      /* n_faces                                                        */
    double *norm, *mu, *old; /* n_components; mu: Rayleigh quotient of z                       */
    qc_symbolic *symbolic;
    qc_factor *factor;
} qc__power_system;

/* trusted, weight: as in qc_field_smoothest. On error free as well. */
qc_status qc__power_create(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                           const uint8_t *trusted, double alignment, qc__power_system *s);
void qc__power_free(qc__power_system *s);

/* value = A + t W + diagonal of (shift M trace(A) / trace(M) in components without alignment,
 * inertia M everywhere). */
void qc__power_fill(qc__power_system *s, double shift, double inertia);
/* work += what the kept faces contribute to the equations of their neighbours; work = z there. */
void qc__power_add_kept(qc__power_system *s, const qc_complex *guide);
/* Factor of the matrix last filled. */
qc_status qc__power_factorise(qc_ctx *ctx, qc__power_system *s);

/* z = eigenvector of the smallest eigenvalue of A z = mu M z in each component without alignment,
 * of M-norm one. Needs the factor of a slightly shifted matrix. */
qc_status qc__power_eigenvector(qc_ctx *ctx, qc__power_system *s);

#endif
