/* The ladder of attempts on one component. Where a map folds over, the steps run again: with other
 * integers, since rounding has many nearly equal answers and which of them unfold cannot be told
 * before the map is cut into quads; with more quads, since where quads are too large for the
 * distances between singularities and features none does; and in the end without the condition that
 * features lie on isolines, which some features contradict. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/remesh/internal.h"

/* One attempt: other integers, more quads (in steps of sqrt(2)), features as guides alone. */
typedef struct rung {
    int32_t other, finer;
    bool soft;
} rung;

static const rung ladder[] = {
    {0, 0, false}, {1, 0, false}, {0, 1, false}, {0, 2, false}, {0, 0, true}, {1, 0, true},
    {0, 1, true},  {0, 2, true},  {0, 3, true},  {0, 4, true},  {0, 6, true},
};
enum { RUNGS = (int)(sizeof ladder / sizeof *ladder) };

typedef struct climb {
    qc_ctx *ctx;
    qc_pipeline *pipeline;
    qc_bag *bag;
    uint32_t first, end;
    int64_t round, features; /* steps, -1 = none */
    uint64_t seed;           /* what the user set */
    double refine;
    bool hard;
} climb;

static int64_t find_step(const qc_pipeline *pipeline, uint32_t first, const char *id) {
    for (uint32_t i = first; i < qc_pipeline_count(pipeline); i++)
        if (strcmp(qc_pipeline_step_stage(pipeline, i)->id, id) == 0) return i;
    return -1;
}

/* A text from the pipeline is valid until the next call. */
static void read_settings(climb *c) {
    const char *step = qc_pipeline_step_name(c->pipeline, (uint32_t)c->round);
    const char *text = qc_pipeline_get(c->pipeline, step, "seed");
    c->seed = text ? strtoull(text, NULL, 10) : 0;
    text = qc_pipeline_get(c->pipeline, step, "refine");
    c->refine = text ? qc__parse_double(text, NULL) : 1;
    if (c->features < 0) return;
    step = qc_pipeline_step_name(c->pipeline, (uint32_t)c->features);
    text = qc_pipeline_get(c->pipeline, step, "hard");
    c->hard = text && strcmp(text, "true") == 0;
}

/* Parameters of an attempt; {0, 0, !hard} are those the user set. */
static qc_status set_rung(const climb *c, rung r) {
    const char *step = qc_pipeline_step_name(c->pipeline, (uint32_t)c->round);
    char refine[40];
    qc__print_double(refine, sizeof refine, c->refine * pow(2, 0.5 * r.finer));
    qc_status status = qc__set_seed(c->pipeline, step, c->seed + (uint64_t)r.other);
    if (status == QC_OK) status = qc_pipeline_set(c->pipeline, step, "refine", refine);
    if (status != QC_OK || !c->hard) return status;
    return qc_pipeline_set(c->pipeline, qc_pipeline_step_name(c->pipeline, (uint32_t)c->features),
                           "hard", r.soft ? "false" : "true");
}

/* Says what became of what was asked for. */
static void warn_compromise(const climb *c, rung r, const char *reason) {
    const qc_sizing *sizing = qc_bag_latest(c->bag, QC_TYPE_SIZING);
    const qc_polygon_mesh *quads = qc_bag_latest(c->bag, QC_TYPE_POLYGON_MESH);
    if (c->hard && r.soft)
        qc__log(c->ctx, QC_LOG_WARNING,
                "features guide the directions but are not edges of the quads: %s", reason);
    if (r.finer == 0 || !sizing || !quads) return;
    const double length = sizing->edge_length;
    const double wanted =
        sizing->target_quads > 0 ? sizing->target_quads : sizing->mesh->area / (length * length);
    qc__log(c->ctx, QC_LOG_WARNING, "made %d quads instead of %.0f, which are too large here: %s",
            (int)quads->n_faces, wanted, reason);
}

static const char *difference(rung from, rung to) {
    if (from.soft != to.soft) return "features as guides alone";
    return to.finer > 0 ? "more quads" : "other integers";
}

/* Whether a failed attempt leaves the next one something to change. Rounding itself does not get
 * better by other integers, it raises the density by itself, and it needs the features to be there;
 * whatever a step before it has against hard features is not mended by other integers either. */
static bool worth_trying(const climb *c, qc_status status, rung next) {
    const char *stage = qc_ctx_error(c->ctx)->stage;
    if (status != QC_ERR_FAILED) return false;
    for (uint32_t i = c->first; i <= (uint32_t)c->round; i++)
        if (strcmp(stage, qc_pipeline_step_name(c->pipeline, i)) == 0)
            return c->hard && next.soft && c->features <= (int64_t)i;
    return true;
}

/* Steps from `from` on, apart up to the rounding, so that what they make is there for the next
 * attempt; [lo, 1] of the progress. */
static qc_status run_from(const climb *c, uint32_t from, double lo) {
    const uint32_t round = (uint32_t)c->round;
    const double middle = lo + (1 - lo) * (double)(round - from) / (c->end - from);
    qc__range outer = qc__range_begin(c->ctx, NULL, lo, middle);
    qc_status status =
        from < round ? qc_pipeline_run_range(c->pipeline, from, round, c->bag) : QC_OK;
    qc__range_end(c->ctx, outer);
    if (status != QC_OK) return status;
    outer = qc__range_begin(c->ctx, NULL, middle, 1);
    status = qc_pipeline_run_range(c->pipeline, round, c->end, c->bag);
    qc__range_end(c->ctx, outer);
    return status;
}

static qc_status run_rung(const climb *c, rung before, rung r) {
    const bool again = c->hard && r.soft != before.soft; /* the field changes as well */
    const qc_status status = set_rung(c, r);
    return status == QC_OK ? run_from(c, (uint32_t)(again ? c->features : c->round), 1) : status;
}

static qc_status run_ladder(const climb *c, qc_status status) {
    rung before = {0, 0, !c->hard};
    char reason[512];
    snprintf(reason, sizeof reason, "%s", qc_ctx_error(c->ctx)->text);
    for (int i = 1; i < RUNGS && status == QC_ERR_FAILED; i++) {
        const rung r = ladder[i];
        const bool same = r.soft == before.soft && r.finer == 0 && r.other == 0;
        if ((!c->hard && !r.soft) || same || !worth_trying(c, status, r)) continue;
        if (r.finer == 1) snprintf(reason, sizeof reason, "%s", qc_ctx_error(c->ctx)->text);
        qc__log(c->ctx, QC_LOG_WARNING, "%s; trying again with %s", qc_ctx_error(c->ctx)->text,
                difference(before, r));
        status = run_rung(c, before, r);
        if (status == QC_OK) warn_compromise(c, r, reason);
        before = r;
    }
    const qc_status restored = set_rung(c, (rung){0, 0, false});
    return status == QC_OK ? restored : status;
}

qc_status qc__run_with_attempts(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t first, qc_bag *bag) {
    climb c = {.ctx = ctx,
               .pipeline = pipeline,
               .bag = bag,
               .first = first,
               .end = qc_pipeline_count(pipeline),
               .round = find_step(pipeline, first, "qc.round"),
               .features = find_step(pipeline, first, "qc.features")};
    if (c.round < 0) return qc_pipeline_run_range(pipeline, first, c.end, bag);
    const qc_status status = run_from(&c, first, 0);
    if (status != QC_ERR_FAILED) return status;
    read_settings(&c);
    return run_ladder(&c, status);
}
