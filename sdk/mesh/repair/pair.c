/* Repair step 5: pairs the halfedges of each edge. Of three or more faces at an edge the best fitting
 * pairs stay connected (consistent orientation, then the smallest dihedral deviation, then the convex
 * side, so that solids touching in an edge come apart); the rest is cut open. */
#include <math.h>

#include "sdk/mesh/repair/internal.h"

enum { MOST_FACES = 32 }; /* an edge with more faces than this is cut open altogether               */

static void face_normal(const qc__repair *r, int32_t face, double n[3]) {
    const int32_t *t = r->triangle + 3 * (size_t)face;
    const double *a = qc__repair_point(r, t[0]), *b = qc__repair_point(r, t[1]);
    const double *c = qc__repair_point(r, t[2]);
    double length = 0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        length += n[k] * n[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) n[k] = length > 0 ? n[k] / length : 0;
}

static bool opposite(const qc__repair *r, int32_t h, int32_t g) {
    return r->triangle[qc_next(h)] == r->triangle[qc_prev(g)];
}

/* Fit of two faces at a common edge; more is better. */
static double fit(const qc__repair *r, int32_t h, int32_t g) {
    double m[3], n[3], cosine = 0, side = 0;
    bool consistent = opposite(r, h, g);
    face_normal(r, h / 3, m);
    face_normal(r, g / 3, n);
    const double *a = qc__repair_point(r, r->triangle[qc_next(h)]);
    const double *apex = qc__repair_point(r, r->triangle[g]);
    for (int k = 0; k < 3; k++) {
        cosine += m[k] * n[k];
        side += m[k] * (apex[k] - a[k]);
    }
    if (!consistent) cosine = -cosine;
    return (consistent ? 4 : 0) + cosine + (side < 0 ? 1e-9 : 0);
}

static void pair_best(qc__repair *r, const int32_t *side, int32_t n) {
    double score[MOST_FACES][MOST_FACES];
    if (n > MOST_FACES) return;
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < i; j++) score[i][j] = fit(r, side[j], side[i]);
    for (bool first = true;; first = false) {
        int32_t bi = -1, bj = -1;
        for (int32_t i = 0; i < n; i++)
            for (int32_t j = 0; j < i; j++) {
                if (r->twin[side[i]] >= 0 || r->twin[side[j]] >= 0) continue;
                if (bi < 0 || score[i][j] > score[bi][bj]) bi = i, bj = j;
            }
        if (bi < 0 || (!first && !opposite(r, side[bi], side[bj]))) return;
        r->twin[side[bi]] = side[bj];
        r->twin[side[bj]] = side[bi];
    }
}

qc_status qc__repair_pair(qc__repair *r) {
    qc__edge_groups edges;
    r->twin = QC__NEW(r->ctx, int32_t, 3 * (size_t)r->n_faces);
    r->cut = QC__ZERO(r->ctx, uint8_t, r->n_vertices);
    if (!r->twin || !r->cut) return QC_ERR_NOMEM;
    qc_status status =
        qc__edge_groups_create(r->ctx, r->n_vertices, r->n_faces, r->triangle, &edges);
    if (status != QC_OK) return status;
    for (int32_t h = 0; h < 3 * r->n_faces; h++) r->twin[h] = -1;
    for (int32_t i = 0; i < edges.n; i++) {
        const int32_t *side = edges.order + edges.start[i];
        int32_t n = edges.start[i + 1] - edges.start[i];
        if (n == 2) {
            r->twin[side[0]] = side[1];
            r->twin[side[1]] = side[0];
        } else if (n > 2) {
            qc__repair_note(r, QC_REPAIR_NON_MANIFOLD_EDGE, r->source_face[side[0] / 3]);
            r->cut[r->triangle[qc_next(side[0])]] = 1;
            r->cut[r->triangle[qc_prev(side[0])]] = 1;
            pair_best(r, side, n);
        }
    }
    qc__edge_groups_free(&edges);
    return QC_OK;
}
