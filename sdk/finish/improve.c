/* Search for a better place of a vertex next to a bad quad: the worst quad at it is made as good as
 * moves in a few directions can make it (optimisation-based smoothing of the worst element: Freitag
 * and Ollivier-Gooch, Tetrahedral mesh improvement using swapping and smoothing, 1997). */
#include "sdk/finish/internal.h"

enum { DIRECTIONS = 8, LENGTHS = 4 };

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

/* Direction i of DIRECTIONS; on a curve only there and back. */
static bool direction(const qc__relaxation *r, int32_t v, int i, double d[3]) {
    const double angle = 6.283185307179586 * i / DIRECTIONS;
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

void qc__improve_worst(qc__relaxation *r, int32_t v) {
    if (r->anchor[v] == QC__FIXED || r->around.face_start[v] == r->around.face_start[v + 1]) return;
    double best = qc__ring_quality(r, v, r->position + 3 * (int64_t)v),
           length = 0.4 * qc__size_at(r, v);
    if (best >= r->quality) return;
    qc__spot place;
    bool found = false;
    for (int n = 0; n < LENGTHS; n++, length *= 0.5) {
        double d[3];
        for (int i = 0; i < DIRECTIONS && direction(r, v, i, d); i++) {
            qc__spot spot;
            for (int k = 0; k < 3; k++) d[k] *= length;
            if (!qc__step(r, v, d, &spot)) continue;
            const double q = qc__ring_quality(r, v, spot.x);
            if (q <= best) continue;
            best = q;
            place = spot;
            found = true;
        }
    }
    if (found) qc__place(r, v, &place);
}
