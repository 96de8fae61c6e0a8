/* The trinoid of Jorge and Meeks (1983): Weierstrass data g = z^2, eta = dz / (z^3 - 1)^2 on the
 * sphere minus the cube roots of unity w_k. X = Re int ((1 - g^2)/2, i (1 + g^2)/2, g) eta is
 * elementary: with N / (z^3 - 1)^2 = sum_k A_k / (z - w_k)^2 + B_k / (z - w_k), B_k real, each
 * coordinate is sum_k Re(-A_k / (z - w_k)) + B_k log|z - w_k|. Each end is cut off at a small
 * circle. */
#include <complex.h>

#include "sdk/shape/internal.h"

static const double HOLE = 0.22; /* spherical radius of the disks removed round w_k */

typedef struct half_lune {
    int end; /* k                                                                               */
    double side; /* +1, -1: the meridian which bounds it */
} half_lune;

/* Coefficients of x1 = 1/2 int (1 - z^4) eta and x2 = i/2 int (1 + z^4) eta. */
static double coordinate(double _Complex z, double _Complex constant, double _Complex quartic) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double _Complex w = cexp(I * (2 * QC__PI * k / 3));
        double _Complex q = 3 * w * w, dq = 3 * w; /* (z^3 - 1)/(z - w) and its derivative at w */
        double _Complex n = constant + quartic * w * w * w * w, dn = 4 * quartic * w * w * w;
        double _Complex a = n / (q * q), b = dn / (q * q) - 2 * n * dq / (q * q * q);
        sum += creal(-a / (z - w)) + creal(b) * log(cabs(z - w));
    }
    return sum;
}

static void weierstrass(double _Complex z, double out[3]) {
    out[0] = coordinate(z, 0.5, -0.5);
    out[1] = coordinate(z, 0.5 * I, 0.5 * I);
    out[2] = creal(-1 / (3 * (z * z * z - 1))) - 1.0 / 6;
}

/* u along the meridian from z = 0 to infinity, v from it towards the end. Beyond the unit circle
 * the symmetry z -> 1 / conj(z) is used: it reflects x3. */
static void trinoid(const void *data, double u, double v, double out[3]) {
    const half_lune *h = data;
    double height = QC__PI * (u - 0.5), sector = h->side * QC__PI / 3;
    double b[3] = {cos(height) * cos(sector), cos(height) * sin(sector), sin(height)};
    double full = acos(b[0]), angle = full * pow(HOLE / full, v);
    double across[3] = {0, b[1] / sin(full), b[2] / sin(full)};
    double x = cos(angle), y = sin(angle) * across[1], up = sin(angle) * across[2];
    bool upper = up > 0;
    double _Complex z = (x + I * y) / (1 + fabs(up)) * cexp(I * (2 * QC__PI * h->end / 3));
    weierstrass(z, out);
    if (upper) out[2] = -out[2];
}

void qc__shape_trinoid(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 6 * 0.6, 2);
    int32_t m = (int32_t)(0.6 * n + 0.5);
    for (int i = 0; i < 6; i++) {
        half_lune h = {i / 2, i % 2 ? -1 : 1};
        qc__soup_patch(soup, 2 * ((n + 1) / 2), m < 1 ? 1 : m, h.side > 0, trinoid, &h);
    }
}
