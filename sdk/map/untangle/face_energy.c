/* Energy, gradient and target shape of one face (see face_energy.h). */
#include "sdk/map/untangle/face_energy.h"
#include <math.h>

static const double theta = 0.5; /* balance of shape and area */

static qc_complex times(qc_complex a, qc_complex b) {
    const qc_complex c = {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    return c;
}

/* Thickens a sliver: keeps its longest edge and the foot of its height. */
static void thicken(qc_complex e[3], double thinnest) {
    int32_t k = 0;
    for (int32_t i = 1; i < 3; i++)
        if (hypot(e[i].re, e[i].im) > hypot(e[k].re, e[k].im)) k = i;
    const double length = hypot(e[k].re, e[k].im);
    const qc_complex ahead = {e[k].re / length, e[k].im / length}, back = {ahead.re, -ahead.im};
    qc_complex side = times(e[(k + 1) % 3], back);
    if (side.im >= thinnest * length) return;
    side.im = thinnest * length;
    side = times(side, ahead);
    e[(k + 1) % 3] = side;
    e[(k + 2) % 3] = (qc_complex){-e[k].re - side.re, -e[k].im - side.im};
}

void qc__target_hats(const qc_complex edge[3], double thinnest, qc_complex hat[3], double *area) {
    qc_complex e[3] = {edge[0], edge[1], edge[2]};
    thicken(e, thinnest);
    const double twice = e[0].re * e[1].im - e[0].im * e[1].re;
    *area = 0.5 * twice;
    for (int32_t k = 0; k < 3; k++) /* grad phi_k = J e_k / 2A */
        hat[k] = (qc_complex){-e[k].im / twice, e[k].re / twice};
}

/* Gradients of u and v in the target frame. */
static void jacobian(const qc_complex hat[3], const qc_complex f[3], qc_complex *du,
                     qc_complex *dv) {
    *du = *dv = (qc_complex){0, 0};
    for (int32_t k = 0; k < 3; k++) {
        du->re += f[k].re * hat[k].re;
        du->im += f[k].re * hat[k].im;
        dv->re += f[k].im * hat[k].re;
        dv->im += f[k].im * hat[k].im;
    }
}

static double det(qc_complex du, qc_complex dv) {
    return du.re * dv.im - du.im * dv.re;
}

double qc__jacobian_det(const qc_complex hat[3], const qc_complex f[3]) {
    qc_complex du, dv;
    jacobian(hat, f, &du, &dv);
    return det(du, dv);
}

/* From the gradients by du and dv to those by the corners. */
static void by_corners(const qc_complex hat[3], qc_complex gu, qc_complex gv,
                       qc_complex gradient[3]) {
    for (int32_t k = 0; k < 3; k++)
        gradient[k] = (qc_complex){gu.re * hat[k].re + gu.im * hat[k].im,
                                   gv.re * hat[k].re + gv.im * hat[k].im};
}

double qc__face_energy(const qc_complex hat[3], double A, double eps, double pull,
                       const qc_complex f[3], qc_complex gradient[3]) {
    qc_complex du, dv;
    jacobian(hat, f, &du, &dv);
    const double d = det(du, dv), root = sqrt(eps * eps + d * d);
    /* chi = (d + root) / 2 without cancellation for d < 0 */
    const double chi = d >= 0 ? 0.5 * (d + root) : 0.5 * eps * eps / (root - d);
    const double trace = du.re * du.re + du.im * du.im + dv.re * dv.re + dv.im * dv.im;
    const double top = (1 - theta) * trace + theta * (1 + d * d);
    const double by_trace = A * ((1 - theta) * 2 / chi + pull), by_one = A * pull;
    const double by_det = A * (theta * 2 * d / chi - top / chi * (0.5 * (1 + d / root)) / chi);
    const qc_complex gu = {by_trace * du.re + by_det * dv.im - by_one,
                           by_trace * du.im - by_det * dv.re};
    const qc_complex gv = {by_trace * dv.re - by_det * du.im,
                           by_trace * dv.im + by_det * du.re - by_one};
    by_corners(hat, gu, gv, gradient);
    return A * (top / chi + pull * (0.5 * trace + 1 - du.re - dv.im));
}

double qc__face_barrier(const qc_complex hat[3], double A, const qc_complex f[3],
                        qc_complex gradient[3]) {
    qc_complex du, dv;
    jacobian(hat, f, &du, &dv);
    const double d = det(du, dv);
    if (!(d > 0)) {
        for (int32_t k = 0; k < 3; k++) gradient[k] = (qc_complex){0, 0};
        return INFINITY;
    }
    const double trace = du.re * du.re + du.im * du.im + dv.re * dv.re + dv.im * dv.im;
    const double by_trace = A * 2 * (1 + 1 / (d * d)), by_det = -A * 2 * trace / (d * d * d);
    const qc_complex gu = {by_trace * du.re + by_det * dv.im, by_trace * du.im - by_det * dv.re};
    const qc_complex gv = {by_trace * dv.re - by_det * du.im, by_trace * dv.im + by_det * du.re};
    by_corners(hat, gu, gv, gradient);
    return A * trace * (1 + 1 / (d * d));
}

static double cross(qc_complex a, qc_complex b) {
    return a.re * b.im - a.im * b.re;
}

double qc__face_limit(const qc_complex f[3], const qc_complex p[3]) {
    qc_complex e[2], g[2];
    for (int32_t k = 0; k < 2; k++) {
        e[k] = (qc_complex){f[k + 1].re - f[0].re, f[k + 1].im - f[0].im};
        g[k] = (qc_complex){p[k + 1].re - p[0].re, p[k + 1].im - p[0].im};
    }
    const double c = cross(e[0], e[1]), b = cross(e[0], g[1]) + cross(g[0], e[1]);
    const double a = cross(g[0], g[1]), root = b * b - 4 * a * c;
    if (root < 0) return INFINITY;
    const double q = -0.5 * (b + copysign(sqrt(root), b)); /* the roots are q / a and c / q */
    const double first = q / a, second = c / q;
    return fmin(first > 0 ? first : INFINITY, second > 0 ? second : INFINITY);
}
