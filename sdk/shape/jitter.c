/* Random tangential displacement of the vertices which lie neither on the boundary nor on a crease.
 * A move that would turn or sharpen one of the triangles too much is not made. */
#include <string.h>

#include "sdk/shape/internal.h"

static const double SMOOTH = 0.7; /* cosine between the normals at a vertex: else a crease       */
static const double AMPLITUDE = 0.3;   /* of the shortest edge at the vertex   */
static const double MAX_COSINE = 0.97; /* of an angle after the move */

typedef struct star {
    double normal[3]; /* unit, mean                                                               */
    double shortest; /* edge                                                                      */
    bool movable;
} star;

/* Edges from corner c to its two neighbours, and the unit normal; returns the corner's cosine. */
static double corner(const qc_mesh *m, const double *p, int32_t c, double a[3], double b[3],
                     double n[3]) {
    int64_t v = m->face_vertex[c], x = m->face_vertex[qc_next(c)], y = m->face_vertex[qc_prev(c)];
    for (int i = 0; i < 3; i++) {
        a[i] = p[3 * x + i] - p[3 * v + i];
        b[i] = p[3 * y + i] - p[3 * v + i];
    }
    qc__cross(a, b, n);
    qc__normalize(n);
    return qc__dot(a, b) / sqrt(qc__dot(a, a) * qc__dot(b, b));
}

static star look(const qc_mesh *m, const double *p, int32_t v) {
    star s = {{0, 0, 0}, INFINITY, true};
    double a[3], b[3], n[3], first[3] = {0, 0, 0};
    int32_t c = m->vertex_corner[v];
    do {
        corner(m, p, c, a, b, n);
        if (c == m->vertex_corner[v]) memcpy(first, n, sizeof n);
        if (qc__dot(first, n) < SMOOTH) s.movable = false;
        s.shortest = fmin(s.shortest, sqrt(qc__dot(a, a)));
        for (int i = 0; i < 3; i++) s.normal[i] += n[i];
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != m->vertex_corner[v]);
    s.movable = s.movable && c >= 0;
    if (s.movable) qc__normalize(s.normal);
    return s;
}

static bool acceptable(const qc_mesh *m, const double *p, int32_t v, const double normal[3]) {
    double a[3], b[3], n[3];
    int32_t c = m->vertex_corner[v];
    do {
        for (int k = 0; k < 3; k++)
            if (corner(m, p, c - c % 3 + k, a, b, n) > MAX_COSINE) return false;
        if (qc__dot(n, normal) < SMOOTH) return false;
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != m->vertex_corner[v]);
    return true;
}

static void move(const qc_mesh *m, double *p, int32_t v, qc__random *r) {
    double d[3], old[3], *x = p + 3 * (int64_t)v;
    for (int i = 0; i < 3; i++) d[i] = 2 * qc__random_unit(r) - 1;
    star s = look(m, p, v);
    if (!s.movable) return;
    double along = qc__dot(d, s.normal);
    for (int i = 0; i < 3; i++) {
        old[i] = x[i];
        x[i] += AMPLITUDE * s.shortest * (d[i] - along * s.normal[i]);
    }
    if (!acceptable(m, p, v, s.normal)) memcpy(x, old, sizeof old);
}

qc_status qc__shape_jitter(qc_ctx *ctx, const qc_mesh *m, uint64_t seed, qc_mesh **out) {
    double *p = QC__NEW(ctx, double, 3 * (size_t)m->n_vertices);
    if (!p) return QC_ERR_NOMEM;
    memcpy(p, m->position, 3 * (size_t)m->n_vertices * sizeof *p);
    qc__random r = {seed ^ 0x6a697474};
    for (int32_t v = 0; v < m->n_vertices; v++) move(m, p, v, &r);
    qc_status status = qc_mesh_create(ctx, m->n_vertices, p, m->n_faces, m->face_vertex, out);
    qc__free(p);
    return status;
}
