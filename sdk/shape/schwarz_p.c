/* Translational cell of the Schwarz P surface, by its nodal approximation cos x + cos y + cos z = 0
 * in
 * [-pi, pi]^3: a sphere with six holes, star-shaped about the origin. Around each hole lies a ring
 * between the neck (where one coordinate is pi) and a face of the cube of directions. */
#include "sdk/shape/internal.h"

typedef struct wedge {
    int axis, quarter;
    double sign;
} wedge;

/* Root r in [0, end] of sum cos(r d_i) = 0 for |r d_i| <= pi: the sum decreases. */
static double radius(const double d[3], double end, double target) {
    double lo = 0, hi = end;
    for (int i = 0; i < 60; i++) {
        double mid = 0.5 * (lo + hi);
        if (cos(mid * d[0]) + cos(mid * d[1]) + cos(mid * d[2]) > target)
            lo = mid;
        else
            hi = mid;
    }
    return 0.5 * (lo + hi);
}

static void ring(const void *data, double u, double v, double out[3]) {
    static const double turn[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const wedge *w = data;
    double a = turn[w->quarter][0], b = turn[w->quarter][1], s = tan(0.25 * QC__PI * (2 * u - 1));
    double x = a - s * b, y = b + s * a; /* on the boundary of the square */
    /* neck: (r x, r y, pi) with cos(r x) + cos(r y) = 1, i.e. with cos 0 added, = 2 */
    double neck = radius((double[3]){x, y, 0}, QC__PI, 2.0) / QC__PI;
    double scale = (1 - v) + v * neck;
    double d[3] = {scale * x, scale * y, 1}, r = v == 1 ? QC__PI : radius(d, QC__PI, 0.0);
    out[(w->axis + 1) % 3] = r * d[0];
    out[(w->axis + 2) % 3] = r * d[1];
    out[w->axis] = w->sign * r;
}

void qc__shape_schwarz_p(qc__soup *soup, const qc_shape_options *options) {
    /* a quarter ring is about 2.6 wide at the cube, 1.9 at the neck, and 1.5 high */
    int32_t n = qc__segments(options->resolution, 24 * 0.65, 2), m = (int32_t)(0.65 * n + 0.5);
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 8; i++) {
            wedge w = {axis, i % 4, i < 4 ? 1 : -1};
            qc__soup_patch(soup, n, m < 1 ? 1 : m, i >= 4, ring, &w);
        }
    }
}
