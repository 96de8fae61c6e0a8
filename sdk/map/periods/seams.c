/* Segments, cones and wedges of a cut surface (see seams.h). */
#include "sdk/map/periods/features.h"
#include <string.h>

void qc__seams_free(qc__seams *s) {
    if (!s) return;
    void *const blocks[] = {s->edge_segment,
                            s->edge_left,
                            s->segment_turn,
                            s->segment_node,
                            s->cone_vertex,
                            s->vertex_cone,
                            s->cone_turn,
                            s->vertex_wedge,
                            s->corner_wedge,
                            s->wedge_turn,
                            s->wedge_start,
                            s->term_segment,
                            s->term_turn,
                            s->node_vertex,
                            s->closing_start,
                            s->node_cone,
                            s->cone_pole,
                            s->closing_segment,
                            s->closing_turn,
                            s->vertex_given,
                            s->given_start,
                            s->given_symbol,
                            s->given_value,
                            s->fixed_component,
                            s->level_coordinate,
                            s->level_relation_start,
                            s->level_relation_symbol,
                            s->level_relation_value};
    qc__rows_free(&s->symbol_row);
    qc__rows_free(&s->free_row);
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(s);
}

/* What the tracing steps share. */
typedef struct builder {
    qc_ctx *ctx;
    const qc_cover *cover;
    const uint8_t *cut;
    const int8_t *face_turn;
    int32_t *degree; /* cut edges at each vertex */
    int32_t *hole;   /* n_vertices: the pole whose hole a boundary vertex is on, -1 */
    qc__seams *s;
} builder;

static bool is_cut(const builder *b, int32_t h) {
    return b->cut[b->cover->mesh->halfedge_edge[h]] && b->cover->mesh->twin[h] >= 0;
}

static bool is_node(const builder *b, int32_t v) {
    return b->degree[v] > 0 && (b->degree[v] != 2 || b->s->vertex_cone[v] >= 0 ||
                                qc_vertex_on_boundary(b->cover->mesh, v));
}

static qc_status number_points(builder *b, const uint8_t *point) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    s->vertex_cone = QC__NEW(b->ctx, int32_t, mesh->n_vertices);
    if (!s->vertex_cone) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) s->vertex_cone[v] = point[v] ? s->n_cones++ : -1;
    s->cone_vertex = QC__NEW(b->ctx, int32_t, s->n_cones + mesh->n_poles);
    s->cone_turn = QC__ZERO(b->ctx, int8_t, s->n_cones + mesh->n_poles);
    s->cone_pole = QC__NEW(b->ctx, int32_t, mesh->n_poles);
    if (!s->cone_vertex || !s->cone_turn || !s->cone_pole) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (s->vertex_cone[v] >= 0) s->cone_vertex[s->vertex_cone[v]] = v;
    return QC_OK;
}

static qc_status find_points(builder *b, const int32_t *index4, const qc__features *features) {
    const qc_mesh *mesh = b->cover->mesh;
    int8_t *shift = QC__NEW(b->ctx, int8_t, mesh->n_vertices);
    uint8_t *point = QC__NEW(b->ctx, uint8_t, mesh->n_vertices);
    qc_status status = shift && point ? qc_cover_shifts(b->ctx, b->cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc__feature_corners(b->ctx, features, point);
    for (int32_t v = 0; v < mesh->n_vertices && status == QC_OK; v++)
        point[v] |= !qc_vertex_on_boundary(mesh, v) && (shift[v] != 0 || index4[v] != 0);
    if (status == QC_OK) status = number_points(b, point);
    qc__free(shift);
    qc__free(point);
    return status;
}

static int32_t first_tip(const qc_mesh *mesh, int32_t pole) {
    return mesh->face_vertex[mesh->pole_corner[mesh->pole_start[pole]]];
}

/* The poles at which segments end, and the vertices of their holes. */
static qc_status find_poles(builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    b->hole = QC__NEW(b->ctx, int32_t, mesh->n_vertices);
    if (!b->hole) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) b->hole[v] = -1;
    for (int32_t i = 0; i < mesh->n_poles; i++) {
        int32_t ends = 0;
        for (int32_t j = mesh->pole_start[i]; j < mesh->pole_start[i + 1]; j++) {
            const int32_t c = mesh->pole_corner[j];
            const int32_t tip = mesh->face_vertex[c], link = mesh->face_vertex[qc_prev(c)];
            b->hole[tip] = b->hole[link] = i;
            ends += b->degree[tip] + b->degree[link];
        }
        if (ends == 0) continue; /* the shift around it is zero whatever the map */
        const int32_t k = s->n_cones + s->n_poles;
        s->cone_vertex[k] = first_tip(mesh, i);
        s->cone_turn[k] = 1;
        s->cone_pole[s->n_poles++] = i;
    }
    return QC_OK;
}

/* What a segment that ends at vertex v is incident with. */
static int32_t node_of(const builder *b, int32_t v) {
    return b->hole[v] < 0 ? v : first_tip(b->cover->mesh, b->hole[v]);
}

static qc_status count_degrees(builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    b->degree = QC__ZERO(b->ctx, int32_t, mesh->n_vertices);
    if (!b->degree) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (is_cut(b, mesh->edge_halfedge[2 * e])) {
            b->degree[mesh->edge_vertex[2 * e]]++;
            b->degree[mesh->edge_vertex[2 * e + 1]]++;
        }
    return QC_OK;
}

/* The cut halfedge leaving the end of h along the graph, at a vertex of degree 2: walk about the
 * vertex from the left side of h until the next cut edge. */
static int32_t next_on_segment(const builder *b, int32_t h) {
    const qc_mesh *mesh = b->cover->mesh;
    int32_t out = qc_next(h); /* leaves the end of h, in the face on the left of h */
    while (!is_cut(b, out)) out = qc_next(mesh->twin[out]);
    return out;
}

/* Traces the segment which starts with halfedge h; its left faces lie on the left of h. */
static void trace_segment(builder *b, int32_t h, int32_t k) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    const int32_t first = h;
    s->segment_node[2 * k] = node_of(b, qc_halfedge_start(mesh, h));
    s->segment_turn[k] = (int8_t)qc__combed_rotation(b->cover, b->face_turn, h);
    for (;;) {
        s->edge_segment[mesh->halfedge_edge[h]] = k;
        s->edge_left[mesh->halfedge_edge[h]] = h;
        const int32_t v = qc_halfedge_end(mesh, h);
        s->segment_node[2 * k + 1] = node_of(b, v);
        if (is_node(b, v)) return;
        h = next_on_segment(b, h);
        if (h == first) return;
    }
}

static qc_status trace_segments(builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    int64_t turn_capacity = 0, node_capacity = 0;
    s->edge_segment = QC__NEW(b->ctx, int32_t, mesh->n_edges);
    s->edge_left = QC__NEW(b->ctx, int32_t, mesh->n_edges);
    if (!s->edge_segment || !s->edge_left) return QC_ERR_NOMEM;
    memset(s->edge_segment, -1, sizeof(int32_t) * (size_t)mesh->n_edges);
    memset(s->edge_left, -1, sizeof(int32_t) * (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int32_t side = 0; side < 2; side++) {
            const int32_t h = mesh->edge_halfedge[2 * e + side];
            if (h < 0 || !is_cut(b, h) || s->edge_segment[e] >= 0) continue;
            if (!is_node(b, qc_halfedge_start(mesh, h))) continue;
            const int32_t k = s->n_segments;
            if (!qc__reserve(b->ctx, (void **)&s->segment_turn, &turn_capacity, k + 1,
                             sizeof(int8_t)) ||
                !qc__reserve(b->ctx, (void **)&s->segment_node, &node_capacity, 2 * k + 2,
                             sizeof(int32_t)))
                return QC_ERR_NOMEM;
            trace_segment(b, h, k);
            s->n_segments++;
        }
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (is_cut(b, mesh->edge_halfedge[2 * e]) && s->edge_segment[e] < 0)
            return qc__fail(b->ctx, QC_ERR_FAILED, e, "edge %d lies on a cut cycle without a node",
                            (int)e);
    return QC_OK;
}

/* --- wedges ----------------------------------------------------------------------------------- */

static bool walk_reserve(qc_ctx *ctx, qc__walk *w) {
    if (w->n < w->capacity) return true;
    const int32_t capacity = w->capacity < 16 ? 16 : 2 * w->capacity;
    int32_t *segment = qc__realloc(ctx, w->segment, (size_t)capacity, sizeof *segment);
    if (!segment) return false;
    w->segment = segment;
    int8_t *turn = qc__realloc(ctx, w->term_turn, (size_t)capacity, sizeof *turn);
    if (!turn) return false;
    w->term_turn = turn;
    w->capacity = capacity;
    return true;
}

void qc__walk_free(qc__walk *w) {
    qc__free(w->segment);
    qc__free(w->term_turn);
    *w = (qc__walk){0};
}

/* f -> i^rho f + tau from left to right, i^-rho (f - tau) the other way. */
bool qc__walk_cross(qc_ctx *ctx, const qc__seams *s, qc__walk *w, int32_t h) {
    const int32_t e = s->mesh->halfedge_edge[h], k = s->edge_segment[e];
    if (k < 0) return true;
    const bool from_left = s->edge_left[e] == h;
    const int32_t turn = from_left ? s->segment_turn[k] : -s->segment_turn[k];
    if (!walk_reserve(ctx, w)) return false;
    w->turn = (w->turn + turn) & 3;
    for (int32_t j = 0; j < w->n; j++) w->term_turn[j] = (int8_t)((w->term_turn[j] + turn) & 3);
    w->segment[w->n] = k;
    w->term_turn[w->n++] = (int8_t)(from_left ? 0 : (turn + 2) & 3);
    return true;
}

static bool append_terms(qc_ctx *ctx, const qc__walk *w, int32_t **segment, int8_t **turn,
                         int64_t *n, int64_t *capacity) {
    if (*n + w->n > *capacity) {
        int64_t segments = *capacity, turns = *capacity;
        if (!qc__reserve(ctx, (void **)segment, &segments, *n + w->n, sizeof **segment))
            return false;
        if (!qc__reserve(ctx, (void **)turn, &turns, segments, sizeof **turn)) return false;
        *capacity = segments < turns ? segments : turns;
    }
    if (w->n > 0) {
        memcpy(*segment + *n, w->segment, sizeof **segment * (size_t)w->n);
        memcpy(*turn + *n, w->term_turn, sizeof **turn * (size_t)w->n);
    }
    *n += w->n;
    return true;
}

/* First corner of the fan of v which follows a cut edge or the boundary. */
static int32_t first_corner(const builder *b, int32_t v) {
    const qc_mesh *mesh = b->cover->mesh;
    const int32_t start = mesh->vertex_corner[v];
    if (qc_vertex_on_boundary(mesh, v) || b->degree[v] == 0) return start;
    int32_t c = start;
    while (!is_cut(b, qc_prev(c))) c = qc_corner_ccw(mesh, c);
    return c;
}

/* Wedges of vertex v with their terms; leaves the walk closed once around (interior vertices). */
static bool walk_vertex(builder *b, int32_t v, qc__walk *w) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    const int32_t start = first_corner(b, v);
    w->turn = w->n = 0;
    int32_t c = start;
    bool fresh = true;
    do {
        if (fresh) {
            const int32_t at = s->n_wedges++;
            s->wedge_turn[at] = (int8_t)w->turn;
            s->wedge_start[at] = s->n_terms;
            if (!append_terms(b->ctx, w, &s->term_segment, &s->term_turn, &s->n_terms,
                              &s->term_capacity))
                return false;
        }
        s->corner_wedge[c] = s->n_wedges - 1;
        const int32_t h = qc_next(c); /* the edge crossed counter-clockwise */
        fresh = is_cut(b, h);
        if (fresh && !qc__walk_cross(b->ctx, s, w, h)) return false;
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return true;
}

static bool record_closing(builder *b, int32_t v, int32_t cone, const qc__walk *w) {
    qc__seams *s = b->s;
    s->node_vertex[s->n_nodes] = v;
    s->node_cone[s->n_nodes] = cone;
    s->closing_start[s->n_nodes++] = s->n_closing_terms;
    return append_terms(b->ctx, w, &s->closing_segment, &s->closing_turn, &s->n_closing_terms,
                        &s->closing_capacity);
}

/* Once around the hole of a pole, from tip to tip about the vertices between. */
static bool walk_pole(builder *b, int32_t pole, qc__walk *w) {
    const qc_mesh *mesh = b->cover->mesh;
    w->turn = w->n = 0;
    for (int32_t j = mesh->pole_start[pole]; j < mesh->pole_start[pole + 1]; j++)
        for (int32_t c = qc_prev(mesh->pole_corner[j]); mesh->twin[qc_next(c)] >= 0;
             c = qc_corner_ccw(mesh, c))
            if (is_cut(b, qc_next(c)) && !qc__walk_cross(b->ctx, b->s, w, qc_next(c))) return false;
    return true;
}

static qc_status make_wedges(builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    int64_t most = mesh->n_vertices;
    int32_t nodes = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        most += b->degree[v];
        nodes += is_node(b, v);
    }
    s->vertex_wedge = QC__NEW(b->ctx, int32_t, mesh->n_vertices + 1);
    s->corner_wedge = QC__NEW(b->ctx, int32_t, 3 * (int64_t)mesh->n_faces);
    s->wedge_turn = QC__NEW(b->ctx, int8_t, most);
    s->wedge_start = QC__NEW(b->ctx, int64_t, most + 1);
    nodes += s->n_poles;
    s->node_vertex = QC__NEW(b->ctx, int32_t, nodes);
    s->node_cone = QC__NEW(b->ctx, int32_t, nodes);
    s->closing_start = QC__NEW(b->ctx, int64_t, nodes + 1);
    if (!s->vertex_wedge || !s->corner_wedge || !s->wedge_turn || !s->wedge_start ||
        !s->node_vertex || !s->node_cone || !s->closing_start)
        return QC_ERR_NOMEM;
    qc__walk w = {0};
    qc_status status = QC_OK;
    for (int32_t v = 0; v < mesh->n_vertices && status == QC_OK; v++) {
        s->vertex_wedge[v] = s->n_wedges;
        if (!walk_vertex(b, v, &w)) status = QC_ERR_NOMEM;
        if (status != QC_OK || qc_vertex_on_boundary(mesh, v)) continue;
        if (s->vertex_cone[v] >= 0) s->cone_turn[s->vertex_cone[v]] = (int8_t)(w.turn & 3);
        if (is_node(b, v) && !record_closing(b, v, s->vertex_cone[v], &w)) status = QC_ERR_NOMEM;
    }
    for (int32_t i = 0; i < s->n_poles && status == QC_OK; i++) {
        const int32_t cone = s->n_cones + i;
        if (!walk_pole(b, s->cone_pole[i], &w) ||
            !record_closing(b, s->cone_vertex[cone], cone, &w))
            status = QC_ERR_NOMEM;
    }
    s->vertex_wedge[mesh->n_vertices] = s->n_wedges;
    s->wedge_start[s->n_wedges] = s->n_terms;
    s->closing_start[s->n_nodes] = s->n_closing_terms;
    qc__walk_free(&w);
    return status;
}

qc_status qc__seams_create(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                           const int8_t *face_turn, const int32_t *index4, const int8_t *axis,
                           qc__seams **out) {
    qc__seams *s = QC__ZERO(ctx, qc__seams, 1);
    if (!s) return QC_ERR_NOMEM;
    s->mesh = cover->mesh;
    const qc__features features = {cover, face_turn, axis};
    builder b = {.ctx = ctx, .cover = cover, .cut = cut, .face_turn = face_turn, .s = s};
    qc_status status = find_points(&b, index4, &features);
    if (status == QC_OK) status = count_degrees(&b);
    if (status == QC_OK) status = find_poles(&b);
    if (status == QC_OK) status = trace_segments(&b);
    if (status == QC_OK) status = make_wedges(&b);
    if (status == QC_OK) status = qc__seams_find_given(ctx, s, &features);
    qc__free(b.degree);
    qc__free(b.hole);
    if (status != QC_OK) {
        qc__seams_free(s);
        return status;
    }
    *out = s;
    return QC_OK;
}
