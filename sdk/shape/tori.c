/* Torus of revolution, and a torus which is flat everywhere: a "diplotorus" (Arnoux, Lelievre,
 * Marquez 2021), two triangulated sleeves between a regular 12-gon and its turned copy. Rotations
 * and the exchange of the polygons make all 24 vertices alike, so their angle defects are equal
 * and, as they sum to zero, vanish. */
#include "sdk/shape/internal.h"

static const double MINOR = 0.4;

static void revolution(const void *data, double u, double v, double out[3]) {
    (void)data;
    double r = 1 + MINOR * cos(2 * QC__PI * v);
    out[0] = r * cos(2 * QC__PI * u);
    out[1] = r * sin(2 * QC__PI * u);
    out[2] = MINOR * sin(2 * QC__PI * v);
}

void qc__shape_torus(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 1 / MINOR, 4);
    qc__soup_patch(soup, (int32_t)floor(n / MINOR + 0.5), n, false, revolution, NULL);
}

enum { SIDES = 12 };

/* Bottom vertex k is at angle k, top vertex k at angle k + 1/2, in units of 2 pi / 12. */
static void flat_vertex(bool top, int k, double out[3]) {
    double angle = 2 * QC__PI * (k + (top ? 0.5 : 0.0)) / SIDES;
    out[0] = cos(angle);
    out[1] = sin(angle);
    out[2] = top ? 0.45 : -0.45;
}

static void linear(const void *data, double u, double v, double out[3]) {
    const double *p = data; /* three corners */
    for (int i = 0; i < 3; i++) out[i] = (1 - u - v) * p[i] + u * p[3 + i] + v * p[6 + i];
}

/* Triangles of the sleeve whose edges lead from bottom vertex k to the top vertices k + turn - 1
 * and k + turn. turn = 0 gives the convex antiprism, turn = 2 edges of 45 and 75 degrees. */
static void sleeve(qc__soup *soup, int32_t n, int turn, bool flip) {
    for (int k = 0; k < SIDES; k++) {
        double p[2][3][3];
        int second = flip ? 2 : 1, third = flip ? 1 : 2;
        flat_vertex(false, k, p[0][0]);
        flat_vertex(false, k + 1, p[0][second]);
        flat_vertex(true, k + turn, p[0][third]);
        flat_vertex(false, k, p[1][0]);
        flat_vertex(true, k + turn, p[1][second]);
        flat_vertex(true, k + turn - 1, p[1][third]);
        for (int i = 0; i < 2; i++) qc__soup_triangle(soup, n, linear, p[i]);
    }
}

void qc__shape_flat_torus(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 2 * SIDES, 1);
    sleeve(soup, n, 0, false);
    sleeve(soup, n, 2, true);
}
