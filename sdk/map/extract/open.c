/* Open cells: the unit squares which the boundary of the surface cuts, their corners inside the
 * surface and the cells which they touch across their sides. */
#include <math.h>

#include "sdk/map/extract/internal.h"

/* --- pieces along the boundary ---------------------------------------------------------------- */

static qc_status flood_at(qc_ctx *ctx, qc__pieces *p, int32_t face, int64_t u, int64_t v) {
    const int64_t unit = (int64_t)1 << p->ports->lattice->g->bits;
    const qc__visit visit = {.face = face, .at = {u * unit, v * unit}, .d = 0};
    return qc__pieces_find(p, visit) >= 0 ? QC_OK : qc__pieces_flood(ctx, p, visit);
}

/* The squares which a boundary halfedge meets, column by column. */
static qc_status flood_along(qc_ctx *ctx, qc__pieces *p, int32_t h) {
    const qc_grid_map *g = p->ports->lattice->g;
    const int64_t unit = (int64_t)1 << g->bits;
    qc__point a = qc__grid_corner(g, qc_next(h)), b = qc__grid_corner(g, qc_prev(h));
    if (a.u > b.u) {
        const qc__point swap = a;
        a = b;
        b = swap;
    }
    const double slope = b.u > a.u ? (double)(b.v - a.v) / (double)(b.u - a.u) : 0;
    for (int64_t i = a.u >> g->bits; i <= b.u >> g->bits; i++) {
        const double from = (double)(i * unit > a.u ? i * unit - a.u : 0);
        const double to = (double)((i + 1) * unit < b.u ? (i + 1) * unit - a.u : b.u - a.u);
        double low = (double)a.v + slope * from, high = (double)a.v + slope * to;
        if (b.u == a.u) {
            low = (double)(a.v < b.v ? a.v : b.v);
            high = (double)(a.v < b.v ? b.v : a.v);
        } else if (low > high) {
            const double swap = low;
            low = high;
            high = swap;
        }
        const int64_t first = (int64_t)floor(low / (double)unit - 1e-3);
        const int64_t last = (int64_t)floor(high / (double)unit + 1e-3);
        for (int64_t j = first; j <= last; j++) {
            if (!qc__meets_square(a, b, (qc__point){i * unit, j * unit}, unit)) continue;
            const qc_status status = flood_at(ctx, p, h / 3, i, j);
            if (status != QC_OK) return status;
        }
    }
    return QC_OK;
}

qc_status qc__open_pieces(qc_ctx *ctx, const qc__ports *ports, qc__pieces *p) {
    const qc_mesh *m = ports->lattice->g->mesh;
    for (int32_t h = 0; h < 3 * m->n_faces; h++) {
        if (h % 1024 == 0 && !qc__progress(ctx, 0.7 + 0.05 * h / (3.0 * m->n_faces)))
            return QC_ERR_CANCELLED;
        if (m->twin[h] >= 0) continue;
        const qc_status status = flood_along(ctx, p, h);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* --- contacts --------------------------------------------------------------------------------- */

/* 4 cell + side of the complete cell whose first side is that of the square of v. */
static int32_t complete_side(const qc__cells *c, const qc__ports *ports, const qc__visit *v) {
    const int32_t id = qc__lattice_find(ports->lattice, v->face, v->at);
    const int32_t port = id >= 0 ? qc__port_find(ports, id, v->face, v->d) : -1;
    return port >= 0 ? c->left[port] : -1;
}

/* Code of the first side of the square of v, which meets the face of v; complete cells next to open
 * ones are flooded when they are met first. -1 = none. */
static qc_status first_side(qc_ctx *ctx, qc__cells *c, const qc__ports *ports, qc__visit v,
                            int32_t *code) {
    int32_t found = qc__pieces_find(&c->pieces, v);
    if (found < 0) {
        const qc_status status = qc__pieces_flood(ctx, &c->pieces, v);
        if (status != QC_OK) return status;
        qc__piece *piece = &c->pieces.piece[c->pieces.n - 1];
        for (int64_t i = piece->first; i < c->pieces.n_visits && piece->code < 0; i++)
            piece->code = complete_side(c, ports, &c->pieces.visit[i]);
        found = qc__pieces_find(&c->pieces, v);
    }
    const qc__visit *w = &c->pieces.visit[found];
    const int32_t base = c->pieces.piece[w->piece].code;
    *code = base < 0 ? -1 : (base & ~3) | ((base + v.d - w->d) & 3);
    return QC_OK;
}

static bool add_contact(qc_ctx *ctx, qc__cells *c, int64_t first, int32_t side, int32_t other) {
    for (int64_t i = first; i < c->n_contacts; i++)
        if (c->contact[2 * i] == side && c->contact[2 * i + 1] == other) return true;
    if (!qc__reserve(ctx, (void **)&c->contact, &c->contact_capacity, c->n_contacts + 1,
                     2 * sizeof(int32_t)))
        return false;
    c->contact[2 * c->n_contacts] = side;
    c->contact[2 * c->n_contacts++ + 1] = other;
    return true;
}

/* The neighbour of the square of v across its side k, as seen from the face of v; or from the face
 * across the halfedge which runs along the side. false = the face does not reach it. */
static bool neighbour(const qc_grid_map *g, const qc__visit *v, int k, qc__visit *w) {
    const int64_t unit = (int64_t)1 << g->bits;
    *w = (qc__visit){
        .face = v->face, .at = qc__square_corner(v, (k + 1) & 3, unit), .d = (v->d + k + 2) & 3};
    qc__point c[3];
    for (int i = 0; i < 3; i++) c[i] = qc__in_square(w, qc__grid_corner(g, 3 * v->face + i));
    if (qc__triangle_meets_square(c, (qc__point){0, 0}, unit)) return true;
    for (int i = 0; i < 3; i++) {
        const qc__point a = c[(i + 1) % 3], b = c[(i + 2) % 3];
        if (a.v != 0 || b.v != 0 || (a.u <= 0 && b.u <= 0) || (a.u >= unit && b.u >= unit))
            continue;
        const int32_t h = 3 * v->face + i;
        if (g->mesh->twin[h] < 0) return false;
        w->face = g->mesh->twin[h] / 3;
        w->at = qc__grid_transition(g, h, w->at);
        w->d = (w->d + qc__grid_rotation(g, h)) & 3;
        return true;
    }
    return false;
}

static qc_status contacts_of(qc_ctx *ctx, qc__cells *c, const qc__ports *ports, int32_t piece) {
    const qc_grid_map *g = ports->lattice->g;
    const int64_t first = c->n_contacts, end = qc__piece_end(&c->pieces, piece);
    const int32_t cell = c->n_complete + piece;
    for (int64_t i = c->pieces.piece[piece].first; i < end; i++)
        for (int k = 0; k < 4; k++) {
            qc__visit w;
            int32_t other = -1;
            if (!neighbour(g, &c->pieces.visit[i], k, &w)) continue;
            const qc_status status = first_side(ctx, c, ports, w, &other);
            if (status != QC_OK) return status;
            if (other >= 0 && !add_contact(ctx, c, first, 4 * cell + k, other)) return QC_ERR_NOMEM;
        }
    return QC_OK;
}

/* Lattice vertices at the corners of an open cell. */
static void corners_of(qc__cells *c, const qc__ports *ports, int32_t piece) {
    const int64_t unit = (int64_t)1 << ports->lattice->g->bits;
    int32_t *corner = c->corner + 4 * (int64_t)(c->n_complete + piece);
    for (int k = 0; k < 4; k++) corner[k] = -1;
    for (int64_t i = c->pieces.piece[piece].first; i < qc__piece_end(&c->pieces, piece); i++) {
        const qc__visit *v = &c->pieces.visit[i];
        for (int k = 0; k < 4; k++)
            if (corner[k] < 0)
                corner[k] =
                    qc__lattice_find(ports->lattice, v->face, qc__square_corner(v, k, unit));
    }
}

qc_status qc__open_cells(qc_ctx *ctx, const qc__ports *ports, qc__cells *c) {
    const int32_t n_open = c->n - c->n_complete;
    c->contact_first = QC__NEW(ctx, int32_t, (int64_t)n_open + 1);
    if (!c->contact_first) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < n_open; i++) {
        qc__piece *piece = &c->pieces.piece[i];
        piece->code = 4 * (c->n_complete + i);
        c->face[c->n_complete + i] = c->pieces.visit[piece->first].face;
        for (int k = 0; k < 4; k++) c->across[piece->code + k] = -1;
        corners_of(c, ports, i);
    }
    for (int32_t i = 0; i < n_open; i++) {
        if (i % 64 == 0 && !qc__progress(ctx, 0.8 + 0.05 * i / n_open)) return QC_ERR_CANCELLED;
        c->contact_first[i] = (int32_t)c->n_contacts;
        const qc_status status = contacts_of(ctx, c, ports, i);
        if (status != QC_OK) return status;
    }
    c->contact_first[n_open] = (int32_t)c->n_contacts;
    return QC_OK;
}
