/* qc_report: the figures of a run as sums which add up over components. */
#include "sdk/map/report/report.h"
#include <math.h>

static void destroy(qc_object *object) {
    qc__free(object);
}

qc_status qc_report_create(qc_ctx *ctx, qc_report **out) {
    qc_report *report = QC__ZERO(ctx, qc_report, 1);
    if (!report) return QC_ERR_NOMEM;
    qc_object_init(&report->object, QC_TYPE_REPORT, destroy);
    *out = report;
    return QC_OK;
}

/* One edge length for two parts: the one which makes the joint number of quads on the joint area.
 */
static double joint_edge_length(const qc_report *a, const qc_report *b) {
    const double h = a->density.edge_length, g = b->density.edge_length;
    const double n = a->density.target_quads, m = b->density.target_quads;
    if (h == g || g == 0) return h;
    if (h == 0) return g;
    return n + m > 0 ? sqrt((n * h * h + m * g * g) / (n + m)) : fmax(h, g);
}

void qc_report_add(qc_report *sum, const qc_report *part) {
    const bool first = sum->quads.faces == 0;
    sum->density.edge_length = joint_edge_length(sum, part);
    sum->density.target_quads += part->density.target_quads;
    sum->input.vertices += part->input.vertices;
    sum->input.faces += part->input.faces;
    sum->input.genus += part->input.genus;
    sum->input.boundaries += part->input.boundaries;
    sum->input.components += part->input.components;
    sum->field.singularities += part->field.singularities;
    for (int i = 0; i < 17; i++) sum->field.index4[i] += part->field.index4[i];
    sum->energy.field += part->energy.field;
    sum->energy.curl += part->energy.curl;
    sum->energy.harmonic += part->energy.harmonic;
    sum->energy.harmonic_direct += part->energy.harmonic_direct;
    sum->energy.iterations += part->energy.iterations;
    sum->energy.evaluations += part->energy.evaluations;
    sum->uv.flipped += part->uv.flipped;
    sum->uv.degenerate += part->uv.degenerate;
    sum->uv.max_seam_error = fmax(sum->uv.max_seam_error, part->uv.max_seam_error);
    sum->uv.arap_sum += part->uv.arap_sum;
    sum->uv.area += part->uv.area;
    if (part->quads.faces > 0)
        sum->quads.min_scaled_jacobian =
            first ? part->quads.min_scaled_jacobian
                  : fmin(sum->quads.min_scaled_jacobian, part->quads.min_scaled_jacobian);
    sum->quads.vertices += part->quads.vertices;
    sum->quads.faces += part->quads.faces;
    sum->quads.non_quads += part->quads.non_quads;
    sum->quads.irregular += part->quads.irregular;
    sum->quads.euler += part->quads.euler;
    sum->quads.components += part->quads.components;
    sum->quads.boundaries += part->quads.boundaries;
    sum->quads.edges += part->quads.edges;
    sum->quads.edge_sum += part->quads.edge_sum;
    sum->quads.edge_sum2 += part->quads.edge_sum2;
    sum->quads.corners += part->quads.corners;
    sum->quads.angle_sum += part->quads.angle_sum;
    sum->quads.angle_sum2 += part->quads.angle_sum2;
    sum->quads.hausdorff = fmax(sum->quads.hausdorff, part->quads.hausdorff);
    sum->quads.distance_sum += part->quads.distance_sum;
    sum->quads.distance_samples += part->quads.distance_samples;
    sum->quads.feature_edges += part->quads.feature_edges;
    sum->quads.feature_distance = fmax(sum->quads.feature_distance, part->quads.feature_distance);
    sum->quads.diagonal = fmax(sum->quads.diagonal, part->quads.diagonal);
}

static void add_matching(const qc_matching *matching, qc_report *report) {
    const qc_mesh *mesh = matching->field->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t i = matching->index4[v];
        if (i == 0) continue;
        report->field.singularities++;
        report->field.index4[8 + (i < -8 ? -8 : i > 8 ? 8 : i)]++;
    }
    for (int32_t i = 0; i < mesh->n_poles && matching->pole_index4; i++) {
        const int32_t index4 = matching->pole_index4[i];
        report->field.singularities++;
        report->field.index4[8 + (index4 > 8 ? 8 : index4)]++;
    }
}

qc_status qc_report_measure(qc_ctx *ctx, const qc_mesh *mesh, const qc_sizing *sizing,
                            const qc_matching *matching, const qc_corner_map *map,
                            const qc_polygon_mesh *quads, const qc_closest_point *closest,
                            qc_report *report) {
    qc_report r = {.object = report->object};
    qc_status status = QC_OK;
    if (mesh) {
        r.input.vertices = mesh->n_vertices;
        r.input.faces = mesh->n_faces;
        r.input.genus = mesh->genus;
        r.input.boundaries = mesh->n_boundary_loops - mesh->n_poles;
        r.input.components = mesh->n_components;
    }
    if (sizing) {
        r.density.edge_length = sizing->edge_length;
        r.density.target_quads = sizing->target_quads;
    }
    if (matching) add_matching(matching, &r);
    qc__range outer = qc__range_begin(ctx, NULL, 0.0, 0.2);
    if (map) status = qc__report_map(ctx, map, &r);
    qc__range_end(ctx, outer);
    outer = qc__range_begin(ctx, NULL, 0.2, 0.3);
    if (status == QC_OK && quads) status = qc__report_quads(ctx, quads, &r);
    qc__range_end(ctx, outer);
    if (status == QC_OK && map && quads) status = qc__report_features(ctx, map, quads, &r);
    if (status == QC_OK && mesh && quads)
        status = qc__report_distance(ctx, mesh, quads,
                                     closest ? closest : &qc_closest_point_builtin, &r);
    if (status == QC_OK) *report = r;
    return status;
}
