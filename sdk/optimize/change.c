/* Several flips at once: L* follows by updates of its factor (thesis 6.2.1), the field by one
 * solve, E_D = 1/2 |y|^2 by a forward solve. Refused changes are rolled back bit for bit. */
#include "sdk/optimize/internal.h"

#include <string.h>

/* Above this many flips at once a new factorisation is cheaper than the sweeps. */
#define SWEEPS_MAX 48

static void add_entry(const qc_hermitian *A, int32_t i, int32_t j, qc_complex d) {
    const int32_t row = i < j ? i : j, col = i < j ? j : i;
    qc_complex *value = (qc_complex *)A->val; /* owned by the stiffness of the distortion */
    for (int64_t p = A->colptr[col]; p < A->colptr[col + 1]; p++) {
        if (A->row[p] != row) continue;
        value[p].re += d.re;
        value[p].im += i < j ? d.im : -d.im;
    }
}

/* Index (K + sum +-theta) / 2 pi: theta falls by a quarter turn for each step, and counts with + at
 * the end of the halfedge in s, with - at its start. */
static void step_matching(qc_distortion *d, qc_flip_step flip) {
    const int32_t h = d->mesh->edge_halfedge[2 * flip.edge];
    const int32_t p[2] = {qc_halfedge_start(d->mesh, h), qc_halfedge_end(d->mesh, h)};
    d->m[flip.edge] = (int8_t)(d->m[flip.edge] + flip.step);
    for (int i = 0; i < 2; i++) {
        if (qc_vertex_on_boundary(d->mesh, p[i])) continue;
        d->branch_points -= d->index4[p[i]] != 0;
        d->index4[p[i]] += i == 0 ? flip.step : -flip.step;
        d->branch_points += d->index4[p[i]] != 0;
    }
}

/* Matrix, matching and bend; *coupling tells what to do to the factor. */
static void flip_state(qc_distortion *d, qc_flip_step flip, qc__coupling *coupling) {
    int32_t s, t;
    const double bend = qc__flip_bend(d, flip, &s, &t);
    *coupling = qc__flip_coupling(d, flip);
    for (int32_t i = 0; i < coupling->n; i++)
        add_entry(&d->matrix->A, coupling->k, coupling->row[i], coupling->d[i]);
    d->side[coupling->k].in_t = qc__flip_side(d, flip);
    if (d->odd) d->odd[coupling->k] = !d->odd[coupling->k];
    if (!qc__face_is_fixed(d, s)) d->bend[s] += bend;
    if (!qc__face_is_fixed(d, t)) d->bend[t] -= bend;
    step_matching(d, flip);
}

static qc_status flip_factor(qc_ctx *ctx, qc_distortion *d, const qc__coupling *c) {
    if (c->n == 0) return QC_OK;
    const int last = c->n - 1;
    const qc_complex zero = {0, 0};
    d->updates++;
    return qc_flip(ctx, d->factor, c->k, c->row[0], c->d[0], c->row[last], last ? c->d[1] : zero);
}

static void flip_back(qc_distortion *d, int32_t n, const qc_flip_step *flip) {
    for (int32_t i = n; i-- > 0;) {
        const qc_flip_step back = {flip[i].edge, -flip[i].step};
        qc__coupling coupling;
        flip_state(d, back, &coupling);
    }
}

/* angle, turned and curl get the rotations, field and weak curl of the present matching. */
static qc_status measure(qc_ctx *ctx, qc_distortion *d, double *energy) {
    const size_t F = (size_t)d->mesh->n_faces, n = (size_t)d->n;
    const qc_flip_step none = {-1, 0};
    memcpy(d->angle, d->bend, F * sizeof *d->angle);
    qc_status status = qc_solve_real(ctx, d->smoother.factor, 1, d->angle);
    if (status) return status;
    qc__rotate_field(d->mesh->n_faces, d->angle, d->start->field->x, d->turned);
    qc__weak_curl(d, d->turned, none, d->curl);
    memcpy(d->curl + n, d->curl, n * sizeof *d->curl);
    status = qc_solve_forward(ctx, d->factor, 1, d->curl + n);
    double square = 0;
    for (size_t i = n; i < 2 * n; i++)
        square += d->curl[i].re * d->curl[i].re + d->curl[i].im * d->curl[i].im;
    *energy = 0.5 * square;
    d->evaluations++;
    return status;
}

static void keep(qc_distortion *d, int32_t n, double energy) {
    const size_t F = (size_t)d->mesh->n_faces;
    memcpy(d->alpha, d->angle, F * sizeof *d->alpha);
    memcpy(d->x, d->turned, F * sizeof *d->x);
    memcpy(d->r, d->curl, (size_t)d->n * sizeof *d->r);
    d->energy = energy;
    d->changes += n;
}

/* Every flip in a factor of its own state: a failed update means L* became singular on the way. */
static qc_status update_factor(qc_ctx *ctx, qc_distortion *d, int32_t n, const qc_flip_step *flip,
                               int32_t *done) {
    qc_status status = QC_OK;
    for (*done = 0; !status && *done < n; ++*done) {
        qc__coupling coupling;
        flip_state(d, flip[*done], &coupling);
        if (n <= SWEEPS_MAX) status = flip_factor(ctx, d, &coupling);
    }
    if (!status && n > SWEEPS_MAX) {
        d->stale = true;
        status = qc__refresh_factor(ctx, d);
    }
    return status;
}

static qc_status undo(qc_ctx *ctx, qc_distortion *d, int32_t n, int32_t done,
                      const qc_flip_step *flip) {
    flip_back(d, done, flip);
    if (n > SWEEPS_MAX) {
        d->stale = true;
        return qc__refresh_factor(ctx, d);
    }
    return qc_factor_rollback(ctx, d->factor);
}

qc_status qc_distortion_change(qc_ctx *ctx, qc_distortion *d, int32_t n, const qc_flip_step *flip,
                               double limit, double *energy, bool *accepted) {
    double found = INFINITY;
    int32_t done = 0;
    qc_status status = qc__check_flips(ctx, d, n, flip);
    if (!status) status = qc__refresh_factor(ctx, d);
    if (!status && n <= SWEEPS_MAX) status = qc_factor_begin(ctx, d->factor);
    if (status) return status;
    status = update_factor(ctx, d, n, flip, &done);
    const bool singular = status == QC_ERR_NOT_POSDEF;
    if (!status) status = measure(ctx, d, &found);
    const bool better = !status && found < limit;
    if (better) {
        keep(d, n, found);
        qc__sample_state(ctx, d);
        if (n <= SWEEPS_MAX) status = qc_factor_commit(ctx, d->factor);
    } else {
        const qc_status undone = undo(ctx, d, n, done, flip);
        if (singular) qc__clear_error(ctx);
        if (!status || singular) status = undone;
    }
    if (energy) *energy = found;
    if (accepted) *accepted = better;
    return status;
}
