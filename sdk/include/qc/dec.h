/* qc/dec.h - discrete exterior calculus and Hodge decomposition on a mesh or on its covering.
 *
 * Everything is written for complex-valued 1-forms which are constant on each face: a form is an
 * array z of 3 n_faces numbers, z[3t+k] = Z_t(e_tk), its value on the counter-clockwise edge vector
 * opposite corner k; the three values of a face sum to zero. A frame field (X, Y) is Z(e) = <X,e> +
 * i <Y,e> (conj(x) e for a cross). On a covering the value lives in the gauge of its face; across
 * an edge it is multiplied by i^{-turn} (qc/cover.h). Real fields on the plain mesh are forms with
 * zero imaginary part and cover.matching == NULL. This representation is intrinsic: only cotangents
 * enter.
 * L2 product: <a,b> = sum_t 1/2 sum_k cot_k conj(a_k) b_k.
 *
 * cotangent is always the array of qc_mesh_geometry (3 n_faces). Statements about orthogonality use
 * c_0 c_1 + c_1 c_2 + c_2 c_0 = 1, which holds on every face whose area was not floored. Calls
 * which take no solve cost a few passes over the faces and fail with NOMEM only. Outputs may not
 * overlap inputs unless said so.
 * Thread rule: each call on the thread of its context; inputs are only read. */
#ifndef QC_DEC_H
#define QC_DEC_H

#include <qc/cover.h>
#include <qc/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- tangent vectors -------------------------------------------------------------------------- */

/* Edge vectors e_tk of each face as complex numbers in the orthonormal frame of the face, whose
 * real axis points along halfedge 0 (corner 1 to corner 2): edge: 3 n_faces. */
QC_API qc_status qc_tangent_edges(qc_ctx *ctx, const qc_mesh *mesh, qc_complex *edge);
/* The frame in space: real_axis and imaginary_axis, 3 n_faces each (unit vectors). */
QC_API qc_status qc_tangent_frames(qc_ctx *ctx, const qc_mesh *mesh, double *real_axis,
                                   double *imaginary_axis);
/* Transport s -> t across interior edge e: rho_e = -e_t / e_s, |rho| = 1 (docs/conventions.md);
 * rho: n_edges, 1 on the boundary. edge as above. */
QC_API qc_status qc_tangent_transport(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                                      qc_complex *rho);

/* --- matrices --------------------------------------------------------------------------------- */

typedef struct qc_stiffness {
    qc_hermitian A; /* arrays owned by this struct                                                */
    int32_t *unknown; /* n_edges or n_vertices: row of the matrix, -1 = value fixed to zero */
} qc_stiffness;
QC_API void qc_stiffness_free(qc_stiffness *stiffness);
/* Crouzeix-Raviart stiffness L* (1.5), (3.7), in the gauge of s (docs/conventions.md). Boundary
 * edges are no unknowns. A closed component with trivial holonomy, where the kernel is the
 * constants, gets its first edge fixed. cotangent: 3 n_faces. */
QC_API qc_status qc_stiffness_edges(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                    qc_stiffness **out);
/* Conforming stiffness L (1.2.1), complex as in 3.2.3, in the gauge of qc_cover_corner_turns.
 * Branch points are no unknowns (a symmetric function vanishes there); pinned (n_vertices flags,
 * may be NULL) adds others; a component with trivial holonomy and nothing fixed gets its first
 * vertex fixed. */
QC_API qc_status qc_stiffness_vertices(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                       const uint8_t *pinned, qc_stiffness **out);

/* --- operators -------------------------------------------------------------------------------- */

/* Form of a cross field: z = scale_t conj(x_t) e_tk; scale: n_faces or NULL = 1. */
QC_API qc_status qc_form_from_cross(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                                    const qc_complex *x, const double *scale, qc_complex *z);
/* <a,b>. */
QC_API qc_complex qc_form_product(const qc_mesh *mesh, const double *cotangent, const qc_complex *a,
                                  const qc_complex *b);
/* Gradient of the conforming function F (n_vertices, gauge of qc_cover_corner_turns). */
QC_API qc_status qc_form_gradient(qc_ctx *ctx, const qc_cover *cover, const qc_complex *F,
                                  qc_complex *z);
/* Gradient of the nonconforming function v (n_edges, midpoint values in the gauge of s). */
QC_API qc_status qc_form_gradient_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *v,
                                        qc_complex *z);
/* J applied to a form: (JX) . e; z and out may be the same. */
QC_API qc_status qc_form_rotate(qc_ctx *ctx, const qc_mesh *mesh, const double *cotangent,
                                const qc_complex *z, qc_complex *out);
/* curl*(e) = i^m Z_t(e) - Z_s(e), e in the direction of its halfedge in s (n_edges; 0 on the
 * boundary). */
QC_API qc_status qc_form_curl_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *z,
                                    qc_complex *curl);
/* Weak operators: <grad phi_p, Z> at vertices (= -div), and <J grad psi_e, Z> at edges (= -curl*),
 * as right hand sides of L and L*; n_vertices / n_edges. Zero at branch points and on boundary
 * edges, which are never unknowns. */
QC_API qc_status qc_form_divergence(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                    const qc_complex *z, qc_complex *div);
QC_API qc_status qc_form_weak_curl_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *z,
                                         qc_complex *r);

/* --- Hodge decomposition (Theorem 1.12) ------------------------------------------------------ */

enum {
    QC_HODGE_CONFORMING = 0,   /* X = im grad|S_h + im J grad|S*_h + (ker curl* and ker div)   */
    QC_HODGE_NONCONFORMING = 1 /* X = im grad|S*_h + im J grad|S_h + (ker div* and ker curl) */
};
/* z = potential + copotential + harmonic; each 3 n_faces, any may be NULL. Closed meshes as in the
 * theorem; with boundary the co-potential vanishes there (the potential in the nonconforming
 * version); on a covering functions at vertices vanish at the branch points. Errors: ARGUMENT
 * (version), NOT_POSDEF and FAILED as below (where = edge or vertex), NOMEM, CANCELLED. */
QC_API qc_status qc_hodge_decompose(qc_ctx *ctx, const qc_cover *cover, int32_t version,
                                    const qc_complex *z, qc_complex *potential,
                                    qc_complex *copotential, qc_complex *harmonic);
/* Removes the curl: Z^ = Z - J grad v with L* v = r (6.1), the curl-free form closest to Z, to
 * machine precision of max |Z| even on slivers. L* is factorised by `solver` (NULL = builtin). out
 * may be z or NULL, v (n_edges) and energy may be NULL; *energy = E_D = 1/2 |J grad v|^2 = 1/2 v^H
 * L* v. Errors: NOT_POSDEF (where = edge: faces without area), FAILED (where = edge: curl above
 * 1e-9 max |Z| is left there), NOMEM, CANCELLED, those of the solver. */
QC_API qc_status qc_hodge_remove_curl(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                                      const qc_solver *solver, const qc_complex *z, qc_complex *out,
                                      qc_complex *v, double *energy);

/* Integrates a curl-free form over the surface cut along `cut` (n_edges flags; NULL = nothing)
 * after combing: f (3 n_faces corner values in the combed gauge, f' = i^{face_turn} f), f = 0 at
 * corner 0 of the first face of each patch of faces joined by uncut edges. face_turn: n_faces, from
 * qc_cover_comb with the same cut; NULL = 0. residual (may be NULL) gets the largest mismatch at
 * the ends of uncut edges: zero up to rounding when the form is curl-free and the cut opens
 * everything. */
QC_API qc_status qc_form_integrate(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                                   const int8_t *face_turn, const qc_complex *z, qc_complex *f,
                                   double *residual);

/* Basis of the harmonic fields with given jumps on the plain mesh (thesis 1.2.6): one real form per
 * independent cycle of qc_mesh_cut_graph, H = Sigma - (Sigma)_P, Sigma jumping by 1 across that
 * cycle. *count: 2 genus on a closed connected mesh, 2 genus + b - 1 with b boundary loops (fields
 * tangential to the boundary in the weak sense). *basis: count x 3 n_faces (NULL when count = 0),
 * free with qc_cover_free_array. Errors: NOT_POSDEF (where = vertex), NOMEM, CANCELLED. */
QC_API qc_status qc_hodge_harmonic_basis(qc_ctx *ctx, const qc_mesh *mesh, int32_t *count,
                                         qc_complex **basis);

#ifdef __cplusplus
}
#endif
#endif
