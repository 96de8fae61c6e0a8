/* Trefoil: a tube round the torus knot (2, 3), as in Figure 2 of the 2007 paper. The curve is
 * sampled by arc length; the frame is parallel (rotation minimising), its holonomy spread over the
 * curve, so that the grid closes and is as regular as the curve allows. */
#include "sdk/shape/internal.h"

enum { SAMPLES = 4096 };
static const double RADIUS = 0.42;

typedef struct tube {
    double point[SAMPLES + 1][3], tangent[SAMPLES + 1][3], normal[SAMPLES + 1][3];
    double length[SAMPLES + 1]; /* arc length from the start */
    double holonomy; /* angle by which the frame misses itself after one turn            */
} tube;

static void curve(double t, double out[3]) {
    double r = 2 + cos(3 * t);
    out[0] = r * cos(2 * t);
    out[1] = r * sin(2 * t);
    out[2] = sin(3 * t);
}

static void derivative(double t, double out[3]) {
    double r = 2 + cos(3 * t), dr = -3 * sin(3 * t);
    out[0] = dr * cos(2 * t) - 2 * r * sin(2 * t);
    out[1] = dr * sin(2 * t) + 2 * r * cos(2 * t);
    out[2] = 3 * cos(3 * t);
}

static void make_orthogonal(double a[3], const double unit[3]) {
    double s = qc__dot(a, unit);
    for (int i = 0; i < 3; i++) a[i] -= s * unit[i];
    qc__normalize(a);
}

/* Parallel transport by projection: its error is of third order in the step. */
static void follow(tube *k) {
    for (int i = 0; i <= SAMPLES; i++) {
        double t = 2 * QC__PI * (i % SAMPLES) / SAMPLES, d[3];
        curve(t, k->point[i]);
        derivative(t, k->tangent[i]);
        qc__normalize(k->tangent[i]);
        k->length[i] = 0;
        for (int c = 0; c < 3; c++) {
            k->normal[i][c] = i > 0 ? k->normal[i - 1][c] : c == 2;
            d[c] = i > 0 ? k->point[i][c] - k->point[i - 1][c] : 0;
        }
        make_orthogonal(k->normal[i], k->tangent[i]);
        if (i > 0) k->length[i] = k->length[i - 1] + sqrt(qc__dot(d, d));
    }
    double binormal[3];
    qc__cross(k->tangent[0], k->normal[0], binormal);
    k->holonomy =
        atan2(qc__dot(k->normal[SAMPLES], binormal), qc__dot(k->normal[SAMPLES], k->normal[0]));
}

static int sample_before(const tube *k, double length) {
    int lo = 0, hi = SAMPLES;
    while (hi - lo > 1) {
        int mid = (lo + hi) / 2;
        if (k->length[mid] <= length)
            lo = mid;
        else
            hi = mid;
    }
    return lo;
}

static void tube_point(const void *data, double u, double v, double out[3]) {
    const tube *k = data;
    double s = u * k->length[SAMPLES];
    int i = sample_before(k, s);
    double f = (s - k->length[i]) / (k->length[i + 1] - k->length[i]);
    double normal[3], tangent[3], binormal[3], centre[3];
    curve(2 * QC__PI * (i + f) / SAMPLES, centre);
    derivative(2 * QC__PI * (i + f) / SAMPLES, tangent);
    qc__normalize(tangent);
    for (int c = 0; c < 3; c++) normal[c] = (1 - f) * k->normal[i][c] + f * k->normal[i + 1][c];
    make_orthogonal(normal, tangent);
    qc__cross(tangent, normal, binormal);
    double angle = 2 * QC__PI * v - k->holonomy * u;
    for (int c = 0; c < 3; c++)
        out[c] = centre[c] + RADIUS * (cos(angle) * normal[c] + sin(angle) * binormal[c]);
}

void qc__shape_knot(qc__soup *soup, const qc_shape_options *options) {
    tube *k = QC__NEW(soup->ctx, tube, 1);
    if (!k) {
        soup->status = QC_ERR_NOMEM;
        return;
    }
    follow(k);
    double ratio = k->length[SAMPLES] / (2 * QC__PI * RADIUS);
    int32_t n = qc__segments(options->resolution, ratio, 4);
    /* v runs counter-clockwise about the tangent: (u, v) sees the inside */
    qc__soup_patch(soup, (int32_t)floor(ratio * n + 0.5), n, true, tube_point, k);
    qc__free(k);
}
