/* The statistics file: keys as docs/files.md fixes them; ratios are made from the sums of the
 * report. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "sdk/remesh/internal.h"

#define HALF_PI 1.57079632679489661923

/* Standard deviation from a count, a sum and a sum of squares. */
static double deviation(double n, double sum, double sum2) {
    const double mean = n > 0 ? sum / n : 0, variance = n > 0 ? sum2 / n - mean * mean : 0;
    return variance > 0 ? sqrt(variance) : 0;
}

void qc_report_figures(const qc_report *r, qc_figures *out) {
    qc_figures f = {0, 0, 0, 0, 0, 0};
    if (r->quads.edge_sum > 0)
        f.rsd_edge = 100 * deviation(r->quads.edges, r->quads.edge_sum, r->quads.edge_sum2) *
                     r->quads.edges / r->quads.edge_sum;
    f.rsd_angle =
        100 * deviation(r->quads.corners, r->quads.angle_sum, r->quads.angle_sum2) / HALF_PI;
    if (r->quads.diagonal > 0) {
        f.hausdorff_rel = r->quads.hausdorff / r->quads.diagonal;
        f.feature_distance_rel = r->quads.feature_distance / r->quads.diagonal;
        if (r->quads.distance_samples > 0)
            f.mean_dist_rel = r->quads.distance_sum / r->quads.distance_samples / r->quads.diagonal;
    }
    if (r->uv.area > 0) f.arap_mean = r->uv.arap_sum / r->uv.area;
    *out = f;
}

static json_t *number(double x) {
    return isfinite(x) ? json_real(x) : json_null();
}
static json_t *integer(int64_t n) {
    return json_integer((json_int_t)n);
}
static double percent(double part, double whole) {
    return whole > 0 ? 100 * part / whole : 0;
}

/* Counts by quarter index; -1 and +1 always, others where there are any. */
static json_t *index_counts(const qc_report *r) {
    json_t *counts = json_object();
    for (int i = -8; i <= 8; i++) {
        char key[8];
        if (i == 0 || (r->field.index4[8 + i] == 0 && abs(i) != 1)) continue;
        snprintf(key, sizeof key, "%d", i);
        json_object_set_new(counts, key, integer(r->field.index4[8 + i]));
    }
    return counts;
}

static json_t *energies(const qc_report *r) {
    const double field = r->energy.field;
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "E_D", number(r->energy.curl), "E_H",
                     number(r->energy.harmonic), "E_D_rel", number(percent(r->energy.curl, field)),
                     "E_H_rel", number(percent(r->energy.harmonic, field)), "E_H_direct_rel",
                     number(percent(r->energy.harmonic_direct, field)), "iterations",
                     integer(r->energy.iterations), "evaluations", integer(r->energy.evaluations));
}

static json_t *quads(const qc_report *r, const qc_figures *f) {
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "vertices",
                     integer(r->quads.vertices), "faces", integer(r->quads.faces), "non_quads",
                     integer(r->quads.non_quads), "irregular", integer(r->quads.irregular), "euler",
                     integer(r->quads.euler), "components", integer(r->quads.components),
                     "boundaries", integer(r->quads.boundaries), "rsd_edge", number(f->rsd_edge),
                     "rsd_angle", number(f->rsd_angle), "min_scaled_jacobian",
                     number(r->quads.min_scaled_jacobian), "hausdorff_rel",
                     number(f->hausdorff_rel), "mean_dist_rel", number(f->mean_dist_rel),
                     "feature_edges", integer(r->quads.feature_edges), "feature_distance_rel",
                     number(f->feature_distance_rel));
}

static json_t *seconds(const qc_pipeline *pipeline, const qc_stats_options *o) {
    json_t *stages = json_object();
    for (uint32_t i = 0; pipeline && i < qc_pipeline_count(pipeline); i++)
        json_object_set_new(stages, qc_pipeline_step_name(pipeline, i),
                            number(qc_pipeline_seconds(pipeline, i)));
    return json_pack("{s:o,s:o,s:o,s:o}", "total", number(o->total), "read", number(o->read),
                     "write", number(o->write), "stages", stages);
}

/* Every step with its parameters, and the versions of the stages. */
static void add_pipeline(json_t *root, const qc_pipeline *pipeline) {
    char *text = NULL;
    if (!pipeline || qc_pipeline_print(pipeline, &text) != QC_OK) return;
    json_t *steps = json_loads(text, 0, NULL), *versions = json_object();
    qc_text_free(text);
    if (steps) json_object_set_new(root, "pipeline", steps);
    for (uint32_t i = 0; i < qc_pipeline_count(pipeline); i++) {
        const qc_stage *stage = qc_pipeline_step_stage(pipeline, i);
        json_object_set_new(versions, stage->id, json_string(stage->version));
    }
    json_object_set_new(root, "versions", versions);
}

/* The plane at which a half was mirrored. */
static void add_mirror(json_t *root, const qc_report *r) {
    const double *m = r->mirror;
    if (m[0] == 0 && m[1] == 0 && m[2] == 0) return;
    json_object_set_new(
        root, "mirror",
        json_pack("[o,o,o,o]", number(m[0]), number(m[1]), number(m[2]), number(m[3])));
}

static double peak_rss_mb(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (double)usage.ru_maxrss / 1024 : 0;
}

static json_t *statistics(const qc_report *r, const qc_pipeline *pipeline,
                          const qc_stats_options *o) {
    qc_figures f;
    json_t *list = json_array();
    qc_report_figures(r, &f);
    for (int32_t i = 0; i < o->n_warnings; i++)
        json_array_append_new(list, json_string(o->warning[i]));
    json_t *root = json_pack(
        "{s:s,s:{s:s,s:o,s:o,s:o,s:o,s:o},s:{s:o,s:o},s:{s:o,s:o},s:o,s:{s:o,s:o,s:o,s:o},s:o,s:o,"
        "s:o,s:s,s:o}",
        "quadcover", qc_version(), /**/
        "input", "file", o->input ? o->input : "", "vertices", integer(r->input.vertices), "faces",
        integer(r->input.faces), "genus", integer(r->input.genus), "boundaries",
        integer(r->input.boundaries), "components", integer(r->input.components), /**/
        "density", "edge_length", number(r->density.edge_length), "target_quads",
        number(r->density.target_quads),                                                      /**/
        "field", "singularities", integer(r->field.singularities), "index4", index_counts(r), /**/
        "energy", energies(r),                                                                /**/
        "uv", "flipped", integer(r->uv.flipped), "degenerate", integer(r->uv.degenerate),
        "max_seam_error", number(r->uv.max_seam_error), "arap_mean", number(f.arap_mean), /**/
        "quads", quads(r, &f), "seconds", seconds(pipeline, o), "peak_rss_mb",
        number(peak_rss_mb()), "mode", o->mode ? o->mode : "", "warnings", list);
    if (root) add_mirror(root, r);
    if (root) add_pipeline(root, pipeline);
    return root;
}

qc_status qc_stats_json(qc_ctx *ctx, const qc_report *report, const qc_pipeline *pipeline,
                        const qc_stats_options *options, char **json) {
    qc_stats_options o = QC_STATS_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    json_t *root = statistics(report, pipeline, &o);
    if (!root)
        return qc__fail(ctx, QC_ERR_INPUT, -1,
                        "statistics: a text is not valid UTF-8; rename the file");
    char *text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(root);
    const size_t length = text ? strlen(text) : 0;
    char *copy = text ? QC__NEW(ctx, char, length + 2) : NULL;
    if (copy) {
        memcpy(copy, text, length);
        memcpy(copy + length, "\n", 2);
        *json = copy;
    }
    free(text);
    return copy ? QC_OK : QC_ERR_NOMEM;
}
