/* Slivers flipped or flattened by rounding (docs/theory/exact-grid.md): a vertex moves by a few
 * grid units inside its star. Regular vertices only; coordinates on isolines stay there, so
 * features do. */
#include <stdlib.h>

#include "sdk/map/grid/internal.h"

enum { RADIUS = 4, PASSES = 4 };

void qc__grid_spread(const qc_grid_map *g, int32_t v, qc__point p, int32_t *uv) {
    const int32_t first = g->mesh->vertex_corner[v];
    int32_t c = first;
    do {
        uv[2 * (int64_t)c] = (int32_t)p.u;
        uv[2 * (int64_t)c + 1] = (int32_t)p.v;
        const int32_t h = qc_next(c);
        if (g->mesh->twin[h] < 0) return;
        p = qc__grid_transition(g, h, p);
        c = qc_corner_ccw(g->mesh, c);
    } while (c != first);
}

/* Faces around v which are not positive. */
static int bad_faces(const qc_grid_map *g, int32_t v) {
    const int32_t first = g->mesh->vertex_corner[v];
    int32_t c = first;
    int n = 0;
    do {
        n += qc_grid_map_orientation(g, c / 3) <= 0;
        c = qc_corner_ccw(g->mesh, c);
    } while (c >= 0 && c != first);
    return n;
}

/* Tries all offsets of max norm 1, 2, ... RADIUS and keeps the first best one. */
static bool move_vertex(const qc_grid_map *g, int32_t v, int32_t *uv) {
    const qc__point home = qc__grid_corner(g, g->mesh->vertex_corner[v]);
    const int64_t mask = ((int64_t)1 << g->bits) - 1;
    const int free_u = (home.u & mask) != 0, free_v = (home.v & mask) != 0;
    if (!free_u && !free_v) return false;
    int best = bad_faces(g, v);
    const int before = best;
    qc__point place = home;
    for (int radius = 1; radius <= RADIUS && best > 0; radius++)
        for (int du = -radius * free_u; du <= radius * free_u; du++)
            for (int dv = -radius * free_v; dv <= radius * free_v && best > 0; dv++) {
                if (abs(du) < radius && abs(dv) < radius) continue;
                const qc__point p = {home.u + du, home.v + dv};
                qc__grid_spread(g, v, p, uv);
                const int n = bad_faces(g, v);
                if (n >= best) continue;
                best = n;
                place = p;
            }
    qc__grid_spread(g, v, place, uv);
    return best < before;
}

/* Whether moving corner c by RADIUS can turn its face round at all. */
static bool within_reach(const qc_grid_map *g, int32_t c) {
    const qc__point d = qc__minus(qc__grid_corner(g, qc_prev(c)), qc__grid_corner(g, qc_next(c)));
    return -qc_grid_map_orientation(g, c / 3) < RADIUS * (llabs(d.u) + llabs(d.v));
}

qc_status qc__grid_repair(qc_ctx *ctx, qc_grid_map *g, int32_t *uv) {
    const qc_mesh *m = g->mesh;
    bool changed = true;
    for (int pass = 0; pass < PASSES && changed; pass++) {
        changed = false;
        for (int32_t t = 0; t < m->n_faces; t++) {
            if (t % 8192 == 0 && !qc__progress(ctx, 0.9 + 0.1 * t / m->n_faces))
                return QC_ERR_CANCELLED;
            for (int32_t c = 3 * t; c < 3 * t + 3 && qc_grid_map_orientation(g, t) <= 0; c++) {
                const int32_t v = m->face_vertex[c];
                if (g->holonomy[v] != 0 || !within_reach(g, c)) continue;
                changed |= move_vertex(g, v, uv);
            }
        }
    }
    return QC_OK;
}
