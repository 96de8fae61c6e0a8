/* Rings around the holes of poles (see pole_rings.h). */
#include "sdk/map/extract/pole_rings.h"
#include <math.h>
#include "sdk/mesh/internal.h"

typedef struct tracer {
    qc__pole_rings *rings;
    uint8_t *seen; /* vertices */
    int32_t *next; /* vertices: along the loop, the quads on the left; -1 */
} tracer;

/* Follows next from v; the length of the loop, 0 = no simple loop through v. */
static int32_t follow(const tracer *s, int32_t v, int32_t *ring) {
    int32_t n = 0, w = v;
    do {
        if (w < 0 || n > s->rings->q->n_vertices) return 0;
        ring[n++] = w;
        w = s->next[w];
    } while (w != v);
    return n;
}

/* The cells at the vertices of the ring which are still there, marked by drop = 2. Returns how many
 * there are. */
static int32_t mark_row(tracer *s, const int32_t *ring, int32_t n) {
    const qc__cells *c = s->rings->cells;
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) s->seen[ring[i]] = 1;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || s->rings->drop[cell]) continue;
        bool touches = false;
        for (int k = 0; k < 4; k++)
            touches |= s->seen[s->rings->vertex[4 * (int64_t)cell + k]] != 0;
        if (!touches) continue;
        s->rings->drop[cell] = 2;
        count++;
    }
    return count;
}

typedef struct row {
    int32_t sides;  /* on the side away from the pole; -1 = the row ends at a boundary */
    int32_t first;  /* a vertex there */
    int32_t spokes; /* edges from the ring to it ... */
    double height;  /* ... and the sum of their lengths */
} row;

static row measure_row(tracer *s) {
    const qc__cells *c = s->rings->cells;
    row r = {0, -1, 0, 0};
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (s->rings->drop[a / 4] != 2) continue;
        const int32_t v = s->rings->vertex[a], w = s->rings->vertex[qc__side_end(a)],
                      b = c->across[a];
        if (s->seen[v] != s->seen[w]) {
            r.spokes++;
            r.height +=
                qc__distance3(qc__ring_position(s->rings, v), qc__ring_position(s->rings, w));
        }
        if (s->seen[v] && s->seen[w]) continue;
        if (b < 0 || !c->keep[b / 4] || s->rings->drop[b / 4] == 1) {
            r.sides = -1;
            return r;
        }
        if (s->rings->drop[b / 4] == 2) continue;
        s->next[w] = v;
        r.first = w;
        r.sides++;
    }
    return r;
}

/* Leaves the row around a ring out when the ring is too near to the pole and what remains is a ring
 * again. *ring becomes the new one. */
static bool peel(tracer *s, int32_t pole, int32_t *ring, int32_t *n) {
    const double near = 0.5;
    double radius = 0;
    for (int32_t i = 0; i < *n; i++)
        radius +=
            qc__distance3(qc__ring_position(s->rings, ring[i]), qc__pole_position(s->rings, pole));
    const int32_t cells = mark_row(s, ring, *n);
    const row r = measure_row(s);
    bool good = r.sides >= 4 && r.spokes > 0 && radius / *n < near * r.height / r.spokes;
    int32_t length = 0;
    /* an annulus: every cell has four sides, those inside are shared */
    good = good && (4 * cells - *n - r.sides) % 2 == 0 &&
           *n + r.sides - (4 * cells + *n + r.sides) / 2 + cells == 0;
    for (int32_t i = 0; i < *n; i++) s->seen[ring[i]] = 0;
    if (good) {
        length = follow(s, r.first, ring + *n);
        good = length == r.sides;
    }
    for (int32_t cell = 0; cell < s->rings->cells->n; cell++)
        if (s->rings->drop[cell] == 2) s->rings->drop[cell] = good;
    if (!good) return false;
    for (int32_t i = 0; i < length; i++) ring[i] = ring[*n + i];
    *n = length;
    return true;
}

static qc_status refuse(const tracer *s, int32_t pole, int32_t n) {
    const qc_mesh *m = qc__rings_mesh(s->rings);
    const int32_t face = m->pole_corner[m->pole_start[pole]] / 3;
    if (n % 2)
        return qc__fail(s->rings->ctx, QC_ERR_FAILED, face,
                        "%d grid lines run around the pole at face %d; quads close an even number: "
                        "round to the lattice of quads",
                        (int)n, (int)face);
    return qc__fail(
        s->rings->ctx, QC_ERR_FAILED, face,
        "the pole at face %d is not surrounded by quads (%d sides); try a finer density", (int)face,
        (int)n);
}

/* next of the boundary of the kept cells; at[pole] = a vertex on its loop, -1 = none. */
static void find_boundary(const tracer *s, int32_t *at) {
    const qc__cells *c = s->rings->cells;
    for (int32_t v = 0; v < s->rings->q->n_vertices; v++) s->next[v] = -1;
    for (int32_t i = 0; i < qc__rings_mesh(s->rings)->n_poles; i++) at[i] = -1;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (!c->keep[a / 4] || c->across[a] >= 0) continue;
        s->next[s->rings->vertex[a]] = s->rings->vertex[qc__side_end(a)];
        if (c->rim_pole[a] >= 0 && at[c->rim_pole[a]] < 0) at[c->rim_pole[a]] = s->rings->vertex[a];
    }
}

static qc_status find_rings(tracer *s, const int32_t *at) {
    const int32_t n_poles = qc__rings_mesh(s->rings)->n_poles;
    int32_t total = 0;
    for (int32_t i = 0; i < n_poles; i++) {
        int32_t n = at[i] < 0 ? 0 : follow(s, at[i], s->rings->ring + total);
        s->rings->start[i] = total;
        if (n < 4 || n % 2) return refuse(s, i, n);
        for (int k = 0; k < 2 && peel(s, i, s->rings->ring + total, &n); k++) {}
        total += n;
    }
    s->rings->start[n_poles] = total;
    return QC_OK;
}

void qc__pole_rings_free(qc__pole_rings *rings) {
    qc__free(rings->drop);
    qc__free(rings->ring);
    qc__free(rings->start);
}

qc_status qc__pole_rings_create(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                                const qc_polygon_mesh *q, qc__pole_rings *out) {
    *out = (qc__pole_rings){.ctx = ctx, .cells = cells, .vertex = vertex, .q = q};
    tracer s = {.rings = out};
    const int32_t n_poles = qc__rings_mesh(out)->n_poles, nv = q->n_vertices;
    out->drop = QC__ZERO(ctx, uint8_t, cells->n);
    out->ring = QC__NEW(ctx, int32_t, 3 * (int64_t)nv + 3);
    out->start = QC__NEW(ctx, int32_t, n_poles + 1);
    s.seen = QC__ZERO(ctx, uint8_t, nv);
    s.next = QC__NEW(ctx, int32_t, nv);
    int32_t *at = QC__NEW(ctx, int32_t, n_poles);
    qc_status status =
        out->drop && out->ring && out->start && s.seen && s.next && at ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        find_boundary(&s, at);
        status = find_rings(&s, at);
    }
    qc__free(s.seen);
    qc__free(s.next);
    qc__free(at);
    return status;
}
