/* Cells of the grid (ROBUST 3): cycles of four ports whose unit square lies in the surface as a
 * whole. Next to boundaries which are not aligned, and around holes smaller than a cell, squares
 * are dropped. */
#include "sdk/map/extract_internal.h"

/* To the other end, then the next port clockwise. */
int32_t qc__next_side(const qc__ports *p, int32_t port) {
    const int32_t mate = p->mate[port];
    if (mate < 0) return -1;
    const int32_t id = p->vertex[mate];
    if (mate > p->first[id]) return mate - 1;
    return qc__lattice_on_boundary(p->lattice, id) ? -1 : p->first[id + 1] - 1;
}

/* --- does a square contain boundary?
 * -------------------------------------------------------------- */

/* A face as seen from the cell: the cell's square has its first corner at `at` and its first side
 * in direction d of the face's chart. */
typedef struct visit {
    int32_t face, previous; /* earlier visit of the same face, -1 = none */
    qc__point at;
    int d;
} visit;

typedef struct flood {
    qc_ctx *ctx;
    const qc__ports *ports;
    int32_t *last; /* n_faces: latest visit of a face; stale unless visits[last] agrees */
    visit *visits;
    int64_t n, capacity;
} flood;

static bool push(flood *f, visit v) {
    const int32_t last = f->last[v.face];
    v.previous = last < f->n && f->visits[last].face == v.face ? last : -1;
    for (int32_t i = v.previous; i >= 0; i = f->visits[i].previous)
        if (f->visits[i].d == v.d && f->visits[i].at.u == v.at.u && f->visits[i].at.v == v.at.v)
            return true;
    if (!qc__reserve(f->ctx, (void **)&f->visits, &f->capacity, f->n + 1, sizeof *f->visits))
        return false;
    f->last[v.face] = (int32_t)f->n;
    f->visits[f->n++] = v;
    return true;
}

/* Whether the segment a b meets the open square (0, unit)^2: separating axes u, v and the segment's
 * normal. */
static bool meets_square(qc__point a, qc__point b, int64_t unit) {
    if ((a.u <= 0 && b.u <= 0) || (a.u >= unit && b.u >= unit)) return false;
    if ((a.v <= 0 && b.v <= 0) || (a.v >= unit && b.v >= unit)) return false;
    const qc__point d = qc__minus(b, a);
    int left = 0, right = 0;
    for (int i = 0; i < 4; i++) {
        const qc__point corner = {i & 1 ? unit : 0, i & 2 ? unit : 0};
        const int64_t side = qc__cross(d, qc__minus(corner, a));
        left += side > 0;
        right += side < 0;
    }
    return left > 0 && right > 0;
}

/* Visits all faces which meet the open square left of `port`; *boundary = a boundary halfedge which
 * does, -1 = none. */
static qc_status flood_cell(flood *f, int32_t port, int32_t *boundary) {
    const qc_grid_map *g = f->ports->lattice->g;
    const int64_t unit = (int64_t)1 << g->bits;
    f->n = 0;
    *boundary = -1;
    if (!push(f, (visit){f->ports->face[port], -1, qc__port_point(f->ports, port),
                         f->ports->dir[port]}))
        return QC_ERR_NOMEM;
    for (int64_t i = 0; i < f->n; i++) {
        const visit v = f->visits[i];
        qc__point corner[3];
        for (int k = 0; k < 3; k++) {
            const qc__point p = qc__grid_corner(g, 3 * v.face + k);
            corner[k] = qc__turn(qc__minus(p, v.at), 4 - v.d);
        }
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * v.face + k;
            if (!meets_square(corner[(k + 1) % 3], corner[(k + 2) % 3], unit)) continue;
            if (g->mesh->twin[h] < 0) {
                *boundary = h;
                return QC_OK;
            }
            const visit w = {g->mesh->twin[h] / 3, -1, qc__grid_transition(g, h, v.at),
                             (v.d + qc__grid_rotation(g, h)) & 3};
            if (!push(f, w)) return QC_ERR_NOMEM;
        }
    }
    return QC_OK;
}

/* --- cells
 * ------------------------------------------------------------------------------------------ */

static qc_status not_closed(qc_ctx *ctx, const qc__ports *p, int32_t port) {
    return qc__fail(ctx, QC_ERR_FAILED, p->face[port],
                    "the cell of the grid which starts in face %d at (%d, %d) does not close after "
                    "four sides; the map is not injective there",
                    (int)p->face[port], (int)p->uv[2 * (int64_t)port],
                    (int)p->uv[2 * (int64_t)port + 1]);
}

static qc_status refuse(qc_ctx *ctx, qc__cells *cells, int64_t *capacity, int32_t port,
                        int32_t boundary) {
    if (!qc__reserve(ctx, (void **)&cells->refused, capacity, cells->n_refused + 1,
                     2 * sizeof(int32_t)))
        return QC_ERR_NOMEM;
    cells->refused[2 * cells->n_refused] = port;
    cells->refused[2 * cells->n_refused++ + 1] = boundary;
    return QC_OK;
}

static qc_status collect(qc_ctx *ctx, const qc__ports *p, flood *f, qc__cells *cells) {
    const bool closed = p->lattice->g->mesh->n_boundary_edges == 0;
    int64_t capacity = 0;
    for (int32_t port = 0; port < p->n; port++) {
        if (port % 64 == 0 && !qc__progress(ctx, 0.7 + 0.15 * port / p->n))
            return QC_ERR_CANCELLED;
        if (cells->left[port] >= 0) continue;
        int32_t side[5] = {port, -1, -1, -1, -1};
        bool lowest = true;
        for (int i = 0; i < 4 && side[i] >= 0; i++) {
            side[i + 1] = qc__next_side(p, side[i]);
            lowest &= side[i] >= port;
        }
        if (side[4] != port) {
            if (closed) return not_closed(ctx, p, port);
            continue;
        }
        if (!lowest) continue; /* was refused before */
        int32_t boundary = -1;
        qc_status status = closed ? QC_OK : flood_cell(f, port, &boundary);
        if (status == QC_OK && boundary >= 0)
            status = refuse(ctx, cells, &capacity, port, boundary);
        if (status != QC_OK) return status;
        if (boundary >= 0) continue;
        for (int i = 0; i < 4; i++) {
            cells->port[4 * (int64_t)cells->n + i] = side[i];
            cells->left[side[i]] = cells->n;
        }
        cells->n++;
    }
    return QC_OK;
}

qc_status qc__cells_create(qc_ctx *ctx, const qc__ports *ports, qc__cells *out) {
    const int32_t n_faces = ports->lattice->g->mesh->n_faces;
    qc__cells cells = {.n = 0};
    flood f = {.ctx = ctx, .ports = ports};
    cells.left = QC__NEW(ctx, int32_t, ports->n);
    cells.port = QC__NEW(ctx, int32_t, ports->n); /* every cell takes four */
    f.last = QC__ZERO(ctx, int32_t, n_faces);
    qc_status status = cells.left && cells.port && f.last ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t i = 0; i < ports->n; i++) cells.left[i] = -1;
        status = collect(ctx, ports, &f, &cells);
    }
    qc__free(f.last);
    qc__free(f.visits);
    if (status == QC_OK)
        *out = cells;
    else
        qc__cells_free(&cells);
    return status;
}

void qc__cells_free(qc__cells *cells) {
    qc__free(cells->port);
    qc__free(cells->left);
    qc__free(cells->refused);
    *cells = (qc__cells){0};
}
