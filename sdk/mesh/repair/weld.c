/* Repair step 2: vertices with exactly equal coordinates become one.
 *
 * In a soup of separate faces (STL) all of them do. In a mesh with connectivity only coinciding
 * boundary edges are glued, where exactly two meet: sheets which merely touch stay apart, and the
 * glueing cannot make an edge or a vertex non-manifold which joined its faces before. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

static uint64_t hash_point(const double p[3]) {
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        h = (h ^ qc__sort_key(p[k])) * UINT64_C(0x9e3779b97f4a7c15);
        h ^= h >> 29;
    }
    return h;
}

/* uses[v]: number of faces at v. */
static void count_uses(const qc__repair *r, int32_t *uses) {
    memset(uses, 0, (size_t)r->n_vertices * sizeof *uses);
    for (int32_t c = 0; c < 3 * r->n_faces; c++) uses[r->triangle[c]]++;
}

/* place[v]: the lowest used vertex at the coordinates of v; vertices without faces stay alone. */
static qc_status find_places(const qc__repair *r, const int32_t *uses, int32_t *place) {
    size_t size = 16;
    while (size < 2 * (size_t)r->n_vertices) size *= 2;
    int32_t *slot = QC__NEW(r->ctx, int32_t, size);
    if (!slot) return QC_ERR_NOMEM;
    memset(slot, 0xff, size * sizeof *slot);
    for (int32_t v = 0; v < r->n_vertices; v++) {
        place[v] = v;
        if (!uses[v]) continue;
        const double *p = qc__repair_point(r, v);
        size_t i = (size_t)hash_point(p) & (size - 1);
        for (; slot[i] >= 0; i = (i + 1) & (size - 1)) {
            const double *q = qc__repair_point(r, slot[i]);
            if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) break;
        }
        if (slot[i] < 0) slot[i] = v;
        place[v] = slot[i];
    }
    qc__free(slot);
    return QC_OK;
}

/* Most vertices belong to a single face: there is no connectivity to respect. */
static bool is_loose(const qc__repair *r, const int32_t *uses) {
    int64_t used = 0, single = 0;
    for (int32_t v = 0; v < r->n_vertices; v++) {
        used += uses[v] > 0;
        single += uses[v] == 1;
    }
    return 2 * single > used;
}

/* Faces which cover each other are two sides of a sheet, not neighbours. */
static bool faces_fold_over(const qc__repair *r, const int32_t *place, int32_t h, int32_t g) {
    return place[r->triangle[h]] == place[r->triangle[g]];
}

/* Unites the ends of boundary edges at the same two places, where exactly two edges are. */
static qc_status glue_boundary(qc__repair *r, const int32_t *place, const qc__edge_groups *edges,
                               int32_t *parent) {
    int32_t n = 0;
    for (int32_t i = 0; i < edges->n; i++) n += edges->start[i + 1] - edges->start[i] == 1;
    int32_t *side = QC__NEW(r->ctx, int32_t, n), *lo = QC__NEW(r->ctx, int32_t, n);
    int32_t *hi = QC__NEW(r->ctx, int32_t, n), *order = QC__NEW(r->ctx, int32_t, n);
    qc_status status = side && lo && hi && order ? QC_OK : QC_ERR_NOMEM;
    n = 0;
    for (int32_t i = 0; status == QC_OK && i < edges->n; i++) {
        if (edges->start[i + 1] - edges->start[i] != 1) continue;
        int32_t h = edges->order[edges->start[i]];
        int32_t a = place[r->triangle[qc_next(h)]], b = place[r->triangle[qc_prev(h)]];
        side[n] = h;
        lo[n] = a < b ? a : b;
        hi[n++] = a < b ? b : a;
    }
    if (status == QC_OK) status = qc__sort_pairs(r->ctx, r->n_vertices, n, lo, hi, order);
    for (int32_t i = 0, end; status == QC_OK && i < n; i = end) {
        int32_t a = lo[order[i]], b = hi[order[i]];
        for (end = i + 1; end < n && lo[order[end]] == a && hi[order[end]] == b; end++) {}
        if (end - i != 2 || a == b) continue;
        int32_t h = side[order[i]], g = side[order[i + 1]];
        if (faces_fold_over(r, place, h, g)) continue;
        int32_t hs = r->triangle[qc_next(h)], he = r->triangle[qc_prev(h)];
        int32_t gs = r->triangle[qc_next(g)], ge = r->triangle[qc_prev(g)];
        bool same = place[hs] == place[gs];
        qc__sets_unite(parent, hs, same ? gs : ge);
        qc__sets_unite(parent, he, same ? ge : gs);
    }
    qc__free(side);
    qc__free(lo);
    qc__free(hi);
    qc__free(order);
    return status;
}

static void apply(qc__repair *r, int32_t *parent) {
    for (int32_t v = 0; v < r->n_vertices; v++) {
        if (qc__sets_find(parent, v) == v) continue;
        r->merged[v] = 1;
        qc__repair_note(r, QC_REPAIR_WELDED, v);
    }
    for (int32_t c = 0; c < 3 * r->n_faces; c++)
        r->triangle[c] = qc__sets_find(parent, r->triangle[c]);
}

qc_status qc__repair_weld(qc__repair *r) {
    qc__edge_groups edges = {0};
    int32_t *uses = QC__NEW(r->ctx, int32_t, r->n_vertices);
    int32_t *place = QC__NEW(r->ctx, int32_t, r->n_vertices);
    int32_t *parent = QC__NEW(r->ctx, int32_t, r->n_vertices);
    qc_status status = uses && place && parent ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        count_uses(r, uses);
        qc__sets_init(parent, r->n_vertices);
        status = find_places(r, uses, place);
    }
    if (status == QC_OK && is_loose(r, uses)) {
        for (int32_t v = 0; v < r->n_vertices; v++) qc__sets_unite(parent, v, place[v]);
    } else if (status == QC_OK) {
        status = qc__edge_groups_create(r->ctx, r->n_vertices, r->n_faces, r->triangle, &edges);
        if (status == QC_OK) status = glue_boundary(r, place, &edges, parent);
    }
    if (status == QC_OK) apply(r, parent);
    qc__edge_groups_free(&edges);
    qc__free(uses);
    qc__free(place);
    qc__free(parent);
    return status;
}
