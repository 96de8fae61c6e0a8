/* Repair step 1: polygons become triangles; corners which repeat their predecessor are left out. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

static void polygon_free(qc__polygon *p) {
    qc__free(p->vertex);
    qc__free(p->point);
    qc__free(p->triangles);
    qc__free(p->ring);
    qc__free(p->flat);
}

static qc_status polygon_create(qc_ctx *ctx, int32_t n, qc__edge_set *taken, qc__polygon *p) {
    p->vertex = QC__NEW(ctx, int32_t, n);
    p->point = QC__NEW(ctx, double, 3 * (size_t)n);
    p->triangles = QC__NEW(ctx, int32_t, 3 * (size_t)n);
    p->ring = QC__NEW(ctx, int32_t, n);
    p->flat = QC__NEW(ctx, double, 2 * (size_t)n);
    p->taken = taken;
    return p->vertex && p->point && p->triangles && p->ring && p->flat ? QC_OK : QC_ERR_NOMEM;
}

/* All sides of the polygons, with room for their diagonals. */
static qc_status take_sides(qc_ctx *ctx, const qc_polygon_mesh *s, int64_t n_triangles,
                            qc__edge_set *taken) {
    qc_status status = qc__edge_set_create(ctx, s->n_corners + n_triangles, taken);
    for (int32_t f = 0; status == QC_OK && f < s->n_faces; f++)
        for (int32_t c = s->face_offset[f]; c < s->face_offset[f + 1]; c++) {
            int32_t next = c + 1 < s->face_offset[f + 1] ? c + 1 : s->face_offset[f];
            qc__edge_set_add(taken, s->face_vertex[c], s->face_vertex[next]);
        }
    return status;
}

static int32_t distinct_corners(const qc_polygon_mesh *s, int32_t f, int32_t *corner) {
    int32_t n = 0;
    for (int32_t c = s->face_offset[f]; c < s->face_offset[f + 1]; c++)
        if (n == 0 || s->face_vertex[c] != corner[n - 1]) corner[n++] = s->face_vertex[c];
    while (n > 1 && corner[0] == corner[n - 1]) n--;
    return n;
}

static void add_triangle(qc__repair *r, int32_t a, int32_t b, int32_t c, int32_t face) {
    int32_t *t = r->triangle + 3 * (size_t)r->n_faces;
    t[0] = a, t[1] = b, t[2] = c;
    r->source_face[r->n_faces++] = face;
}

static void add_polygon(qc__repair *r, int32_t f, qc__polygon *p) {
    for (int32_t i = 0; i < p->n; i++)
        memcpy(p->point + 3 * (size_t)i, r->soup->position + 3 * (size_t)p->vertex[i],
               3 * sizeof(double));
    qc__triangulate_polygon(p);
    for (int32_t i = 0; i < p->n - 2; i++) {
        const int32_t *t = p->triangles + 3 * (size_t)i;
        add_triangle(r, p->vertex[t[0]], p->vertex[t[1]], p->vertex[t[2]], f);
    }
}

static qc_status add_faces(qc__repair *r, qc__polygon *p) {
    const qc_polygon_mesh *s = r->soup;
    for (int32_t f = 0; f < s->n_faces; f++) {
        p->n = distinct_corners(s, f, p->vertex);
        if (s->face_offset[f + 1] - s->face_offset[f] > 3)
            qc__repair_note(r, QC_REPAIR_TRIANGULATED, f);
        if (p->n < 3)
            qc__repair_note(r, QC_REPAIR_DEGENERATE, f);
        else if (p->n == 3)
            add_triangle(r, p->vertex[0], p->vertex[1], p->vertex[2], f);
        else
            add_polygon(r, f, p);
        if ((f % 4096 == 0 || p->n > 64) && !qc__progress(r->ctx, 0.1 * f / s->n_faces))
            return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

qc_status qc__repair_triangulate(qc__repair *r) {
    const qc_polygon_mesh *s = r->soup;
    qc__polygon polygon = {0};
    qc__edge_set taken = {0};
    int32_t longest = 3;
    int64_t n_triangles = 0;
    for (int32_t f = 0; f < s->n_faces; f++) {
        int32_t n = s->face_offset[f + 1] - s->face_offset[f];
        if (n > longest) longest = n;
        n_triangles += n > 2 ? n - 2 : 1;
    }
    r->triangle = QC__NEW(r->ctx, int32_t, 3 * (size_t)n_triangles);
    r->source_face = QC__NEW(r->ctx, int32_t, (size_t)n_triangles);
    qc_status status = r->triangle && r->source_face ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = polygon_create(r->ctx, longest, &taken, &polygon);
    if (status == QC_OK && longest > 3) status = take_sides(r->ctx, s, n_triangles, &taken);
    if (status == QC_OK) status = add_faces(r, &polygon);
    polygon_free(&polygon);
    qc__free(taken.slot);
    return status;
}
