/* Closes the holes of poles (docs/theory/poles.md): a loop of 2 k sides r_0, r_1, ... gets a vertex
 * p at the pole and the k quads (p, r_2i, r_2i+1, r_2i+2). The loop is that of the complete cells
 * around the hole, without its innermost row where that is nearer to the pole than half a quad. */
#include <math.h>

#include "sdk/map/extract/internal.h"

typedef struct closer {
    qc_ctx *ctx;
    const qc__cells *cells;
    const int32_t *vertex; /* 4 cells: of the corners of kept cells */
    const qc_polygon_mesh *q;
    uint8_t *drop;  /* cells: in a row which is left out */
    uint8_t *seen;  /* vertices of q */
    int32_t *next;  /* vertices of q: along the loop, the quads on the left; -1 */
    int32_t *ring;  /* vertices on the loops, one pole after the other */
    int32_t *start; /* n_poles + 1 */
    uint8_t *odd;   /* n_poles: quads begin with the second vertex of the loop */
} closer;

static const qc_mesh *mesh_of(const closer *s) {
    return s->cells->pieces.ports->lattice->g->mesh;
}

static int32_t side_end(int32_t a) {
    return (a & ~3) | ((a + 1) & 3);
}

static double distance(const double *x, const double *y) {
    return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
}

static const double *position(const closer *s, int32_t v) {
    return s->q->position + 3 * (int64_t)v;
}

static const double *pole_position(const closer *s, int32_t pole) {
    const qc_mesh *m = mesh_of(s);
    return m->position + 3 * (int64_t)m->face_vertex[m->pole_corner[m->pole_start[pole]]];
}

/* Follows next from v; the length of the loop, 0 = no simple loop through v. */
static int32_t follow(const closer *s, int32_t v, int32_t *ring) {
    int32_t n = 0, w = v;
    do {
        if (w < 0 || n > s->q->n_vertices) return 0;
        ring[n++] = w;
        w = s->next[w];
    } while (w != v);
    return n;
}

/* --- the innermost row --------------------------------------------------------------------------
 */

/* The cells at the vertices of the ring which are still there, marked by drop = 2. Returns how many
 * there are. */
static int32_t mark_row(closer *s, const int32_t *ring, int32_t n) {
    const qc__cells *c = s->cells;
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) s->seen[ring[i]] = 1;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || s->drop[cell]) continue;
        bool touches = false;
        for (int k = 0; k < 4; k++) touches |= s->seen[s->vertex[4 * (int64_t)cell + k]] != 0;
        if (!touches) continue;
        s->drop[cell] = 2;
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

static row measure_row(closer *s) {
    const qc__cells *c = s->cells;
    row r = {0, -1, 0, 0};
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (s->drop[a / 4] != 2) continue;
        const int32_t v = s->vertex[a], w = s->vertex[side_end(a)], b = c->across[a];
        if (s->seen[v] != s->seen[w]) {
            r.spokes++;
            r.height += distance(position(s, v), position(s, w));
        }
        if (s->seen[v] && s->seen[w]) continue;
        if (b < 0 || !c->keep[b / 4] || s->drop[b / 4] == 1) {
            r.sides = -1;
            return r;
        }
        if (s->drop[b / 4] == 2) continue;
        s->next[w] = v;
        r.first = w;
        r.sides++;
    }
    return r;
}

/* Leaves the row around a ring out when the ring is too near to the pole and what remains is a ring
 * again. *ring becomes the new one. */
static bool peel(closer *s, int32_t pole, int32_t *ring, int32_t *n) {
    const double near = 0.5;
    double radius = 0;
    for (int32_t i = 0; i < *n; i++)
        radius += distance(position(s, ring[i]), pole_position(s, pole));
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
    for (int32_t cell = 0; cell < s->cells->n; cell++)
        if (s->drop[cell] == 2) s->drop[cell] = good;
    if (!good) return false;
    for (int32_t i = 0; i < length; i++) ring[i] = ring[*n + i];
    *n = length;
    return true;
}

/* --- rings ------------------------------------------------------------------------------------ */

static qc_status refuse(const closer *s, int32_t pole, int32_t n) {
    const qc_mesh *m = mesh_of(s);
    const int32_t face = m->pole_corner[m->pole_start[pole]] / 3;
    if (n % 2)
        return qc__fail(s->ctx, QC_ERR_FAILED, face,
                        "%d grid lines run around the pole at face %d; quads close an even number: "
                        "round to the lattice of quads",
                        (int)n, (int)face);
    return qc__fail(
        s->ctx, QC_ERR_FAILED, face,
        "the pole at face %d is not surrounded by quads (%d sides); try a finer density", (int)face,
        (int)n);
}

/* next of the boundary of the kept cells; at[pole] = a vertex on its loop, -1 = none. */
static void find_boundary(const closer *s, int32_t *at) {
    const qc__cells *c = s->cells;
    for (int32_t v = 0; v < s->q->n_vertices; v++) s->next[v] = -1;
    for (int32_t i = 0; i < mesh_of(s)->n_poles; i++) at[i] = -1;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (!c->keep[a / 4] || c->across[a] >= 0) continue;
        s->next[s->vertex[a]] = s->vertex[side_end(a)];
        if (c->rim_pole[a] >= 0 && at[c->rim_pole[a]] < 0) at[c->rim_pole[a]] = s->vertex[a];
    }
}

static qc_status find_rings(closer *s, const int32_t *at) {
    const int32_t n_poles = mesh_of(s)->n_poles;
    int32_t total = 0;
    for (int32_t i = 0; i < n_poles; i++) {
        int32_t n = at[i] < 0 ? 0 : follow(s, at[i], s->ring + total);
        s->start[i] = total;
        if (n < 4 || n % 2) return refuse(s, i, n);
        for (int k = 0; k < 2 && peel(s, i, s->ring + total, &n); k++) {}
        total += n;
    }
    s->start[n_poles] = total;
    return QC_OK;
}

/* Least sine of the corners of the quad p, a, b, c seen along the mean normal. */
static double shape(const double *x[4]) {
    double cross[4][3], normal[3] = {0}, least = 1;
    for (int k = 0; k < 4; k++) {
        const double *o = x[k], *a = x[(k + 1) & 3], *b = x[(k + 3) & 3];
        for (int j = 0; j < 3; j++) {
            const int m = (j + 1) % 3, n = (j + 2) % 3;
            cross[k][j] = (a[m] - o[m]) * (b[n] - o[n]) - (a[n] - o[n]) * (b[m] - o[m]);
            normal[j] += cross[k][j];
        }
    }
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    for (int k = 0; k < 4; k++) {
        const double scale = distance(x[k], x[(k + 1) & 3]) * distance(x[k], x[(k + 3) & 3]);
        const double dot =
            cross[k][0] * normal[0] + cross[k][1] * normal[1] + cross[k][2] * normal[2];
        least = fmin(least, scale > 0 && length > 0 ? dot / (scale * length) : -1);
    }
    return least;
}

/* Corner k of quad i of a pole: -1 = the pole. The ring runs the other way round than the quads
 * beside it see it. */
static int32_t quad_corner(const closer *s, int32_t pole, bool odd, int32_t i, int k) {
    const int32_t n = s->start[pole + 1] - s->start[pole];
    if (k == 0) return -1;
    return s->ring[s->start[pole] + (2 * n - 2 * i - k - odd) % n];
}

static double worst(const closer *s, int32_t pole, bool odd) {
    double least = 1;
    for (int32_t i = 0; 2 * i < s->start[pole + 1] - s->start[pole]; i++) {
        const double *x[4] = {pole_position(s, pole)};
        for (int k = 1; k < 4; k++) x[k] = position(s, quad_corner(s, pole, odd, i, k));
        least = fmin(least, shape(x));
    }
    return least;
}

/* --- the closed mesh ----------------------------------------------------------------------------
 */

/* Kept vertices in their order, then the poles. number: of the vertices of q. */
static void copy_vertices(const closer *s, int32_t *number, qc_polygon_mesh *out) {
    const qc_mesh *m = mesh_of(s);
    int32_t n = 0;
    for (int32_t v = 0; v < s->q->n_vertices; v++) {
        if (number[v] < 0) continue;
        for (int k = 0; k < 3; k++) {
            out->position[3 * (int64_t)n + k] = position(s, v)[k];
            out->source_barycentric[3 * (int64_t)n + k] =
                s->q->source_barycentric[3 * (int64_t)v + k];
        }
        out->source_face[n] = s->q->source_face[v];
        number[v] = n++;
    }
    for (int32_t i = 0; i < m->n_poles; i++, n++) {
        const int32_t tip = m->pole_corner[m->pole_start[i]];
        for (int k = 0; k < 3; k++) {
            out->position[3 * (int64_t)n + k] = pole_position(s, i)[k];
            out->source_barycentric[3 * (int64_t)n + k] = k == tip % 3;
        }
        out->source_face[n] = tip / 3;
    }
}

static void copy_faces(const closer *s, const int32_t *number, qc_polygon_mesh *out) {
    const qc_mesh *m = mesh_of(s);
    const qc__cells *c = s->cells;
    int32_t n = 0;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || s->drop[cell]) continue;
        for (int k = 0; k < 4; k++)
            out->face_vertex[n++] = number[s->vertex[4 * (int64_t)cell + k]];
    }
    for (int32_t i = 0; i < m->n_poles; i++)
        for (int32_t j = 0; 2 * j < s->start[i + 1] - s->start[i]; j++)
            for (int k = 0; k < 4; k++) {
                const int32_t v = quad_corner(s, i, s->odd[i], j, k);
                out->face_vertex[n++] = v < 0 ? out->n_vertices - m->n_poles + i : number[v];
            }
    for (int32_t f = 0; f <= out->n_faces; f++) out->face_offset[f] = 4 * f;
}

/* Lines both of whose ends stay. */
static int32_t copy_lines(const closer *s, const int32_t *number, qc_polygon_mesh *out) {
    int32_t n = 0;
    for (int32_t i = 0; i < s->q->n_lines; i++) {
        const int32_t v = number[s->q->line[2 * (int64_t)i]];
        const int32_t w = number[s->q->line[2 * (int64_t)i + 1]];
        if (v < 0 || w < 0) continue;
        if (out) {
            out->line[2 * (int64_t)n] = v;
            out->line[2 * (int64_t)n + 1] = w;
            out->source_edge[n] = s->q->source_edge[i];
        }
        n++;
    }
    return n;
}

static qc_status build(closer *s, qc_polygon_mesh **out) {
    const qc_mesh *m = mesh_of(s);
    const qc__cells *c = s->cells;
    int32_t *number = QC__NEW(s->ctx, int32_t, s->q->n_vertices);
    if (!number) return QC_ERR_NOMEM;
    int32_t n_vertices = m->n_poles, n_faces = s->start[m->n_poles] / 2;
    for (int32_t v = 0; v < s->q->n_vertices; v++) number[v] = -1;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || s->drop[cell]) continue;
        n_faces++;
        for (int k = 0; k < 4; k++) {
            int32_t *v = &number[s->vertex[4 * (int64_t)cell + k]];
            n_vertices += *v < 0;
            *v = 0;
        }
    }
    qc_polygon_mesh *q = NULL;
    const qc_status status =
        qc_polygon_mesh_create(s->ctx, n_vertices, n_faces, 4 * n_faces, 0,
                               copy_lines(s, number, NULL), QC_POLYGON_SOURCE, &q);
    if (status == QC_OK) {
        copy_vertices(s, number, q);
        copy_lines(s, number, q);
        copy_faces(s, number, q);
        *out = q;
    }
    qc__free(number);
    return status;
}

qc_status qc__close_poles(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                          qc_polygon_mesh **quads) {
    closer s = {.ctx = ctx, .cells = cells, .vertex = vertex, .q = *quads};
    const int32_t n_poles = mesh_of(&s)->n_poles, nv = s.q->n_vertices;
    qc_polygon_mesh *closed = NULL;
    s.drop = QC__ZERO(ctx, uint8_t, cells->n);
    s.seen = QC__ZERO(ctx, uint8_t, nv);
    s.next = QC__NEW(ctx, int32_t, nv);
    s.ring = QC__NEW(ctx, int32_t, 3 * (int64_t)nv + 3);
    s.start = QC__NEW(ctx, int32_t, n_poles + 1);
    s.odd = QC__NEW(ctx, uint8_t, n_poles);
    int32_t *at = QC__NEW(ctx, int32_t, n_poles);
    qc_status status =
        s.drop && s.seen && s.next && s.ring && s.start && s.odd && at ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        find_boundary(&s, at);
        status = find_rings(&s, at);
    }
    if (status == QC_OK) {
        for (int32_t i = 0; i < n_poles; i++) s.odd[i] = worst(&s, i, true) > worst(&s, i, false);
        status = build(&s, &closed);
    }
    if (status == QC_OK) {
        qc_object_release(*quads);
        *quads = closed;
    }
    void *const blocks[] = {s.drop, s.seen, s.next, s.ring, s.start, s.odd, at};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
