/* Corners of kept and open cells at the vertices on the rim of the quads, as compressed rows. */
#include "sdk/map/extract/rim.h"

/* moved[v]: outside the surface, or on the rim inside it; at[id]: vertex there, -2 = several. */
static void find_rim(const qc__rim *r, int32_t n_lattice, uint8_t *moved, int32_t *at) {
    const qc__cells *c = r->cells;
    const qc__lattice *lattice = c->pieces.ports->lattice;
    for (int32_t v = 0; v < r->q->n_vertices; v++) moved[v] = v >= n_lattice;
    for (int32_t id = 0; id < lattice->n; id++) at[id] = -1;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (r->vertex[a] < 0) continue;
        if (c->across[a] < 0) moved[r->vertex[a]] = moved[r->vertex[qc__side_end(a)]] = 1;
        if (c->corner[a] < 0) continue;
        int32_t *v = &at[c->corner[a]];
        *v = *v == -1 || *v == r->vertex[a] ? r->vertex[a] : -2;
    }
    for (int32_t a = 0; c->rim_pole && a < 4 * c->n; a++)
        if (c->rim_pole[a] >= 0) moved[r->vertex[a]] = moved[r->vertex[qc__side_end(a)]] = 0;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        const int32_t v = r->vertex[a], id = c->corner[a];
        if (v >= 0 && id >= 0 && (at[id] == -2 || qc__lattice_on_boundary(lattice, id)))
            moved[v] = 0;
    }
}

/* The vertex of corner a, also in dropped cells; -1 = none which is moved. */
static int32_t vertex_at(const qc__rim *r, const uint8_t *moved, const int32_t *at, int32_t a) {
    const int32_t id = r->cells->corner[a];
    const int32_t v = r->vertex[a] >= 0 ? r->vertex[a] : id >= 0 ? at[id] : -1;
    return v >= 0 && moved[v] ? v : -1;
}

/* Rows of the corners from `begin` on; kept = of kept cells only. first has two more than rows. */
static qc_status rows(qc_ctx *ctx, const qc__rim *r, const uint8_t *moved, const int32_t *at,
                      int32_t begin, bool kept, int32_t *first, int32_t **out) {
    const int32_t n = r->q->n_vertices;
    for (int32_t i = 0; i < n + 2; i++) first[i] = 0;
    for (int32_t a = begin; a < 4 * r->cells->n; a++) {
        const int32_t v = kept && r->vertex[a] < 0 ? -1 : vertex_at(r, moved, at, a);
        if (v >= 0) first[v + 2]++;
    }
    for (int32_t i = 0; i <= n; i++) first[i + 1] += first[i];
    *out = QC__NEW(ctx, int32_t, first[n + 1]);
    if (!*out) return QC_ERR_NOMEM;
    for (int32_t a = begin; a < 4 * r->cells->n; a++) {
        const int32_t v = kept && r->vertex[a] < 0 ? -1 : vertex_at(r, moved, at, a);
        if (v >= 0) (*out)[first[v + 1]++] = a;
    }
    return QC_OK;
}

qc_status qc__rim_create(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                         int32_t n_lattice, qc_polygon_mesh *q, qc__rim *out) {
    const qc__lattice *lattice = cells->pieces.ports->lattice;
    qc__rim r = {.cells = cells, .g = lattice->g, .vertex = vertex, .q = q};
    uint8_t *moved = QC__NEW(ctx, uint8_t, q->n_vertices);
    int32_t *at = QC__NEW(ctx, int32_t, lattice->n);
    r.kept_first = QC__NEW(ctx, int32_t, (int64_t)q->n_vertices + 2);
    r.open_first = QC__NEW(ctx, int32_t, (int64_t)q->n_vertices + 2);
    r.placed = QC__NEW(ctx, uint8_t, q->n_vertices);
    qc_status status =
        moved && at && r.kept_first && r.open_first && r.placed ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        find_rim(&r, n_lattice, moved, at);
        status = rows(ctx, &r, moved, at, 0, true, r.kept_first, &r.kept);
    }
    if (status == QC_OK)
        status = rows(ctx, &r, moved, at, 4 * cells->n_complete, false, r.open_first, &r.open);
    for (int32_t v = 0; status == QC_OK && v < q->n_vertices; v++) r.placed[v] = v < n_lattice;
    qc__free(moved);
    qc__free(at);
    if (status == QC_OK)
        *out = r;
    else
        qc__rim_free(&r);
    return status;
}

void qc__rim_free(qc__rim *r) {
    qc__free(r->kept_first);
    qc__free(r->kept);
    qc__free(r->open_first);
    qc__free(r->open);
    qc__free(r->placed);
    *r = (qc__rim){0};
}
