/* Cells of the grid (stages/extract/extract.md): the complete ones are the cycles of four ports
 * around a unit square which the boundary of the surface does not meet. */
#include <string.h>

#include "sdk/map/extract/internal.h"

/* To the other end, then the next port clockwise. */
int32_t qc__next_side(const qc__ports *p, int32_t port) {
    const int32_t mate = p->mate[port];
    if (mate < 0) return -1;
    const int32_t id = p->vertex[mate];
    if (mate > p->first[id]) return mate - 1;
    return qc__lattice_on_boundary(p->lattice, id) ? -1 : p->first[id + 1] - 1;
}

static qc_status not_closed(qc_ctx *ctx, const qc__ports *p, int32_t port) {
    return qc__fail(ctx, QC_ERR_FAILED, p->face[port],
                    "the cell of the grid which starts in face %d at (%d, %d) does not close after "
                    "four sides; the map is not injective there",
                    (int)p->face[port], (int)p->uv[2 * (int64_t)port],
                    (int)p->uv[2 * (int64_t)port + 1]);
}

/* Whether the port runs along an aligned boundary with the outside on its left: the last of its
 * fan.
 */
static bool faces_outside(const qc__ports *p, int32_t port) {
    const int32_t id = p->vertex[port];
    return qc__lattice_on_boundary(p->lattice, id) && port + 1 == p->first[id + 1];
}

/* Numbers the complete cells by left; side: their sides are counted. */
static qc_status collect(qc_ctx *ctx, const qc__ports *p, qc__cells *cells) {
    const bool closed = !p->lattice->open;
    for (int32_t port = 0; port < p->n; port++) cells->left[port] = -1;
    for (int32_t port = 0; port < p->n; port++) {
        if (port % 8192 == 0 && !qc__progress(ctx, 0.75 + 0.05 * port / p->n))
            return QC_ERR_CANCELLED;
        if (cells->left[port] >= 0) continue;
        int32_t side[5] = {port, -1, -1, -1, -1};
        for (int i = 0; i < 4 && side[i] >= 0; i++) side[i + 1] = qc__next_side(p, side[i]);
        if (side[4] != port) {
            if (closed && !faces_outside(p, port)) return not_closed(ctx, p, port);
            continue;
        }
        const qc__visit v = {
            .face = p->face[port], .at = qc__port_point(p, port), .d = p->dir[port]};
        if (!closed && qc__pieces_find(&cells->pieces, v) >= 0) continue;
        for (int i = 0; i < 4; i++) cells->left[side[i]] = 4 * cells->n_complete + i;
        cells->n_complete++;
    }
    return QC_OK;
}

static void join_complete(const qc__ports *p, qc__cells *cells) {
    for (int32_t port = 0; port < p->n; port++) {
        const int32_t side = cells->left[port];
        if (side < 0) continue;
        cells->corner[side] = p->vertex[port];
        cells->across[side] = cells->left[p->mate[port]];
        if ((side & 3) == 0) cells->face[side / 4] = p->face[port];
    }
}

qc_status qc__cells_create(qc_ctx *ctx, const qc__ports *ports, qc__cells *out) {
    const bool open = ports->lattice->open;
    qc__cells cells = {.pieces = {.ports = ports}};
    qc_status status = open ? qc__open_pieces(ctx, ports, &cells.pieces) : QC_OK;
    const int32_t n_open = cells.pieces.n;
    if (status == QC_OK) {
        cells.left = QC__NEW(ctx, int32_t, ports->n);
        status = cells.left ? collect(ctx, ports, &cells) : QC_ERR_NOMEM;
    }
    if (status == QC_OK && (int64_t)cells.n_complete + n_open > INT32_MAX / 4)
        status = qc__fail(ctx, QC_ERR_FAILED, -1, "too many quads; try a coarser density");
    if (status == QC_OK) {
        cells.n = cells.n_complete + n_open;
        cells.corner = QC__NEW(ctx, int32_t, 4 * (int64_t)cells.n);
        cells.across = QC__NEW(ctx, int32_t, 4 * (int64_t)cells.n);
        cells.face = QC__NEW(ctx, int32_t, cells.n);
        cells.keep = QC__NEW(ctx, uint8_t, cells.n);
        status = cells.corner && cells.across && cells.face && cells.keep ? QC_OK : QC_ERR_NOMEM;
    }
    if (status == QC_OK) {
        memset(cells.keep, 1, (size_t)cells.n);
        join_complete(ports, &cells);
        if (open) status = qc__open_cells(ctx, ports, &cells);
    }
    if (status == QC_OK)
        *out = cells;
    else
        qc__cells_free(&cells);
    return status;
}

void qc__cells_free(qc__cells *cells) {
    qc__free(cells->corner);
    qc__free(cells->across);
    qc__free(cells->face);
    qc__free(cells->left);
    qc__free(cells->keep);
    qc__free(cells->rim_pole);
    qc__free(cells->contact_first);
    qc__free(cells->contact);
    qc__pieces_free(&cells->pieces);
    *cells = (qc__cells){0};
}
