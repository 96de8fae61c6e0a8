/* Search for a better place of a vertex next to a bad quad, among moves in a few directions: where
 * the worst quad at it is best, or where a high power of what the quads at it lack is least
 * (optimisation-based smoothing: Freitag and Ollivier-Gooch, Tetrahedral mesh improvement using
 * swapping and smoothing, 1997). The worst alone gets stuck where several vertices would have to
 * move at once; the sum, being smooth, does not. */
#include "sdk/finish/internal.h"

/* Times the quality wanted: below it all quads are regarded first. */
static const double hopeless = 0.3;
enum { DIRECTIONS = 8, LENGTHS = 6 };

/* Axes of the plane of a face. */
static void plane(const double normal[3], double u[3], double v[3]) {
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(normal[i]) < fabs(normal[k])) k = i;
    const double axis[3] = {k == 0, k == 1, k == 2};
    qc__cross3(normal, axis, u);
    const double l = qc__norm3(u);
    for (int i = 0; i < 3; i++) u[i] = l > 0 ? u[i] / l : 0;
    qc__cross3(normal, u, v);
}

/* On a curve only there and back. */
bool qc__direction(const qc__relaxation *r, int32_t v, int i, int n, double d[3]) {
    const double angle = 6.283185307179586 * i / n;
    double a[3], b[3];
    if (r->anchor[v] >= 0) {
        double weight[3];
        int32_t face;
        qc__curve_point(&r->curves, r->anchor[v], r->spot[v].arc, &face, weight, a);
        for (int k = 0; k < 3; k++) d[k] = i == 0 ? a[k] : -a[k];
        return i < 2;
    }
    plane(r->normal + 3 * (int64_t)r->spot[v].face, a, b);
    for (int k = 0; k < 3; k++) d[k] = cos(angle) * a[k] + sin(angle) * b[k];
    return true;
}

/* What is made less, were v at x. */
typedef double measure(const qc__relaxation *r, int32_t v, const double x[3]);

static double worst(const qc__relaxation *r, int32_t v, const double x[3]) {
    return -qc__ring_quality(r, v, x);
}

static void improve(qc__relaxation *r, int32_t v, double enough, measure *bad) {
    const double *now = r->position + 3 * (int64_t)v;
    if (r->anchor[v] == QC__FIXED || r->around.face_start[v] == r->around.face_start[v + 1]) return;
    if (qc__ring_quality(r, v, now) >= enough) return;
    double best = bad(r, v, now), length = 0.4 * qc__size_at(r, v);
    qc__spot place;
    bool found = false;
    for (int n = 0; n < LENGTHS; n++, length *= 0.5) {
        double d[3];
        for (int i = 0; i < DIRECTIONS && qc__direction(r, v, i, DIRECTIONS, d); i++) {
            qc__spot spot;
            for (int k = 0; k < 3; k++) d[k] *= length;
            if (!qc__step(r, v, d, &spot)) continue;
            const double b = bad(r, v, spot.x);
            if (b >= best || qc__ring_quality(r, v, spot.x) < r->least) continue;
            if (qc__ring_turns(r, v, spot.x)) continue;
            best = b;
            place = spot;
            found = true;
        }
    }
    if (found) qc__place(r, v, &place);
}

void qc__improve_all(qc__relaxation *r, int32_t v) {
    improve(r, v, hopeless * r->quality, qc__ring_badness);
}

void qc__improve_worst(qc__relaxation *r, int32_t v) {
    improve(r, v, r->quality, worst);
}
