/* Which faces stay connected at an edge with three or more: solids which touch there come apart; of
 * sheets the best fitting pairs (consistent orientation, then the smallest dihedral deviation, then
 * the lowest numbers) stay together, and the rest is cut open. */
#include <math.h>

#include "sdk/mesh/repair/internal.h"

enum { MOST_FACES = 32 }; /* an edge with more faces than this is cut open altogether */

static void face_normal(const qc__repair *r, int32_t face, double n[3]) {
    const int32_t *t = r->triangle + 3 * (size_t)face;
    const double *a = qc__repair_point(r, t[0]), *b = qc__repair_point(r, t[1]);
    const double *c = qc__repair_point(r, t[2]);
    double length = 0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        length += n[k] * n[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) n[k] = length > 0 ? n[k] / length : 0;
}

static bool opposite(const qc__repair *r, int32_t h, int32_t g) {
    return r->triangle[qc_next(h)] == r->triangle[qc_prev(g)];
}

/* Fit of two faces at a common edge: orientation first, then the dihedral angle; more is better. */
static double fit(const qc__repair *r, int32_t h, int32_t g) {
    double m[3], n[3], cosine = 0;
    bool consistent = opposite(r, h, g);
    face_normal(r, h / 3, m);
    face_normal(r, g / 3, n);
    for (int k = 0; k < 3; k++) cosine += m[k] * n[k];
    return consistent ? 4 + cosine : -cosine;
}

static void pair_greedily(qc__repair *r, const int32_t *side, int32_t n) {
    double score[MOST_FACES][MOST_FACES];
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < i; j++) score[i][j] = fit(r, side[j], side[i]);
    for (bool first = true;; first = false) {
        int32_t bi = -1, bj = -1;
        for (int32_t i = 0; i < n; i++)
            for (int32_t j = 0; j < i; j++) {
                if (r->twin[side[i]] >= 0 || r->twin[side[j]] >= 0) continue;
                if (bi < 0 || score[i][j] > score[bi][bj]) bi = i, bj = j;
            }
        if (bi < 0 || (!first && !opposite(r, side[bi], side[bj]))) return;
        r->twin[side[bi]] = side[bj];
        r->twin[side[bj]] = side[bi];
    }
}

/* Angles of the faces around the edge, from the first one on, about the direction of side[0]. */
static void face_angles(const qc__repair *r, const int32_t *side, int32_t n, double *angle) {
    const double *a = qc__repair_point(r, r->triangle[qc_next(side[0])]);
    const double *b = qc__repair_point(r, r->triangle[qc_prev(side[0])]);
    double axis[3], u[3], v[3], length = 0, along = 0;
    const double *first = qc__repair_point(r, r->triangle[side[0]]);
    for (int k = 0; k < 3; k++) {
        axis[k] = b[k] - a[k];
        length += axis[k] * axis[k];
        along += axis[k] * (first[k] - a[k]);
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) {
        axis[k] = length > 0 ? axis[k] / length : 0;
        u[k] = first[k] - a[k] - (length > 0 ? along / length : 0) * axis[k];
    }
    for (int k = 0; k < 3; k++)
        v[k] = axis[(k + 1) % 3] * u[(k + 2) % 3] - axis[(k + 2) % 3] * u[(k + 1) % 3];
    for (int32_t i = 0; i < n; i++) {
        const double *p = qc__repair_point(r, r->triangle[side[i]]);
        double x = 0, y = 0;
        for (int k = 0; k < 3; k++) {
            x += (p[k] - a[k]) * u[k];
            y += (p[k] - a[k]) * v[k];
        }
        angle[i] = i == 0 ? 0 : atan2(y, x);
    }
}

/* Solids which touch in the edge: around it the faces run to and fro in turn, and those with
 * material between them belong together. The material of a face along the axis lies at smaller
 * angles. */
static bool pair_solids(qc__repair *r, const int32_t *side, int32_t n) {
    double angle[MOST_FACES];
    int32_t order[MOST_FACES];
    if (n % 2) return false;
    face_angles(r, side, n, angle);
    for (int32_t i = 0; i < n; i++) {
        int32_t j = i;
        for (; j > 0 && angle[order[j - 1]] > angle[i]; j--) order[j] = order[j - 1];
        order[j] = i;
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t now = order[i], next = order[(i + 1) % n];
        if (!opposite(r, side[now], side[next])) return false;
        if (i + 1 < n && angle[next] - angle[now] < 1e-9) return false;
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t h = side[order[i]], g = side[order[(i + n - 1) % n]];
        if (opposite(r, side[0], h)) continue;
        r->twin[h] = g;
        r->twin[g] = h;
    }
    return true;
}

void qc__repair_pair_best(qc__repair *r, const int32_t *side, int32_t n) {
    if (n > MOST_FACES || pair_solids(r, side, n)) return;
    pair_greedily(r, side, n);
}
