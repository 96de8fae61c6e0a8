/* Feature edges of a mesh chained to curves between corners, by arc length. */
#include "sdk/finish/internal.h"

/* Two feature edges which turn by more are a corner: there a sector has other than two quarters. */
#define CORNER_COSINE 0.70710678118654752

static bool flagged(const qc_mesh *m, const uint8_t *feature, int32_t e) {
    return (feature && feature[e]) || m->edge_halfedge[2 * (int64_t)e + 1] < 0;
}

/* Feature edges at v: at most two of them in `edge`; returns how many there are. */
static int edges_at(const qc_mesh *m, const uint8_t *feature, int32_t v, int32_t edge[2]) {
    const int32_t first = m->vertex_corner[v];
    int n = 0;
    if (qc_vertex_on_boundary(m, v)) edge[n++] = m->halfedge_edge[qc_prev(first)];
    for (int32_t c = first; c >= 0;) {
        const int32_t e = m->halfedge_edge[qc_next(c)];
        if (flagged(m, feature, e) && n++ < 2) edge[n - 1] = e;
        c = qc_corner_ccw(m, c);
        if (c == first) break;
    }
    return n;
}

static bool turns(const qc_mesh *m, int32_t v, const int32_t edge[2]) {
    double d[2][3];
    for (int i = 0; i < 2; i++) {
        const int32_t w = qc__other_end(m, edge[i], v);
        for (int k = 0; k < 3; k++)
            d[i][k] = m->position[3 * (int64_t)w + k] - m->position[3 * (int64_t)v + k];
    }
    return -qc__dot3(d[0], d[1]) < CORNER_COSINE * qc__norm3(d[0]) * qc__norm3(d[1]);
}

static int32_t following(const qc_mesh *m, const uint8_t *feature, int32_t v, int32_t e) {
    int32_t edge[2];
    edges_at(m, feature, v, edge);
    return edge[0] == e ? edge[1] : edge[0];
}

/* Goes back from edge e to where its curve begins: a corner, or e itself on a closed curve. */
static int32_t beginning(const qc__curves *c, const uint8_t *feature, int32_t e, int32_t *from) {
    int32_t at = c->mesh->edge_vertex[2 * (int64_t)e], edge = e;
    while (!c->corner[at]) {
        const int32_t back = following(c->mesh, feature, at, edge);
        if (back == e) {
            edge = e;
            at = c->mesh->edge_vertex[2 * (int64_t)e];
            break;
        }
        edge = back;
        at = qc__other_end(c->mesh, edge, at);
    }
    *from = at;
    return edge;
}

static void follow(qc__curves *c, const uint8_t *feature, int32_t e) {
    const qc_mesh *m = c->mesh;
    int32_t at, place = c->start[c->n];
    const int32_t first = beginning(c, feature, e, &at);
    double arc = 0;
    e = first;
    do {
        double d[3];
        const int32_t h = m->edge_halfedge[2 * (int64_t)e];
        c->halfedge[place] = m->edge_vertex[2 * (int64_t)e] == at ? h : ~h;
        c->arc[place] = arc;
        c->edge_at[e] = place++;
        c->edge_curve[e] = c->n;
        qc__halfedge_vector(m, h, d);
        arc += qc__norm3(d);
        at = qc__other_end(m, e, at);
        if (c->corner[at]) break;
        e = following(m, feature, at, e);
    } while (e != first);
    c->length[c->n] = arc;
    c->closed[c->n] = !c->corner[at];
    c->start[++c->n] = place;
}

static bool allocate(qc_ctx *ctx, const uint8_t *feature, qc__curves *c) {
    const qc_mesh *m = c->mesh;
    int64_t n = 0;
    for (int32_t e = 0; e < m->n_edges; e++) n += flagged(m, feature, e);
    c->start = QC__ZERO(ctx, int32_t, n + 1);
    c->halfedge = QC__NEW(ctx, int32_t, n);
    c->arc = QC__NEW(ctx, double, n);
    c->length = QC__NEW(ctx, double, n);
    c->closed = QC__NEW(ctx, uint8_t, n);
    c->edge_at = QC__NEW(ctx, int32_t, m->n_edges);
    c->edge_curve = QC__NEW(ctx, int32_t, m->n_edges);
    c->corner = QC__NEW(ctx, uint8_t, m->n_vertices);
    return c->start && c->halfedge && c->arc && c->length && c->closed && c->edge_at &&
           c->edge_curve && c->corner;
}

qc_status qc__curves_create(qc_ctx *ctx, const qc_mesh *m, const uint8_t *feature,
                            qc__curves *out) {
    qc__curves c = {.mesh = m};
    if (!allocate(ctx, feature, &c)) {
        qc__curves_clear(&c);
        return QC_ERR_NOMEM;
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        int32_t edge[2];
        const int n = edges_at(m, feature, v, edge);
        c.corner[v] = n > 0 && (n != 2 || turns(m, v, edge));
    }
    for (int32_t e = 0; e < m->n_edges; e++) c.edge_at[e] = c.edge_curve[e] = -1;
    for (int32_t e = 0; e < m->n_edges; e++)
        if (flagged(m, feature, e) && c.edge_at[e] < 0) follow(&c, feature, e);
    *out = c;
    return QC_OK;
}

void qc__curves_clear(qc__curves *c) {
    qc__free(c->start);
    qc__free(c->halfedge);
    qc__free(c->arc);
    qc__free(c->length);
    qc__free(c->closed);
    qc__free(c->edge_at);
    qc__free(c->edge_curve);
    qc__free(c->corner);
    *c = (qc__curves){.mesh = NULL};
}

int32_t qc__curve_end(const qc__curves *c, int32_t i, int end) {
    const int32_t h = c->halfedge[end ? c->start[i + 1] - 1 : c->start[i]];
    if (h >= 0) return end ? qc_halfedge_end(c->mesh, h) : qc_halfedge_start(c->mesh, h);
    return end ? qc_halfedge_start(c->mesh, ~h) : qc_halfedge_end(c->mesh, ~h);
}

/* The last place of curve i which begins at or before s. */
static int32_t place_of(const qc__curves *c, int32_t i, double s) {
    int32_t low = c->start[i], high = c->start[i + 1];
    while (high - low > 1) {
        const int32_t middle = low + (high - low) / 2;
        if (c->arc[middle] <= s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

int32_t qc__curve_edge(const qc__curves *c, int32_t i, double s) {
    const int32_t h = c->halfedge[place_of(c, i, s)];
    return c->mesh->halfedge_edge[h < 0 ? ~h : h];
}

double qc__curve_point(const qc__curves *c, int32_t i, double s, int32_t *face, double weight[3],
                       double tangent[3]) {
    const double length = c->length[i];
    if (c->closed[i])
        s -= length * floor(s / length);
    else
        s = fmin(fmax(s, 0), length);
    const int32_t place = place_of(c, i, s), signed_h = c->halfedge[place];
    const int32_t h = signed_h < 0 ? ~signed_h : signed_h;
    double d[3];
    qc__halfedge_vector(c->mesh, h, d);
    const double l = qc__norm3(d);
    double u = l > 0 ? fmin(fmax((s - c->arc[place]) / l, 0), 1) : 0;
    if (signed_h < 0) u = 1 - u;
    *face = h / 3;
    weight[h % 3] = 0;
    weight[qc_next(h) % 3] = 1 - u;
    weight[qc_prev(h) % 3] = u;
    for (int k = 0; tangent && k < 3; k++)
        tangent[k] = l > 0 ? (signed_h < 0 ? -d[k] : d[k]) / l : 0;
    return s;
}
