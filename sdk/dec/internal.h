/* Kernels of sdk/dec shared between its files, and complex arithmetic on qc_complex. */
#ifndef QC_DEC_INTERNAL_H
#define QC_DEC_INTERNAL_H

#include <complex.h>

#include <qc/dec.h>

#include "sdk/base/internal.h"

static inline double _Complex qc__load(qc_complex a) {
    const union {
        qc_complex pair;
        double _Complex number;
    } u = {a};
    return u.number;
}
static inline qc_complex qc__store(double _Complex a) {
    const qc_complex z = {creal(a), cimag(a)};
    return z;
}
static inline qc_complex qc__sub(qc_complex a, qc_complex b) {
    const qc_complex z = {a.re - b.re, a.im - b.im};
    return z;
}
static inline qc_complex qc__add(qc_complex a, qc_complex b) {
    const qc_complex z = {a.re + b.re, a.im + b.im};
    return z;
}
static inline qc_complex qc__scale(double s, qc_complex a) {
    const qc_complex z = {s * a.re, s * a.im};
    return z;
}

/* The midpoint value v_e, which lives in the gauge of s, is i^{turn} v_e in the face of h. */
static inline int32_t qc__edge_turn(const qc_cover *cover, int32_t h) {
    const qc_mesh *m = cover->mesh;
    return m->edge_halfedge[2 * m->halfedge_edge[h]] == h ? 0 : qc_cover_turn(cover, h);
}

/* Cotangents of a mesh, 3 n_faces; NULL when memory runs out. */
double *qc__cotangents(qc_ctx *ctx, const qc_mesh *mesh);

/* z = grad f for corner values f_c = i^{corner_turn[c]} F_v. */
void qc__gradient(const qc_mesh *mesh, const int8_t *corner_turn, const qc_complex *F,
                  qc_complex *z);
/* out = z - J grad v (in place allowed) for the non-conforming v. */
void qc__subtract_rotation(const qc_cover *cover, const double *cotangent, const qc_complex *v,
                           const qc_complex *z, qc_complex *out);
/* Weak divergence with the gauge given; zero where branch[v] != 0 (NULL = nowhere). */
void qc__divergence(const qc_mesh *mesh, const double *cotangent, const int8_t *corner_turn,
                    const int8_t *branch, const qc_complex *z, qc_complex *div);
/* out = J z; in place allowed. */
void qc__rotate(const qc_mesh *mesh, const double *cotangent, const qc_complex *z, qc_complex *out);

/* A stiffness matrix with its factor. The factor is that of D A D, D a diagonal of powers of two
 * which brings every diagonal entry of A to [1/2, 2): slivers do not hide small pivots, and nothing
 * is rounded. */
typedef struct qc__system {
    const qc_stiffness *stiffness; /* borrowed */
    const qc_solver *solver;       /* borrowed */
    int32_t n_elements;      /* length of stiffness->unknown                                 */
    double *scale;           /* D                                                            */
    qc_complex *val;         /* of D A D                                                     */
    qc_solver_state *factor; /* NULL when there is no unknown                           */
} qc__system;
/* solver NULL = builtin. `element` names the unknowns ("edge", "vertex") in errors: NOT_POSDEF with
 * where = element. */
qc_status qc__system_create(qc_ctx *ctx, const qc_solver *solver, const qc_stiffness *stiffness,
                            int32_t n_elements, const char *element, qc__system *out);
/* New values of the same pattern; on error the system can only be freed. */
qc_status qc__system_update(qc_ctx *ctx, qc__system *system, const qc_stiffness *stiffness,
                            const char *element);
void qc__system_free(qc__system *system);
/* Overwrites the right-hand side x (n_elements) by the solution, zero where a value is fixed. */
qc_status qc__system_solve(qc_ctx *ctx, const qc__system *system, qc_complex *x);

/* L* of a covering with its factor, for several calls with other cotangents: the analysis is done
 * once. Starts as zeros; belongs to one covering and one solver. */
typedef struct qc__curl_system {
    qc_stiffness *stiffness; /* NULL = not made yet */
    qc__system system;
} qc__curl_system;
void qc__curl_system_free(qc__curl_system *kept);
/* qc_hodge_remove_curl with a system that is kept; on error it can only be freed. */
qc_status qc__remove_curl(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                          const qc_solver *solver, qc__curl_system *kept, const qc_complex *z,
                          qc_complex *out, qc_complex *v, double *energy);

#endif
