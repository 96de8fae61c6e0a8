/* Independent values of a seamless map (see reduced_map.h; docs/theory/exact-grid.md). */
#include "sdk/map/untangle/reduced_map.h"
#include <math.h>

#include "sdk/map/grid/internal.h"

void qc__reduced_map_free(qc__reduced_map *map) {
    if (!map) return;
    qc__free(map->value);
    qc__free(map->fixed);
    qc__free(map->turn);
    qc__free(map->offset);
    qc__free(map);
}

typedef struct source {
    const qc_mesh *mesh;
    const double *uv;
    const int8_t *rotation;
    bool integer;
} source;

static qc_complex corner_uv(const source *s, int32_t c) {
    return (qc_complex){s->uv[2 * (int64_t)c], s->uv[2 * (int64_t)c + 1]};
}

/* tau of f_t = i^r f_s + tau across edge e, the mean over both ends. */
static qc_complex translation(const source *s, int32_t e) {
    const int32_t h = s->mesh->edge_halfedge[2 * (int64_t)e];
    const int32_t k = s->mesh->edge_halfedge[2 * (int64_t)e + 1], r = s->rotation[e];
    const qc_complex a = qc_quarter_turn(corner_uv(s, qc_next(h)), r);
    const qc_complex b = qc_quarter_turn(corner_uv(s, qc_prev(h)), r);
    const qc_complex p = corner_uv(s, qc_prev(k)), q = corner_uv(s, qc_next(k));
    qc_complex tau = {0.5 * (p.re - a.re + q.re - b.re), 0.5 * (p.im - a.im + q.im - b.im)};
    if (s->integer) tau = (qc_complex){rint(tau.re), rint(tau.im)};
    return tau;
}

/* Composes a chart with the transition across halfedge h: f -> i^r f + tau from s to t, i^-r (f -
 * tau) back. */
static void cross(const source *s, int32_t h, int8_t *turn, qc_complex *offset) {
    const int32_t e = s->mesh->halfedge_edge[h], r = s->rotation[e];
    const qc_complex tau = translation(s, e);
    if (s->mesh->edge_halfedge[2 * (int64_t)e] == h) {
        *offset = qc_quarter_turn(*offset, r);
        offset->re += tau.re;
        offset->im += tau.im;
        *turn = (int8_t)((*turn + r) & 3);
    } else {
        offset->re -= tau.re;
        offset->im -= tau.im;
        *offset = qc_quarter_turn(*offset, -r);
        *turn = (int8_t)((*turn - r) & 3);
    }
}

qc_status qc__reduced_map_create(qc_ctx *ctx, const qc_grid_map *grid, const double *uv,
                                 bool integer, qc__reduced_map **out) {
    const qc_mesh *mesh = grid->mesh;
    const source s = {mesh, uv, grid->rotation, integer};
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    qc__reduced_map *m = QC__ZERO(ctx, qc__reduced_map, 1);
    if (!m) return QC_ERR_NOMEM;
    m->mesh = mesh;
    m->value = QC__NEW(ctx, qc_complex, mesh->n_vertices);
    m->fixed = QC__NEW(ctx, uint8_t, mesh->n_vertices);
    m->turn = QC__NEW(ctx, int8_t, n_corners);
    m->offset = QC__NEW(ctx, qc_complex, n_corners);
    if (!m->value || !m->fixed || !m->turn || !m->offset) {
        qc__reduced_map_free(m);
        return QC_ERR_NOMEM;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t start = mesh->vertex_corner[v];
        m->value[v] = corner_uv(&s, start);
        m->fixed[v] = grid->holonomy[v] != 0
                          ? QC__FIXED
                          : qc__feature_levels(mesh, grid->rotation, grid->axis, v);
        const qc_complex p = m->value[v];
        if (integer && m->fixed[v] & 1) m->value[v].re = rint(p.re);
        if (integer && m->fixed[v] & 2) m->value[v].im = rint(p.im);
        int8_t turn = 0;
        qc_complex offset = {0, 0};
        int32_t c = start;
        do {
            m->turn[c] = turn;
            m->offset[c] = offset;
            if (mesh->twin[qc_next(c)] >= 0) cross(&s, qc_next(c), &turn, &offset);
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    *out = m;
    return QC_OK;
}
