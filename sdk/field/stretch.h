/* Lengths which depend on the direction (qc_sizing_set_stretch): what they do to the frame of a
 * cross. A cross x has the lengths h e^s along X and h e^-s along Y, s = Re(stretch conj(x)^2), so
 * that Z(e) = <X, e> / h_u + i <Y, e> / h_v is that of the length h, stretched by s. */
#ifndef QC_FIELD_STRETCH_H
#define QC_FIELD_STRETCH_H

#include <math.h>
#include <qc/field.h>

/* s above. */
static inline double qc__stretch_along(qc_complex stretch, qc_complex x) {
    return stretch.re * (x.re * x.re - x.im * x.im) + stretch.im * 2 * x.re * x.im;
}

/* The frame's value on a vector where z is that for equal lengths. */
static inline qc_complex qc__stretched(qc_complex z, double s) {
    const double shrink = exp(-s);
    return (qc_complex){z.re * shrink, z.im / shrink};
}

/* The stretch (n_faces) of the ratio sqrt(|k1 / k2|), at most `most`, of the curvatures kappa (2
 * n_faces, |k1| >= |k2|, that along x first), averaged over about `radius`. Errors: NOMEM,
 * CANCELLED. */
qc_status qc__curvature_stretch(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                                const double *kappa, double most, double radius,
                                qc_complex *stretch);

#endif
