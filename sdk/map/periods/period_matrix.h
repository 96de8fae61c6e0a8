/* Harmonic maps with given periods and their energies. Internal to sdk/map.
 *
 * With the free variables x of seams.h a map is f' = W F + O x. Its Dirichlet energy is minimal in
 * F for L F = -B x with L = W^H K W, B = W^H K O, K the cotangent stiffness of single faces; the
 * minimum is 1/2 x^H P x with the period matrix P = O^H K (O + W F(x)) (Sigma trick, thesis 6.3.2:
 * only faces at the seams enter once F is known). */
#ifndef QC_MAP_PERIOD_MATRIX_H
#define QC_MAP_PERIOD_MATRIX_H

#include "sdk/map/periods/seams.h"

typedef struct qc__periods {
    const qc__seams *seams;
    const double *cotangent; /* 3 n_faces, borrowed */
    qc_stiffness *stiffness;
    const qc_solver *solver; /* borrowed */
    qc_solver_state *factor; /* NULL when there is no unknown */
    int8_t *gauge; /* n_vertices: F here = i^gauge F of qc_stiffness_vertices                    */
    int32_t n_seam_faces;
    int32_t *seam_face; /* faces with a corner in a wedge that has terms */
    int32_t n_columns;  /* = n_free; symbols by free variable: ...  */
    int64_t *column_start;
    int32_t *column_symbol;
    double _Complex *column_value;
} qc__periods;

/* face_turn: the combing the seams were made with. solver NULL = builtin. */
qc_status qc__periods_create(qc_ctx *ctx, const qc_cover *cover, const qc__seams *seams,
                             const double *cotangent, const int8_t *face_turn,
                             const qc_solver *solver, qc__periods **out);
void qc__periods_free(qc__periods *periods);
/* P as a real symmetric matrix of size 2 n_free, column-major: variable j is (2j, 2j+1) = (re, im).
 */
qc_status qc__period_matrix(qc_ctx *ctx, const qc__periods *periods, double *P);
/* Adds to f (3 n_faces) the map of least energy with periods d (n_free, in lattice units). */
qc_status qc__periods_add_map(qc_ctx *ctx, const qc__periods *periods, const double _Complex *d,
                              qc_complex *f);

#endif
