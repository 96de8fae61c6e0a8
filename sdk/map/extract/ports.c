/* Ports of lattice vertices (stages/extract/extract.md): one for each axis direction in the
 * half-open sectors around a point, so that every direction appears exactly once. */
#include "sdk/map/extract/internal.h"

/* Appends the directions of [a, b) (closed: [a, b]) counter-clockwise. Arrays NULL = count only. */
static void put_sector(qc__ports *p, int32_t id, int32_t t, const bool inside[4], qc__point at) {
    int d = 0;
    while (d < 4 && !(inside[d] && !inside[(d + 3) & 3])) d++;
    if (d == 4) return;
    for (; inside[d & 3]; d++) {
        if (p->face) {
            p->vertex[p->n] = id;
            p->face[p->n] = t;
            p->uv[2 * (int64_t)p->n] = (int32_t)(at.u >> p->lattice->g->bits);
            p->uv[2 * (int64_t)p->n + 1] = (int32_t)(at.v >> p->lattice->g->bits);
            p->dir[p->n] = (int8_t)(d & 3);
            p->mate[p->n] = -1;
        }
        p->n++;
    }
}

static void ports_at_vertex(qc__ports *p, int32_t id) {
    const qc_grid_map *g = p->lattice->g;
    const int32_t first = g->mesh->vertex_corner[p->lattice->home[id]];
    int32_t c = first;
    do {
        bool inside[4];
        for (int d = 0; d < 4; d++) inside[d] = qc__in_corner(g, c, d);
        put_sector(p, id, c / 3, inside, qc__grid_corner(g, c));
        c = qc_corner_ccw(g->mesh, c);
    } while (c >= 0 && c != first);
}

/* Directions on the left of halfedge h and along it; on the boundary also those against it. */
static void ports_on_side(qc__ports *p, int32_t id, int32_t h, qc__point at) {
    const qc_grid_map *g = p->lattice->g;
    const qc__point e = qc__minus(qc__grid_corner(g, qc_prev(h)), qc__grid_corner(g, qc_next(h)));
    bool inside[4];
    for (int d = 0; d < 4; d++) {
        const qc__point axis = qc__turn_point((qc__point){1, 0}, d);
        const int64_t side = qc__cross(e, axis);
        const bool along = e.u * axis.u + e.v * axis.v > 0;
        inside[d] = side > 0 || (side == 0 && (along || g->mesh->twin[h] < 0));
    }
    put_sector(p, id, h / 3, inside, at);
}

static void ports_on_edge(qc__ports *p, int32_t id, qc__point at) {
    const qc_mesh *m = p->lattice->g->mesh;
    const int32_t e = p->lattice->home[id], h = m->edge_halfedge[2 * (int64_t)e];
    ports_on_side(p, id, h, at);
    if (m->twin[h] >= 0)
        ports_on_side(p, id, m->twin[h], qc__grid_transition(p->lattice->g, h, at));
}

static qc_status put_all(qc_ctx *ctx, qc__ports *p) {
    static const bool everywhere[2][4] = {{true, true, false, false}, {false, false, true, true}};
    const qc__lattice *l = p->lattice;
    p->n = 0;
    for (int32_t id = 0; id < l->n; id++) {
        if (id % 8192 == 0 && !qc__progress(ctx, 0.2 + 0.1 * id / l->n)) return QC_ERR_CANCELLED;
        const int64_t unit = (int64_t)1 << l->g->bits;
        const qc__point at = {l->uv[2 * (int64_t)id] * unit, l->uv[2 * (int64_t)id + 1] * unit};
        p->first[id] = p->n;
        if (id < l->n_at_vertices)
            ports_at_vertex(p, id);
        else if (id < l->n_on_skeleton)
            ports_on_edge(p, id, at);
        else
            for (int half = 0; half < 2; half++)
                put_sector(p, id, l->home[id], everywhere[half], at);
    }
    p->first[l->n] = p->n;
    return QC_OK;
}

qc_status qc__ports_create(qc_ctx *ctx, const qc__lattice *lattice, qc__ports *out) {
    qc__ports p = {.lattice = lattice};
    p.first = QC__NEW(ctx, int32_t, (int64_t)lattice->n + 1);
    qc_status status = p.first ? put_all(ctx, &p) : QC_ERR_NOMEM; /* counts */
    if (status == QC_OK) {
        p.vertex = QC__NEW(ctx, int32_t, p.n);
        p.uv = QC__NEW(ctx, int32_t, 2 * (int64_t)p.n);
        p.dir = QC__NEW(ctx, int8_t, p.n);
        p.mate = QC__NEW(ctx, int32_t, p.n);
        p.face = QC__NEW(ctx, int32_t, p.n);
        status = p.vertex && p.face && p.uv && p.dir && p.mate ? put_all(ctx, &p) : QC_ERR_NOMEM;
    }
    if (status == QC_OK)
        *out = p;
    else
        qc__ports_free(&p);
    return status;
}

void qc__ports_free(qc__ports *p) {
    qc__free(p->first);
    qc__free(p->vertex);
    qc__free(p->face);
    qc__free(p->uv);
    qc__free(p->dir);
    qc__free(p->mate);
    *p = (qc__ports){0};
}

int32_t qc__port_find(const qc__ports *p, int32_t id, int32_t t, int d) {
    for (int32_t i = p->first[id]; i < p->first[id + 1]; i++)
        if (p->face[i] == t && p->dir[i] == d) return i;
    return -1;
}
