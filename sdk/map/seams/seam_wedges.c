/* Wedges about the vertices of a cut surface, and the walks once around its nodes (see seams.h). */
#include "sdk/map/seams/seam_builder.h"
#include <string.h>

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
static int32_t first_corner(const qc__seam_builder *b, int32_t v) {
    const qc_mesh *mesh = b->cover->mesh;
    const int32_t start = mesh->vertex_corner[v];
    if (qc_vertex_on_boundary(mesh, v) || b->degree[v] == 0) return start;
    int32_t c = start;
    while (!qc__is_cut(b, qc_prev(c))) c = qc_corner_ccw(mesh, c);
    return c;
}

/* Wedges of vertex v with their terms; leaves the walk closed once around (interior vertices). */
static bool walk_vertex(qc__seam_builder *b, int32_t v, qc__walk *w) {
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
        fresh = qc__is_cut(b, h);
        if (fresh && !qc__walk_cross(b->ctx, s, w, h)) return false;
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return true;
}

static bool record_closing(qc__seam_builder *b, int32_t v, int32_t cone, const qc__walk *w) {
    qc__seams *s = b->s;
    s->node_vertex[s->n_nodes] = v;
    s->node_cone[s->n_nodes] = cone;
    s->closing_start[s->n_nodes++] = s->n_closing_terms;
    return append_terms(b->ctx, w, &s->closing_segment, &s->closing_turn, &s->n_closing_terms,
                        &s->closing_capacity);
}

/* Once around the hole of a pole, from tip to tip about the vertices between. */
static bool walk_pole(qc__seam_builder *b, int32_t pole, qc__walk *w) {
    const qc_mesh *mesh = b->cover->mesh;
    w->turn = w->n = 0;
    for (int32_t j = mesh->pole_start[pole]; j < mesh->pole_start[pole + 1]; j++)
        for (int32_t c = qc_prev(mesh->pole_corner[j]); mesh->twin[qc_next(c)] >= 0;
             c = qc_corner_ccw(mesh, c))
            if (qc__is_cut(b, qc_next(c)) && !qc__walk_cross(b->ctx, b->s, w, qc_next(c)))
                return false;
    return true;
}

qc_status qc__seams_wedges(qc__seam_builder *b) {
    const qc_mesh *mesh = b->cover->mesh;
    qc__seams *s = b->s;
    int64_t most = mesh->n_vertices;
    int32_t nodes = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        most += b->degree[v];
        nodes += qc__is_node(b, v);
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
        if (qc__is_node(b, v) && !record_closing(b, v, s->vertex_cone[v], &w))
            status = QC_ERR_NOMEM;
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
