/* Triangles of one polygon in space, decided in its projection along the Newell normal.
 *
 * Convex polygons become a fan (quads along the shorter diagonal); others lose ears: corners which
 * turn left and whose triangle holds no other corner that does not turn left. */
#include <math.h>

#include "sdk/mesh/repair/internal.h"

/* Drops the axis in which the Newell normal is largest, so that the polygon is counter-clockwise.
 */
static void project(int32_t n, const double *p, double *flat) {
    double normal[3] = {0, 0, 0};
    for (int32_t i = 0; i < n; i++) {
        const double *a = p + 3 * i, *b = p + 3 * ((i + 1) % n);
        for (int k = 0; k < 3; k++) {
            int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            normal[k] += (a[k1] - b[k1]) * ((a[k2] - p[k2]) + (b[k2] - p[k2]));
        }
    }
    int axis = fabs(normal[0]) > fabs(normal[1]) ? 0 : 1;
    if (fabs(normal[2]) >= fabs(normal[axis])) axis = 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int32_t i = 0; i < n; i++) {
        flat[2 * i] = p[3 * i + (normal[axis] < 0 ? v : u)];
        flat[2 * i + 1] = p[3 * i + (normal[axis] < 0 ? u : v)];
    }
}

static double turn(const double *flat, int32_t a, int32_t b, int32_t c) {
    const double *p = flat + 2 * a, *q = flat + 2 * b, *s = flat + 2 * c;
    return (q[0] - p[0]) * (s[1] - q[1]) - (q[1] - p[1]) * (s[0] - q[0]);
}

static bool same_place(const double *flat, int32_t a, int32_t b) {
    return flat[2 * a] == flat[2 * b] && flat[2 * a + 1] == flat[2 * b + 1];
}

static bool is_taken(const qc__polygon *p, int32_t a, int32_t b) {
    return qc__edge_set_has(p->taken, p->vertex[a], p->vertex[b]);
}

/* Whether corner i of the ring of m corners can be cut off. */
static bool is_ear(const qc__polygon *p, int32_t m, int32_t i) {
    const double *flat = p->flat;
    const int32_t *ring = p->ring;
    int32_t a = ring[(i + m - 1) % m], b = ring[i], c = ring[(i + 1) % m];
    if (!(turn(flat, a, b, c) > 0) || (m > 3 && is_taken(p, a, c))) return false;
    for (int32_t j = 0; j < m; j++) {
        int32_t v = ring[j];
        if (v == a || v == b || v == c || same_place(flat, v, a) || same_place(flat, v, b) ||
            same_place(flat, v, c))
            continue;
        if (turn(flat, ring[(j + m - 1) % m], v, ring[(j + 1) % m]) > 0) continue;
        if (turn(flat, a, b, v) >= 0 && turn(flat, b, c, v) >= 0 && turn(flat, c, a, v) >= 0)
            return false;
    }
    return true;
}

/* The corner to cut next, from `begin` on; in a self-intersecting rest the sharpest left turn. */
static int32_t find_ear(const qc__polygon *p, int32_t m, int32_t begin) {
    const double *flat = p->flat;
    const int32_t *ring = p->ring;
    int32_t best = begin % m;
    double most = -INFINITY;
    for (int32_t k = 0; k < m; k++) {
        int32_t i = (begin + k) % m;
        if (is_ear(p, m, i)) return i;
        double t = turn(flat, ring[(i + m - 1) % m], ring[i], ring[(i + 1) % m]);
        if (t > most) {
            most = t;
            best = i;
        }
    }
    return best;
}

static bool is_convex(int32_t n, const double *flat) {
    for (int32_t i = 0; i < n; i++)
        if (!(turn(flat, i, (i + 1) % n, (i + 2) % n) > 0)) return false;
    return true;
}

static double distance2(const double *p, const double *q) {
    double d = 0;
    for (int k = 0; k < 3; k++) d += (p[k] - q[k]) * (p[k] - q[k]);
    return d;
}

/* A fan around corner s; false when one of its diagonals is taken. */
static bool fan(qc__polygon *p, int32_t s) {
    int32_t n = p->n;
    for (int32_t i = 2; i < n - 1; i++)
        if (is_taken(p, s, (s + i) % n)) return false;
    for (int32_t i = 0; i < n - 2; i++) {
        int32_t *t = p->triangles + 3 * (size_t)i;
        t[0] = s;
        t[1] = (s + i + 1) % n;
        t[2] = (s + i + 2) % n;
        if (i > 0) qc__edge_set_add(p->taken, p->vertex[s], p->vertex[t[1]]);
    }
    return true;
}

static void clip_ears(qc__polygon *p) {
    int32_t *ring = p->ring, *out = p->triangles, begin = 0;
    for (int32_t i = 0; i < p->n; i++) ring[i] = i;
    for (int32_t m = p->n; m > 2; m--) {
        int32_t i = find_ear(p, m, begin);
        int32_t a = ring[(i + m - 1) % m], c = ring[(i + 1) % m];
        *out++ = a;
        *out++ = ring[i];
        *out++ = c;
        if (m > 3) qc__edge_set_add(p->taken, p->vertex[a], p->vertex[c]);
        for (int32_t j = i; j + 1 < m; j++) ring[j] = ring[j + 1];
        begin = i + 1; /* a later corner: ears round the polygon, no fan */
    }
}

void qc__triangulate_polygon(qc__polygon *p) {
    project(p->n, p->point, p->flat);
    if (is_convex(p->n, p->flat)) {
        const double *x = p->point;
        int32_t s = p->n == 4 && distance2(x + 3, x + 9) < distance2(x, x + 6);
        if (fan(p, s) || fan(p, s + 1)) return;
    }
    clip_ears(p);
}
