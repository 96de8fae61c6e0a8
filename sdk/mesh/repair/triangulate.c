/* Repair step 1: polygons become triangles; corners which repeat their predecessor are left out. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

typedef struct scratch {
    int32_t *corner, *triangles, *work;
    double *point, *flat;
} scratch;

static void scratch_free(scratch *w) {
    qc__free(w->corner);
    qc__free(w->triangles);
    qc__free(w->work);
    qc__free(w->point);
    qc__free(w->flat);
}

static qc_status scratch_create(qc_ctx *ctx, int32_t n, scratch *w) {
    w->corner = QC__NEW(ctx, int32_t, n);
    w->triangles = QC__NEW(ctx, int32_t, 3 * (size_t)n);
    w->work = QC__NEW(ctx, int32_t, n);
    w->point = QC__NEW(ctx, double, 3 * (size_t)n);
    w->flat = QC__NEW(ctx, double, 2 * (size_t)n);
    return w->corner && w->triangles && w->work && w->point && w->flat ? QC_OK : QC_ERR_NOMEM;
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

static void add_polygon(qc__repair *r, int32_t f, int32_t n, scratch *w) {
    for (int32_t i = 0; i < n; i++)
        memcpy(w->point + 3 * (size_t)i, r->soup->position + 3 * (size_t)w->corner[i],
               3 * sizeof(double));
    qc__triangulate_polygon(n, w->point, w->triangles, w->work, w->flat);
    for (int32_t i = 0; i < n - 2; i++)
        add_triangle(r, w->corner[w->triangles[3 * i]], w->corner[w->triangles[3 * i + 1]],
                     w->corner[w->triangles[3 * i + 2]], f);
}

qc_status qc__repair_triangulate(qc__repair *r) {
    const qc_polygon_mesh *s = r->soup;
    scratch w = {0};
    int32_t longest = 3;
    int64_t n_triangles = 0;
    for (int32_t f = 0; f < s->n_faces; f++) {
        int32_t n = s->face_offset[f + 1] - s->face_offset[f];
        if (n > longest) longest = n;
        n_triangles += n > 2 ? n - 2 : 1;
    }
    r->triangle = QC__NEW(r->ctx, int32_t, 3 * (size_t)n_triangles);
    r->source_face = QC__NEW(r->ctx, int32_t, (size_t)n_triangles);
    qc_status status = r->triangle && r->source_face ? scratch_create(r->ctx, longest, &w)
                                                     : QC_ERR_NOMEM;
    for (int32_t f = 0; status == QC_OK && f < s->n_faces; f++) {
        int32_t sides = s->face_offset[f + 1] - s->face_offset[f];
        int32_t n = distinct_corners(s, f, w.corner);
        if (sides > 3) qc__repair_note(r, QC_REPAIR_TRIANGULATED, f);
        if (n < 3) qc__repair_note(r, QC_REPAIR_DEGENERATE, f);
        else if (n == 3) add_triangle(r, w.corner[0], w.corner[1], w.corner[2], f);
        else add_polygon(r, f, n, &w);
        if ((f % 4096 == 0 || n > 64) && !qc__progress(r->ctx, 0.1 * f / s->n_faces))
            status = QC_ERR_CANCELLED;
    }
    scratch_free(&w);
    return status;
}
