/* Running the steps of a component again with other integers where the first ones left a map which
 * folds over. Rounding is the one step with many nearly equal answers; which of them unfold cannot
 * be told before the map is cut into quads. */
#include <stdlib.h>
#include <string.h>

#include "sdk/remesh/internal.h"

enum { ATTEMPTS = 4 };

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

static qc_status run_from(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t round, qc_bag *bag) {
    const uint32_t end = qc_pipeline_count(pipeline);
    const char *step = qc_pipeline_step_name(pipeline, round);
    const char *text = qc_pipeline_get(pipeline, step, "seed");
    const uint64_t seed = text ? strtoull(text, NULL, 10) : 0;
    qc_status status = qc_pipeline_run_range(pipeline, round, end, bag);
    for (int k = 1; k < ATTEMPTS && text && failed_later(ctx, status, step); k++) {
        qc__log(ctx, QC_LOG_WARNING, "%s; rounding again with other integers",
                qc_ctx_error(ctx)->text);
        const qc__range outer = qc__range_begin(ctx, NULL, 1, 1);
        status = qc__set_seed(pipeline, step, seed + (uint64_t)k);
        if (status == QC_OK) status = qc_pipeline_run_range(pipeline, round, end, bag);
        qc__range_end(ctx, outer);
    }
    if (text) {
        const qc_status restored = qc__set_seed(pipeline, step, seed);
        if (status == QC_OK) status = restored;
    }
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
