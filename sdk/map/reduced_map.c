/* Independent values of an integer-seamless map (see reduced_map.h; ROBUST 1 without features). */
#include "sdk/map/reduced_map.h"

void qc__reduced_map_free(qc__reduced_map *map) {
    if (!map) return;
    qc__free(map->value);
    qc__free(map->pinned);
    qc__free(map->turn);
    qc__free(map->offset);
    qc__free(map);
}

/* Composes a chart with the transition across halfedge h: f -> i^r f + T from s to t, i^-r (f - T) back. */
static void cross(const qc_grid_map *grid, int32_t h, int8_t *turn, qc_complex *offset) {
    const int32_t e = grid->mesh->halfedge_edge[h], r = grid->rotation[e];
    const double tu = grid->translation[2 * (int64_t)e], tv = grid->translation[2 * (int64_t)e + 1];
    if (grid->mesh->edge_halfedge[2 * (int64_t)e] == h) {
        *offset = qc_quarter_turn(*offset, r);
        offset->re += tu;
        offset->im += tv;
        *turn = (int8_t)((*turn + r) & 3);
    } else {
        offset->re -= tu;
        offset->im -= tv;
        *offset = qc_quarter_turn(*offset, -r);
        *turn = (int8_t)((*turn - r) & 3);
    }
}

qc_status qc__reduced_map_create(qc_ctx *ctx, const qc_grid_map *grid, qc__reduced_map **out) {
    const qc_mesh *mesh = grid->mesh;
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    qc__reduced_map *m = QC__ZERO(ctx, qc__reduced_map, 1);
    if (!m) return QC_ERR_NOMEM;
    m->mesh = mesh;
    m->value = QC__NEW(ctx, qc_complex, mesh->n_vertices);
    m->pinned = QC__NEW(ctx, uint8_t, mesh->n_vertices);
    m->turn = QC__NEW(ctx, int8_t, n_corners);
    m->offset = QC__NEW(ctx, qc_complex, n_corners);
    if (!m->value || !m->pinned || !m->turn || !m->offset) {
        qc__reduced_map_free(m);
        return QC_ERR_NOMEM;
    }
    const double unit = 1.0 / (double)((int64_t)1 << grid->bits);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t start = mesh->vertex_corner[v];
        m->value[v].re = unit * grid->uv[2 * (int64_t)start];
        m->value[v].im = unit * grid->uv[2 * (int64_t)start + 1];
        m->pinned[v] = grid->holonomy[v] != 0;
        int8_t turn = 0;
        qc_complex offset = {0, 0};
        int32_t c = start;
        do {
            m->turn[c] = turn;
            m->offset[c] = offset;
            if (mesh->twin[qc_next(c)] >= 0) cross(grid, qc_next(c), &turn, &offset);
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    *out = m;
    return QC_OK;
}
