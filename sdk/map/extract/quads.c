/* The quad mesh of the kept cells: shared vertices, positions, sources. */
#include "sdk/map/extract/internal.h"

/* Source face, exact orientations over the whole, and the point of the surface. */
static void place_vertex(const qc__lattice *l, int32_t id, qc_polygon_mesh *q, int32_t v) {
    const qc_mesh *m = l->g->mesh;
    const int32_t t = qc__lattice_face(l, id);
    const int64_t unit = (int64_t)1 << l->g->bits;
    const qc__point p = {l->uv[2 * (int64_t)id] * unit, l->uv[2 * (int64_t)id + 1] * unit};
    const double whole = (double)qc_grid_map_orientation(l->g, t);
    q->source_face[v] = t;
    for (int i = 0; i < 3; i++) q->position[3 * (int64_t)v + i] = 0;
    for (int k = 0; k < 3; k++) {
        const qc__point a = qc__grid_corner(l->g, 3 * t + (k + 1) % 3);
        const qc__point b = qc__grid_corner(l->g, 3 * t + (k + 2) % 3);
        const double w = (double)qc__cross(qc__minus(b, a), qc__minus(p, a)) / whole;
        q->source_barycentric[3 * (int64_t)v + k] = w;
        for (int i = 0; i < 3; i++)
            q->position[3 * (int64_t)v + i] +=
                w * m->position[3 * (int64_t)m->face_vertex[3 * t + k] + i];
    }
}

static qc_status fill(qc_ctx *ctx, const qc__ports *p, const qc__cells *c, const int32_t *vertex,
                      int32_t n_lattice, qc_polygon_mesh *q) {
    int32_t n = 0;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell]) continue;
        q->face_offset[n / 4] = n;
        for (int k = 0; k < 4; k++) q->face_vertex[n++] = vertex[4 * (int64_t)cell + k];
    }
    q->face_offset[n / 4] = n;
    for (int32_t a = 0; a < 4 * c->n; a++)
        if (vertex[a] >= 0 && vertex[a] < n_lattice && c->corner[a] >= 0)
            place_vertex(p->lattice, c->corner[a], q, vertex[a]);
    return c->n > c->n_complete ? qc__place_rim(ctx, c, vertex, n_lattice, q) : QC_OK;
}

static qc_status fill_lines(qc_ctx *ctx, const qc__ports *p, const qc__cells *c,
                            const int32_t *vertex, qc_polygon_mesh *q) {
    int32_t *side = QC__NEW(ctx, int32_t, q->n_lines), n;
    if (!side) return QC_ERR_NOMEM;
    const qc_status status = qc__feature_sides(ctx, p, c, side, q->source_edge, &n);
    for (int32_t i = 0; status == QC_OK && i < n; i++) {
        q->line[2 * (int64_t)i] = vertex[side[i]];
        q->line[2 * (int64_t)i + 1] = vertex[qc__side_end(side[i])];
    }
    qc__free(side);
    return status;
}

qc_status qc__quads_create(qc_ctx *ctx, const qc__ports *p, const qc__cells *c,
                           qc_polygon_mesh **out) {
    int32_t *vertex = QC__NEW(ctx, int32_t, 4 * (int64_t)c->n);
    if (!vertex) return QC_ERR_NOMEM;
    int32_t n_lattice = 0, n_vertices = 0, n_quads = 0;
    for (int32_t cell = 0; cell < c->n; cell++) n_quads += c->keep[cell] != 0;
    qc_polygon_mesh *q = NULL;
    int32_t n_lines = 0;
    qc_status status = qc__quad_vertices(ctx, p, c, vertex, &n_lattice, &n_vertices);
    if (status == QC_OK) status = qc__feature_sides(ctx, p, c, NULL, NULL, &n_lines);
    if (status == QC_OK)
        status = qc_polygon_mesh_create(ctx, n_vertices, n_quads, 4 * n_quads, 0, n_lines,
                                        QC_POLYGON_SOURCE, &q);
    if (status == QC_OK && n_lines > 0) status = fill_lines(ctx, p, c, vertex, q);
    if (status == QC_OK) status = fill(ctx, p, c, vertex, n_lattice, q);
    if (status == QC_OK && p->lattice->g->mesh->n_poles > 0)
        status = qc__close_poles(ctx, c, vertex, &q);
    if (status == QC_OK)
        *out = q;
    else
        qc_object_release(q);
    qc__free(vertex);
    return status;
}
