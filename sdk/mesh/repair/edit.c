/* Local edits of a paired triangle list with the checks which keep it a manifold (link condition of
 * Dey, Edelsbrunner, Guha, Nekhayev 1999). */
#include "sdk/mesh/repair/edit.h"

#include <math.h>

qc_status qc__edit_begin(qc__repair *r, qc__edit *e) {
    *e = (qc__edit){.r = r};
    e->corner = QC__NEW(r->ctx, int32_t, r->n_vertices);
    e->mark = QC__ZERO(r->ctx, int32_t, r->n_vertices);
    if (!e->corner || !e->mark) {
        qc__edit_end(e);
        return QC_ERR_NOMEM;
    }
    for (int32_t v = 0; v < r->n_vertices; v++) e->corner[v] = -1;
    for (int32_t c = 0; c < 3 * r->n_faces; c++)
        if (r->triangle[c - c % 3] >= 0) e->corner[r->triangle[c]] = c;
    return QC_OK;
}

void qc__edit_end(qc__edit *e) {
    qc__free(e->corner);
    qc__free(e->mark);
    *e = (qc__edit){0};
}

double qc__edit_quality(const qc__edit *e, int32_t a, int32_t b, int32_t c, double normal[3]) {
    const double *p[3] = {qc__repair_point(e->r, a), qc__repair_point(e->r, b),
                          qc__repair_point(e->r, c)};
    double n[3], area = 0, longest = 0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] =
            (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
        area += n[k] * n[k];
        double d = 0;
        for (int m = 0; m < 3; m++) d += (p[i][m] - p[j][m]) * (p[i][m] - p[j][m]);
        longest = d > longest ? d : longest;
        if (normal) normal[k] = n[k];
    }
    return longest > 0 ? sqrt(area) / (2 * longest) : 0;
}

/* --- walks ------------------------------------------------------------------------------------ */

/* Corners around a vertex: counter-clockwise to the boundary or once round, then clockwise. */
typedef struct walk {
    int32_t first, now;
    bool clockwise, open;
} walk;

static walk walk_begin(const qc__edit *e, int32_t v) {
    return (walk){e->corner[v], e->corner[v], false, false};
}

static void walk_next(const qc__edit *e, walk *w) {
    const int32_t *twin = e->r->twin;
    if (!w->clockwise) {
        int32_t g = twin[qc_next(w->now)];
        w->now = g < 0 ? -1 : qc_next(g);
        if (w->now == w->first)
            w->now = -1;
        else if (g < 0) {
            w->open = w->clockwise = true;
            w->now = w->first;
        } else
            return;
        if (w->now < 0) return;
    }
    int32_t g = twin[qc_prev(w->now)];
    w->now = g < 0 ? -1 : qc_prev(g);
}

static bool on_boundary(const qc__edit *e, int32_t v) {
    walk w = walk_begin(e, v);
    while (w.now >= 0) walk_next(e, &w);
    return w.open;
}

static int32_t count_faces(const qc__edit *e, int32_t v) {
    int32_t n = 0;
    for (walk w = walk_begin(e, v); w.now >= 0; walk_next(e, &w)) n++;
    return n;
}

/* Marks the neighbours of u with a new stamp; then the marked neighbours of v can be counted. */
static void mark_ring(qc__edit *e, int32_t u) {
    e->stamp++;
    for (walk w = walk_begin(e, u); w.now >= 0; walk_next(e, &w)) {
        e->mark[e->r->triangle[qc_next(w.now)]] = e->stamp;
        e->mark[e->r->triangle[qc_prev(w.now)]] = e->stamp;
    }
}

static int32_t count_marked(qc__edit *e, int32_t v) {
    int32_t n = 0;
    for (walk w = walk_begin(e, v); w.now >= 0; walk_next(e, &w))
        for (int side = 0; side < 2; side++) {
            int32_t x = e->r->triangle[side ? qc_prev(w.now) : qc_next(w.now)];
            if (e->mark[x] != e->stamp) continue;
            e->mark[x] = 0; /* once */
            n++;
        }
    return n;
}

static void link_twins(qc__repair *r, int32_t h, int32_t g) {
    if (h >= 0) r->twin[h] = g;
    if (g >= 0) r->twin[g] = h;
}

/* --- collapse --------------------------------------------------------------------------------- */

/* The apex of halfedge h loses a face; it must keep a proper fan, and the two other edges of the
 * face must not both be boundary. */
static bool apex_survives(const qc__edit *e, int32_t h) {
    if (e->r->twin[qc_next(h)] < 0 && e->r->twin[qc_prev(h)] < 0) return false;
    int32_t apex = e->r->triangle[h];
    return on_boundary(e, apex) || count_faces(e, apex) > 3;
}

/* Whether the faces around `gone` stay good when it moves to `stays`. */
static bool ring_survives(const qc__edit *e, int32_t gone, int32_t stays, double least) {
    for (walk w = walk_begin(e, gone); w.now >= 0; walk_next(e, &w)) {
        int32_t a = e->r->triangle[qc_next(w.now)], b = e->r->triangle[qc_prev(w.now)];
        double before[3], after[3];
        if (a == stays || b == stays) continue;
        double q0 = qc__edit_quality(e, gone, a, b, before);
        double q1 = qc__edit_quality(e, stays, a, b, after);
        double dot = before[0] * after[0] + before[1] * after[1] + before[2] * after[2];
        if (q0 < least) {
            if (q1 < q0) return false;
        } else if (q1 < least || dot <= 0)
            return false;
    }
    return true;
}

/* Takes the face of h out: its other edges become one. */
static void close_face(qc__edit *e, int32_t h, int32_t stays) {
    qc__repair *r = e->r;
    int32_t apex = r->triangle[h], a = r->twin[qc_next(h)], b = r->twin[qc_prev(h)];
    link_twins(r, a, b); /* one of them may be the boundary */
    /* a runs from the apex to the end of h, b from the start of h to the apex */
    e->corner[apex] = a >= 0 ? qc_next(a) : qc_prev(b);
    e->corner[stays] = a >= 0 ? qc_prev(a) : qc_next(b);
    r->triangle[h - h % 3] = -1;
}

bool qc__edit_collapse(qc__edit *e, int32_t h, double least) {
    qc__repair *r = e->r;
    int32_t g = r->twin[h], u = r->triangle[qc_next(h)], v = r->triangle[qc_prev(h)];
    bool bu = on_boundary(e, u), bv = on_boundary(e, v);
    if (bu && bv && g >= 0) return false;
    if (!apex_survives(e, h) || (g >= 0 && !apex_survives(e, g))) return false;
    mark_ring(e, u);
    if (count_marked(e, v) != (g >= 0 ? 2 : 1)) return false; /* link condition */
    int32_t stays = bu != bv ? (bu ? u : v) : u < v ? u : v, gone = stays == u ? v : u;
    if (!ring_survives(e, gone, stays, least)) {
        int32_t swap = stays;
        if (bu != bv) return false;
        stays = gone;
        gone = swap;
        if (!ring_survives(e, gone, stays, least)) return false;
    }
    for (walk w = walk_begin(e, gone); w.now >= 0; walk_next(e, &w)) r->triangle[w.now] = stays;
    close_face(e, h, stays);
    if (g >= 0) close_face(e, g, stays);
    e->corner[gone] = -1;
    r->merged[r->source_vertex[gone]] = 1;
    return true;
}

/* --- flip ------------------------------------------------------------------------------------- */

bool qc__edit_flip(qc__edit *e, int32_t h, double least) {
    qc__repair *r = e->r;
    int32_t *t = r->triangle, g = r->twin[h];
    if (g < 0) return false;
    int32_t a = t[qc_next(h)], b = t[qc_prev(h)], c = t[h], d = t[g];
    if (c == d) return false;
    mark_ring(e, c);
    if (e->mark[d] == e->stamp) return false; /* c and d are joined by an edge already */
    double old[3], n1[3], n2[3];
    double worst = qc__edit_quality(e, c, a, b, NULL), other = qc__edit_quality(e, d, b, a, old);
    double q1 = qc__edit_quality(e, c, a, d, n1), q2 = qc__edit_quality(e, d, b, c, n2);
    if (q1 <= worst || q2 <= worst) return false;
    if (other >= least) {
        double dot1 = 0, dot2 = 0;
        for (int k = 0; k < 3; k++) {
            dot1 += old[k] * n1[k];
            dot2 += old[k] * n2[k];
        }
        if (q1 < least || q2 < least || dot1 <= 0 || dot2 <= 0) return false;
    }
    /* faces (c a b) and (d b a) become (c a d) and (d b c) */
    int32_t x = r->twin[qc_next(h)], y = r->twin[qc_next(g)];
    t[qc_prev(h)] = d;
    t[qc_prev(g)] = c;
    link_twins(r, h, y);
    link_twins(r, g, x);
    link_twins(r, qc_next(h), qc_next(g));
    e->corner[a] = qc_next(h);
    e->corner[b] = qc_next(g);
    e->corner[c] = h;
    e->corner[d] = g;
    return true;
}

/* --- removal ---------------------------------------------------------------------------------- */

/* A face with one boundary edge may go when its apex is inside; one with two leaves a corner. */
bool qc__edit_remove_boundary(qc__edit *e, int32_t face) {
    qc__repair *r = e->r;
    int32_t n = 0, open = -1;
    for (int32_t h = 3 * face; h < 3 * face + 3; h++)
        if (r->twin[h] < 0) open = h, n++;
    if (n == 0 || n == 3 || (n == 1 && on_boundary(e, r->triangle[open]))) return false;
    for (int32_t h = 3 * face; h < 3 * face + 3; h++) {
        int32_t v = r->triangle[h], next = -1; /* another corner of v */
        if (r->twin[qc_next(h)] >= 0)
            next = qc_next(r->twin[qc_next(h)]);
        else if (r->twin[qc_prev(h)] >= 0)
            next = qc_prev(r->twin[qc_prev(h)]);
        e->corner[v] = next;
        if (next < 0) r->merged[r->source_vertex[v]] = 1;
    }
    for (int32_t h = 3 * face; h < 3 * face + 3; h++)
        if (r->twin[h] >= 0) r->twin[r->twin[h]] = -1, r->twin[h] = -1;
    r->triangle[3 * face] = -1;
    return true;
}
