/* Which vertices of the quads slide on which curve: those of the boundary on the boundary, and
 * those which have one edge of the quads along a feature in each direction. Corners stay. */
#include "sdk/finish/internal.h"

/* Of the diagonal: what is nearer is on the curve. */
#define ON_CURVE 1e-6
/* A quad edge may be this much shorter than the piece of curve it stands for. */
#define CHORD 1.5

/* Where a vertex lies on the features of the mesh. */
typedef struct hit {
    int32_t curve, corner; /* curve, or mesh vertex; -1 = none */
    double arc;
    bool boundary;
} hit;

typedef struct search {
    const qc__relaxation *r;
    const double *x;
    double near2;
    bool boundary; /* boundary edges are preferred */
    hit best;
} search;

static double distance2(const double a[3], const double b[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

static void try_edge(search *s, int32_t e) {
    const qc__curves *c = &s->r->curves;
    const int32_t place = c->edge_at[e];
    if (place < 0) return;
    const int32_t signed_h = c->halfedge[place], h = signed_h < 0 ? ~signed_h : signed_h;
    double d[3], at[3];
    const double *from = c->mesh->position + 3 * (int64_t)qc_halfedge_start(c->mesh, h);
    qc__halfedge_vector(c->mesh, h, d);
    for (int k = 0; k < 3; k++) at[k] = s->x[k] - from[k];
    const double l2 = qc__dot3(d, d);
    const double u = l2 > 0 ? fmin(fmax(qc__dot3(at, d) / l2, 0), 1) : 0;
    for (int k = 0; k < 3; k++) at[k] = from[k] + u * d[k];
    const bool boundary = c->mesh->edge_halfedge[2 * (int64_t)e + 1] < 0;
    if (distance2(at, s->x) > s->near2) return;
    if (s->best.curve >= 0 && (s->best.boundary == s->boundary || boundary != s->boundary)) return;
    s->best.curve = c->edge_curve[e];
    s->best.arc = c->arc[place] + sqrt(l2) * (signed_h < 0 ? 1 - u : u);
    s->best.boundary = boundary;
}

static void try_fan(search *s, int32_t v) {
    const qc_mesh *m = s->r->mesh;
    if (distance2(m->position + 3 * (int64_t)v, s->x) > s->near2) return;
    if (s->r->curves.corner[v]) s->best.corner = v;
    const int32_t first = m->vertex_corner[v];
    for (int32_t c = first; c >= 0;) {
        try_edge(s, m->halfedge_edge[qc_next(c)]);
        try_edge(s, m->halfedge_edge[qc_prev(c)]);
        c = qc_corner_ccw(m, c);
        if (c == first) break;
    }
}

static hit locate(const qc__relaxation *r, int32_t v, bool boundary) {
    const qc_mesh *m = r->mesh;
    const double near = ON_CURVE * m->diagonal;
    const int32_t t = r->spot[v].face;
    search s = {r, r->position + 3 * (int64_t)v, near * near, boundary, {-1, -1, 0, false}};
    for (int k = 0; k < 3; k++) {
        try_edge(&s, m->halfedge_edge[3 * t + k]);
        try_fan(&s, m->face_vertex[3 * t + k]);
    }
    return s.best;
}

/* A vertex is inside when every edge which leaves it in one quad arrives in another one. */
static bool is_inside(const qc__relaxation *r, int32_t v) {
    const int32_t *face_vertex = r->quads->face_vertex, *corner = r->around.face;
    const int32_t begin = r->around.face_start[v], end = r->around.face_start[v + 1];
    for (int32_t i = begin; i < end; i++) {
        const int32_t next = face_vertex[(corner[i] & ~3) + ((corner[i] + 1) & 3)];
        bool found = false;
        for (int32_t j = begin; j < end && !found; j++)
            found = face_vertex[(corner[j] & ~3) + ((corner[j] + 3) & 3)] == next;
        if (!found) return false;
    }
    return end > begin;
}

/* Arc length from a to the vertex with hit b along a's curve, of the shorter way; INFINITY when b
 * is not on it. */
static double ahead(const qc__curves *c, const hit *a, const hit *b) {
    const double length = c->length[a->curve];
    double best = INFINITY;
    if (b->corner >= 0) {
        if (qc__curve_end(c, a->curve, 0) == b->corner) best = -a->arc;
        if (qc__curve_end(c, a->curve, 1) == b->corner && length - a->arc < fabs(best))
            best = length - a->arc;
        return c->closed[a->curve] ? INFINITY : best;
    }
    if (b->curve != a->curve) return INFINITY;
    const double d = b->arc - a->arc;
    return c->closed[a->curve] ? d - length * floor(d / length + 0.5) : d;
}

/* Counts the edge from v to w when it is along the curve of v: n[2 v] of them run forward, n[2 v +
 * 1] backward. known: the quads tell that it is on a feature, which else the length of the piece
 * between its ends does. One on a feature which leads round a corner to another curve counts as
 * two: then v stays. */
static void count_edge(const qc__relaxation *r, const hit *at, int32_t v, int32_t w, bool known,
                       uint8_t *n) {
    if (at[v].curve < 0) return;
    const double chord =
        sqrt(distance2(r->position + 3 * (int64_t)v, r->position + 3 * (int64_t)w));
    const double d = ahead(&r->curves, &at[v], &at[w]);
    if (known && isinf(d))
        n[2 * v] = 2;
    else if ((known || fabs(d) <= CHORD * chord) && n[2 * v + (d < 0)] < 2)
        n[2 * v + (d < 0)]++;
}

static void count_edges(const qc__relaxation *r, const hit *at, uint8_t *n) {
    const qc_polygon_mesh *q = r->quads;
    for (int32_t i = 0; i < q->n_lines; i++) {
        const int32_t *end = q->line + 2 * (int64_t)i;
        count_edge(r, at, end[0], end[1], true, n);
        count_edge(r, at, end[1], end[0], true, n);
    }
    for (int32_t c = 0; q->n_lines == 0 && c < q->n_corners; c++)
        count_edge(r, at, q->face_vertex[c], q->face_vertex[(c & ~3) + ((c + 1) & 3)], false, n);
}

/* n: edges along the curve, forward and backward. */
static int32_t anchor(const hit *at, const uint8_t n[2], bool inside) {
    if (at->corner >= 0) return QC__FIXED;
    if (!inside) return at->curve >= 0 && at->boundary ? at->curve : QC__FIXED;
    if (at->curve < 0 || n[0] + n[1] == 0) return QC__FREE;
    return n[0] == 1 && n[1] == 1 ? at->curve : QC__FIXED;
}

qc_status qc__find_anchors(qc_ctx *ctx, qc__relaxation *r) {
    const int32_t n = r->quads->n_vertices;
    hit *at = QC__NEW(ctx, hit, n);
    uint8_t *inside = QC__NEW(ctx, uint8_t, n);
    uint8_t *along = QC__ZERO(ctx, uint8_t, 2 * (int64_t)n);
    const qc_status status = at && inside && along ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t v = 0; v < n; v++) {
            inside[v] = is_inside(r, v);
            at[v] = locate(r, v, !inside[v]);
        }
        count_edges(r, at, along);
        for (int32_t v = 0; v < n; v++) {
            r->anchor[v] = anchor(&at[v], along + 2 * (int64_t)v, inside[v]);
            r->spot[v].arc = at[v].arc;
        }
    }
    qc__free(at);
    qc__free(inside);
    qc__free(along);
    return status;
}
