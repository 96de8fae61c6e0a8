/* Winding of cones and layout of their stars (see cones.h). */
#include "sdk/map/untangle/cones.h"
#include <math.h>

static const double quarter = 1.57079632679489661923;

static double angle_between(qc_complex a, qc_complex b) {
    return atan2(a.re * b.im - a.im * b.re, a.re * b.re + a.im * b.im);
}

/* Image of tangent vector e of face t under the guiding field: conj(x) e. */
static qc_complex guided(const qc__guide *g, int32_t t, qc_complex e, double sign) {
    const qc_complex x = g->cross[t];
    const qc_complex z = {sign * (x.re * e.re + x.im * e.im), sign * (x.re * e.im - x.im * e.re)};
    return z;
}

/* At corner c of vertex v: guided images of the edges to the next and to the previous corner. */
static void guided_edges(const qc__guide *g, int32_t c, qc_complex *to_next, qc_complex *to_prev) {
    *to_next = guided(g, c / 3, g->edge[qc_prev(c)], 1.0);
    *to_prev = guided(g, c / 3, g->edge[qc_next(c)], -1.0);
}

double qc__guide_angle(const qc__guide *g, int32_t v) {
    const qc_mesh *mesh = g->map->mesh;
    const int32_t start = mesh->vertex_corner[v];
    double sum = 0;
    int32_t c = start;
    do {
        qc_complex a, b, next_a, next_b;
        guided_edges(g, c, &a, &b);
        sum += angle_between(a, b);
        const int32_t d = qc_corner_ccw(mesh, c);
        if (d < 0) break;
        guided_edges(g, d, &next_a, &next_b);
        /* the shared edge in both charts, which differ by the rotation of the transition */
        const int32_t h = qc_next(c), e = mesh->halfedge_edge[h];
        const int32_t r =
            mesh->edge_halfedge[2 * (int64_t)e] == h ? g->rotation[e] : -g->rotation[e];
        sum += angle_between(qc_quarter_turn(b, r), next_a);
        c = d;
    } while (c != start);
    return sum;
}

double qc__map_angle(const qc__guide *g, int32_t v) {
    const qc__reduced_map *m = g->map;
    const int32_t start = m->mesh->vertex_corner[v];
    double sum = 0;
    int32_t c = start;
    do {
        qc_complex f[3];
        const int32_t corner[3] = {c, qc_next(c), qc_prev(c)};
        for (int32_t k = 0; k < 3; k++)
            f[k] = qc__reduced_map_corner(m, m->value[m->mesh->face_vertex[corner[k]]], corner[k]);
        const qc_complex a = {f[1].re - f[0].re, f[1].im - f[0].im};
        const qc_complex b = {f[2].re - f[0].re, f[2].im - f[0].im};
        sum += angle_between(a, b);
        c = qc_corner_ccw(m->mesh, c);
    } while (c >= 0 && c != start);
    return sum;
}

int32_t qc__guide_turns(const qc__guide *g, int32_t v) {
    return (int32_t)lround(qc__guide_angle(g, v) / quarter);
}

int32_t qc__map_turns(const qc__guide *g, int32_t v) {
    return (int32_t)lround(qc__map_angle(g, v) / quarter);
}

/* The edges of a star by developed angle. */
enum { LARGEST_STAR = 256 };
typedef struct star {
    int32_t n;
    int32_t corner[LARGEST_STAR]; /* corner of v whose next corner is the neighbour */
    double angle[LARGEST_STAR];   /* guided direction in the chart of that corner   */
    double bend[LARGEST_STAR]; /* wanted minus guided direction                                   */
    bool anchor[LARGEST_STAR];
} star;

/* Directions of the guiding field; neighbours which cannot move are anchors with their true
 * direction. */
static bool read_star(const qc__guide *g, int32_t v, star *s) {
    const qc__reduced_map *m = g->map;
    const int32_t start = m->mesh->vertex_corner[v];
    int32_t c = start;
    s->n = 0;
    do {
        if (s->n == LARGEST_STAR) return false;
        const int32_t n = qc_next(c), w = m->mesh->face_vertex[n];
        qc_complex a, b;
        guided_edges(g, c, &a, &b);
        s->corner[s->n] = c;
        s->angle[s->n] = atan2(a.im, a.re);
        s->anchor[s->n] = qc__pinned(m, w);
        s->bend[s->n] = 0;
        if (qc__pinned(m, w)) {
            const qc_complex p = qc__reduced_map_corner(m, m->value[v], c);
            const qc_complex q = qc__reduced_map_corner(m, m->value[w], n);
            const qc_complex d = {q.re - p.re, q.im - p.im};
            if (d.re != 0 || d.im != 0) s->bend[s->n] = angle_between(a, d);
        }
        s->n++;
        c = qc_corner_ccw(m->mesh, c);
    } while (c >= 0 && c != start);
    return true;
}

/* Between anchors the bend is interpolated by position in the star. */
static void spread_bends(star *s) {
    for (int32_t j = 0; j < s->n; j++) {
        if (s->anchor[j]) continue;
        int32_t before = 0, after = 0;
        while (before < s->n && !s->anchor[(j - before + s->n) % s->n]) before++;
        while (after < s->n && !s->anchor[(j + after) % s->n]) after++;
        if (before == s->n) return; /* no anchor at all */
        const double x = s->bend[(j - before + s->n) % s->n], y = s->bend[(j + after) % s->n];
        s->bend[j] = (x * after + y * before) / (before + after);
    }
}

void qc__lay_out_star(const qc__guide *g, int32_t v, double scale) {
    const qc__reduced_map *m = g->map;
    star s;
    if (!read_star(g, v, &s)) return;
    spread_bends(&s);
    for (int32_t j = 0; j < s.n; j++) {
        const int32_t c = s.corner[j], n = qc_next(c), w = m->mesh->face_vertex[n];
        if (s.anchor[j]) continue;
        const qc_complex e = g->edge[qc_prev(c)], p = qc__reduced_map_corner(m, m->value[v], c);
        const double r = scale * hypot(e.re, e.im), angle = s.angle[j] + s.bend[j];
        const qc_complex local = {p.re + r * cos(angle) - m->offset[n].re,
                                  p.im + r * sin(angle) - m->offset[n].im};
        m->value[w] = qc__keep_fixed(m, w, qc_quarter_turn(local, -m->turn[n]));
    }
}
