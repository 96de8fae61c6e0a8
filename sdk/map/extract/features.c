/* Feature edges of the quads (stages/extract/extract.md): isolines which run along features of the
 * map. A chain starts and ends at lattice points, so it is covered by whole sides. */
#include <stdlib.h>

#include "sdk/map/extract/internal.h"

/* Whether the image of halfedge h of port's face is a feature which runs in direction d, +-d. */
static bool runs_along(const qc_grid_map *g, int32_t h, int d, bool either) {
    if (g->axis[g->mesh->halfedge_edge[h]] < 0) return false;
    const qc__point axis = qc__turn_point((qc__point){1, 0}, d);
    const qc__point e = qc__minus(qc__grid_corner(g, qc_prev(h)), qc__grid_corner(g, qc_next(h)));
    return qc__cross(e, axis) == 0 && (either || e.u * axis.u + e.v * axis.v > 0);
}

int32_t qc__port_feature(const qc__ports *p, int32_t port) {
    const qc__lattice *l = p->lattice;
    const qc_grid_map *g = l->g;
    const qc_mesh *m = g->mesh;
    const int32_t id = p->vertex[port], t = p->face[port], home = l->home[id];
    const int d = p->dir[port];
    if (!g->axis || id >= l->n_on_skeleton) return -1;
    if (id >= l->n_at_vertices) {
        const int32_t h = m->edge_halfedge[2 * (int64_t)home];
        const int32_t in_face = h / 3 == t ? h : m->twin[h];
        return runs_along(g, in_face, d, true) ? home : -1;
    }
    int32_t c = 3 * t;
    while (m->face_vertex[c] != home) c++;
    if (runs_along(g, qc_prev(c), d, false)) return m->halfedge_edge[qc_prev(c)];
    const int32_t last = qc_next(c); /* the closed end of a fan on the boundary */
    return m->twin[last] < 0 && runs_along(g, last, (d + 2) & 3, false) ? m->halfedge_edge[last]
                                                                        : -1;
}

/* Total length of the features in grid units, exact. */
static int64_t feature_length(const qc_grid_map *g) {
    int64_t sum = 0;
    for (int32_t e = 0; e < g->mesh->n_edges; e++) {
        if (g->axis[e] < 0) continue;
        const int32_t h = g->mesh->edge_halfedge[2 * (int64_t)e];
        const qc__point d =
            qc__minus(qc__grid_corner(g, qc_prev(h)), qc__grid_corner(g, qc_next(h)));
        sum += llabs(d.u) + llabs(d.v);
    }
    return sum;
}

/* Side of a kept cell along the port or its mate, -1 = none. */
static int32_t side_along(const qc__ports *p, const qc__cells *c, int32_t port) {
    for (int i = 0; i < 2; i++, port = p->mate[port]) {
        const int32_t side = c->left[port];
        if (side >= 0 && c->keep[side / 4]) return side;
    }
    return -1;
}

static qc_status broken(qc_ctx *ctx, const qc__ports *p, int32_t port, int32_t e) {
    const int32_t *v = p->lattice->g->mesh->edge_vertex + 2 * (int64_t)e;
    return qc__fail(ctx, QC_ERR_FAILED, p->face[port],
                    "the feature at edge %d (vertices %d, %d; face %d) is no chain of quad edges; "
                    "the map is not injective there",
                    (int)e, (int)v[0], (int)v[1], (int)p->face[port]);
}

qc_status qc__feature_sides(qc_ctx *ctx, const qc__ports *p, const qc__cells *c, int32_t *side,
                            int32_t *source, int32_t *n_out) {
    const qc_grid_map *g = p->lattice->g;
    const bool strict = !p->lattice->open;
    int32_t n = 0, cut = 0, whole = 0;
    for (int32_t port = 0; g->axis && port < p->n; port++) {
        const int32_t e = qc__port_feature(p, port), mate = p->mate[port];
        if (e < 0 || (mate >= 0 && mate < port)) continue;
        const bool both = mate >= 0 && qc__port_feature(p, mate) >= 0;
        const int32_t a = mate >= 0 ? side_along(p, c, port) : -1;
        whole += both;
        cut += a < 0;
        if (strict && (!both || a < 0)) return broken(ctx, p, port, e);
        if (a < 0) continue;
        if (side) {
            side[n] = a;
            source[n] = e;
        }
        n++;
    }
    if (strict && g->axis && ((int64_t)whole << g->bits) != feature_length(g))
        return qc__fail(ctx, QC_ERR_FAILED, -1,
                        "the features are %.17g units long, their quad edges %d",
                        (double)feature_length(g) / (double)((int64_t)1 << g->bits), (int)whole);
    if (cut > 0 && !side)
        qc__log(ctx, QC_LOG_WARNING, "%d quad edges of features are cut off by the boundary",
                (int)cut);
    *n_out = n;
    return QC_OK;
}
