/* Imprint: the common refinement of the mesh and its coarse complex, on which the map of
 * quantization is affine on every face, hence injective (docs/theory/quantization.md). */
#include "sdk/map/quantize/imprinter.h"

typedef qc__imprinter imprinter;

static void place_vertices(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    for (int32_t e = 0; e < m->n_edges; e++)
        for (int32_t i = q->edge_start[e]; i < q->edge_start[e + 1]; i++) {
            const int32_t v = q->vertex[i];
            if (v < m->n_vertices) continue;
            const double *a = m->position + 3 * (int64_t)m->edge_vertex[2 * (int64_t)e];
            const double *b = m->position + 3 * (int64_t)m->edge_vertex[2 * (int64_t)e + 1];
            for (int j = 0; j < 3; j++)
                q->refiner.position[3 * (int64_t)v + j] = a[j] + q->share[i] * (b[j] - a[j]);
            q->refiner.source_vertex[v] = -1;
        }
}

static int32_t count_faces(const imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    int32_t n = m->n_faces;
    for (int32_t e = 0; e < m->n_edges; e++)
        n += (q->edge_start[e + 1] - q->edge_start[e]) *
             (m->edge_halfedge[2 * (int64_t)e + 1] < 0 ? 1 : 2);
    return n;
}

static qc_status prepare(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    q->edge_start = QC__NEW(q->ctx, int32_t, m->n_edges + 1);
    q->edge = QC__NEW(q->ctx, qc_complex, 3 * (int64_t)m->n_faces);
    if (!q->edge_start || !q->edge) return QC_ERR_NOMEM;
    qc_status status = qc_tangent_edges(q->ctx, m, q->edge);
    if (status != QC_OK) return status;
    qc__find_crossings(q);
    status = qc__poll(q->ctx);
    if (status != QC_OK) return status;
    const int32_t n = q->edge_start[m->n_edges];
    q->share = QC__NEW(q->ctx, double, n);
    q->place = QC__NEW(q->ctx, double, 2 * (int64_t)n);
    q->vertex = QC__NEW(q->ctx, int32_t, n);
    if (!q->share || !q->place || !q->vertex) return QC_ERR_NOMEM;
    qc__find_crossings(q);
    const int32_t n_faces = count_faces(q);
    q->uv = QC__NEW(q->ctx, double, 6 * (int64_t)n_faces);
    q->weight = QC__NEW(q->ctx, double, 9 * (int64_t)n_faces);
    if (!q->uv || !q->weight) return QC_ERR_NOMEM;
    status = qc__poll(q->ctx);
    if (status == QC_OK)
        status = qc__refiner_create(q->ctx, m, q->n_vertices, n_faces, &q->refiner);
    if (status == QC_OK) place_vertices(q);
    return status;
}

static qc_status cut_faces(imprinter *q) {
    for (int32_t t = 0; t < q->map->mesh->n_faces; t++) {
        if (t % 4096 == 0 && !qc__progress(q->ctx, (double)t / q->map->mesh->n_faces))
            return QC_ERR_CANCELLED;
        if (qc__cut_face(q, t)) continue;
        if (q->short_of_memory) return QC_ERR_NOMEM;
        return qc__fail(q->ctx, QC_ERR_FAILED, t, "face %d is not cut along chords", (int)t);
    }
    return QC_OK;
}

void qc__imprint_free(qc__imprint *imprint) {
    qc_object_release(imprint->mesh);
    void *const blocks[] = {imprint->uv,     imprint->rotation, imprint->axis,
                            imprint->parent, imprint->weight,   imprint->turn};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    *imprint = (qc__imprint){0};
}

/* Parts of an edge inherit its transition and its feature; chords have none. */
static qc_status publish(imprinter *q, qc__imprint *out) {
    qc__refinement made;
    qc_status status = qc__refiner_finish(q->ctx, &q->refiner, &made);
    if (status != QC_OK) return status;
    const qc__exact_map *map = q->map;
    const int32_t n = made.mesh->n_edges;
    int8_t *rotation = QC__NEW(q->ctx, int8_t, n);
    int8_t *axis = map->axis ? QC__NEW(q->ctx, int8_t, n) : NULL;
    if (!rotation || (map->axis && !axis)) {
        qc__free(rotation);
        qc__free(axis);
        qc__refinement_free(&made);
        return QC_ERR_NOMEM;
    }
    for (int32_t e = 0; e < n; e++) {
        const int32_t h = made.parent_halfedge[made.mesh->edge_halfedge[2 * (int64_t)e]];
        rotation[e] = h < 0 ? 0 : map->rotation[map->mesh->halfedge_edge[h]];
        if (axis) axis[e] = h < 0 ? -1 : map->axis[map->mesh->halfedge_edge[h]];
    }
    *out = (qc__imprint){made.mesh, q->uv, rotation, axis, made.parent, q->weight, made.turn};
    q->uv = q->weight = NULL;
    qc__free(made.parent_halfedge);
    return QC_OK;
}

qc_status qc__imprint_create(qc_ctx *ctx, const qc__exact_map *map, const qc__coarse_map *coarse,
                             const qc__point *x, qc__imprint *out) {
    imprinter q = {.ctx = ctx, .map = map, .coarse = coarse, .x = x};
    qc_status status = prepare(&q);
    if (status == QC_OK) status = cut_faces(&q);
    if (status == QC_OK) status = publish(&q, out);
    qc__refiner_free(&q.refiner);
    void *const blocks[] = {q.edge_start, q.share,  q.vertex, q.place, q.edge,
                            q.uv,         q.weight, q.node,   q.piece};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
