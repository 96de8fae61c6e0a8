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

/* The map of least energy with given values in the wedges (qc__seams_wedge_values; any others do
 * too): F (n_vertices), zero at given coordinates. */
qc_status qc__periods_extend(qc_ctx *ctx, const qc__periods *periods, const double _Complex *wedge,
                             double _Complex *F);
/* Corner values f' = i^{a_w} F_v + wedge (3 n_faces). */
void qc__periods_corners(const qc__seams *seams, const double _Complex *wedge,
                         const double _Complex *F, qc_complex *f);

#endif
