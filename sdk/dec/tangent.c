/* Orthonormal frames of the faces, edge vectors as complex numbers, and transport across edges
 * (docs/conventions.md: rho = -e_t / e_s). */
#include <math.h>

#include "sdk/dec/internal.h"
#include "sdk/mesh/internal.h"

/* out = a / |a|; false when a = 0. */
static bool normalise3(const double a[3], double out[3]) {
    const double length = sqrt(qc__dot3(a, a));
    for (int i = 0; i < 3; i++) out[i] = length > 0 ? a[i] / length : 0;
    return length > 0;
}

static void edge_vector(const qc_mesh *m, int32_t h, double out[3]) {
    const double *p = m->position + 3 * (size_t)qc_halfedge_start(m, h);
    const double *q = m->position + 3 * (size_t)qc_halfedge_end(m, h);
    for (int i = 0; i < 3; i++) out[i] = q[i] - p[i];
}

/* Unit vectors x along halfedge 0 and y = J x. Faces without area get some frame of their longest
 * direction. */
static void face_frame(const qc_mesh *m, int32_t t, double x[3], double y[3]) {
    double e0[3], e1[3], n[3], up[3];
    edge_vector(m, 3 * t, e0);
    edge_vector(m, 3 * t + 1, e1);
    if (!normalise3(e0, x) && !normalise3(e1, x)) x[0] = 1;
    qc__cross3(x, e1, n);
    qc__cross3(n, x, up);
    if (normalise3(up, y)) return;
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(x[i]) < fabs(x[axis])) axis = i;
    double unit[3] = {axis == 0, axis == 1, axis == 2};
    qc__cross3(x, unit, n);
    normalise3(n, y);
}

qc_status qc_tangent_edges(qc_ctx *ctx, const qc_mesh *m, qc_complex *edge) {
    (void)ctx;
    for (int32_t t = 0; t < m->n_faces; t++) {
        double x[3], y[3], e[3];
        face_frame(m, t, x, y);
        edge_vector(m, 3 * t, e);
        edge[3 * t].re = qc__dot3(e, x);
        edge[3 * t].im = 0;
        edge_vector(m, 3 * t + 1, e);
        edge[3 * t + 1].re = qc__dot3(e, x);
        edge[3 * t + 1].im = qc__dot3(e, y);
        edge[3 * t + 2].re = -edge[3 * t].re - edge[3 * t + 1].re;
        edge[3 * t + 2].im = -edge[3 * t + 1].im;
    }
    return QC_OK;
}

qc_status qc_tangent_frames(qc_ctx *ctx, const qc_mesh *m, double *real_axis,
                            double *imaginary_axis) {
    (void)ctx;
    for (int32_t t = 0; t < m->n_faces; t++)
        face_frame(m, t, real_axis + 3 * (size_t)t, imaginary_axis + 3 * (size_t)t);
    return QC_OK;
}

qc_status qc_tangent_transport(qc_ctx *ctx, const qc_mesh *m, const qc_complex *edge,
                               qc_complex *rho) {
    (void)ctx;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t s = m->edge_halfedge[2 * e], t = m->edge_halfedge[2 * e + 1];
        double _Complex r = 1;
        if (t >= 0) {
            const double _Complex es = qc__load(edge[s]), et = qc__load(edge[t]);
            const double length = cabs(es) * cabs(et);
            if (length > 0) {
                r = -et * conj(es) / length;
                r /= cabs(r);
            }
        }
        rho[e] = qc__store(r);
    }
    return QC_OK;
}
