/* The quad mesh of the kept cells: shared vertices, positions, sources. */
#include "sdk/map/extract_internal.h"

int32_t qc__quad_vertices(const qc__ports *p, const qc__cells *c, int32_t *vertex) {
    int32_t n = 0;
    for (int32_t id = 0; id < p->lattice->n; id++) {
        const int32_t first = p->first[id], last = p->first[id + 1];
        const bool cyclic = !qc__lattice_on_boundary(p->lattice, id);
        int32_t run = -1; /* vertex of the cells since the last gap */
        for (int32_t i = first; i < last; i++) {
            if (c->left[i] < 0) {
                run = -1;
                vertex[i] = -1;
                continue;
            }
            if (run < 0) run = n++;
            vertex[i] = run;
        }
        /* The last run of a full turn goes on in the first one. */
        if (!cyclic || run < 0 || vertex[first] < 0 || vertex[first] == run) continue;
        for (int32_t i = last - 1; vertex[i] == run; i--) vertex[i] = vertex[first];
        n--;
    }
    return n;
}

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

qc_status qc__quads_create(qc_ctx *ctx, const qc__ports *p, const qc__cells *c,
                           qc_polygon_mesh **out) {
    if (c->n > INT32_MAX / 4)
        return qc__fail(ctx, QC_ERR_FAILED, -1, "too many quads; try a coarser density");
    int32_t *vertex = QC__NEW(ctx, int32_t, p->n);
    if (!vertex) return QC_ERR_NOMEM;
    const int32_t n = qc__quad_vertices(p, c, vertex);
    qc_polygon_mesh *q = NULL;
    const qc_status status =
        qc_polygon_mesh_create(ctx, n, c->n, 4 * c->n, 0, 0, QC_POLYGON_SOURCE, &q);
    if (status == QC_OK) {
        for (int32_t i = 0; i <= c->n; i++) q->face_offset[i] = 4 * i;
        for (int32_t i = 0; i < 4 * c->n; i++) q->face_vertex[i] = vertex[c->port[i]];
        for (int32_t i = 0; i < p->n; i++)
            if (vertex[i] >= 0) place_vertex(p->lattice, p->vertex[i], q, vertex[i]);
        *out = q;
    }
    qc__free(vertex);
    return status;
}
