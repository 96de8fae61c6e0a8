/* Lattice vertices of a grid map (stages/extract/extract.md): every integer point is found once, as
 * mesh vertex, on an edge or in a face, by exact tests only. */
#include <stdlib.h>

#include "sdk/map/extract/internal.h"

enum { MAX_POINTS = 1 << 28 };

/* Floor of a / b, b > 0. */
static int64_t floor_div(int64_t a, int64_t b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

static void put(int32_t *uv, int64_t i, int64_t u, int64_t v) {
    if (!uv) return;
    uv[2 * i] = (int32_t)u;
    uv[2 * i + 1] = (int32_t)v;
}

/* Integer points strictly between a and b, from a to b; uv NULL = count only. One candidate for
 * each integer of the coordinate which varies more. */
static int64_t points_between(qc__point a, qc__point b, int32_t bits, int32_t *uv) {
    const bool swap = llabs(b.u - a.u) < llabs(b.v - a.v);
    const int64_t unit = (int64_t)1 << bits;
    const int64_t ax = swap ? a.v : a.u, ay = swap ? a.u : a.v;
    const int64_t dx = (swap ? b.v : b.u) - ax, dy = (swap ? b.u : b.v) - ay;
    if (dx == 0) return 0;
    const int64_t step = dx > 0 ? 1 : -1;
    int64_t n = 0;
    int64_t k = dx > 0 ? floor_div(ax, unit) + 1 : -floor_div(-ax, unit) - 1;
    for (; (k * unit - ax - dx) * step < 0; k += step) {
        const int64_t rise = (k * unit - ax) * dy;
        if (rise % dx != 0) continue;
        const int64_t y = ay + rise / dx, l = floor_div(y, unit);
        if (l * unit != y) continue;
        put(uv, n++, swap ? l : k, swap ? k : l);
    }
    return n;
}

static int64_t edge_points(const qc_grid_map *g, int32_t e, int32_t *uv) {
    const int32_t h = g->mesh->edge_halfedge[2 * (int64_t)e];
    return points_between(qc__grid_corner(g, qc_next(h)), qc__grid_corner(g, qc_prev(h)), g->bits,
                          uv);
}

/* Integer points strictly inside the triangle, row by row. In row y an edge (a, d) bounds x - a.u
 * by d.u (y - a.v) / d.v, from above when d.v > 0. */
static int64_t face_points(const qc_grid_map *g, int32_t t, int32_t *uv) {
    const int64_t unit = (int64_t)1 << g->bits;
    const qc__point p[3] = {qc__grid_corner(g, 3 * t), qc__grid_corner(g, 3 * t + 1),
                            qc__grid_corner(g, 3 * t + 2)};
    int64_t low = p[0].v, high = p[0].v, n = 0;
    for (int k = 1; k < 3; k++) {
        if (p[k].v < low) low = p[k].v;
        if (p[k].v > high) high = p[k].v;
    }
    for (int64_t row = floor_div(low, unit) + 1; row * unit < high; row++) {
        int64_t left = INT64_MIN, right = INT64_MAX; /* first and last x in grid units */
        bool empty = false;
        for (int k = 0; k < 3; k++) {
            const qc__point a = p[k], d = qc__minus(p[(k + 1) % 3], a);
            const int64_t run = d.u * (row * unit - a.v);
            if (d.v > 0) {
                const int64_t x = a.u - floor_div(-run, d.v) - 1; /* ceil(run / d.v) - 1 */
                if (x < right) right = x;
            } else if (d.v < 0) {
                const int64_t x = a.u + floor_div(-run, -d.v) + 1;
                if (x > left) left = x;
            } else {
                empty |= run <= 0;
            }
        }
        if (empty || left > right) continue;
        const int64_t first = -floor_div(-left, unit), last = floor_div(right, unit);
        if (!uv)
            n += first <= last ? last - first + 1 : 0;
        else
            for (int64_t x = first; x <= last; x++) put(uv, n++, x, row);
    }
    return n;
}

static bool at_lattice(const qc_grid_map *g, qc__point p) {
    return ((p.u | p.v) & (((int64_t)1 << g->bits) - 1)) == 0;
}

static qc_status count(qc_ctx *ctx, qc__lattice *l) {
    const qc_grid_map *g = l->g;
    const qc_mesh *m = g->mesh;
    int64_t n = 0;
    for (int32_t v = 0; v < m->n_vertices; v++)
        l->vertex_id[v] =
            at_lattice(g, qc__grid_corner(g, m->vertex_corner[v])) ? (int32_t)n++ : -1;
    l->n_at_vertices = (int32_t)n;
    for (int32_t e = 0; e < m->n_edges && n <= MAX_POINTS; e++) {
        if (e % 8192 == 0 && !qc__progress(ctx, 0.08 * e / m->n_edges)) return QC_ERR_CANCELLED;
        l->edge_first[e] = (int32_t)n;
        n += edge_points(g, e, NULL);
    }
    l->edge_first[m->n_edges] = l->n_on_skeleton = (int32_t)n;
    for (int32_t t = 0; t < m->n_faces && n <= MAX_POINTS; t++) {
        if (t % 8192 == 0 && !qc__progress(ctx, 0.08 + 0.04 * t / m->n_faces))
            return QC_ERR_CANCELLED;
        l->face_first[t] = (int32_t)n;
        n += face_points(g, t, NULL);
    }
    l->face_first[m->n_faces] = l->n = (int32_t)n;
    if (n <= MAX_POINTS) return QC_OK;
    return qc__fail(ctx, QC_ERR_FAILED, -1,
                    "the map has more than %d grid points; try a coarser density", (int)MAX_POINTS);
}

static qc_status fill(qc_ctx *ctx, qc__lattice *l) {
    const qc_grid_map *g = l->g;
    const qc_mesh *m = g->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const int32_t id = l->vertex_id[v];
        if (id < 0) continue;
        const qc__point p = qc__grid_corner(g, m->vertex_corner[v]);
        l->home[id] = v;
        put(l->uv, id, p.u >> g->bits, p.v >> g->bits);
    }
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (l->edge_first[e] == l->edge_first[e + 1]) continue;
        edge_points(g, e, l->uv + 2 * (int64_t)l->edge_first[e]);
        for (int32_t i = l->edge_first[e]; i < l->edge_first[e + 1]; i++) l->home[i] = e;
    }
    for (int32_t t = 0; t < m->n_faces; t++) {
        const int32_t first = l->face_first[t], last = l->face_first[t + 1];
        if (t % 8192 == 0 && !qc__progress(ctx, 0.12 + 0.08 * t / m->n_faces))
            return QC_ERR_CANCELLED;
        if (first == last) continue;
        face_points(g, t, l->uv + 2 * (int64_t)first);
        for (int32_t i = first; i < last; i++) l->home[i] = t;
    }
    return QC_OK;
}

qc_status qc__lattice_create(qc_ctx *ctx, const qc_grid_map *g, qc__lattice *out) {
    qc__lattice l = {.g = g};
    for (int32_t e = 0; e < g->mesh->n_edges; e++)
        l.open |= g->mesh->edge_halfedge[2 * (int64_t)e + 1] < 0 && (!g->axis || g->axis[e] < 0);
    l.vertex_id = QC__NEW(ctx, int32_t, g->mesh->n_vertices);
    l.edge_first = QC__NEW(ctx, int32_t, (int64_t)g->mesh->n_edges + 1);
    l.face_first = QC__NEW(ctx, int32_t, (int64_t)g->mesh->n_faces + 1);
    qc_status status = l.vertex_id && l.edge_first && l.face_first ? count(ctx, &l) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        l.home = QC__NEW(ctx, int32_t, l.n);
        l.uv = QC__NEW(ctx, int32_t, 2 * (int64_t)l.n);
        status = l.home && l.uv ? fill(ctx, &l) : QC_ERR_NOMEM;
    }
    if (status == QC_OK)
        *out = l;
    else
        qc__lattice_free(&l);
    return status;
}

void qc__lattice_free(qc__lattice *l) {
    qc__free(l->vertex_id);
    qc__free(l->edge_first);
    qc__free(l->face_first);
    qc__free(l->home);
    qc__free(l->uv);
    *l = (qc__lattice){0};
}

int32_t qc__lattice_face(const qc__lattice *l, int32_t id) {
    const int32_t home = l->home[id];
    if (id < l->n_at_vertices) return l->g->mesh->vertex_corner[home] / 3;
    return id < l->n_on_skeleton ? l->g->mesh->edge_halfedge[2 * (int64_t)home] / 3 : home;
}

bool qc__lattice_on_boundary(const qc__lattice *l, int32_t id) {
    const int32_t home = l->home[id];
    if (id < l->n_at_vertices) return qc_vertex_on_boundary(l->g->mesh, home);
    return id < l->n_on_skeleton && l->g->mesh->edge_halfedge[2 * (int64_t)home + 1] < 0;
}

qc__place qc__locate(const qc_grid_map *g, int32_t t, qc__point p, int *k) {
    const qc__point c[3] = {qc__grid_corner(g, 3 * t), qc__grid_corner(g, 3 * t + 1),
                            qc__grid_corner(g, 3 * t + 2)};
    int zeros = 0, sum = 0;
    for (int i = 0; i < 3; i++) {
        const qc__point a = c[(i + 1) % 3], b = c[(i + 2) % 3];
        const int64_t side = qc__cross(qc__minus(b, a), qc__minus(p, a));
        if (side < 0) return QC__OUTSIDE;
        if (side > 0) continue;
        zeros++;
        sum += i;
    }
    if (zeros == 0) return QC__INSIDE;
    *k = zeros == 1 ? sum : 3 - sum; /* at corner k the halfedges other than k vanish */
    return zeros == 1 ? QC__ON_EDGE : QC__AT_CORNER;
}

/* First i in [first, last) whose key sign * uv[2 i + axis] is not below that of p. */
static int32_t lower_bound(const int32_t *uv, int32_t first, int32_t last, int axis, int64_t sign,
                           int64_t key) {
    while (first < last) {
        const int32_t middle = first + (last - first) / 2;
        if (sign * uv[2 * (int64_t)middle + axis] < sign * key)
            first = middle + 1;
        else
            last = middle;
    }
    return first;
}

static int32_t find_in_face(const qc__lattice *l, int32_t t, int64_t u, int64_t v) {
    int32_t first = lower_bound(l->uv, l->face_first[t], l->face_first[t + 1], 1, 1, v);
    const int32_t last = lower_bound(l->uv, first, l->face_first[t + 1], 1, 1, v + 1);
    first = lower_bound(l->uv, first, last, 0, 1, u);
    return first < last && l->uv[2 * (int64_t)first] == u ? first : -1;
}

static int32_t find_on_edge(const qc__lattice *l, int32_t h, qc__point p) {
    const qc_grid_map *g = l->g;
    const int32_t e = g->mesh->halfedge_edge[h], home = g->mesh->edge_halfedge[2 * (int64_t)e];
    if (home != h) p = qc__grid_transition(g, h, p);
    const qc__point d =
        qc__minus(qc__grid_corner(g, qc_prev(home)), qc__grid_corner(g, qc_next(home)));
    const int axis = llabs(d.u) < llabs(d.v);
    const int64_t along = axis ? d.v : d.u, key = (axis ? p.v : p.u) >> g->bits;
    const int32_t i =
        lower_bound(l->uv, l->edge_first[e], l->edge_first[e + 1], axis, along > 0 ? 1 : -1, key);
    return i < l->edge_first[e + 1] && l->uv[2 * (int64_t)i + axis] == key ? i : -1;
}

int32_t qc__lattice_find(const qc__lattice *l, int32_t t, qc__point p) {
    int k = 0;
    switch (qc__locate(l->g, t, p, &k)) {
    case QC__INSIDE:
        return find_in_face(l, t, p.u >> l->g->bits, p.v >> l->g->bits);
    case QC__ON_EDGE:
        return find_on_edge(l, 3 * t + k, p);
    case QC__AT_CORNER:
        return l->vertex_id[l->g->mesh->face_vertex[3 * t + k]];
    default:
        return -1;
    }
}
