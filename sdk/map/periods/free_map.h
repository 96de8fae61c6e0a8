/* A seamless map with free transitions: a vector x of the unknown coordinates of F and then the
 * free variables y (seams.h). Whatever x is, transitions hold and features are isolines. Internal
 * to sdk/map.
 *
 * The Dirichlet energy is quadratic in x with the matrix H = (L, B; B^T, C) of (P.9). The factor of
 * L and that of its Schur complement P = C - B^T L^-1 B, the period matrix, give H^-1. */
#ifndef QC_MAP_FREE_MAP_H
#define QC_MAP_FREE_MAP_H

#include "sdk/map/periods/period_factor.h"

typedef struct qc__free_map {
    const qc__periods *periods;            /* borrowed */
    int64_t n_F, n;                        /* unknown coordinates; with the variables after them */
    double _Complex *base;                 /* n_vertices: F where it is no unknown */
    qc__period_factor schur;               /* empty: y stays, its part of every gradient is 0 */
    double *symbol, *slope;                /* space */
    double _Complex *F, *wedge, *residual; /* space */
} qc__free_map;

/* P: n_free^2, NULL = y stays. Errors: NOMEM, those of the factorisation. */
qc_status qc__free_map_create(qc_ctx *ctx, const qc__periods *periods, const double *P,
                              qc__free_map **out);
void qc__free_map_free(qc__free_map *map);
/* x (n) of corner values f whose variables are y (qc__seams_read). */
void qc__free_map_read(qc__free_map *map, const qc_complex *f, const double *y, double *x);
/* Corner values f (3 n_faces) of x. */
void qc__free_map_corners(qc__free_map *map, const double *x, qc_complex *f);
/* The gradient by x of a function whose gradient by the corner values is g (3 n_faces). */
void qc__free_map_gradient(qc__free_map *map, const qc_complex *g, double *gradient);
/* p := H^-1 p. */
qc_status qc__free_map_precondition(qc_ctx *ctx, qc__free_map *map, double *p);

#endif
