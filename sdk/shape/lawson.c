/* Lawson's minimal surface xi_{2,1} of genus 2 in S^3 (Lawson 1970), projected to R^3 along its
 * three-fold axis. Points P_i (4 of them) and Q_j (6) divide two polar great circles of C^2; the
 * surface consists of the 12 images of the Plateau solution in the geodesic quadrilateral P_0 Q_0
 * P_1 Q_1 with i = j mod 2. That solution is found by relaxing a grid towards its harmonic map to
 * S^3, which for this symmetric patch with a grid of rectangles comes close to minimal. */
#include <string.h>

#include "sdk/shape/internal.h"

enum { P_POINTS = 4, Q_POINTS = 6 };

typedef struct patch {
    int32_t n;
    double (*x)[4]; /* (n+1)^2 points of S^3 */
    int i, j; /* image shown                                                                  */
} patch;

static void normalize4(double x[4]) {
    double s = 1 / sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    for (int c = 0; c < 4; c++) x[c] *= s;
}

/* Boundary: geodesics. Inside: bilinear, projected to the sphere. */
static void start(patch *p) {
    for (int32_t a = 0; a <= p->n; a++) {
        for (int32_t b = 0; b <= p->n; b++) {
            double s = (double)a / p->n, t = (double)b / p->n, *x = p->x[a * (p->n + 1) + b];
            double p0 = (1 - s) * (1 - t), q0 = s * (1 - t), p1 = s * t, q1 = (1 - s) * t;
            x[0] = p0;
            x[1] = p1; /* P_1 is a quarter turn from P_0 */
            x[2] = q0 + q1 * cos(2 * QC__PI / Q_POINTS);
            x[3] = q1 * sin(2 * QC__PI / Q_POINTS);
            normalize4(x);
        }
    }
}

static void relax(qc__soup *soup, patch *p) {
    int32_t row = p->n + 1;
    for (int32_t sweep = 0; sweep < 2 * p->n && soup->status == QC_OK; sweep++) {
        for (int32_t a = 1; a < p->n; a++) {
            for (int32_t b = 1; b < p->n; b++) {
                double *x = p->x[a * row + b];
                for (int c = 0; c < 4; c++)
                    x[c] = x[c - 4] + x[c + 4] + x[c - 4 * row] + x[c + 4 * row];
                normalize4(x);
            }
        }
        if (!qc__progress(soup->ctx, 0.0)) soup->status = QC_ERR_CANCELLED;
    }
}

/* Turns the two circles and projects from the point half-way between P_0 and P_1. */
static void show(const void *data, double u, double v, double out[3]) {
    const patch *p = data;
    int32_t a = (int32_t)floor(u * p->n + 0.5), b = (int32_t)floor(v * p->n + 0.5);
    const double *x = p->x[a * (p->n + 1) + b];
    double alpha = 2 * QC__PI * p->i / P_POINTS - QC__PI / 4, beta = 2 * QC__PI * p->j / Q_POINTS;
    double pole = x[0] * cos(alpha) - x[1] * sin(alpha);
    out[2] = (x[0] * sin(alpha) + x[1] * cos(alpha)) / (1 - pole);
    out[0] = (x[2] * cos(beta) - x[3] * sin(beta)) / (1 - pole);
    out[1] = (x[2] * sin(beta) + x[3] * cos(beta)) / (1 - pole);
}

void qc__shape_lawson(qc__soup *soup, const qc_shape_options *options) {
    patch p = {qc__segments(options->resolution, P_POINTS * Q_POINTS / 2, 2), NULL, 0, 0};
    p.x = qc__malloc(soup->ctx, ((size_t)p.n + 1) * ((size_t)p.n + 1), sizeof *p.x);
    if (!p.x) {
        soup->status = QC_ERR_NOMEM;
        return;
    }
    start(&p);
    relax(soup, &p);
    for (p.i = 0; p.i < P_POINTS; p.i++)
        for (p.j = p.i % 2; p.j < Q_POINTS; p.j += 2)
            qc__soup_patch(soup, p.n, p.n, p.i % 2 == 0, show, &p);
    qc__free(p.x);
}
