/* Harmonic maps with given periods and their energies. Internal to sdk/map.
 *
 * With the free variables y of seams.h a map is f' = W F + O y, F the unknown coordinates. Its
 * Dirichlet energy is minimal in F for L F = -B y with L = W^T K W, B = W^T K O, K the cotangent
 * stiffness of single faces; the minimum is 1/2 y^T P y with the period matrix P = O^T K (O + W
 * F(y)) (Sigma trick, thesis 6.3.2: only faces at the seams enter once F is known). */
#ifndef QC_MAP_PERIOD_MATRIX_H
#define QC_MAP_PERIOD_MATRIX_H

#include "sdk/map/periods/stiffness.h"

typedef struct qc__periods {
    const qc__seams *seams;
    qc__map_stiffness *stiffness;
    int32_t n_seam_faces;
    int32_t *seam_face; /* faces where O is not zero */
    int32_t n_columns;  /* = n_free; symbols by free variable: ...  */
    int64_t *column_start;
    int32_t *column_symbol;
    double *column_value;
} qc__periods;

/* solver NULL = builtin. */
qc_status qc__periods_create(qc_ctx *ctx, const qc__seams *seams, const double *cotangent,
                             const qc_solver *solver, qc__periods **out);
void qc__periods_free(qc__periods *periods);
/* P, n_free x n_free, column-major. */
qc_status qc__period_matrix(qc_ctx *ctx, const qc__periods *periods, double *P);

/* The load of a form d (3 n_faces, on the edges opposite to the corners, in combed charts): the
 * derivative of 1/2 int |dh + d|^2 at h = 0 by the values in the wedges; load: n_wedges. */
void qc__periods_load(const qc__seams *seams, const double *cotangent, const qc_complex *d,
                      double _Complex *load);
/* The map h with given values in the wedges (qc__seams_wedge_values; any others do too) of least
 * 1/2 int |dh + d|^2, d by its load, NULL = 0: F (n_vertices), zero at given coordinates. */
qc_status qc__periods_extend(qc_ctx *ctx, const qc__periods *periods, const double _Complex *wedge,
                             const double _Complex *load, double _Complex *F);
/* Adds that of d = 0 to unknown coordinates x (stiffness->n). */
qc_status qc__periods_add_extension(qc_ctx *ctx, const qc__periods *periods,
                                    const double _Complex *wedge, double *x);
/* Unknown coordinates x as F (n_vertices), zero elsewhere. */
void qc__periods_spread(const qc__periods *periods, const double *x, double _Complex *F);
/* Derivative of that energy by the free variables: slope (n_free). Errors: NOMEM. */
qc_status qc__periods_slope(qc_ctx *ctx, const qc__periods *periods, const double _Complex *wedge,
                            const double _Complex *load, const double _Complex *F, double *slope);
/* The transpose of (F, y) -> corner values, summed by wedges already: of load (n_wedges), by the
 * unknown coordinates of F, dF (stiffness->n), and by the free variables, dy (n_free). symbol:
 * n_symbols of space. */
void qc__periods_pull_back(const qc__periods *periods, const double _Complex *load, double *symbol,
                           double *dF, double *dy);
/* Corner values f' = i^{a_w} F_v + wedge (3 n_faces), and back: what f has in the wedges besides
 * the unknown coordinates of F_v. */
void qc__periods_corners(const qc__seams *seams, const double _Complex *wedge,
                         const double _Complex *F, qc_complex *f);
void qc__periods_split(const qc__seams *seams, const qc_complex *f, double _Complex *wedge,
                       double _Complex *F);

#endif
