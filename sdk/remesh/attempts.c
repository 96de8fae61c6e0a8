/* Running the steps of a component again with other integers, then with more quads, where the first
 * ones left a map which folds over. Rounding is the one step with many nearly equal answers; which
 * of them unfold cannot be told before the map is cut into quads. Where quads are too large for the
 * distances between singularities and features none does, so that in the end more are made. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/remesh/internal.h"

enum { ATTEMPTS = 4, REFINEMENTS = 6 }; /* of sqrt(2): up to 8 times as many quads */

/* Step which runs qc.round and takes a seed, or -1. */
static int64_t find_round(const qc_pipeline *pipeline, uint32_t first) {
    for (uint32_t i = first; i < qc_pipeline_count(pipeline); i++)
        if (strcmp(qc_pipeline_step_stage(pipeline, i)->id, "qc.round") == 0) return i;
    return -1;
}

/* Rounding itself does not get better by other integers. */
static bool failed_later(const qc_ctx *ctx, qc_status status, const char *step) {
    return status == QC_ERR_FAILED && strcmp(qc_ctx_error(ctx)->stage, step) != 0;
}

static qc_status set_refine(qc_pipeline *pipeline, const char *step, double factor) {
    char text[40];
    qc__print_double(text, sizeof text, factor);
    return qc_pipeline_set(pipeline, step, "refine", text);
}

/* Says what became of the number of quads that was asked for. */
static void warn_refined(qc_ctx *ctx, const qc_bag *bag, const char *reason) {
    const qc_sizing *sizing = qc_bag_latest(bag, QC_TYPE_SIZING);
    const qc_polygon_mesh *quads = qc_bag_latest(bag, QC_TYPE_POLYGON_MESH);
    if (!sizing || !quads) return;
    const double length = sizing->edge_length;
    const double wanted =
        sizing->target_quads > 0 ? sizing->target_quads : sizing->mesh->area / (length * length);
    qc__log(ctx, QC_LOG_WARNING, "made %d quads instead of %.0f, which are too large here: %s",
            (int)quads->n_faces, wanted, reason);
}

/* Tries again from the rounding: first other integers, then more quads. */
static qc_status try_again(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t round, qc_bag *bag,
                           uint64_t seed, double refine) {
    const char *step = qc_pipeline_step_name(pipeline, round);
    qc_status status = QC_ERR_FAILED;
    char reason[512] = "";
    for (int k = 1; k < ATTEMPTS + REFINEMENTS && failed_later(ctx, status, step); k++) {
        const int finer = k < ATTEMPTS ? 0 : k - ATTEMPTS + 1;
        qc__log(ctx, QC_LOG_WARNING, "%s; rounding again with %s", qc_ctx_error(ctx)->text,
                finer ? "more quads" : "other integers");
        if (finer <= 1) snprintf(reason, sizeof reason, "%s", qc_ctx_error(ctx)->text);
        const qc__range outer = qc__range_begin(ctx, NULL, 1, 1);
        status = qc__set_seed(pipeline, step, seed + (uint64_t)(finer ? 0 : k));
        if (status == QC_OK) status = set_refine(pipeline, step, refine * pow(2, 0.5 * finer));
        if (status == QC_OK)
            status = qc_pipeline_run_range(pipeline, round, qc_pipeline_count(pipeline), bag);
        qc__range_end(ctx, outer);
        if (status == QC_OK && finer) warn_refined(ctx, bag, reason);
    }
    return status;
}

static qc_status run_from(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t round, qc_bag *bag) {
    const char *step = qc_pipeline_step_name(pipeline, round);
    qc_status status = qc_pipeline_run_range(pipeline, round, qc_pipeline_count(pipeline), bag);
    if (!failed_later(ctx, status, step)) return status;
    const char *text = qc_pipeline_get(pipeline, step, "seed");
    const uint64_t seed = text ? strtoull(text, NULL, 10) : 0;
    text = qc_pipeline_get(pipeline, step, "refine");
    const double refine = text ? qc__parse_double(text, NULL) : 1;
    status = try_again(ctx, pipeline, round, bag, seed, refine);
    const qc_status seed_restored = qc__set_seed(pipeline, step, seed);
    const qc_status refine_restored = set_refine(pipeline, step, refine);
    if (status == QC_OK) status = seed_restored != QC_OK ? seed_restored : refine_restored;
    return status;
}

qc_status qc__run_with_attempts(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t first, qc_bag *bag) {
    const uint32_t end = qc_pipeline_count(pipeline);
    const int64_t round = find_round(pipeline, first);
    if (round < 0) return qc_pipeline_run_range(pipeline, first, end, bag);
    const double share = (double)(round - first) / (end - first);
    qc__range outer = qc__range_begin(ctx, NULL, 0, share);
    qc_status status = qc_pipeline_run_range(pipeline, first, (uint32_t)round, bag);
    qc__range_end(ctx, outer);
    if (status != QC_OK) return status;
    outer = qc__range_begin(ctx, NULL, share, 1);
    status = run_from(ctx, pipeline, (uint32_t)round, bag);
    qc__range_end(ctx, outer);
    return status;
}
