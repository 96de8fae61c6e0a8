/* Tracing of isolines from port to port (stages/extract/extract.md). The line is u or v = const, so
 * the side of a corner is the sign of a difference; only the stop test needs products. */
#include "sdk/map/extract/internal.h"

/* A unit step on its way: its ends in the chart of `face`, direction d from `from` to `to`. */
typedef struct step {
    int32_t face;
    qc__point from, to;
    int d;
    int32_t exit; /* boundary halfedge at which it left the surface */
} step;

/* Sign of the corner's side of the line: positive = left. */
static int side_of(const qc_grid_map *g, const step *s, int32_t c) {
    const qc__point axis = qc__turn_point((qc__point){1, 0}, s->d);
    const int64_t side = qc__cross(axis, qc__minus(qc__grid_corner(g, c), s->from));
    return (side > 0) - (side < 0);
}

/* Moves the step into the chart across halfedge h; false on the boundary. */
static bool cross_edge(const qc_grid_map *g, step *s, int32_t h) {
    if (g->mesh->twin[h] < 0) {
        s->exit = h;
        return false;
    }
    s->from = qc__grid_transition(g, h, s->from);
    s->to = qc__grid_transition(g, h, s->to);
    s->d = (s->d + qc__grid_rotation(g, h)) & 3;
    s->face = g->mesh->twin[h] / 3;
    return true;
}

/* Turns about corner c, one way until the sector with the direction is found. */
static bool turn_about(const qc_grid_map *g, step *s, int32_t c, bool ccw) {
    const int32_t first = c;
    do {
        if (!cross_edge(g, s, ccw ? qc_next(c) : qc_prev(c))) return false;
        c = ccw ? qc_corner_ccw(g->mesh, c) : qc_corner_cw(g->mesh, c);
        if (qc__in_corner(g, c, s->d)) return true;
    } while (c != first);
    return false;
}

/* The line leaves through the regular vertex of corner c: straight on is the sector with its
 * direction. */
static bool pass_vertex(const qc_grid_map *g, step *s, int32_t c) {
    const step before = *s;
    if (turn_about(g, s, c, true)) return true;
    *s = before;
    return turn_about(g, s, c, false);
}

/* To the next triangle along the line, which meets the current one but does not end there. */
static bool advance(const qc_grid_map *g, step *s) {
    const int32_t t = s->face;
    int side[3];
    for (int k = 0; k < 3; k++) side[k] = side_of(g, s, 3 * t + k);
    for (int k = 0; k < 3; k++) { /* halfedge k runs from corner k+1 to corner k+2 */
        const int a = side[(k + 1) % 3], b = side[(k + 2) % 3];
        if (a < 0 && b > 0) return cross_edge(g, s, 3 * t + k);
        if (side[k] == 0 && a > 0 && b < 0) return pass_vertex(g, s, 3 * t + k);
        if (a == 0 && b == 0) return pass_vertex(g, s, 3 * t + (side[k] > 0 ? k + 2 : k + 1) % 3);
    }
    return false;
}

/* The port at s->to which points back; the face may start it on the other side of an edge. */
static int32_t arrive(const qc__ports *p, step s) {
    const qc_grid_map *g = p->lattice->g;
    const int32_t id = qc__lattice_find(p->lattice, s.face, s.to);
    if (id < 0) return -1;
    const int32_t found = qc__port_find(p, id, s.face, (s.d + 2) & 3);
    if (found >= 0) return found;
    int k = 0;
    const qc__place place = qc__locate(g, s.face, s.to, &k);
    if (place == QC__INSIDE) return -1;
    /* A direction along the second edge of a sector belongs to the next one. */
    const int32_t h = place == QC__ON_EDGE ? 3 * s.face + k : qc_next(3 * s.face + k);
    return cross_edge(g, &s, h) ? qc__port_find(p, id, s.face, (s.d + 2) & 3) : -1;
}

/* From a port to the face which holds the next integer point; false when the line leaves the
 * surface. */
static bool walk(const qc__ports *p, int32_t port, step *s) {
    const qc_grid_map *g = p->lattice->g;
    const int64_t unit = (int64_t)1 << g->bits;
    int64_t limit = 4 * (int64_t)g->mesh->n_faces + 16;
    *s = (step){
        .face = p->face[port], .from = qc__port_point(p, port), .d = p->dir[port], .exit = -1};
    s->to = qc__plus(s->from, qc__turn_point((qc__point){unit, 0}, s->d));
    int k;
    while (qc__locate(g, s->face, s->to, &k) == QC__OUTSIDE)
        if (limit-- <= 0 || !advance(g, s)) return false;
    return true;
}

int32_t qc__port_exit(const qc__ports *p, int32_t port) {
    step s;
    return walk(p, port, &s) ? -1 : s.exit;
}

static qc_status unmatched(qc_ctx *ctx, const qc__ports *p, int32_t port) {
    return qc__fail(ctx, QC_ERR_FAILED, p->face[port],
                    "an isoline which starts in face %d at (%d, %d) does not reach the next grid "
                    "point; the map is not injective there",
                    (int)p->face[port], (int)p->uv[2 * (int64_t)port],
                    (int)p->uv[2 * (int64_t)port + 1]);
}

qc_status qc__ports_trace(qc_ctx *ctx, qc__ports *p) {
    for (int32_t port = 0; port < p->n; port++) {
        if (port % 4096 == 0 && !qc__progress(ctx, 0.3 + 0.4 * port / p->n))
            return QC_ERR_CANCELLED;
        if (p->mate[port] >= 0) continue;
        step s;
        const int32_t mate = walk(p, port, &s) ? arrive(p, s) : -1;
        if (mate < 0 && p->lattice->open) continue;
        if (mate < 0 || mate == port || p->mate[mate] >= 0) return unmatched(ctx, p, port);
        p->mate[port] = mate;
        p->mate[mate] = port;
    }
    return QC_OK;
}
