/* Shared inside sdk/optimize: the state of the distortion evaluator and its kernels. */
#ifndef QC_OPTIMIZE_INTERNAL_H
#define QC_OPTIMIZE_INTERNAL_H

#include <qc/optimize.h>

#include "sdk/field/internal.h"
#include "sdk/field/stretch.h"

/* What the weak curl at an edge needs: its faces, and its vector in each, divided by the length
 * there; that of t times i^m, so that r_e = conj(x_s) in_s + conj(x_t) in_t where lengths do not
 * depend on the direction. */
typedef struct qc__side {
    int32_t s, t;
    qc_complex in_s, in_t;
} qc__side;

/* Flips evaluated at a time: right-hand sides which share a pass over the factors. */
enum { QC__TRIALS = 8 };

/* What cancelling a pair did to E_D when it was measured last. */
typedef struct qc__known_pair {
    int32_t p, q;
    double change;
} qc__known_pair;

struct qc_distortion {
    const qc_matching *start; /* retained */
    const qc_mesh *mesh;
    qc__smoother smoother;
    double *cotangent; /* 3 n_faces                                                         */
    qc__side *side;    /* n: the two sides of the edge of each unknown */
    const qc_complex *stretch; /* n_faces, of the sizing, retained; NULL = none */
    const qc_sizing *sizing;   /* retained with it */
    uint8_t *odd;    /* n, with stretch: 1 where m is odd, so that i^m swaps the lengths of t */
    int8_t *m;       /* n_edges                                                           */
    int32_t *index4; /* n_vertices                                                        */
    double *bend;    /* n_faces: right-hand side of the smoothing since the start         */
    double *alpha;   /* n_faces: the rotations it causes                                  */
    qc_complex *x;   /* n_faces: the field                                                */
    qc_stiffness *matrix; /* L*, values kept up to date                                        */
    int32_t n;            /* its size                                                          */
    uint8_t *frozen;      /* n_components: closed with trivial holonomy at the start           */
    uint8_t *hard;        /* n_vertices: 1 on hard features, whose sectors keep their turns     */
    qc_factor *factor;    /* of L*                                                             */
    qc_complex *r;        /* n: weak curl                                                      */
    bool stale; /* the factor is not that of the matrix: a factorisation was interrupted        */
    double energy, whole;
    int32_t branch_points;
    int64_t evaluations, changes, updates; /* updates: flips in the factor                      */
    qc__known_pair *known; /* of the last call of qc_distortion_cancel, sorted by p, then q */
    int64_t n_known;
    double *angle;      /* n_faces QC__TRIALS: work space of trials                             */
    qc_complex *curl;   /* n QC__TRIALS                                                         */
    qc_complex *turned; /* n_faces QC__TRIALS                                                   */
    int32_t *reach;     /* 2 n                                                                  */
    qc_complex *sparse; /* 2 n                                                                  */
};

/* Row k of L* changes by D(k, l) = d_l, D(k, m) = d_m and the conjugates. n: entries, 0 to 2. */
typedef struct qc__coupling {
    int32_t k, n, row[2];
    qc_complex d[2];
} qc__coupling;
/* What m_e += step does to L* at the present matching. */
qc__coupling qc__flip_coupling(const qc_distortion *d, qc_flip_step flip);

/* out_t = x_t exp(i angle_t); may be in place. */
void qc__rotate_field(int32_t n, const double *angle, const qc_complex *x, qc_complex *out);
/* Weak curl of the field x for the matching of d, by unknown; with m += step at the edge of flip if
 * that is not -1. */
void qc__weak_curl(const qc_distortion *d, const qc_complex *x, qc_flip_step flip, qc_complex *r);
/* The side in t of the edge of the flip after m += step. */
qc_complex qc__flip_side(const qc_distortion *d, qc_flip_step flip);
/* With stretch: the part of r_e of an edge vector `in` in a face with cross x; odd: i^m swaps the
 * lengths. *slope (may be NULL): its derivative by the angle of x. */
static inline qc__cplx qc__side_value(qc_complex stretch, bool odd, qc_complex in, qc_complex x,
                                      qc__cplx *slope) {
    const qc__cplx z = conj(qc__c(x)) * qc__c(in);
    const qc__cplx along = (odd ? -1 : 1) * qc__c(stretch) * conj(qc__c(x)) * conj(qc__c(x));
    const qc_complex value = qc__stretched(qc__z(z), creal(along));
    if (slope) {
        const qc_complex turned = qc__stretched(qc__z(-I * z), creal(along));
        const double change = 2 * cimag(along); /* of the stretch */
        *slope = turned.re - change * value.re + I * (turned.im + change * value.im);
    }
    return qc__c(value);
}
/* The two parts of r_i, and their derivatives. */
static inline qc__cplx qc__side_in_s(const qc_distortion *d, int32_t i, qc_complex x) {
    return qc__side_value(d->stretch[d->side[i].s], false, d->side[i].in_s, x, NULL);
}
static inline qc__cplx qc__side_in_t(const qc_distortion *d, int32_t i, qc_complex x) {
    return qc__side_value(d->stretch[d->side[i].t], d->odd[i], d->side[i].in_t, x, NULL);
}
static inline qc__cplx qc__side_slope_s(const qc_distortion *d, int32_t i, qc_complex x) {
    qc__cplx slope;
    qc__side_value(d->stretch[d->side[i].s], false, d->side[i].in_s, x, &slope);
    return slope;
}
static inline qc__cplx qc__side_slope_t(const qc_distortion *d, int32_t i, qc_complex x) {
    qc__cplx slope;
    qc__side_value(d->stretch[d->side[i].t], d->odd[i], d->side[i].in_t, x, &slope);
    return slope;
}
/* The right-hand side of the smoothing changes by +-value at the two faces of the edge. */
double qc__flip_bend(const qc_distortion *d, qc_flip_step flip, int32_t *s, int32_t *t);
/* Marks the vertices on hard features of the field; hard: n_vertices, 0 before. */
void qc__find_hard(const qc_face_field *field, uint8_t *hard);
bool qc__face_is_fixed(const qc_distortion *d, int32_t t);
/* The present state as a point of the curves of Figure 6.1. */
void qc__sample_state(qc_ctx *ctx, const qc_distortion *d);
/* The factor of the matrix as it is. */
qc_status qc__refresh_factor(qc_ctx *ctx, qc_distortion *d);
qc_status qc__check_flips(qc_ctx *ctx, const qc_distortion *d, int32_t n, const qc_flip_step *flip);

/* --- prediction ------------------------------------------------------------------------------- */

/* The change of E_D is about first + c self with c near 1. */
typedef struct qc__prediction {
    double first; /* at the present potential, a lower bound */
    double self;  /* the energy of what the flip adds, near the edge */
} qc__prediction;
/* slope: n_faces, from qc__prepare_slope; v: n, L* v = r. Any thread. */
qc_status qc__prepare_slope(qc_ctx *ctx, const qc_distortion *d, const qc_complex *v,
                            double *slope);
qc__prediction qc__predict(const qc_distortion *d, const qc_complex *v, const double *slope,
                           qc_flip_step flip);

/* --- which flips may be made ------------------------------------------------------------------ */

typedef struct qc__rules {
    bool create;
    double spacing;
} qc__rules;
/* Whether the flip keeps the rules at the present state: number and indices of branch points, and
 * their distance. */
bool qc__flip_allowed(const qc_distortion *d, const qc__rules *rules, qc_flip_step flip);

/* Whether the index of a vertex may change so, in quarters. */
bool qc__index_allowed(int32_t old, int32_t new);

/* How many branch points more there are after the flip, -2 to 2. */
int32_t qc__new_branch_points(const qc_distortion *d, qc_flip_step flip);

#endif
