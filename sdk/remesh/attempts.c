/* The ladder of attempts on one component. Where a map folds over, the steps run again: with
 * integers from quantization and its refined mesh, where no map folds over, or with other ones
 * where that is not possible; with more quads, since where they are too large for the distances
 * between singularities they meet themselves; with fewer hard features, since some contradict each
 * other or lie too close; and in the end without the condition that features lie on isolines.
 *
 * Optimising the branch points takes longer than all other steps, so it is done once: before it,
 * what the features leave no room for is given up on the field as it is (the rehearsal), and where
 * they leave none afterwards the field is taken as it was. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/remesh/internal.h"

/* Which hard features an attempt keeps. */
enum { ALL, AS_SMOOTHED, LESS_ONE, LESS_QUARTER, LESS_HALF, BOUNDARIES, GUIDES };

/* One attempt: other integers, more quads (in steps of sqrt(2)), features. */
typedef struct rung {
    int32_t other, finer, keep;
} rung;

static const rung ladder[] = {
    {0, 0, ALL},        {1, 0, ALL},      {0, 1, ALL},          {0, 0, AS_SMOOTHED},
    {0, 0, LESS_ONE},   {0, 0, LESS_ONE}, {0, 0, LESS_QUARTER}, {0, 0, LESS_HALF},
    {0, 0, BOUNDARIES}, {0, 0, GUIDES},   {1, 0, GUIDES},       {0, 1, GUIDES},
    {0, 2, GUIDES},     {0, 4, GUIDES},   {0, 6, GUIDES},       {0, 8, GUIDES},
    {0, 10, GUIDES},
};
enum { RUNGS = (int)(sizeof ladder / sizeof *ladder) };

typedef struct climb {
    qc_ctx *ctx;
    qc_pipeline *pipeline;
    qc_bag *bag;
    uint32_t first, end;
    int64_t round, features;   /* steps, -1 = none */
    qc__product edges;         /* the features which the field is aligned to */
    qc__optimisation optimise; /* the steps which do so */
    bool rehearsal;            /* no further than to a map with real translations */
    bool as_smoothed;          /* without these steps */
    uint64_t seed;             /* what the user set */
    double refine;
    char quantize[16];
    bool hard, was_hard; /* features, now and in the first attempt */
    qc__concessions given_up;
} climb;

static int64_t find_step(const qc_pipeline *pipeline, uint32_t first, const char *id) {
    for (uint32_t i = first; i < qc_pipeline_count(pipeline); i++)
        if (strcmp(qc_pipeline_step_stage(pipeline, i)->id, id) == 0) return i;
    return -1;
}

static const char *name_of(const climb *c, int64_t step) {
    return qc_pipeline_step_name(c->pipeline, (uint32_t)step);
}

/* Without hard features there is nothing to give up. */
static qc_status find_features(climb *c) {
    c->edges = qc__product_of(c->pipeline, c->bag, (uint32_t)c->features + 1, QC_TYPE_FEATURES);
    c->hard = c->edges.object && qc__has_hard_features(c->pipeline, c->bag, (uint32_t)c->round);
    c->was_hard |= c->hard;
    if (!c->hard || c->given_up.features) return QC_OK;
    return qc__concessions_create(c->ctx, c->edges.object, &c->given_up);
}

/* A text from the pipeline is valid until the next call. */
static qc_status read_settings(climb *c) {
    const char *text = qc_pipeline_get(c->pipeline, name_of(c, c->round), "seed");
    c->seed = text ? strtoull(text, NULL, 10) : 0;
    text = qc_pipeline_get(c->pipeline, name_of(c, c->round), "refine");
    c->refine = text ? qc__parse_double(text, NULL) : 1;
    text = qc_pipeline_get(c->pipeline, name_of(c, c->round), "quantize");
    snprintf(c->quantize, sizeof c->quantize, "%s", text ? text : "never");
    return c->features < 0 ? QC_OK : find_features(c);
}

/* Replaces the features by those which are left. */
static qc_status put_features(const climb *c) {
    qc_features *left = NULL;
    qc_status status = qc__concessions_features(c->ctx, &c->given_up, &left);
    if (status == QC_OK) status = qc_bag_put(c->bag, c->edges.name, left);
    qc_object_release(left);
    return status;
}

/* Whether an attempt is one where the integers of the user's own settings have failed. */
static bool wants_quantization(const climb *c, rung r) {
    const bool first = r.keep == ALL || r.keep == AS_SMOOTHED || r.keep == GUIDES;
    const bool own = r.other == 0 && r.finer == 0 && first;
    return !own && strcmp(c->quantize, "never") != 0;
}

/* Parameters of an attempt; {0, 0, ALL} are those the user set. */
static qc_status set_rung(const climb *c, rung r) {
    const char *step = name_of(c, c->round);
    char refine[40];
    qc__print_double(refine, sizeof refine, c->refine * pow(2, 0.5 * r.finer));
    qc_status status = qc__set_seed(c->pipeline, step, c->seed + (uint64_t)r.other);
    if (status == QC_OK) status = qc_pipeline_set(c->pipeline, step, "refine", refine);
    if (status == QC_OK)
        status = qc_pipeline_set(c->pipeline, step, "quantize",
                                 wants_quantization(c, r) ? "always" : c->quantize);
    if (status != QC_OK || !c->was_hard) return status;
    return qc_pipeline_set(c->pipeline, name_of(c, c->features), "hard",
                           r.keep == GUIDES ? "false" : "true");
}

/* Says what became of what was asked for. */
static void warn_compromise(const climb *c, rung r, const char *reason) {
    const qc_sizing *sizing = qc_bag_latest(c->bag, QC_TYPE_SIZING);
    const qc_polygon_mesh *quads = qc_bag_latest(c->bag, QC_TYPE_POLYGON_MESH);
    if (c->hard && r.keep == GUIDES)
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
    if (to.keep == GUIDES && from.keep != GUIDES) return "features as guides alone";
    if (to.keep == AS_SMOOTHED) return "the branch points of the smooth field";
    if (to.keep != ALL && to.keep != GUIDES) return "fewer features";
    return to.finer > 0 ? "more quads" : "other integers";
}

/* Whether a step up to the rounding failed. */
static bool failed_early(const climb *c) {
    const char *stage = qc_ctx_error(c->ctx)->stage;
    for (uint32_t i = c->first; i <= (uint32_t)c->round; i++)
        if (strcmp(stage, name_of(c, i)) == 0) return true;
    return false;
}

/* Whether a failed attempt leaves the next one something to change. What a step up to the rounding
 * has against hard features is not mended by other integers, and the rounding raises the density by
 * itself. */
static bool worth_trying(const climb *c, rung next, rung before) {
    const qc__concessions *f = &c->given_up;
    if (!c->hard) return next.keep == GUIDES && !failed_early(c);
    if (next.keep == ALL) return !failed_early(c);
    if (next.keep == AS_SMOOTHED) return c->optimise.end > 0 && !c->rehearsal;
    if (next.keep == GUIDES) return before.keep != GUIDES || !failed_early(c);
    return f->n_gone < f->n;
}

/* How many features the attempt is without; at least one more than before. */
static int32_t count_dropped(const qc__concessions *f, int32_t keep) {
    const int32_t part = keep == LESS_QUARTER ? (f->n + 3) / 4
                         : keep == LESS_HALF  ? (f->n + 1) / 2
                         : keep == BOUNDARIES ? f->n - f->n_boundaries
                                              : 0;
    return part > f->n_gone ? part : f->n_gone + 1;
}

/* The place an error names: a face where quads are cut out, else a vertex. */
static bool find_place(const climb *c, double place[3]) {
    const qc_error *error = qc_ctx_error(c->ctx);
    const qc_corner_map *map = qc_bag_latest(c->bag, QC_TYPE_CORNER_MAP);
    const qc_mesh *mesh = map && !failed_early(c) ? map->mesh : qc_bag_latest(c->bag, QC_TYPE_MESH);
    const bool face = !failed_early(c);
    if (!mesh || error->where < 0 || error->where >= (face ? mesh->n_faces : mesh->n_vertices))
        return false;
    for (int i = 0; i < 3; i++) {
        place[i] = 0;
        for (int k = 0; k < 3; k++) {
            const int64_t v = face ? mesh->face_vertex[3 * error->where + k] : error->where;
            place[i] += mesh->position[3 * v + i] / 3;
        }
    }
    return true;
}

static qc_status give_up_features(climb *c, int32_t keep) {
    double place[3];
    const qc_sizing *sizing = qc_bag_latest(c->bag, QC_TYPE_SIZING);
    const double quad = sizing ? sizing->edge_length : c->given_up.features->mesh->diagonal / 100;
    const bool known = find_place(c, place);
    char reason[512];
    snprintf(reason, sizeof reason, "%s", qc_ctx_error(c->ctx)->text);
    return qc__concessions_grow(c->ctx, &c->given_up, count_dropped(&c->given_up, keep),
                                known ? place : NULL, quad, reason);
}

/* Steps from .. end - 1 in [lo, hi] of the progress. */
static qc_status run_range(const climb *c, uint32_t from, uint32_t end, double lo, double hi) {
    if (from >= end) return QC_OK;
    const qc__range outer = qc__range_begin(c->ctx, NULL, lo, hi);
    const qc_status status = qc_pipeline_run_range(c->pipeline, from, end, c->bag);
    qc__range_end(c->ctx, outer);
    return status;
}

/* Steps from `from` on, apart up to the rounding, so that what they make is there for the next
 * attempt; [lo, 1] of the progress. */
static qc_status run_from(const climb *c, uint32_t from, double lo) {
    const uint32_t round = (uint32_t)c->round;
    const double middle = lo + (1 - lo) * (double)(round - from) / (c->end - from);
    qc_status status = QC_OK;
    if (c->rehearsal)
        return qc__optimisation_rehearse(c->ctx, c->pipeline, c->bag, c->optimise, from, round);
    if (c->as_smoothed && from < c->optimise.end) {
        status = run_range(c, from, c->optimise.first, lo, middle);
        if (status == QC_OK) status = qc__optimisation_undo(c->pipeline, c->bag, c->optimise);
        from = c->optimise.end;
    }
    if (status == QC_OK) status = run_range(c, from, round, lo, middle);
    return status == QC_OK ? run_range(c, round, c->end, middle, 1) : status;
}

static qc_status run_rung(climb *c, rung before, rung r) {
    const bool fewer = r.keep >= LESS_ONE && r.keep <= BOUNDARIES;
    const bool soft = c->hard && r.keep == GUIDES && before.keep != GUIDES;
    qc_status status = fewer ? give_up_features(c, r.keep) : QC_OK;
    if (status == QC_OK && fewer) status = put_features(c);
    if (status == QC_OK) status = set_rung(c, r);
    c->as_smoothed |= r.keep == AS_SMOOTHED;
    /* with other features the field changes as well */
    const int64_t from = soft                    ? c->features
                         : fewer                 ? c->edges.step + 1
                         : r.keep == AS_SMOOTHED ? c->optimise.first
                                                 : c->round;
    return status == QC_OK ? run_from(c, (uint32_t)from, 1) : status;
}

static qc_status run_ladder(climb *c, qc_status status) {
    rung before = {0, 0, c->hard ? ALL : GUIDES};
    char reason[512];
    snprintf(reason, sizeof reason, "%s", qc_ctx_error(c->ctx)->text);
    for (int i = 1; i < RUNGS && status == QC_ERR_FAILED; i++) {
        const rung r = ladder[i];
        const bool same = !c->hard && r.finer == 0 && r.other == 0;
        if (same || !worth_trying(c, r, before)) continue;
        if (r.finer == 1 || (r.keep == GUIDES && before.keep != GUIDES))
            snprintf(reason, sizeof reason, "%s", qc_ctx_error(c->ctx)->text);
        qc__log(c->ctx, QC_LOG_WARNING, "%s; trying again with %s", qc_ctx_error(c->ctx)->text,
                difference(before, r));
        status = run_rung(c, before, r);
        if (status == QC_OK) warn_compromise(c, r, reason);
        before = r;
    }
    const qc_status restored = set_rung(c, (rung){0, 0, ALL});
    return status == QC_OK ? restored : status;
}

/* The first attempt, and others while they fail. */
static qc_status climb_up(climb *c, uint32_t from) {
    qc_status status = run_from(c, from, 0);
    if (status != QC_ERR_FAILED) return status;
    const qc_status read = read_settings(c);
    return read == QC_OK ? run_ladder(c, status) : read;
}

/* What hard features leave no room for is given up before the branch points are optimised. */
static qc_status prepare_optimisation(climb *c) {
    c->rehearsal = true;
    const qc_status status = climb_up(c, c->first);
    c->rehearsal = false;
    return status;
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
    c.optimise = qc__optimisation_find(pipeline, first, (uint32_t)c.round);
    qc_status status = c.optimise.end > 0 ? prepare_optimisation(&c) : QC_OK;
    if (status == QC_OK) status = climb_up(&c, c.optimise.end > 0 ? c.optimise.first : first);
    qc__concessions_clear(&c.given_up);
    return status;
}
