/* Features of the map against the lines of the quads: ends of the lines to the features, vertices
 * of the features to the lines. Before the quads are moved the first is rounding noise; the second
 * is so where features are straight, else the sagitta of the chords. */
#include <math.h>
#include <qc/closest_point.h>

#include "sdk/map/report/report.h"

/* A segment a b is the triangle a b b. */
static void put_segment(int32_t *triangle, int32_t a, int32_t b) {
    triangle[0] = a;
    triangle[1] = triangle[2] = b;
}

/* Largest distance of the ends of segments `from` to the segments `to`. */
static qc_status farthest(qc_ctx *ctx, int32_t n_to, const double *to_position, const int32_t *to,
                          int32_t n_from, const double *from_position, const int32_t *from,
                          double *distance) {
    const qc_closest_point *closest = &qc_closest_point_builtin;
    qc_closest_tree *tree = NULL;
    const qc_status status = closest->build(closest, ctx, n_to, to_position, to, &tree);
    int32_t nearest = 0;
    for (int64_t i = 0; status == QC_OK && i < 3 * (int64_t)n_from; i++) {
        double weight[3];
        if (i % 3 == 2) continue;
        const double *point = from_position + 3 * (int64_t)from[i];
        *distance = fmax(*distance, closest->query(tree, point, &nearest, weight));
    }
    closest->destroy(tree);
    return status;
}

qc_status qc__report_features(qc_ctx *ctx, const qc_corner_map *map, const qc_polygon_mesh *quads,
                              qc_report *report) {
    const qc_mesh *m = map->mesh;
    int32_t n = 0;
    for (int32_t e = 0; map->axis && e < m->n_edges; e++) n += map->axis[e] >= 0;
    report->quads.feature_edges = quads->n_lines;
    if (n == 0 || quads->n_lines == 0) return QC_OK;
    int32_t *feature = QC__NEW(ctx, int32_t, 3 * (int64_t)n);
    int32_t *line = QC__NEW(ctx, int32_t, 3 * (int64_t)quads->n_lines);
    qc_status status = feature && line ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int32_t i = 0;
        for (int32_t e = 0; e < m->n_edges; e++)
            if (map->axis[e] >= 0)
                put_segment(feature + 3 * (int64_t)i++, m->edge_vertex[2 * (int64_t)e],
                            m->edge_vertex[2 * (int64_t)e + 1]);
        for (i = 0; i < quads->n_lines; i++)
            put_segment(line + 3 * (int64_t)i, quads->line[2 * (int64_t)i],
                        quads->line[2 * (int64_t)i + 1]);
        double *distance = &report->quads.feature_distance;
        status =
            farthest(ctx, n, m->position, feature, quads->n_lines, quads->position, line, distance);
        if (status == QC_OK)
            status = farthest(ctx, quads->n_lines, quads->position, line, n, m->position, feature,
                              distance);
    }
    qc__free(feature);
    qc__free(line);
    return status;
}
