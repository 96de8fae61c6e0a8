/* qc/optimize.h - placing branch points by the curl they cause (thesis chapter 6).
 *
 * The distortion E_D = 1/2 |X_C|^2 of a frame field is a function of its matching: the matching
 * fixes the smoothest field (5.3) and the stiffness matrix L* (6.1). A flip adds a turn to the
 * matching of one interior edge; it moves, creates or cancels branch points at the two ends.
 * Thread rule: a qc_distortion is mutable and belongs to one thread at a time. */
#ifndef QC_OPTIMIZE_H
#define QC_OPTIMIZE_H

#include <qc/field.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- distortion as a function of the matching ------------------------------------------------- */

typedef struct qc_distortion qc_distortion;

/* m_edge += step, step = +1 or -1. */
typedef struct qc_flip_step {
    int32_t edge, step;
} qc_flip_step;

/* Starts at the given matching, whose field counts as the minimiser of (5.3) for it: alignment
 * pulls towards where the field is in the trusted faces with the field's weights, lambda as in
 * qc_field_smooth. sizing NULL = length 1. Factorises both systems. Edges of components in which
 * the holonomy is trivial cannot be flipped. Errors: ARGUMENT, NOT_POSDEF (faces without area),
 * NOMEM, CANCELLED. */
QC_API qc_status qc_distortion_create(qc_ctx *ctx, const qc_matching *matching,
                                      const qc_sizing *sizing, double lambda, qc_distortion **out);
QC_API void qc_distortion_free(qc_distortion *distortion);

typedef struct qc_distortion_state {
    double energy; /* E_D of the present matching, in parameter units                          */
    double whole;  /* 1/2 |X|^2 of the field: E_D_rel = energy / whole                         */
    int32_t branch_points; /* interior vertices of index other than 0                          */
    int64_t evaluations, changes; /* of E_D; of accepted flips                                 */
    const int8_t *m;              /* n_edges, borrowed until the next change                   */
    const int32_t *index4;        /* n_vertices, borrowed                                      */
} qc_distortion_state;
QC_API void qc_distortion_get_state(const qc_distortion *distortion, qc_distortion_state *state);

/* Whether the edge can be flipped: interior, no end on a hard feature (whose sectors keep their
 * quarter turns), of a component without trivial holonomy. */
QC_API bool qc_distortion_can_flip(const qc_distortion *distortion, int32_t edge);

/* E_D after each of n flips made alone, exactly (to rounding); infinity where L* would become
 * singular. The state stays. Many at a time cost less each than one. Errors: ARGUMENT (where = edge
 * which cannot be flipped), NOMEM, CANCELLED. */
QC_API qc_status qc_distortion_try(qc_ctx *ctx, qc_distortion *distortion, int32_t n,
                                   const qc_flip_step *flip, double *energy);

/* All n flips together when E_D is then below `limit`; otherwise everything stays bit for bit.
 * *accepted and *energy (the value found, infinity as above) may be NULL. Errors as above. */
QC_API qc_status qc_distortion_change(qc_ctx *ctx, qc_distortion *distortion, int32_t n,
                                      const qc_flip_step *flip, double limit, double *energy,
                                      bool *accepted);

/* share (n_edges): |Re(conj(v_e) r_e)| / 2, the share of the edge in E_D; theta (n_edges):
 * curvature of the present field; either may be NULL. 0 on the boundary. Also looks for drift of
 * the updated factor and factorises again where there is any. Errors: NOMEM, CANCELLED. */
QC_API qc_status qc_distortion_shares(qc_ctx *ctx, qc_distortion *distortion, double *share,
                                      double *theta);

/* The present matching with its field (of the same mesh, weights and flags). */
QC_API qc_status qc_distortion_matching(qc_ctx *ctx, const qc_distortion *distortion,
                                        qc_matching **out);

/* --- curl reduction (Algorithm 6.1, steps 2 and 3) -------------------------------------------- */

typedef struct qc_reduce_options {
    uint32_t struct_size;
    int32_t create;      /* 1: new branch points may appear; 0: they move and cancel only       */
    int64_t evaluations; /* at most so many                                                     */
    int64_t patience;    /* ends after so many trials in a row without gain                     */
    double spacing; /* branch points do not move nearer to each other than this, in units of the
                       mesh; 0 = any distance                                                   */
    double gain;    /* smallest gain of a flip that counts, in parameter units (as E_D)         */
    double seconds; /* ends with what there is after this time; 0 = none. The result then depends
                       on the speed of the machine                                              */
} qc_reduce_options;
#define QC_REDUCE_OPTIONS_INIT                                                                     \
    { sizeof(qc_reduce_options), 0, 20000, 96, 0.0, 0.0, 0.0 }

/* Flips edges of large share, best predictions first, as long as E_D falls; every flip that stays
 * was verified by an exact evaluation. With `create` branch points are moved before new ones are
 * made. Indices stay within -2/4 and 1/4 where they are. Deterministic. CANCELLED: the
 * distortion is valid and the best so far. Errors: NOMEM, CANCELLED. */
QC_API qc_status qc_distortion_reduce(qc_ctx *ctx, qc_distortion *distortion,
                                      const qc_reduce_options *options);

/* --- cancelling pairs (Algorithm 6.1, steps 1 and 4) ------------------------------------------ */

typedef struct qc_cancel_options {
    uint32_t struct_size;
    int32_t neighbours; /* nearest branch points of opposite sign that are tried for each one   */
    double increase;    /* a pair is cancelled when E_D then rises by less than this: 0 in step 1,
                           the expected fall of E_H (6.4) in step 4; parameter units               */
    double spacing;     /* pairs nearer than this (units of the mesh) are cancelled at any price
                           below `most`, since rounding could not part them; 0 = none              */
    double most;   /* parameter units                                                         */
    int64_t pairs; /* at most so many; 0 = any number                                         */
} qc_cancel_options;
#define QC_CANCEL_OPTIONS_INIT                                                                     \
    { sizeof(qc_cancel_options), 3, 0.0, 0.0, 0.0, 0 }

/* Measures the change of E_D for every pair, then cancels in order of that change less what the
 * pair may cost, each measured again just before. *cancelled (may be NULL) counts the pairs.
 * A later call on the same distortion does not measure again what cost over twice its price.
 * Deterministic; errors and cancelling as qc_distortion_reduce. */
QC_API qc_status qc_distortion_cancel(qc_ctx *ctx, qc_distortion *distortion,
                                      const qc_cancel_options *options, int32_t *cancelled);

/* --- merging without a field solve (2007 paper, 4.2) ------------------------------------------ */

/* A matching of the same field with fewer branch points: indices are carried along paths of edges,
 * whose matchings turn, while C = lambda * branch points + sum |theta_e| falls; the largest fall
 * first, at most `most` times. No index leaves -2/4 .. 1/4. cost (may be NULL): C before and after.
 * Deterministic; any thread. Errors: ARGUMENT (lambda negative), NOMEM, CANCELLED. */
QC_API qc_status qc_matching_merge(qc_ctx *ctx, const qc_matching *matching, double lambda,
                                   int32_t most, double cost[2], qc_matching **out);

#ifdef __cplusplus
}
#endif
#endif
