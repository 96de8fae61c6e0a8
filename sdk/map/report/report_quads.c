/* Regularity of a quad mesh as in Table 7.1 of the thesis: sums of edge lengths and corner angles,
 * and the smallest scaled Jacobian (sine of the corner angle against the face normal). */
#include <math.h>

#include "sdk/map/report/report.h"
#include "sdk/mesh/internal.h"

static void difference(const qc_polygon_mesh *m, int32_t from, int32_t to, double d[3]) {
    for (int k = 0; k < 3; k++)
        d[k] = m->position[3 * (int64_t)to + k] - m->position[3 * (int64_t)from + k];
}

/* Every undirected edge once: the corners are bucketed by the lower end of the edge they start, and
 * each bucket is sorted by the higher end. */
static void add_bucket_edges(const qc_polygon_mesh *m, int32_t low, int32_t *high, int32_t n,
                             qc_report *report) {
    for (int32_t i = 1; i < n; i++)
        for (int32_t j = i; j > 0 && high[j - 1] > high[j]; j--) {
            const int32_t swap = high[j];
            high[j] = high[j - 1];
            high[j - 1] = swap;
        }
    for (int32_t i = 0; i < n; i++) {
        if (i > 0 && high[i] == high[i - 1]) continue;
        double d[3];
        difference(m, low, high[i], d);
        const double l = qc__norm3(d);
        report->quads.edges += 1;
        report->quads.edge_sum += l;
        report->quads.edge_sum2 += l * l;
    }
}

static void edge_of(const qc_polygon_mesh *m, int32_t f, int32_t c, int32_t *low, int32_t *high) {
    const int32_t next = c + 1 < m->face_offset[f + 1] ? c + 1 : m->face_offset[f];
    const int32_t a = m->face_vertex[c], b = m->face_vertex[next];
    *low = a < b ? a : b;
    *high = a < b ? b : a;
}

static qc_status add_edges(qc_ctx *ctx, const qc_polygon_mesh *m, qc_report *report) {
    int32_t *start = QC__ZERO(ctx, int32_t, (int64_t)m->n_vertices + 2);
    int32_t *high = QC__NEW(ctx, int32_t, m->n_corners);
    const qc_status status = start && high ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int32_t a, b;
        for (int32_t f = 0; f < m->n_faces; f++)
            for (int32_t c = m->face_offset[f]; c < m->face_offset[f + 1]; c++) {
                edge_of(m, f, c, &a, &b);
                start[a + 2]++;
            }
        for (int32_t v = 0; v < m->n_vertices; v++) start[v + 2] += start[v + 1];
        for (int32_t f = 0; f < m->n_faces; f++)
            for (int32_t c = m->face_offset[f]; c < m->face_offset[f + 1]; c++) {
                edge_of(m, f, c, &a, &b);
                high[start[a + 1]++] = b;
            }
        for (int32_t v = 0; v < m->n_vertices; v++)
            add_bucket_edges(m, v, high + start[v], start[v + 1] - start[v], report);
    }
    qc__free(start);
    qc__free(high);
    return status;
}

static void add_corners(const qc_polygon_mesh *m, int32_t f, qc_report *report) {
    const int32_t n = m->face_offset[f + 1] - m->face_offset[f];
    const int32_t *v = m->face_vertex + m->face_offset[f];
    for (int32_t i = 0; i < n; i++) {
        double to_next[3], to_previous[3], c[3];
        difference(m, v[i], v[(i + 1) % n], to_next);
        difference(m, v[i], v[(i + n - 1) % n], to_previous);
        qc__cross3(to_next, to_previous, c);
        const double angle = atan2(qc__norm3(c), qc__dot3(to_next, to_previous));
        report->quads.corners += 1;
        report->quads.angle_sum += angle;
        report->quads.angle_sum2 += angle * angle;
    }
    report->quads.min_scaled_jacobian =
        fmin(report->quads.min_scaled_jacobian, qc__scaled_jacobian(m->position, v, n));
}

qc_status qc__report_quads(qc_ctx *ctx, const qc_polygon_mesh *quads, qc_report *report) {
    qc_polygon_topology topology;
    qc_status status = qc_polygon_mesh_topology(ctx, quads, &topology);
    if (status == QC_OK) status = add_edges(ctx, quads, report);
    if (status != QC_OK) return status;
    report->quads.vertices = quads->n_vertices;
    report->quads.faces = quads->n_faces;
    report->quads.non_quads = topology.non_quads;
    report->quads.irregular = topology.irregular;
    report->quads.euler = topology.euler;
    report->quads.components = topology.components;
    report->quads.boundaries = topology.boundary_loops;
    report->quads.min_scaled_jacobian = quads->n_faces > 0 ? 1.0 : 0.0;
    for (int32_t f = 0; f < quads->n_faces; f++) {
        if (f % 65536 == 0 && !qc__progress(ctx, (double)f / quads->n_faces))
            return QC_ERR_CANCELLED;
        add_corners(quads, f, report);
    }
    return QC_OK;
}
