/* Costa's minimal surface: torus C / (Z + iZ) minus 0, 1/2, i/2 in the closed form of A. Gray
 * (Modern Differential Geometry of Curves and Surfaces, 1997):
 *   x = 1/2 Re(-zeta(z) + pi u + pi^2/(4 e1) + pi/(2 e1) (zeta(z - 1/2) - zeta(z - i/2))),
 *   y = 1/2 Re(-i zeta(z) + pi v + pi^2/(4 e1) - pi/(2 e1) (i zeta(z - 1/2) - i zeta(z - i/2))),
 *   w = sqrt(2 pi)/4 log |(P(z) - e1) / (P(z) + e1)|,   z = u + iv, e1 = P(1/2).
 * The torus is tiled by four squares about the half periods; those about the three ends have a
 * round hole. */
#include <complex.h>

#include "sdk/shape/internal.h"

static const double E1 = 6.875185818020372827; /* Gamma(1/4)^4 / (8 pi) */

/* Weierstrass zeta and P for the periods 1 and i, nome exp(-pi); zeta(z + i) = zeta(z) - i pi. */
static void elliptic(double _Complex z, double _Complex *zeta, double _Complex *p) {
    double turns = floor(cimag(z) + 0.5);
    z -= I * turns;
    double _Complex s = csin(QC__PI * z);
    double _Complex sum = QC__PI * z + QC__PI * ccos(QC__PI * z) / s;
    double _Complex second = QC__PI * QC__PI / (s * s) - QC__PI;
    for (int n = 1; n <= 14; n++) {
        double q = exp(-2 * QC__PI * n), c = q / (1 - q);
        sum += 4 * QC__PI * c * csin(2 * QC__PI * n * z);
        second -= 8 * QC__PI * QC__PI * n * c * ccos(2 * QC__PI * n * z);
    }
    *zeta = sum - I * QC__PI * turns;
    *p = second;
}

static void surface(double _Complex z, double out[3]) {
    double _Complex zeta, right, up, p, unused;
    elliptic(z, &zeta, &p);
    elliptic(z - 0.5, &right, &unused);
    elliptic(z - 0.5 * I, &up, &unused);
    double constant = QC__PI * QC__PI / (4 * E1), factor = QC__PI / (2 * E1);
    out[0] = 0.5 * creal(-zeta + QC__PI * creal(z) + constant + factor * (right - up));
    out[1] = 0.5 * creal(-I * zeta + QC__PI * cimag(z) + constant - factor * I * (right - up));
    out[2] = 0.25 * sqrt(2 * QC__PI) * log(cabs((p - E1) / (p + E1)));
}

typedef struct square {
    double _Complex centre, turn; /* turn: 1, i, -1, -i for the side of the square */
    double hole;
} square;

static void ring(const void *data, double u, double v, double out[3]) {
    const square *q = data;
    double _Complex outer = 0.25 + 0.25 * I * (2 * u - 1); /* right side, upwards */
    surface(q->centre + q->turn * outer * pow(q->hole / cabs(outer), v), out);
}

static void plain(const void *data, double u, double v, double out[3]) {
    const square *q = data;
    surface(q->centre + 0.25 * (2 * u - 1) + 0.25 * I * (2 * v - 1), out);
}

void qc__shape_costa(qc__soup *soup, const qc_shape_options *options) {
    const double _Complex turn[4] = {1, I, -1, -I};
    const double _Complex centre[3] = {0, 0.5, 0.5 * I};
    const double hole[3] = {0.09, 0.045, 0.045};
    int32_t n = qc__segments(options->resolution, 1 + 4 * 0.7 + 8 * 1.1, 2);
    for (int i = 0; i < 12; i++) {
        square q = {centre[i / 4], turn[i % 4], hole[i / 4]};
        int32_t rows = (int32_t)((i < 4 ? 0.7 : 1.1) * n + 0.5);
        qc__soup_patch(soup, n, rows, false, ring, &q);
    }
    square last = {0.5 + 0.5 * I, 1, 0};
    qc__soup_patch(soup, n, n, false, plain, &last);
}
