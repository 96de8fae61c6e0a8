/* What a flip will do to E_D, from its surroundings alone. E_D = max over v of Re(v^H r) - 1/2 v^H
 * L* v gives, with v of the present state and r', D of the flip, E_D' - E_D = Re(v^H (r' - r)) -
 * 1/2 v^H D v + 1/2 rho^H (L* + D)^{-1} rho,   rho = r' - r - D v. The rotations of faces far from
 * the edge are small: there r' is linear in them, and one solve with the smoothing matrix gives
 * that part for all edges. Near the edge they are those of a regular mesh (1/3 of the turn in the
 * two faces, half of that in each further ring). rho is concentrated there, too, and the last term
 * is taken with the block of L* + D at the edges of the nearest faces. */
#include <string.h>

#include "sdk/optimize/internal.h"

enum { FACES = 6, EDGES = 13 };

typedef struct patch {
    int32_t n_faces, n;
    int32_t face[FACES];
    double angle[FACES]; /* rotation of the face by the flip */
    int32_t row[EDGES];  /* of L* */
} patch;

static void add_face(const qc_distortion *d, patch *p, int32_t t, double angle) {
    for (int32_t i = 0; i < p->n_faces; i++)
        if (p->face[i] == t) return;
    if (p->n_faces == FACES) return;
    p->face[p->n_faces] = t;
    p->angle[p->n_faces++] = angle;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        const int32_t row = d->matrix->unknown[d->mesh->halfedge_edge[h]];
        bool known = row < 0;
        for (int32_t i = 0; i < p->n && !known; i++) known = p->row[i] == row;
        if (!known && p->n < EDGES) p->row[p->n++] = row;
    }
}

static void add_ring(const qc_distortion *d, patch *p) {
    const int32_t n = p->n_faces;
    for (int32_t i = 0; i < n; i++)
        for (int32_t h = 3 * p->face[i]; h < 3 * p->face[i] + 3; h++)
            if (d->mesh->twin[h] >= 0) add_face(d, p, d->mesh->twin[h] / 3, 0.5 * p->angle[i]);
}

/* In the faces beyond the patch the halving goes on. */
static double angle_in(const qc_distortion *d, const patch *p, int32_t t) {
    for (int32_t i = 0; i < p->n_faces; i++)
        if (p->face[i] == t) return p->angle[i];
    double angle = 0;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++)
        for (int32_t i = 0; i < p->n_faces; i++)
            if (d->mesh->twin[h] >= 0 && d->mesh->twin[h] / 3 == p->face[i])
                angle += 0.5 * p->angle[i];
    return angle;
}

static double _Complex entry(const qc_hermitian *A, int32_t i, int32_t j) {
    const int32_t row = i < j ? i : j, col = i < j ? j : i;
    for (int64_t k = A->colptr[col]; k < A->colptr[col + 1]; k++)
        if (A->row[k] == row) return i < j ? qc__c(A->val[k]) : conj(qc__c(A->val[k]));
    return 0;
}

/* 1/2 b^H B^{-1} b by elimination; B: n x n Hermitian positive definite, the upper triangle used.
 */
static double half_energy(int32_t n, double _Complex B[EDGES][EDGES], double _Complex *b) {
    double sum = 0;
    for (int32_t i = 0; i < n; i++) {
        const double pivot = creal(B[i][i]);
        if (!(pivot > 0)) return INFINITY;
        sum += 0.5 * (creal(b[i]) * creal(b[i]) + cimag(b[i]) * cimag(b[i])) / pivot;
        for (int32_t j = i + 1; j < n; j++) {
            const double _Complex factor = conj(B[i][j]) / pivot;
            if (creal(factor) == 0 && cimag(factor) == 0) continue;
            for (int32_t k = j; k < n; k++) B[j][k] -= factor * B[i][k];
            b[j] -= factor * b[i];
        }
    }
    return sum;
}

static double _Complex rotation(double angle) { /* e^{-i angle} for |angle| <= pi / 6 */
    const double z = angle * angle;
    return (1 - z / 2 * (1 - z / 12 * (1 - z / 30))) - I * angle * (1 - z / 6 * (1 - z / 20));
}

/* r' - r at one edge, and the linear part of that which `slope` already has. The faces turn by as
 * and at, the value in t by `turn` besides. */
static void stretched_near_edge(const qc_distortion *d, int32_t row, double as, double at,
                                double _Complex turn, double _Complex *change,
                                double _Complex *linear) {
    const qc__side *e = &d->side[row];
    const qc_complex xs = d->x[e->s], xt = d->x[e->t];
    const double _Complex s = qc__side_in_s(d, row, qc__z(qc__c(xs) * conj(rotation(as))));
    const double _Complex t = qc__side_in_t(d, row, qc__z(qc__c(xt) * conj(rotation(at))));
    *change = s - qc__side_in_s(d, row, xs) + turn * t - qc__side_in_t(d, row, xt);
    *linear = as * qc__side_slope_s(d, row, xs) + at * qc__side_slope_t(d, row, xt);
}

static void near_edge(const qc_distortion *d, const patch *p, int32_t row, qc_flip_step flip,
                      double _Complex *change, double _Complex *linear) {
    const qc__side *e = &d->side[row];
    const double as = angle_in(d, p, e->s), at = angle_in(d, p, e->t);
    const bool flipped = row == d->matrix->unknown[flip.edge];
    const double _Complex turn = !flipped ? 1.0 : flip.step > 0 ? I : -I;
    if (d->stretch) {
        stretched_near_edge(d, row, as, at, turn, change, linear);
        return;
    }
    const double _Complex s = conj(qc__c(d->x[e->s])) * qc__c(e->in_s);
    const double _Complex t = conj(qc__c(d->x[e->t])) * qc__c(e->in_t);
    *change = s * (rotation(as) - 1) + t * (turn * rotation(at) - 1);
    *linear = -I * (s * as + t * at);
}

static double real_product(qc_complex a, double _Complex b) {
    return a.re * creal(b) + a.im * cimag(b);
}

qc__prediction qc__predict(const qc_distortion *d, const qc_complex *v, const double *slope,
                           qc_flip_step flip) {
    int32_t s, t;
    const double bend = qc__flip_bend(d, flip, &s, &t), third = -flip.step * QC__PI / 6;
    const qc__coupling c = qc__flip_coupling(d, flip);
    patch p = {0};
    add_face(d, &p, s, third);
    add_face(d, &p, t, -third);
    add_ring(d, &p);
    double _Complex B[EDGES][EDGES], rho[EDGES];
    double first = bend * (slope[s] - slope[t]);
    for (int32_t i = 0; i < p.n; i++) {
        double _Complex change, linear;
        near_edge(d, &p, p.row[i], flip, &change, &linear);
        first += real_product(v[p.row[i]], change - linear);
        rho[i] = change;
        for (int32_t j = i; j < p.n; j++) B[i][j] = entry(&d->matrix->A, p.row[i], p.row[j]);
    }
    for (int32_t q = 0; q < c.n; q++) {
        first -= real_product(v[c.k], qc__c(c.d[q]) * qc__c(v[c.row[q]]));
        for (int32_t i = 0; i < p.n; i++) {
            if (p.row[i] == c.k) rho[i] -= qc__c(c.d[q]) * qc__c(v[c.row[q]]);
            if (p.row[i] == c.row[q]) rho[i] -= conj(qc__c(c.d[q])) * qc__c(v[c.k]);
            for (int32_t j = i; j < p.n; j++) {
                if (p.row[i] == c.k && p.row[j] == c.row[q]) B[i][j] += qc__c(c.d[q]);
                if (p.row[j] == c.k && p.row[i] == c.row[q]) B[i][j] += conj(qc__c(c.d[q]));
            }
        }
    }
    const qc__prediction out = {first, half_energy(p.n, B, rho)};
    return out;
}

/* d Re(v^H r) / d alpha_t, then through the smoothing matrix. */
qc_status qc__prepare_slope(qc_ctx *ctx, const qc_distortion *d, const qc_complex *v,
                            double *slope) {
    memset(slope, 0, (size_t)d->mesh->n_faces * sizeof *slope);
    for (int32_t i = 0; i < d->n; i++) {
        const qc__side *e = &d->side[i];
        const double _Complex w = conj(qc__c(v[i]));
        if (d->stretch) {
            slope[e->s] += creal(w * qc__side_slope_s(d, i, d->x[e->s]));
            slope[e->t] += creal(w * qc__side_slope_t(d, i, d->x[e->t]));
            continue;
        }
        slope[e->s] += cimag(w * conj(qc__c(d->x[e->s])) * qc__c(e->in_s));
        slope[e->t] += cimag(w * conj(qc__c(d->x[e->t])) * qc__c(e->in_t));
    }
    for (int32_t t = 0; t < d->mesh->n_faces; t++)
        if (qc__face_is_fixed(d, t)) slope[t] = 0;
    return qc_solve_real(ctx, d->smoother.factor, 1, slope);
}
