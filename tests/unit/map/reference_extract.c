/* A slow second extraction for the tests (see reference_extract.h). */
#include "unit/map/reference_extract.h"

#include <stdlib.h>
#include <string.h>

typedef struct point {
    int64_t u, v;
} point;

/* What triangle t holds of a lattice point, or of the unit square to the upper right of (u, v). */
typedef struct reference_point {
    int32_t t;
    int64_t u, v;
    int32_t set; /* parent, then class */
    int turn;    /* of squares: quarter turns to the frame of the class */
} reference_point;

static point corner(const qc_grid_map *g, int32_t c) {
    return (point){g->uv[2 * c], g->uv[2 * c + 1]};
}
static int64_t side(point a, point b, point p) {
    return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
}
static point turned(point p, int r) {
    for (; r > 0; r--) p = (point){-p.v, p.u};
    return p;
}
/* Into the chart across halfedge h; unit: of the coordinates of p. */
static point across(const qc_grid_map *g, int32_t h, point p, int64_t unit, int *rotation) {
    const int32_t e = g->mesh->halfedge_edge[h];
    const point t = {g->translation[2 * e] * unit, g->translation[2 * e + 1] * unit};
    if (g->mesh->edge_halfedge[2 * e] == h) {
        *rotation = g->rotation[e];
        p = turned(p, *rotation);
        return (point){p.u + t.u, p.v + t.v};
    }
    *rotation = (4 - g->rotation[e]) & 3;
    return turned((point){p.u - t.u, p.v - t.v}, *rotation);
}

static bool in_triangle(const qc_grid_map *g, int32_t t, point p) {
    for (int k = 0; k < 3; k++)
        if (side(corner(g, 3 * t + k), corner(g, 3 * t + (k + 1) % 3), p) < 0) return false;
    return true;
}

/* Whether the convex hull of n points meets the open square: no axis separates them. */
static bool meets(const point *p, int n, point o, int64_t unit) {
    const point s[4] = {{o.u, o.v}, {o.u + unit, o.v}, {o.u + unit, o.v + unit}, {o.u, o.v + unit}};
    int below[4] = {0};
    for (int i = 0; i < n; i++) {
        below[0] += p[i].u <= s[0].u;
        below[1] += p[i].u >= s[2].u;
        below[2] += p[i].v <= s[0].v;
        below[3] += p[i].v >= s[2].v;
    }
    for (int i = 0; i < 4; i++)
        if (below[i] == n) return false;
    for (int i = 0; i < n; i++) { /* n = 2: the segment both ways, else the sides of a triangle */
        int inside = 0;
        for (int k = 0; k < 4; k++) inside += side(p[i], p[(i + 1) % n], s[k]) > 0;
        if (inside == 0) return false;
    }
    return true;
}

static int64_t floor_unit(int64_t x, int32_t bits) {
    return x >> bits;
}

static int32_t root(reference_point *p, int32_t i) {
    while (p[i].set != i) i = p[i].set;
    return i;
}

static int32_t find(const reference_point *p, int32_t n, int32_t t, int64_t u, int64_t v) {
    int32_t low = 0, high = n; /* sorted by triangle */
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (p[middle].t < t)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < n && p[low].t == t; low++)
        if (p[low].u == u && p[low].v == v) return low;
    return -1;
}

/* All lattice points (or squares) of all triangles. NULL = count only. */
static int32_t list(const qc_grid_map *g, bool squares, reference_point *out) {
    const int64_t unit = (int64_t)1 << g->bits;
    int32_t n = 0;
    for (int32_t t = 0; t < g->mesh->n_faces; t++) {
        const point p[3] = {corner(g, 3 * t), corner(g, 3 * t + 1), corner(g, 3 * t + 2)};
        point low = p[0], high = p[0];
        for (int k = 1; k < 3; k++) {
            if (p[k].u < low.u) low.u = p[k].u;
            if (p[k].v < low.v) low.v = p[k].v;
            if (p[k].u > high.u) high.u = p[k].u;
            if (p[k].v > high.v) high.v = p[k].v;
        }
        for (int64_t u = floor_unit(low.u, g->bits); u <= floor_unit(high.u, g->bits); u++)
            for (int64_t v = floor_unit(low.v, g->bits); v <= floor_unit(high.v, g->bits); v++) {
                const point o = {u * unit, v * unit};
                if (squares ? !meets(p, 3, o, unit) : !in_triangle(g, t, o)) continue;
                if (out) out[n] = (reference_point){t, u, v, n, 0};
                n++;
            }
    }
    return n;
}

static reference_point *listed(const qc_grid_map *g, bool squares, int32_t *n) {
    *n = list(g, squares, NULL);
    reference_point *p = malloc(sizeof *p * (size_t)(*n + 1));
    list(g, squares, p);
    return p;
}

/* Points on an edge are one on both sides. Numbers the classes. */
static int32_t glue_points(const qc_grid_map *g, reference_point *p, int32_t n) {
    const int64_t unit = (int64_t)1 << g->bits;
    for (int32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * p[i].t + k;
            const point at = {p[i].u, p[i].v}, o = {at.u * unit, at.v * unit};
            if (g->mesh->twin[h] < 0 ||
                side(corner(g, 3 * p[i].t + (k + 1) % 3), corner(g, 3 * p[i].t + (k + 2) % 3), o))
                continue;
            int r;
            const point q = across(g, h, at, 1, &r);
            const int32_t j = find(p, n, g->mesh->twin[h] / 3, q.u, q.v);
            if (j < 0) return -1;
            p[root(p, i)].set = root(p, j);
        }
    int32_t classes = 0;
    int32_t *number = malloc(sizeof *number * (size_t)(n + 1));
    for (int32_t i = 0; i < n; i++) number[i] = root(p, i) == i ? classes++ : -1;
    for (int32_t i = 0; i < n; i++) number[i] = number[root(p, i)];
    for (int32_t i = 0; i < n; i++) p[i].set = number[i];
    free(number);
    return classes;
}

/* Squares which an edge crosses are one on both sides: flood with frames. quad: 4 a class. */
static bool flood_squares(const qc_grid_map *g, reference_point *s, int32_t n,
                          const reference_point *p, int32_t n_points, reference_quads *out) {
    const int64_t unit = (int64_t)1 << g->bits;
    int32_t *queue = malloc(sizeof *queue * (size_t)(n + 1));
    out->quad = malloc(4 * sizeof *out->quad * (size_t)(n + 1));
    bool whole = true;
    for (int32_t i = 0; i < n; i++) s[i].set = -1;
    for (int32_t seed = 0; seed < n; seed++) {
        if (s[seed].set >= 0) continue;
        int32_t *quad = out->quad + 4 * out->n_quads, count = 0;
        for (int k = 0; k < 4; k++) quad[k] = -1;
        s[seed].set = out->n_quads++;
        queue[count++] = seed;
        for (int32_t i = 0; i < count; i++) {
            const reference_point *a = &s[queue[i]];
            const point o = {a->u * unit, a->v * unit};
            static const int64_t du[4] = {0, 1, 1, 0}, dv[4] = {0, 0, 1, 1};
            for (int k = 0; k < 4; k++) {
                const int32_t at = find(p, n_points, a->t, a->u + du[k], a->v + dv[k]);
                if (at >= 0) quad[(k + a->turn) & 3] = p[at].set;
            }
            for (int k = 0; k < 3; k++) {
                const int32_t h = 3 * a->t + k;
                const point e[2] = {corner(g, 3 * a->t + (k + 1) % 3),
                                    corner(g, 3 * a->t + (k + 2) % 3)};
                if (g->mesh->twin[h] < 0 || !meets(e, 2, o, unit)) continue;
                int r;
                const point centre = across(g, h, (point){2 * a->u + 1, 2 * a->v + 1}, 2, &r);
                const int32_t j = find(s, n, g->mesh->twin[h] / 3, floor_unit(centre.u, 1),
                                       floor_unit(centre.v, 1));
                if (j < 0) {
                    whole = false;
                    continue;
                }
                if (s[j].set >= 0) continue;
                s[j].set = a->set;
                s[j].turn = (a->turn + 4 - r) & 3; /* corner k here is corner k + r there */
                queue[count++] = j;
            }
        }
        for (int k = 0; k < 4; k++) whole &= quad[k] >= 0;
    }
    free(queue);
    return whole;
}

static int compare(const void *a, const void *b) {
    const int32_t *x = a, *y = b;
    for (int k = 0; k < 4; k++)
        if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

void reference_sort(int32_t *quad, int32_t n) {
    for (int32_t f = 0; f < n; f++) {
        int32_t old[4];
        int least = 0;
        memcpy(old, quad + 4 * f, sizeof old);
        for (int k = 1; k < 4; k++)
            if (old[k] < old[least]) least = k;
        for (int k = 0; k < 4; k++) quad[4 * f + k] = old[(least + k) & 3];
    }
    qsort(quad, (size_t)n, 4 * sizeof *quad, compare);
}

bool reference_extract(const qc_grid_map *g, reference_quads *out) {
    memset(out, 0, sizeof *out);
    out->grid = g;
    out->point = listed(g, false, &out->n_points);
    out->n_vertices = glue_points(g, out->point, out->n_points);
    if (out->n_vertices < 0) return false;
    int32_t n;
    reference_point *squares = listed(g, true, &n);
    const bool whole = flood_squares(g, squares, n, out->point, out->n_points, out);
    free(squares);
    if (whole) reference_sort(out->quad, out->n_quads);
    return whole;
}

void reference_free(reference_quads *r) {
    free(r->quad);
    free(r->point);
    memset(r, 0, sizeof *r);
}

int32_t reference_vertex(const reference_quads *r, int32_t t, int64_t u, int64_t v) {
    const int32_t i = find(r->point, r->n_points, t, u, v);
    return i < 0 ? -1 : r->point[i].set;
}
