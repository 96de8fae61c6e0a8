/* Where the edges of the mesh cross those of its coarse complex, in exact order
 * (docs/theory/quantization.md). */
#include "sdk/map/quantize/imprinter.h"

typedef qc__imprinter imprinter;

/* A crossing nearer than that to an end of its edge (parameter units) becomes that end: the grid
 * of the map could not tell them apart. */
static const double nearest = 6e-5;

void qc__imprint_meet(const qc__cursor *k, qc__point a, qc__point b, int32_t h, double share[2]) {
    const qc__point p = qc__cursor_place(k, a), e = k->coarse->vector[h];
    const qc__point d = qc__minus(qc__cursor_place(k, b), p);
    const qc__point from = qc__minus(qc__corner_place(k->coarse->vector, h), p);
    const double area = qc__area_of(d, e);
    share[0] = qc__area_of(from, e) / area;
    share[1] = qc__area_of(from, d) / area;
}

int32_t qc__imprint_turn(const imprinter *q, int k) {
    const qc__point *c = q->walk.corner;
    return qc__cursor_turn(&q->cursor, c[k], qc__minus(c[(k + 1) % 3], c[k]));
}

int32_t qc__imprint_exit(const imprinter *q, int k) {
    return qc__cursor_exit(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3]);
}

void qc__imprint_begin(imprinter *q, int32_t face, int k) {
    q->face = face;
    q->walk = qc__face_walk_begin(q->map, q->coarse, q->x, face);
    q->cursor = qc__face_walk_to(&q->walk, k);
    for (int32_t h = qc__imprint_turn(q, k); h >= 0; h = qc__imprint_turn(q, k))
        qc__cursor_cross(&q->cursor, h);
}

static bool is_near(const double a[2], const double b[2]) {
    return hypot(a[0] - b[0], a[1] - b[1]) < nearest;
}

/* The crossings from..to of edge e, between the values a and b of its ends. */
static void name_crossings(imprinter *q, int32_t e, int32_t from, int32_t to, const double a[2],
                           const double b[2]) {
    const int32_t *end = q->map->mesh->edge_vertex + 2 * (int64_t)e;
    int32_t low = from, high = to;
    for (int32_t i = from; i < to; i++)
        if (is_near(q->place + 2 * (int64_t)i, a)) low = i + 1;
    for (int32_t i = to; i-- > low;)
        if (is_near(q->place + 2 * (int64_t)i, b)) high = i;
    for (int32_t i = from; i < to; i++) {
        q->vertex[i] = i < low ? end[0] : i < high ? q->n_vertices++ : end[1];
        q->share[i] = i < low ? 0 : i < high ? fmin(fmax(q->share[i], 0), 1) : 1;
    }
}

void qc__find_crossings(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    int32_t n = 0;
    q->n_vertices = m->n_vertices;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * (int64_t)e];
        const int k = qc_next(h) % 3;
        double start[2], end[2];
        q->edge_start[e] = n;
        qc__imprint_begin(q, h / 3, k);
        qc__cursor_value(&q->cursor, q->walk.corner[k], start);
        for (int32_t c = qc__imprint_exit(q, k); c >= 0; c = qc__imprint_exit(q, k), n++) {
            double share[2];
            qc__imprint_meet(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3], c, share);
            if (q->share) {
                q->share[n] = share[0];
                qc__cursor_on_edge(&q->cursor, c, share[1], q->place + 2 * (int64_t)n);
            }
            qc__cursor_cross(&q->cursor, c);
        }
        qc__cursor_value(&q->cursor, q->walk.corner[(k + 1) % 3], end);
        if (q->share) name_crossings(q, e, q->edge_start[e], n, start, end);
    }
    q->edge_start[m->n_edges] = n;
}
