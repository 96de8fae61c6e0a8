/* Two-sided distance between a quad mesh and the surface it was made from: sampled at the vertices,
 * edge midpoints and face centres of the quads, and at the vertices of the mesh. */
#include <math.h>

#include "sdk/map/report/report.h"

enum { CHUNK = 256, BATCH = 1 << 16 };

typedef struct query {
    const qc_closest_point *closest;
    const qc_closest_tree *tree;
    const double *point;
    double *distance;
} query;

static void run_queries(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const query *q = arg;
    int32_t nearest = 0;
    double weight[3];
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        q->distance[i] = q->closest->query(q->tree, q->point + 3 * i, &nearest, weight);
}

/* distance[i] of point i to the nearest triangle. */
static qc_status distances(qc_ctx *ctx, const qc_closest_point *closest,
                           const qc_closest_tree *tree, int64_t n, const double *point,
                           double *distance) {
    for (int64_t at = 0; at < n; at += BATCH) {
        if (!qc__progress(ctx, (double)at / (double)n)) return QC_ERR_CANCELLED;
        query q = {closest, tree, point + 3 * at, distance + at};
        qc__parallel_for(ctx, n - at < BATCH ? n - at : BATCH, CHUNK, run_queries, &q);
    }
    return QC_OK;
}

/* Polygons as fans of triangles; 3 (n_corners - 2 n_faces) indices. */
static void fan(const qc_polygon_mesh *quads, int32_t *vertex) {
    int64_t n = 0;
    for (int32_t f = 0; f < quads->n_faces; f++) {
        const int32_t first = quads->face_offset[f], last = quads->face_offset[f + 1];
        for (int32_t c = first + 1; c + 1 < last; c++) {
            vertex[n++] = quads->face_vertex[first];
            vertex[n++] = quads->face_vertex[c];
            vertex[n++] = quads->face_vertex[c + 1];
        }
    }
}

/* Vertices, then per corner the midpoint of the edge leaving it, then the centres of the faces. */
static void sample(const qc_polygon_mesh *quads, double *point) {
    for (int64_t i = 0; i < 3 * (int64_t)quads->n_vertices; i++) point[i] = quads->position[i];
    double *middle = point + 3 * (int64_t)quads->n_vertices;
    double *centre = middle + 3 * (int64_t)quads->n_corners;
    for (int32_t f = 0; f < quads->n_faces; f++) {
        const int32_t first = quads->face_offset[f], last = quads->face_offset[f + 1];
        double *x = centre + 3 * (int64_t)f;
        x[0] = x[1] = x[2] = 0;
        for (int32_t c = first; c < last; c++) {
            const int32_t next = c + 1 < last ? c + 1 : first;
            const double *p = quads->position + 3 * (int64_t)quads->face_vertex[c];
            const double *q = quads->position + 3 * (int64_t)quads->face_vertex[next];
            for (int k = 0; k < 3; k++) {
                middle[3 * (int64_t)c + k] = 0.5 * (p[k] + q[k]);
                x[k] += p[k] / (last - first);
            }
        }
    }
}

/* Adds the distances of n points to a triangle list. */
static qc_status add(qc_ctx *ctx, const qc_closest_point *closest, int32_t n_triangles,
                     const double *position, const int32_t *vertex, int64_t n, const double *point,
                     qc_report *report) {
    qc_closest_tree *tree = NULL;
    double *distance = QC__NEW(ctx, double, n);
    qc_status status = distance ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = closest->build(closest, ctx, n_triangles, position, vertex, &tree);
    if (status == QC_OK) status = distances(ctx, closest, tree, n, point, distance);
    if (status == QC_OK) {
        for (int64_t i = 0; i < n; i++) {
            report->quads.hausdorff = fmax(report->quads.hausdorff, distance[i]);
            report->quads.distance_sum += distance[i];
        }
        report->quads.distance_samples += (double)n;
    }
    closest->destroy(tree);
    qc__free(distance);
    return status;
}

qc_status qc__report_distance(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads,
                              const qc_closest_point *closest, qc_report *report) {
    const int64_t n_triangles = (int64_t)quads->n_corners - 2 * (int64_t)quads->n_faces;
    const int64_t n = (int64_t)quads->n_vertices + quads->n_corners + quads->n_faces;
    if (n_triangles < 1) return QC_OK;
    double *point = QC__NEW(ctx, double, 3 * n);
    int32_t *vertex = QC__NEW(ctx, int32_t, 3 * n_triangles);
    qc_status status = point && vertex ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        fan(quads, vertex);
        sample(quads, point);
        report->quads.diagonal = mesh->diagonal;
        qc__range outer = qc__range_begin(ctx, NULL, 0.3, 0.8);
        status =
            add(ctx, closest, mesh->n_faces, mesh->position, mesh->face_vertex, n, point, report);
        qc__range_end(ctx, outer);
    }
    if (status == QC_OK) {
        qc__range outer = qc__range_begin(ctx, NULL, 0.8, 1.0);
        status = add(ctx, closest, (int32_t)n_triangles, quads->position, vertex, mesh->n_vertices,
                     mesh->position, report);
        qc__range_end(ctx, outer);
    }
    qc__free(point);
    qc__free(vertex);
    return status;
}
