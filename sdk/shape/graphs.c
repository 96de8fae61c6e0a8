/* The graph of sin u cos v (Figure 10 of the second paper; two extrema and two saddles inside) and
 * the one-sheeted hyperboloid x^2 + y^2 - z^2 = 1 (Figure 8 of the 2007 paper). */
#include "sdk/shape/internal.h"

static void graph(const void *data, double u, double v, double out[3]) {
    (void)data;
    out[0] = QC__PI * (2 * u + 0.25);
    out[1] = QC__PI * (v - 0.25);
    out[2] = sin(out[0]) * cos(out[1]);
}

void qc__shape_graph(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 2, 1);
    qc__soup_patch(soup, 2 * n, n, false, graph, NULL);
}

static const double HEIGHT = 1.2; /* |z| <= sinh(1.2) */

static void hyperboloid(const void *data, double u, double v, double out[3]) {
    (void)data;
    double t = HEIGHT * (2 * v - 1);
    out[0] = cosh(t) * cos(2 * QC__PI * u);
    out[1] = cosh(t) * sin(2 * QC__PI * u);
    out[2] = sinh(t);
}

void qc__shape_hyperboloid(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 2, 2);
    qc__soup_patch(soup, 2 * n, n, false, hyperboloid, NULL);
}
