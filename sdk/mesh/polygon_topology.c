/* Combinatorial check of a polygon mesh. Sides of faces are grouped by their end points; a group of
 * one side is a boundary edge, of two sides an interior edge, of more a non-manifold edge.
 * Degenerate sides (a vertex twice in a row) form no edge. Euler number: referenced vertices -
 * edges + faces. An edge counts as inconsistent when its only two faces run through it in the same
 * direction. */
#include <string.h>

#include "sdk/mesh/internal.h"

static qc_status check_arrays(qc_ctx *ctx, const qc_polygon_mesh *p) {
    if (p->n_faces > 0 && (p->face_offset[0] != 0 || p->face_offset[p->n_faces] != p->n_corners))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "face_offset does not run from 0 to n_corners");
    for (int32_t f = 0; f < p->n_faces; f++) {
        if (p->face_offset[f] > p->face_offset[f + 1])
            return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face_offset decreases at face %d", (int)f);
        for (int32_t c = p->face_offset[f]; c < p->face_offset[f + 1]; c++)
            if (p->face_vertex[c] < 0 || p->face_vertex[c] >= p->n_vertices)
                return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face %d has vertex %d, valid are 0 to %d",
                                (int)f, (int)p->face_vertex[c], (int)p->n_vertices - 1);
    }
    return QC_OK;
}

void qc__sides_free(qc__sides *s) {
    qc__free(s->next);
    qc__free(s->face);
    qc__free(s->order);
    qc__free(s->group);
}

qc_status qc__sides_create(qc_ctx *ctx, const qc_polygon_mesh *p, qc__sides *s) {
    s->n = p->n_corners;
    s->next = QC__NEW(ctx, int32_t, s->n);
    s->face = QC__NEW(ctx, int32_t, s->n);
    s->order = QC__NEW(ctx, int32_t, s->n);
    s->group = QC__NEW(ctx, int32_t, (size_t)s->n + 1);
    int32_t *lo = QC__NEW(ctx, int32_t, s->n), *hi = QC__NEW(ctx, int32_t, s->n);
    qc_status status =
        s->next && s->face && s->order && s->group && lo && hi ? QC_OK : QC_ERR_NOMEM;
    for (int32_t f = 0; status == QC_OK && f < p->n_faces; f++) {
        for (int32_t c = p->face_offset[f]; c < p->face_offset[f + 1]; c++) {
            s->face[c] = f;
            s->next[c] = c + 1 < p->face_offset[f + 1] ? c + 1 : p->face_offset[f];
            int32_t a = p->face_vertex[c], b = p->face_vertex[s->next[c]];
            lo[c] = a < b ? a : b;
            hi[c] = a < b ? b : a;
        }
    }
    if (status == QC_OK) status = qc__sort_pairs(ctx, p->n_vertices, s->n, lo, hi, s->order);
    for (int32_t i = 0; status == QC_OK && i < s->n; i++) {
        int32_t c = s->order[i], before = i > 0 ? s->order[i - 1] : -1;
        bool same = before >= 0 && lo[c] == lo[before] && hi[c] == hi[before];
        if (!same) s->group[s->n_groups++] = i;
    }
    if (status == QC_OK) s->group[s->n_groups] = s->n;
    qc__free(lo);
    qc__free(hi);
    return status;
}

static bool is_side(const qc_polygon_mesh *p, const qc__sides *s, int32_t c) {
    return p->face_vertex[c] != p->face_vertex[s->next[c]];
}

/* Counts edges and edge defects. */
static int32_t count_edges(const qc_polygon_mesh *p, const qc__sides *s, qc_polygon_topology *out,
                           int32_t *first_non_manifold, int32_t *first_inconsistent) {
    int32_t edges = 0;
    for (int32_t g = 0; g < s->n_groups; g++) {
        int32_t begin = s->group[g], n = s->group[g + 1] - begin, c = s->order[begin];
        if (!is_side(p, s, c)) continue;
        edges++;
        if (n > 2) {
            if (out->non_manifold_edges++ == 0) *first_non_manifold = s->face[s->order[begin + 2]];
        } else if (n == 2 && p->face_vertex[c] == p->face_vertex[s->order[begin + 1]]) {
            if (out->inconsistent_edges++ == 0) *first_inconsistent = s->face[s->order[begin + 1]];
        }
    }
    return edges;
}

/* Faces: components (joined by common vertices), shapes. */
static qc_status count_faces(qc_ctx *ctx, const qc_polygon_mesh *p, qc_polygon_topology *out,
                             int32_t *first_degenerate, int32_t *first_unreferenced,
                             int32_t *referenced) {
    int32_t *set = QC__NEW(ctx, int32_t, p->n_vertices);
    int32_t *seen = QC__NEW(ctx, int32_t, p->n_vertices); /* last face + 1 which has the vertex */
    if (!set || !seen) {
        qc__free(set);
        qc__free(seen);
        return QC_ERR_NOMEM;
    }
    qc__sets_init(set, p->n_vertices);
    if (p->n_vertices > 0) memset(seen, 0, (size_t)p->n_vertices * sizeof *seen);
    for (int32_t f = 0; f < p->n_faces; f++) {
        int32_t begin = p->face_offset[f], n = p->face_offset[f + 1] - begin;
        bool degenerate = n < 3;
        for (int32_t c = begin; c < begin + n; c++) {
            int32_t v = p->face_vertex[c];
            degenerate = degenerate || seen[v] == f + 1;
            seen[v] = f + 1;
            qc__sets_unite(set, p->face_vertex[begin], v);
        }
        out->non_quads += n != 4;
        if (degenerate && out->degenerate_faces++ == 0) *first_degenerate = f;
    }
    for (int32_t v = 0; v < p->n_vertices; v++) {
        if (!seen[v] && out->unreferenced_vertices++ == 0) *first_unreferenced = v;
        if (seen[v]) ++*referenced;
        out->components += seen[v] && set[v] == v;
    }
    qc__free(set);
    qc__free(seen);
    return QC_OK;
}

enum { EDGE, VERTEX, INCONSISTENT, DUPLICATE, DEGENERATE, UNREFERENCED, DEFECTS };

static qc_status check(qc_ctx *ctx, const qc_polygon_mesh *p, const qc__sides *s,
                       qc_polygon_topology *out) {
    int32_t first[DEFECTS] = {-1, -1, -1, -1, -1, -1}, referenced = 0;
    int32_t edges = count_edges(p, s, out, &first[EDGE], &first[INCONSISTENT]);
    qc_status status =
        count_faces(ctx, p, out, &first[DEGENERATE], &first[UNREFERENCED], &referenced);
    if (status == QC_OK)
        status = qc__polygon_duplicates(ctx, p, &out->duplicate_faces, &first[DUPLICATE]);
    if (status == QC_OK) status = qc__polygon_vertices(ctx, p, s, out, &first[VERTEX]);
    out->euler = referenced - edges + p->n_faces;
    for (int i = DEFECTS - 1; i >= 0; i--)
        if (first[i] >= 0) out->first_bad_element = first[i];
    return status;
}

qc_status qc_polygon_mesh_topology(qc_ctx *ctx, const qc_polygon_mesh *mesh,
                                   qc_polygon_topology *out) {
    qc_polygon_topology result = {0};
    result.first_bad_element = -1;
    qc__sides sides = {0};
    qc_status status = check_arrays(ctx, mesh);
    if (status == QC_OK) status = qc__sides_create(ctx, mesh, &sides);
    if (status == QC_OK) status = check(ctx, mesh, &sides, &result);
    if (status == QC_OK) *out = result;
    qc__sides_free(&sides);
    return status;
}
