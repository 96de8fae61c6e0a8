/* Energy, gradient and target shapes for untangling (see energy.h). */
#include "sdk/map/untangle/energy.h"
#include <math.h>
#include <string.h>

static const double theta = 0.5;     /* balance of shape and area                                 */
static const double thinnest = 0.05; /* least height of a target shape over its longest edge */

static qc_complex times(qc_complex a, qc_complex b) {
    const qc_complex c = {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    return c;
}

/* Thickens a sliver: keeps its longest edge and the foot of its height. e: ccw edge vectors. */
static void thicken(qc_complex e[3]) {
    int32_t k = 0;
    for (int32_t i = 1; i < 3; i++)
        if (hypot(e[i].re, e[i].im) > hypot(e[k].re, e[k].im)) k = i;
    const double length = hypot(e[k].re, e[k].im);
    const qc_complex back = {e[k].re / length, -e[k].im / length};
    qc_complex side = times(e[(k + 1) % 3], back);
    if (side.im < thinnest * length) side.im = thinnest * length;
    e[k] = (qc_complex){length, 0};
    e[(k + 1) % 3] = side;
    e[(k + 2) % 3] = (qc_complex){-length - side.re, -side.im};
}

qc_status qc__untangle_targets(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                               qc_complex *hat, double *area) {
    const qc_status status = qc_tangent_edges(ctx, mesh, hat);
    if (status != QC_OK) return status;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        qc_complex *e = hat + 3 * (int64_t)t;
        for (int32_t k = 0; k < 3; k++) {
            e[k].re /= edge_length;
            e[k].im /= edge_length;
        }
        thicken(e);
        const double twice = e[0].re * e[1].im - e[0].im * e[1].re;
        area[t] = 0.5 * twice;
        for (int32_t k = 0; k < 3; k++) /* grad phi_k = J e_k / 2A */
            e[k] = (qc_complex){-e[k].im / twice, e[k].re / twice};
    }
    return QC_OK;
}

/* Corner parameters of face t under the unknowns. */
static void corners(const qc__patch *p, const double *x, int32_t t, qc_complex f[3]) {
    for (int32_t k = 0; k < 3; k++) {
        const int64_t c = 3 * (int64_t)t + k;
        const int32_t v = p->map->mesh->face_vertex[c], j = p->local[v];
        qc_complex value = p->map->value[v];
        if (j >= 0) value = (qc_complex){x[2 * (int64_t)j], x[2 * (int64_t)j + 1]};
        f[k] = qc__reduced_map_corner(p->map, value, c);
    }
}

/* Gradients of u and v in the target frame. */
static void jacobian(const qc_complex *hat, const qc_complex f[3], qc_complex *du, qc_complex *dv) {
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

double qc__face_det(const qc__reduced_map *map, const qc_complex *hat, int32_t t) {
    qc_complex f[3], du, dv;
    for (int32_t k = 0; k < 3; k++) {
        const int64_t c = 3 * (int64_t)t + k;
        f[k] = qc__reduced_map_corner(map, map->value[map->mesh->face_vertex[c]], c);
    }
    jacobian(hat + 3 * (int64_t)t, f, &du, &dv);
    return det(du, dv);
}

double qc__patch_energy(qc__patch *p, const double *x, double *gradient) {
    p->work += p->n_faces;
    memset(gradient, 0, sizeof *gradient * 2 * (size_t)p->n_vertices);
    double energy = 0;
    for (int32_t i = 0; i < p->n_faces; i++) {
        const int32_t t = p->face[i];
        const qc_complex *hat = p->hat + 3 * (int64_t)t;
        qc_complex f[3], du, dv;
        corners(p, x, t, f);
        jacobian(hat, f, &du, &dv);
        const double d = det(du, dv), root = sqrt(p->eps * p->eps + d * d);
        /* chi = (d + root) / 2 without cancellation for d < 0 */
        const double chi = d >= 0 ? 0.5 * (d + root) : 0.5 * p->eps * p->eps / (root - d);
        const double trace = du.re * du.re + du.im * du.im + dv.re * dv.re + dv.im * dv.im;
        const double top = (1 - theta) * trace + theta * (1 + d * d), A = p->area[t];
        energy += A * top / chi;
        const double by_trace = A * (1 - theta) * 2 / chi;
        const double by_det = A * (theta * 2 * d / chi - top / chi * (0.5 * (1 + d / root)) / chi);
        const qc_complex gu = {by_trace * du.re + by_det * dv.im,
                               by_trace * du.im - by_det * dv.re};
        const qc_complex gv = {by_trace * dv.re - by_det * du.im,
                               by_trace * dv.im + by_det * du.re};
        for (int32_t k = 0; k < 3; k++) {
            const int64_t c = 3 * (int64_t)t + k;
            const int32_t j = p->local[p->map->mesh->face_vertex[c]];
            if (j < 0) continue;
            const qc_complex at_corner = {gu.re * hat[k].re + gu.im * hat[k].im,
                                          gv.re * hat[k].re + gv.im * hat[k].im};
            const qc_complex at_vertex = qc_quarter_turn(at_corner, -p->map->turn[c]);
            const uint8_t fixed = p->map->fixed[p->vertex[j]];
            if (!(fixed & 1)) gradient[2 * (int64_t)j] += at_vertex.re;
            if (!(fixed & 2)) gradient[2 * (int64_t)j + 1] += at_vertex.im;
        }
    }
    return energy;
}

double qc__patch_min_det(const qc__patch *p, const double *x) {
    double least = INFINITY;
    for (int32_t i = 0; i < p->n_faces; i++) {
        const int32_t t = p->face[i];
        qc_complex f[3], du, dv;
        corners(p, x, t, f);
        jacobian(p->hat + 3 * (int64_t)t, f, &du, &dv);
        const double d = det(du, dv);
        if (d < least) least = d;
    }
    return least;
}
