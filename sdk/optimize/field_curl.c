/* The field and its weak curl for a given matching: rotation by the angles of the smoothing (thesis
 * 5.2.1), r_e of (H.6), and the change of L* by a flip (thesis 6.2.1). */
#include "sdk/optimize/internal.h"

/* sin and cos by their series at a quarter of the angle and two doublings: no branches, and the
 * compiler makes vectors of it. |angle| is a few turns at most; the error a few units of 1e-16. */
static inline void sine_cosine(double angle, double *s, double *c) {
    const double turn = angle * (0.5 / QC__PI);
    const double q = 0.25 * (angle - 2 * QC__PI * (double)(int32_t)turn), z = q * q;
    const double sine =
        q *
        (1 -
         z / 6 *
             (1 -
              z / 20 *
                  (1 - z / 42 *
                           (1 - z / 72 *
                                    (1 - z / 110 *
                                             (1 - z / 156 *
                                                      (1 - z / 210 *
                                                               (1 - z / 272 * (1 - z / 342)))))))));
    const double rest = /* 1 - cos */
        z / 2 *
        (1 -
         z / 12 *
             (1 - z / 30 *
                      (1 - z / 56 *
                               (1 - z / 90 *
                                        (1 - z / 132 *
                                                 (1 - z / 182 * (1 - z / 240 * (1 - z / 306))))))));
    const double s2 = 2 * sine * (1 - rest), r2 = 2 * sine * sine;
    *s = 2 * s2 * (1 - r2);
    *c = 1 - 2 * s2 * s2;
}

void qc__rotate_field(int32_t n, const double *angle, const qc_complex *x, qc_complex *out) {
    for (int32_t t = 0; t < n; t++) {
        double s, c;
        sine_cosine(angle[t], &s, &c);
        const double re = x[t].re * c - x[t].im * s, im = x[t].re * s + x[t].im * c;
        out[t].re = re;
        out[t].im = im;
    }
}

/* conj(x) e. */
static inline qc_complex value(qc_complex x, qc_complex e) {
    const qc_complex z = {x.re * e.re + x.im * e.im, x.re * e.im - x.im * e.re};
    return z;
}

void qc__weak_curl(const qc_distortion *d, const qc_complex *x, qc_flip_step flip, qc_complex *r) {
    const int32_t *halfedge = d->mesh->edge_halfedge, *unknown = d->matrix->unknown;
    for (int32_t e = 0; e < d->mesh->n_edges; e++) {
        if (unknown[e] < 0) continue;
        const int32_t h = halfedge[2 * e], g = halfedge[2 * e + 1];
        const int32_t m = d->m[e] + (e == flip.edge ? flip.step : 0);
        const qc_complex s = value(x[h / 3], d->side[h]);
        const qc_complex t = qc_quarter_turn(value(x[g / 3], d->side[g]), m);
        r[unknown[e]].re = s.re + t.re;
        r[unknown[e]].im = s.im + t.im;
    }
}

bool qc__face_is_fixed(const qc_distortion *d, int32_t t) {
    return d->smoother.fixed[d->mesh->face_component[t]] == t;
}

double qc__flip_bend(const qc_distortion *d, qc_flip_step flip, int32_t *s, int32_t *t) {
    *s = d->mesh->edge_halfedge[2 * flip.edge] / 3;
    *t = d->mesh->edge_halfedge[2 * flip.edge + 1] / 3;
    return -d->smoother.lambda * d->smoother.c.omega[flip.edge] * flip.step * QC__PI / 2;
}

/* In the face t of the edge e with p_e = i^{-m}: L_eb = -2 c conj(p_e) p_b for the other two edges
 * b, c the cotangent between them. */
qc__coupling qc__flip_coupling(const qc_distortion *d, qc_flip_step flip) {
    const qc_mesh *mesh = d->mesh;
    const int32_t g = mesh->edge_halfedge[2 * flip.edge + 1], m = d->m[flip.edge];
    const int32_t other[2] = {qc_next(g), qc_prev(g)};
    qc__coupling out = {d->matrix->unknown[flip.edge], 0, {-1, -1}, {{0, 0}, {0, 0}}};
    for (int i = 0; i < 2; i++) {
        const int32_t h = other[i], b = mesh->halfedge_edge[h], row = d->matrix->unknown[b];
        if (row < 0) continue;
        const int32_t turn = mesh->edge_halfedge[2 * b] == h ? 0 : -d->m[b];
        const qc_complex weight = {-2 * d->cotangent[other[1 - i]], 0};
        const qc_complex new = qc_quarter_turn(weight, m + flip.step + turn);
        const qc_complex old = qc_quarter_turn(weight, m + turn);
        out.row[out.n] = row;
        out.d[out.n].re = new.re - old.re;
        out.d[out.n++].im = new.im - old.im;
    }
    return out;
}
