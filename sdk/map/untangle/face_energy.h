/* The untangling energy of one face. Internal to sdk/map.
 *
 * Garanzha et al. 2021 (docs/theory/untangling.md): with J the Jacobian of the map relative to the
 * target shape of a face of area A, d = det J and chi(d, eps) = (d + sqrt(eps^2 + d^2)) / 2, E = A
 * [ (1 - theta) tr(J^T J) / chi + theta (1 + d^2) / chi ], finite and smooth for inverted faces. */
#ifndef QC_MAP_UNTANGLE_FACE_ENERGY_H
#define QC_MAP_UNTANGLE_FACE_ENERGY_H

#include "sdk/base/internal.h"

/* Least height of target shapes over their longest edge: thick while faces are turned over, since
 * slivers are stiff; thin where slivers are to count as little as their area. */
static const double qc__thick_targets = 0.05, qc__thin_targets = 1e-3;

/* The target shape with counter-clockwise edge vectors (edge k opposite to corner k), slivers
 * thickened to `thinnest`: gradients of the hat functions of its corners, and its area. hat may be
 * edge. */
void qc__target_hats(const qc_complex edge[3], double thinnest, qc_complex hat[3], double *area);

/* det J for corner values f. */
double qc__jacobian_det(const qc_complex hat[3], const qc_complex f[3]);
/* The energy and A pull / 2 |J - 1|^2, which holds the map to the target also in direction, for
 * corner values f; gradient[k] by f_k. */
double qc__face_energy(const qc_complex hat[3], double area, double eps, double pull,
                       const qc_complex f[3], qc_complex gradient[3]);

/* The symmetric Dirichlet energy A (|J|^2 + |J^-1|^2) of a positive face
 * (docs/theory/untangling.md, U.8), infinite with gradient 0 for others. */
double qc__face_barrier(const qc_complex hat[3], double area, const qc_complex f[3],
                        qc_complex gradient[3]);
/* The least t > 0 at which f + t p is no longer positive, INFINITY = none; f is. */
double qc__face_limit(const qc_complex f[3], const qc_complex p[3]);

#endif
