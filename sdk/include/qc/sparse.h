/* qc/sparse.h - sparse Cholesky factorisation of Hermitian (and real symmetric) positive definite
 * matrices: analyse once, factorise often, modify in place, solve.
 *
 * This module stands alone: nothing of geometry. Matrices are borrowed compressed-column views of
 * the UPPER triangle (row <= column), rows sorted and unique within a column, every diagonal entry
 * present. The factor is P A P^T = L D L^H with unit lower triangular L and real positive D, stored
 * by supernodes. Numbering in every call is the caller's; the permutation stays inside.
 * Thread rule of the whole header: a qc_symbolic is immutable and may be shared; a qc_factor may be
 * used by several threads at once as long as no call modifies it; a qc_ctx belongs to one thread.
 */
#ifndef QC_SPARSE_H
#define QC_SPARSE_H

#include <qc/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Upper triangle of a Hermitian n x n matrix by columns. Views own nothing. colptr: n+1. */
typedef struct qc_hermitian {
    int32_t n;
    const int64_t *colptr;
    const int32_t *row;
    const qc_complex *val; /* imaginary parts of the diagonal are ignored */
} qc_hermitian;

/* The same for a real symmetric matrix. */
typedef struct qc_symmetric {
    int32_t n;
    const int64_t *colptr;
    const int32_t *row;
    const double *val;
} qc_symmetric;

typedef struct qc_symbolic qc_symbolic; /* permutation, elimination tree, supernodes; immutable */
typedef struct qc_factor qc_factor; /* numeric factor; the one mutable object of the SDK         */

/* Orders against fill. All are deterministic; AUTO takes what measures best for size and pattern.
 */
enum {
    QC_ORDER_AUTO = 0,
    QC_ORDER_NATURAL = 1,
    QC_ORDER_GIVEN = 2,
    QC_ORDER_AMD = 3,       /* approximate minimum degree */
    QC_ORDER_QUOTIENT = 4,  /* the same for groups of rows; without `group` of rows which have the
                               same neighbours */
    QC_ORDER_DISSECTION = 5 /* nested dissection through the cliques of A, minimum degree in small
                               pieces and where there are no small separators */
};

/* Hints may be NULL. All arrays are borrowed for the call. */
typedef struct qc_analyze_options {
    uint32_t struct_size;
    int32_t ordering;           /* QC_ORDER_...                                             */
    const int32_t *permutation; /* GIVEN: n, permutation[k] = row eliminated k-th           */
    const int32_t *group;       /* QUOTIENT, DISSECTION: n, rows with equal ids stay together */
    const double *position;     /* DISSECTION: n x 3, the place of each row, in any unit    */
} qc_analyze_options;
#define QC_ANALYZE_OPTIONS_INIT                                                                    \
    { sizeof(qc_analyze_options), 0, NULL, NULL, NULL }

typedef struct qc_symbolic_info {
    uint32_t struct_size;
    int32_t n, supernodes, largest_front;
    int64_t nnz_l;  /* entries of L including the diagonal, without padding  */
    int64_t stored; /* entries stored, with the zeros of relaxed supernodes */
    double flops; /* multiply-add pairs counted as 2 real flops for the real case; x4 complex     */
    int64_t bytes_complex, bytes_real; /* memory of a factor */
} qc_symbolic_info;
#define QC_SYMBOLIC_INFO_INIT                                                                      \
    { sizeof(qc_symbolic_info), 0, 0, 0, 0, 0, 0.0, 0, 0 }

/* Symbolic analysis of the pattern (values are not read; val may be NULL). options NULL = AUTO.
 * Errors: ARGUMENT (where = column whose rows are unsorted, out of range or without diagonal; the
 * bad permutation entry; the row whose position is not finite; -1 for an unknown ordering or a hint
 * which the ordering does not take), NOMEM, CANCELLED. */
QC_API qc_status qc_analyze(qc_ctx *ctx, const qc_hermitian *A, const qc_analyze_options *options,
                            qc_symbolic **out);
QC_API qc_status qc_analyze_real(qc_ctx *ctx, const qc_symmetric *A,
                                 const qc_analyze_options *options, qc_symbolic **out);
QC_API void qc_symbolic_free(qc_symbolic *S); /* factors keep what they need: may be freed first */
QC_API void qc_symbolic_get_info(const qc_symbolic *S, qc_symbolic_info *info);
/* permutation (n entries) as for QC_ORDER_GIVEN: permutation[k] = row eliminated k-th. */
QC_API void qc_symbolic_get_permutation(const qc_symbolic *S, int32_t *permutation);

/* Numeric factorisation; A must have the pattern that was analysed (or a subset of it).
 * Errors: NOT_POSDEF (where = pivot: D(j) <= n eps A(j,j)), ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_factorize(qc_ctx *ctx, const qc_symbolic *S, const qc_hermitian *A,
                              qc_factor **out);
QC_API qc_status qc_factorize_real(qc_ctx *ctx, const qc_symbolic *S, const qc_symmetric *A,
                                   qc_factor **out);
/* New values, same pattern. Its first call keeps a workspace in F; later calls with as many threads
 * allocate nothing. On error F is unusable until a refactorise
 * succeeds (solves then answer ARGUMENT). */
QC_API qc_status qc_refactorize(qc_ctx *ctx, qc_factor *F, const qc_hermitian *A);
QC_API qc_status qc_refactorize_real(qc_ctx *ctx, qc_factor *F, const qc_symmetric *A);
QC_API void qc_factor_free(qc_factor *F);

/* Solves A X = B in place. x: n x nrhs, column-major with leading dimension n. Several right-hand
 * sides are blocked: a column does not depend on the others, but alone it may differ in the last
 * bits. The real functions need a real factor, the complex ones a complex factor. Errors: ARGUMENT,
 * NOMEM, CANCELLED (between blocks, when x is partly solved). */
QC_API qc_status qc_solve(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x);
QC_API qc_status qc_solve_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x);

/* Forward solve only: overwrites b with y = D^{-1/2} L^{-1} P b, so that b^H A^{-1} b = |y|^2 and
 * B^H A^{-1} C = Y_B^H Y_C (thesis 6.2.1). y is in elimination order. */
QC_API qc_status qc_solve_forward(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x);
QC_API qc_status qc_solve_forward_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x);

/* Forward solve of one sparse right-hand side b (nb entries at `row`; equal rows add) at the cost
 * of its reach, whatever n is: y can differ from zero only on the paths from `row` to the roots of
 * the elimination tree. *count gets the number of those entries; capacity 0 asks for it alone
 * (index and y may be NULL). index: elimination positions, ascending; y: the values there, as of
 * qc_solve_forward. Errors: ARGUMENT (also: capacity < *count, which is set), NOMEM. */
QC_API qc_status qc_solve_forward_sparse(qc_ctx *ctx, const qc_factor *F, int32_t nb,
                                         const int32_t *row, const qc_complex *b, int32_t capacity,
                                         int32_t *index, qc_complex *y, int32_t *count);
QC_API qc_status qc_solve_forward_sparse_real(qc_ctx *ctx, const qc_factor *F, int32_t nb,
                                              const int32_t *row, const double *b, int32_t capacity,
                                              int32_t *index, double *y, int32_t *count);

/* Entries want[0..nx) of A^{-1} b, b sparse as above, at the cost of the paths from `row` and
 * `want`: x[k] = (A^{-1} b)_{want[k]}. For example single entries of the inverse. */
QC_API qc_status qc_solve_entries(qc_ctx *ctx, const qc_factor *F, int32_t nb, const int32_t *row,
                                  const qc_complex *b, int32_t nx, const int32_t *want,
                                  qc_complex *x);
QC_API qc_status qc_solve_entries_real(qc_ctx *ctx, const qc_factor *F, int32_t nb,
                                       const int32_t *row, const double *b, int32_t nx,
                                       const int32_t *want, double *x);

/* Solve followed by up to `steps` rounds of iterative refinement with A, the matrix which F stands
 * for; ends early once nothing is left to gain. x (n x nrhs) enters as B, leaves as the solution,
 * on error unchanged. *error (may be NULL) gets the largest componentwise backward error max_i |b -
 * A x|_i / (|A| |x| + |b|)_i with |z| = |re| + |im|. */
QC_API qc_status qc_solve_refined(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A,
                                  int32_t nrhs, int32_t steps, qc_complex *x, double *error);
QC_API qc_status qc_solve_refined_real(qc_ctx *ctx, const qc_factor *F, const qc_symmetric *A,
                                       int32_t nrhs, int32_t steps, double *x, double *error);

/* --- modifications ---------------------------------------------------------------------------- */

/* A <- A + sum over q < k of sigma_q w_q w_q^H, sigma_q = +1 or -1, in one sweep; w_q has the
 * entries start[q] .. start[q+1) of row and w (start: k+1). The pattern of L is fixed: the rows of
 * one w_q must differ and form a clique of A (ARGUMENT if they do not fit L). Positive terms are
 * applied before negative ones. On any error F is bit for bit as before. Entries which have decayed
 * below 1e-80 of the largest are taken as zero. Errors: NOT_POSDEF (a downdate left the cone;
 * where = pivot), ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_updown_many(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                                const int32_t *start, const int32_t *row, const qc_complex *w);
QC_API qc_status qc_updown_many_real(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                                     const int32_t *start, const int32_t *row, const double *w);

/* The same for one vector with nw entries. */
QC_API qc_status qc_updown(qc_ctx *ctx, qc_factor *F, int sigma, int32_t nw, const int32_t *row,
                           const qc_complex *w);
QC_API qc_status qc_updown_real(qc_ctx *ctx, qc_factor *F, int sigma, int32_t nw,
                                const int32_t *row, const double *w);

/* Matching flip (thesis 6.2.1): A <- A + D where D couples row k with the rows l and m only:
 * D(k,l) += dl, D(k,m) += dm and the conjugates. Rank 2, one positive and one negative eigenvalue,
 * as in qc_updown_many. */
QC_API qc_status qc_flip(qc_ctx *ctx, qc_factor *F, int32_t k, int32_t l, qc_complex dl, int32_t m,
                         qc_complex dm);

/* Transactions. begin sets a savepoint (they nest); rollback undoes, bit for bit, everything since
 * the innermost one and ends it; commit keeps everything and ends it. Outside a transaction
 * rollback undoes the last modification if that succeeded, once. A modification which fails within
 * a transaction undoes itself only. qc_refactorize ends all transactions: there is no way back.
 * Memory: the old entries of L and of the forward solution on the paths of all modifications since
 * the outermost begin (outside: of the last one), at most one copy of the factor for each. Kept for
 * reuse until the factor is freed. Errors: ARGUMENT (nothing to commit or to roll back), NOMEM
 * (begin). */
QC_API qc_status qc_factor_begin(qc_ctx *ctx, qc_factor *F);
QC_API qc_status qc_factor_commit(qc_ctx *ctx, qc_factor *F);
QC_API qc_status qc_factor_rollback(qc_ctx *ctx, qc_factor *F);

/* Forward solution of one right-hand side b (n, copied, the caller's numbering) carried along with
 * the factor: every modification brings it up to date in the same sweep and a rollback restores it.
 * Attaching again replaces b; neither attach nor detach is possible within a transaction
 * (ARGUMENT). Costs a forward solve, and memory for n entries of b, of y, and one entry for every
 * row below the diagonal block of a supernode. Errors: ARGUMENT, NOMEM. */
QC_API qc_status qc_forward_attach(qc_ctx *ctx, qc_factor *F, const qc_complex *b);
QC_API qc_status qc_forward_attach_real(qc_ctx *ctx, qc_factor *F, const double *b);
QC_API qc_status qc_forward_detach(qc_ctx *ctx, qc_factor *F);

/* b(row[p]) += db[p], a modification of its own for rollback. Its effect on y is computed by the
 * sweep of the next modification, or when y or the energy is asked for: a flip which also changes b
 * takes one sweep. Errors: ARGUMENT (no right-hand side, bad row), NOMEM. */
QC_API qc_status qc_forward_add(qc_ctx *ctx, qc_factor *F, int32_t nb, const int32_t *row,
                                const qc_complex *db);
QC_API qc_status qc_forward_add_real(qc_ctx *ctx, qc_factor *F, int32_t nb, const int32_t *row,
                                     const double *db);

/* y = D^{-1/2} L^{-1} P b (n) as from qc_solve_forward, and b^H A^{-1} b = |y|^2; the latter takes
 * no work proportional to n. Both modify F if a change of b is waiting. No rounding errors pile up:
 * the values are bit for bit those of attaching b anew. Errors: ARGUMENT, NOMEM. */
QC_API qc_status qc_forward_get(qc_ctx *ctx, qc_factor *F, qc_complex *y);
QC_API qc_status qc_forward_get_real(qc_ctx *ctx, qc_factor *F, double *y);
QC_API qc_status qc_forward_energy(qc_ctx *ctx, qc_factor *F, double *energy);

/* --- summaries -------------------------------------------------------------------------------- */

/* log(det A) = sum log D. */
QC_API double qc_factor_logdet(const qc_factor *F);
/* Estimate of the condition number |A|_1 |A^{-1}|_1, a lower bound which is seldom less than a
 * third of it, by about five solves. Only the norm is taken from A: after updates which changed it
 * little, the matrix before them will do. */
QC_API qc_status qc_condition(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A,
                              double *condition);
QC_API qc_status qc_condition_real(qc_ctx *ctx, const qc_factor *F, const qc_symmetric *A,
                                   double *condition);
/* Smallest and largest pivot: their ratio is a cheap lower bound of the condition number. */
QC_API void qc_factor_pivots(const qc_factor *F, double *smallest, double *largest);

/* --- closest vector in a lattice (thesis 6.3) ------------------------------------------------- */

enum { QC_ROUND_DIRECT = 0, QC_ROUND_GREEDY = 1 };

typedef struct qc_lattice_options {
    uint32_t struct_size;
    int32_t start; /* QC_ROUND_DIRECT: nearest integers; QC_ROUND_GREEDY: fix one, re-solve (MIQ) */
    int32_t radius; /* 0..3: then change up to this many entries by +-1 while the energy falls */
    /* With a radius > 0: how many entries of P a search of larger changes may read before; about
     * 10^9 per second. 0: none; negative: as many as suit n. */
    int64_t budget;
    uint64_t seed; /* of that search; the same seed and budget give the same result */
} qc_lattice_options;
#define QC_LATTICE_OPTIONS_INIT                                                                    \
    { sizeof(qc_lattice_options), QC_ROUND_GREEDY, 3, -1, 0 }

typedef struct qc_lattice_result {
    double energy; /* 1/2 (z - t)^T P (z - t) of the result                                  */
    double energy_direct; /* the same for nearest-integer rounding */
    int64_t moves, evaluations;
} qc_lattice_result;

/* Finds integers z (as doubles) with small 1/2 (z - t)^T P (z - t); P: n x n, real symmetric
 * positive definite, column-major, full. Deterministic. Errors: NOT_POSDEF, ARGUMENT, NOMEM,
 * CANCELLED. */
QC_API qc_status qc_lattice_round(qc_ctx *ctx, int32_t n, const double *P, const double *t,
                                  const qc_lattice_options *options, double *z,
                                  qc_lattice_result *result);

#ifdef __cplusplus
}
#endif
#endif
