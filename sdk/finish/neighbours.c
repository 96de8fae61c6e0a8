/* Corners at each vertex of a quad mesh, and a greedy colouring of the vertices: vertices of one
 * class share no face, so that they can be moved at the same time. */
#include "sdk/finish/internal.h"

static void sort_corners(const qc_polygon_mesh *q, int32_t *start, int32_t *corner) {
    for (int32_t c = 0; c < q->n_corners; c++) start[q->face_vertex[c] + 1]++;
    for (int32_t v = 0; v < q->n_vertices; v++) start[v + 1] += start[v];
    for (int32_t c = q->n_corners; c-- > 0;) corner[--start[q->face_vertex[c] + 1]] = c;
    for (int32_t v = 0; v < q->n_vertices; v++) start[v] = start[v + 1];
    start[q->n_vertices] = q->n_corners;
}

/* The lowest class which no vertex with a lower number in a common face has. The last class takes
 * what is left: its members are moved one after the other. */
static int32_t lowest_class(const qc_polygon_mesh *q, const qc__neighbours *n, int32_t v,
                            const int8_t *colour) {
    uint64_t used = 0;
    for (int32_t i = n->face_start[v]; i < n->face_start[v + 1]; i++)
        for (int k = 0; k < 4; k++) {
            const int32_t w = q->face_vertex[(n->face[i] & ~3) + k];
            if (w < v) used |= (uint64_t)1 << colour[w];
        }
    int32_t c = 0;
    while (c < QC__CLASSES - 1 && (used >> c & 1)) c++;
    return c;
}

static qc_status classify(qc_ctx *ctx, const qc_polygon_mesh *q, qc__neighbours *n) {
    int8_t *colour = QC__NEW(ctx, int8_t, q->n_vertices);
    if (!colour) return QC_ERR_NOMEM;
    int32_t next[QC__CLASSES + 1] = {0};
    for (int32_t v = 0; v < q->n_vertices; v++) {
        const int32_t c = lowest_class(q, n, v, colour);
        colour[v] = (int8_t)c;
        next[c + 1]++;
        if (c >= n->n_classes) n->n_classes = c + 1;
    }
    n->class_start = QC__NEW(ctx, int32_t, (int64_t)n->n_classes + 1);
    if (n->class_start) {
        for (int32_t c = 0; c < n->n_classes; c++) next[c + 1] += next[c];
        for (int32_t c = 0; c <= n->n_classes; c++) n->class_start[c] = next[c];
        for (int32_t v = 0; v < q->n_vertices; v++) n->vertex[next[colour[v]]++] = v;
    }
    qc__free(colour);
    return n->class_start ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__neighbours_create(qc_ctx *ctx, const qc_polygon_mesh *q, qc__neighbours *out) {
    qc__neighbours n = {NULL, NULL, 0, NULL, NULL};
    n.face_start = QC__ZERO(ctx, int32_t, (int64_t)q->n_vertices + 1);
    n.face = QC__NEW(ctx, int32_t, q->n_corners);
    n.vertex = QC__NEW(ctx, int32_t, q->n_vertices);
    qc_status status = n.face_start && n.face && n.vertex ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        sort_corners(q, n.face_start, n.face);
        status = classify(ctx, q, &n);
    }
    if (status == QC_OK)
        *out = n;
    else
        qc__neighbours_clear(&n);
    return status;
}

void qc__neighbours_clear(qc__neighbours *n) {
    qc__free(n->face_start);
    qc__free(n->face);
    qc__free(n->class_start);
    qc__free(n->vertex);
    *n = (qc__neighbours){NULL, NULL, 0, NULL, NULL};
}
