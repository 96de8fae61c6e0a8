/* Balls of edge paths and the measure of crowding, see crowd.h. */
#include "crowd.h"

#include <float.h>

qc_status qc__crowd_create(qc_ctx *ctx, const qc_mesh *mesh, const int32_t *index4,
                           const uint8_t *barred, qc__crowd *out) {
    int32_t V = mesh->n_vertices;
    *out = (qc__crowd){mesh,
                       index4,
                       barred,
                       QC__NEW(ctx, double, V),
                       QC__NEW(ctx, int32_t, V),
                       QC__ZERO(ctx, uint8_t, V),
                       QC__NEW(ctx, int32_t, V)};
    if (!out->reach || !out->ball || !out->waiting || !out->queue) return QC_ERR_NOMEM;
    for (int32_t p = 0; p < V; p++) out->reach[p] = INFINITY;
    return QC_OK;
}

void qc__crowd_free(qc__crowd *c) {
    qc__free(c->reach);
    qc__free(c->ball);
    qc__free(c->waiting);
    qc__free(c->queue);
}

static double edge_length(const qc_mesh *mesh, int32_t p, int32_t q) {
    double d[3];
    qc__sub(mesh->position + 3 * (size_t)p, mesh->position + 3 * (size_t)q, d);
    return sqrt(qc__dot3(d, d));
}

typedef struct ring {
    int32_t head, waiting, found;
} ring;

static void improve(qc__crowd *c, ring *r, int32_t q, double reach, double radius) {
    if (!(reach <= radius) || !(reach < c->reach[q]) || (c->barred && c->barred[q])) return;
    if (isinf(c->reach[q])) c->ball[r->found++] = q;
    c->reach[q] = reach;
    if (c->waiting[q]) return;
    c->waiting[q] = 1;
    c->queue[(r->head + r->waiting++) % c->mesh->n_vertices] = q;
}

/* Bellman and Ford's method on a few vertices; reach stays filled. */
static int32_t measure_ball(qc__crowd *c, int32_t p, double radius) {
    const qc_mesh *mesh = c->mesh;
    ring r = {0, 0, 0};
    improve(c, &r, p, 0, radius);
    while (r.waiting > 0) {
        int32_t a = c->queue[r.head], first = mesh->vertex_corner[a], k = first;
        r.head = (r.head + 1) % mesh->n_vertices;
        r.waiting--;
        c->waiting[a] = 0;
        do {
            int32_t q[2] = {mesh->face_vertex[qc_next(k)], mesh->face_vertex[qc_prev(k)]};
            for (int i = 0; i < 2; i++)
                improve(c, &r, q[i], c->reach[a] + edge_length(mesh, a, q[i]), radius);
            k = qc_corner_ccw(mesh, k);
        } while (k >= 0 && k != first);
    }
    return r.found;
}

static void forget_ball(qc__crowd *c, int32_t n) {
    for (int32_t i = 0; i < n; i++) c->reach[c->ball[i]] = INFINITY;
}

int32_t qc__crowd_ball(qc__crowd *c, int32_t p, double radius) {
    int32_t n = measure_ball(c, p, radius);
    forget_ball(c, n);
    return n;
}

/* Whether an edge joins p and q. */
static bool share_edge(const qc_mesh *mesh, int32_t p, int32_t q) {
    int32_t first = mesh->vertex_corner[p], k = first;
    do {
        if (mesh->face_vertex[qc_next(k)] == q || mesh->face_vertex[qc_prev(k)] == q) return true;
        k = qc_corner_ccw(mesh, k);
    } while (k >= 0 && k != first);
    return false;
}

/* Whether vertex i of the ball about p crowds p. */
static bool is_opposite(const qc__crowd *c, int32_t p, int32_t q, double distance) {
    int32_t own = c->index4[p], other = c->index4[q];
    if (own == 0 || other == 0 || (other > 0) == (own > 0)) return false;
    return c->reach[q] < distance || share_edge(c->mesh, p, q);
}

int32_t qc__crowd_measure(qc__crowd *c, int32_t p, double distance) {
    int32_t measure = qc__index_excess(c->index4[p]);
    if (c->index4[p] == 0 || !(distance > 0)) return measure;
    int32_t n = measure_ball(c, p, 2 * distance);
    for (int32_t i = 0; i < n; i++) measure += is_opposite(c, p, c->ball[i], distance);
    forget_ball(c, n);
    return measure;
}

/* Edge from q to the neighbour through which q was reached, *q becomes that neighbour. */
static int32_t step_back(const qc__crowd *c, int32_t *q) {
    const qc_mesh *mesh = c->mesh;
    int32_t first = mesh->vertex_corner[*q], k = first, edge = -1, start = *q;
    double best = INFINITY;
    do {
        int32_t next = qc_next(k), prev = qc_prev(k);
        int32_t corner[2] = {next, prev}, opposite[2] = {prev, next};
        for (int i = 0; i < 2; i++) {
            int32_t a = mesh->face_vertex[corner[i]];
            double reach = c->reach[a] + edge_length(mesh, start, a);
            if (!(c->reach[a] < c->reach[start]) || !(reach < best)) continue;
            best = reach;
            *q = a;
            edge = mesh->halfedge_edge[opposite[i]];
        }
        k = qc_corner_ccw(mesh, k);
    } while (k >= 0 && k != first);
    return edge;
}

int32_t qc__crowd_path(qc__crowd *c, int32_t p, double distance, int32_t *other) {
    int32_t n = measure_ball(c, p, 2 * distance), q = -1, edges = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t a = c->ball[i];
        if (!is_opposite(c, p, a, distance)) continue;
        if (q < 0 || c->reach[a] < c->reach[q] || (!(c->reach[a] > c->reach[q]) && a < q)) q = a;
    }
    *other = q;
    while (q >= 0 && q != p) {
        int32_t edge = step_back(c, &q);
        if (edge < 0) break; /* edges of length zero */
        c->queue[edges++] = edge;
    }
    forget_ball(c, n);
    for (int32_t i = 0; i < edges; i++) c->ball[i] = c->queue[i];
    return q == p ? edges : 0;
}

double qc__crowd_lone_pair(qc__crowd *crowd) {
    const qc_mesh *mesh = crowd->mesh;
    int32_t n = 0, p = -1, q;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (crowd->index4[v] == 0) continue;
        n++;
        if (crowd->index4[v] == 1) p = v;
    }
    if (n != 2 || p < 0 || mesh->euler != 0 || mesh->n_boundary_edges > 0 ||
        mesh->n_components != 1)
        return 0;
    double length = 0;
    const int32_t n_path = qc__crowd_path(crowd, p, 0.5 * DBL_MAX, &q);
    for (int32_t i = 0; i < n_path; i++) {
        const int32_t *end = mesh->edge_vertex + 2 * (int64_t)crowd->ball[i];
        double d[3];
        qc__sub(mesh->position + 3 * (size_t)end[0], mesh->position + 3 * (size_t)end[1], d);
        length += sqrt(qc__dot3(d, d));
    }
    return length;
}
