/* E_D of flips made alone (thesis 6.2.1), several at a time and without touching the factor. With
 * the factor L of L*, the changed weak curl r' and the change D = U C U^H of L* by the flip of edge
 * k, U = (e_k, g), C = (0 1; 1 0), the formula of Sherman, Morrison and Woodbury gives
 *     2 E_D = |y|^2 - u^H M^{-1} u,   M = C + Y^H Y,   u = Y^H y,   L y = r',   L Y = U.
 * Y lives on the paths of three rows to the root of the elimination tree; the right-hand sides r'
 * of all trials share one pass over the factor. det(L* + D) / det(L*) = -det M tells a singular
 * one. */
#include "sdk/optimize/internal.h"

#include <string.h>

/* Smallest determinant of L* after a flip against that before. */
static const double SINGULAR = 1e-9;

typedef struct batch {
    qc_distortion *d;
    const qc_flip_step *flip;
    double *energy;
} batch;

static qc_status smooth_trials(qc_ctx *ctx, qc_distortion *d, int32_t n, const qc_flip_step *flip) {
    const size_t F = (size_t)d->mesh->n_faces;
    memset(d->angle, 0, F * (size_t)n * sizeof *d->angle);
    for (int32_t i = 0; i < n; i++) {
        int32_t s, t;
        const double bend = qc__flip_bend(d, flip[i], &s, &t);
        double *angle = d->angle + F * (size_t)i;
        if (!qc__face_is_fixed(d, s)) angle[s] += bend;
        if (!qc__face_is_fixed(d, t)) angle[t] -= bend;
    }
    return qc_solve_real(ctx, d->smoother.factor, n, d->angle);
}

static void curl_of_trials(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const batch *b = arg;
    const size_t F = (size_t)b->d->mesh->n_faces, n = (size_t)b->d->n;
    (void)worker;
    for (int64_t i = begin; i < end; i++) {
        qc_complex *x = b->d->turned + F * (size_t)i;
        qc__rotate_field(b->d->mesh->n_faces, b->d->angle + F * (size_t)i, b->d->x, x);
        qc__weak_curl(b->d, x, b->flip[i], b->d->curl + n * (size_t)i);
    }
}

/* sum of conj(a_i) b_i over the rows which two ascending lists share; b dense when list = NULL. */
static double _Complex product(int32_t na, const int32_t *ia, const qc_complex *a, int32_t nb,
                               const int32_t *ib, const qc_complex *b) {
    double re = 0, im = 0;
    for (int32_t i = 0, j = 0; i < na; i++) {
        if (ib) {
            while (j < nb && ib[j] < ia[i]) j++;
            if (j == nb) break;
            if (ib[j] != ia[i]) continue;
        } else {
            j = ia[i];
        }
        re += a[i].re * b[j].re + a[i].im * b[j].im;
        im += a[i].re * b[j].im - a[i].im * b[j].re;
    }
    return re + im * I;
}

static double norm2(int32_t n, const qc_complex *y) {
    double sum[4] = {0, 0, 0, 0};
    int32_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; k++) sum[k] += y[i + k].re * y[i + k].re + y[i + k].im * y[i + k].im;
    for (; i < n; i++) sum[0] += y[i].re * y[i].re + y[i].im * y[i].im;
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* The two columns of Y of trial i; count[2] their lengths. */
static qc_status solve_columns(qc_ctx *ctx, qc_distortion *d, const qc__coupling *c,
                               int32_t count[2]) {
    const qc_complex one = {1, 0};
    qc_complex g[2]; /* D = e_k g^H + g e_k^H */
    for (int i = 0; i < 2; i++) g[i] = (qc_complex){c->d[i].re, -c->d[i].im};
    const qc_status status = qc_solve_forward_sparse(ctx, d->factor, 1, &c->k, &one, d->n, d->reach,
                                                     d->sparse, &count[0]);
    if (status) return status;
    return qc_solve_forward_sparse(ctx, d->factor, c->n, c->row, g, d->n, d->reach + d->n,
                                   d->sparse + d->n, &count[1]);
}

static qc_status trial_energy(qc_ctx *ctx, qc_distortion *d, qc_flip_step flip, const qc_complex *y,
                              double *energy) {
    const qc__coupling c = qc__flip_coupling(d, flip);
    double square = norm2(d->n, y);
    if (c.n > 0) {
        int32_t count[2];
        const qc_status status = solve_columns(ctx, d, &c, count);
        if (status) return status;
        const int32_t *i0 = d->reach, *i1 = d->reach + d->n;
        const qc_complex *y0 = d->sparse, *y1 = d->sparse + d->n;
        const double a = norm2(count[0], y0), b = norm2(count[1], y1);
        const double _Complex q = 1 + product(count[0], i0, y0, count[1], i1, y1);
        const double _Complex u0 = product(count[0], i0, y0, 0, NULL, y);
        const double _Complex u1 = product(count[1], i1, y1, 0, NULL, y);
        const double det = a * b - (creal(q) * creal(q) + cimag(q) * cimag(q));
        if (!(det < -SINGULAR)) {
            *energy = INFINITY;
            return QC_OK;
        }
        /* u^H M^{-1} u with M = (a q; conj(q) b) */
        const double uu =
            b * creal(u0 * conj(u0)) + a * creal(u1 * conj(u1)) - 2 * creal(conj(u0) * q * u1);
        square -= uu / det;
    }
    *energy = 0.5 * square;
    return QC_OK;
}

qc_status qc__check_flips(qc_ctx *ctx, const qc_distortion *d, int32_t n,
                          const qc_flip_step *flip) {
    for (int32_t i = 0; i < n; i++) {
        const int32_t e = flip[i].edge;
        if (e < 0 || e >= d->mesh->n_edges || !qc_distortion_can_flip(d, e))
            return qc__fail(ctx, QC_ERR_ARGUMENT, e,
                            "edge %d cannot be flipped: it is on the boundary, at a hard feature "
                            "or in a component with trivial holonomy",
                            (int)e);
        if (flip[i].step != 1 && flip[i].step != -1)
            return qc__fail(ctx, QC_ERR_ARGUMENT, e, "step %d of edge %d is neither 1 nor -1",
                            (int)flip[i].step, (int)e);
    }
    return QC_OK;
}

static qc_status try_batch(qc_ctx *ctx, qc_distortion *d, int32_t n, const qc_flip_step *flip,
                           double *energy) {
    batch b = {d, flip, energy};
    qc_status status = smooth_trials(ctx, d, n, flip);
    if (status) return status;
    qc__parallel_for(ctx, n, 1, curl_of_trials, &b);
    status = qc_solve_forward(ctx, d->factor, n, d->curl);
    for (int32_t i = 0; !status && i < n; i++)
        status = trial_energy(ctx, d, flip[i], d->curl + (size_t)d->n * (size_t)i, &energy[i]);
    d->evaluations += n;
    return status;
}

qc_status qc_distortion_try(qc_ctx *ctx, qc_distortion *d, int32_t n, const qc_flip_step *flip,
                            double *energy) {
    qc_status status = qc__check_flips(ctx, d, n, flip);
    if (!status) status = qc__refresh_factor(ctx, d);
    for (int32_t i = 0; !status && i < n; i += QC__TRIALS) {
        const int32_t k = n - i < QC__TRIALS ? n - i : QC__TRIALS;
        status = try_batch(ctx, d, k, flip + i, energy + i);
    }
    return status;
}
