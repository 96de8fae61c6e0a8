/* Winding of cones and layout of their stars (see untangle_cones.h). */
#include "sdk/map/untangle_cones.h"
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

int32_t qc__guide_turns(const qc__guide *g, int32_t v) {
    const qc_mesh *mesh = g->map->mesh;
    const int32_t start = mesh->vertex_corner[v];
    double sum = 0;
    int32_t c = start;
    do {
        qc_complex a, b, next_a, next_b;
        guided_edges(g, c, &a, &b);
        sum += angle_between(a, b);
        const int32_t d = qc_corner_ccw(mesh, c);
        guided_edges(g, d, &next_a, &next_b);
        /* the shared edge in both charts, which differ by the rotation of the transition */
        const int32_t h = qc_next(c), e = mesh->halfedge_edge[h];
        const int32_t r = mesh->edge_halfedge[2 * (int64_t)e] == h ? g->rotation[e] : -g->rotation[e];
        sum += angle_between(qc_quarter_turn(b, r), next_a);
        c = d;
    } while (c != start);
    return (int32_t)lround(sum / quarter);
}

int32_t qc__map_turns(const qc__guide *g, int32_t v) {
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
    } while (c != start);
    return (int32_t)lround(sum / quarter);
}

void qc__lay_out_star(const qc__guide *g, int32_t v, double scale) {
    const qc__reduced_map *m = g->map;
    const int32_t start = m->mesh->vertex_corner[v];
    int32_t c = start;
    do {
        const int32_t n = qc_next(c), w = m->mesh->face_vertex[n];
        if (!m->pinned[w]) {
            qc_complex a, b;
            guided_edges(g, c, &a, &b);
            const qc_complex p = qc__reduced_map_corner(m, m->value[v], c);
            const qc_complex local = {p.re + scale * a.re - m->offset[n].re,
                                      p.im + scale * a.im - m->offset[n].im};
            m->value[w] = qc_quarter_turn(local, -m->turn[n]);
        }
        c = qc_corner_ccw(m->mesh, c);
    } while (c >= 0 && c != start);
}
