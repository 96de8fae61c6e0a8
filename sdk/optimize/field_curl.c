/* The field and its weak curl for a given matching: rotation by the angles of the smoothing (thesis
 * 5.2.1), r_e of (H.6), and the change of L* by a flip (thesis 6.2.1). */
#include "sdk/optimize/internal.h"

/* sin and cos by their series at a quarter of the angle and two doublings: no branches, and the
 * compiler makes vectors of it. |angle| is a few turns at most; the error a few units of 1e-16. */
static inline void sine_cosine(double angle, double *s, double *c) {
    const double turn = angle * (0.5 / QC__PI);
    const double q = 0.25 * (angle - 2 * QC__PI * (double)(int32_t)turn), z = q * q;
    double a = 1 - z * (1.0 / 342), b = 1 - z * (1.0 / 306); /* sin q = q a, 1 - cos q = z b / 2 */
    a = 1 - z * (1.0 / 272) * a;
    b = 1 - z * (1.0 / 240) * b;
    a = 1 - z * (1.0 / 210) * a;
    b = 1 - z * (1.0 / 182) * b;
    a = 1 - z * (1.0 / 156) * a;
    b = 1 - z * (1.0 / 132) * b;
    a = 1 - z * (1.0 / 110) * a;
    b = 1 - z * (1.0 / 90) * b;
    a = 1 - z * (1.0 / 72) * a;
    b = 1 - z * (1.0 / 56) * b;
    a = 1 - z * (1.0 / 42) * a;
    b = 1 - z * (1.0 / 30) * b;
    a = 1 - z * (1.0 / 20) * a;
    b = 1 - z * (1.0 / 12) * b;
    a = 1 - z * (1.0 / 6) * a;
    const double sine = q * a, s2 = 2 * sine * (1 - 0.5 * z * b), r2 = 2 * sine * sine;
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

static inline qc_complex curl_at(const qc__side *e, const qc_complex *x) {
    const qc_complex s = x[e->s], t = x[e->t], a = e->in_s, b = e->in_t;
    const qc_complex r = {(s.re * a.re + s.im * a.im) + (t.re * b.re + t.im * b.im),
                          (s.re * a.im - s.im * a.re) + (t.re * b.im - t.im * b.re)};
    return r;
}

qc_complex qc__flip_side(const qc_distortion *d, qc_flip_step flip) {
    return qc_quarter_turn(d->side[d->matrix->unknown[flip.edge]].in_t, flip.step);
}

/* The same with lengths which depend on the direction; what is turned is the value of t, after the
 * stretching. */
static void stretched_curl(const qc_distortion *d, const qc_complex *x, qc_flip_step flip,
                           qc_complex *r) {
    const int32_t flipped = flip.edge < 0 ? -1 : d->matrix->unknown[flip.edge];
    for (int32_t i = 0; i < d->n; i++) {
        const qc_complex t = qc__z(qc__side_in_t(d, i, x[d->side[i].t]));
        r[i] = qc__z(qc__side_in_s(d, i, x[d->side[i].s]) +
                     qc__c(i == flipped ? qc_quarter_turn(t, flip.step) : t));
    }
}

void qc__weak_curl(const qc_distortion *d, const qc_complex *x, qc_flip_step flip, qc_complex *r) {
    if (d->stretch) {
        stretched_curl(d, x, flip, r);
        return;
    }
    for (int32_t i = 0; i < d->n; i++) r[i] = curl_at(&d->side[i], x);
    if (flip.edge < 0) return;
    const int32_t i = d->matrix->unknown[flip.edge];
    qc__side changed = d->side[i];
    changed.in_t = qc__flip_side(d, flip);
    r[i] = curl_at(&changed, x);
}

bool qc__face_is_fixed(const qc_distortion *d, int32_t t) {
    return d->smoother.fixed[t];
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
