/* Vertices of the quads: classes of cell corners which are shared across sides, so that cells which
 * only meet at a lattice point get a vertex for each fan. */
#include "sdk/map/extract/internal.h"
#include "sdk/mesh/internal.h"

/* id[root] = lowest lattice vertex of the class, -1 = none; -2 elsewhere. */
static void unite_corners(const qc__cells *c, int32_t *set, int32_t *id) {
    qc__sets_init(set, 4 * c->n);
    for (int32_t a = 0; a < 4 * c->n; a++) {
        const int32_t b = c->keep[a / 4] ? c->across[a] : -1;
        id[a] = -2;
        if (b < a) continue;
        qc__sets_unite(set, a, qc__side_end(b));
        qc__sets_unite(set, b, qc__side_end(a));
    }
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (!c->keep[a / 4]) continue;
        int32_t *lowest = &id[qc__sets_find(set, a)];
        if (*lowest < 0 || (c->corner[a] >= 0 && c->corner[a] < *lowest)) *lowest = c->corner[a];
    }
}

/* Numbers the classes by their lattice vertices, then by their first corner. next: 4 n. */
static int32_t number(const qc__cells *c, const int32_t *id, int32_t n_lattice_points,
                      int32_t *head, int32_t *next, int32_t *vertex, int32_t *n_lattice) {
    int32_t n = 0;
    for (int32_t i = 0; i < n_lattice_points; i++) head[i] = -1;
    for (int32_t a = 4 * c->n - 1; a >= 0; a--) {
        if (id[a] < 0) continue;
        next[a] = head[id[a]];
        head[id[a]] = a;
    }
    for (int32_t i = 0; i < n_lattice_points; i++)
        for (int32_t a = head[i]; a >= 0; a = next[a]) vertex[a] = n++;
    *n_lattice = n;
    for (int32_t a = 0; a < 4 * c->n; a++)
        if (id[a] == -1) vertex[a] = n++;
    return n;
}

qc_status qc__quad_vertices(qc_ctx *ctx, const qc__ports *ports, const qc__cells *c,
                            int32_t *vertex, int32_t *n_lattice, int32_t *n_vertices) {
    const int64_t n = 4 * (int64_t)c->n;
    int32_t *set = QC__NEW(ctx, int32_t, n), *id = QC__NEW(ctx, int32_t, n);
    int32_t *next = QC__NEW(ctx, int32_t, n), *head = QC__NEW(ctx, int32_t, ports->lattice->n);
    const qc_status status = set && id && next && head ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        unite_corners(c, set, id);
        *n_vertices = number(c, id, ports->lattice->n, head, next, vertex, n_lattice);
        for (int32_t a = 0; a < n; a++)
            if (c->keep[a / 4])
                vertex[a] = vertex[qc__sets_find(set, a)];
            else
                vertex[a] = -1;
    }
    qc__free(set);
    qc__free(id);
    qc__free(next);
    qc__free(head);
    return status;
}
