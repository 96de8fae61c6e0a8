/* Stage qc.untangle: removes fold-overs, keeping transitions and lattice points
 * (docs/theory/untangling.md). */
#include <qc/map.h>
#include <qc/stages.h>
#include <stdio.h>

typedef struct params {
    bool enabled;
    int64_t rounds, iterations, relax;
} params;

static const qc_port in[] = {
    {"map", QC_TYPE_CORNER_MAP, 0, "integer-seamless map"},
};
static const qc_port out[] = {
    {"map", QC_TYPE_CORNER_MAP, 0,
     "the same map on the exact grid, without fold-overs where possible"},
};
static const qc_param table[] = {
    QC_PARAM_BOOL(params, enabled, true, "false: only writes the map on the exact grid"),
    QC_PARAM_INT(params, rounds, 20, 1, 1000, "", "outer rounds for each neighbourhood"),
    QC_PARAM_INT(params, iterations, 200, 1, 100000, "", "L-BFGS iterations in a round"),
    QC_PARAM_INT(
        params, relax, 50, 0, 100000, "",
        "then steps which even out what was moved or is distorted, at most; every face stays "
        "positive"),
};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    const qc_corner_map *map = r->input(r, "map");
    qc_grid_map *before = NULL, *after = NULL;
    qc_corner_map *result = NULL;
    qc_status status = qc_grid_map_create(r->ctx, map, 0, &before);
    if (status != QC_OK) return status;
    const int32_t bad = before->n_flipped + before->n_degenerate;
    if (p->enabled && (bad > 0 || p->relax > 0)) {
        qc_untangle_options options = QC_UNTANGLE_OPTIONS_INIT;
        options.max_rounds = (int32_t)p->rounds;
        options.max_iterations = (int32_t)p->iterations;
        options.relax = (int32_t)p->relax;
        status = qc_map_untangle(r->ctx, map, &options, &result);
        if (status == QC_OK && bad > 0) status = qc_grid_map_create(r->ctx, result, 0, &after);
        if (after) {
            char text[160];
            snprintf(text, sizeof text, "fold-overs at %d faces before, %d after", bad,
                     after->n_flipped + after->n_degenerate);
            r->log(r, QC_LOG_INFO, text);
        }
        qc_object_release(after);
    } else {
        status = qc_grid_map_to_corner_map(r->ctx, before, map, &result);
    }
    qc_object_release(before);
    if (status != QC_OK) {
        qc_object_release(result);
        return status;
    }
    return r->output(r, "map", result);
}

const qc_stage qc_stage_untangle = {
    QC_STAGE_SIZES,
    .id = "qc.untangle",
    .version = "1.0",
    .brief = "Removes fold-overs of an integer-seamless map and writes it on the exact grid.",
    .doc = "Where faces are inverted or degenerate, the parameters in a neighbourhood move to the "
           "minimum of a regularised distortion energy which is finite for inverted faces; its "
           "regularisation falls until every face is positively oriented by an exact integer test. "
           "Transitions and cones do not change. Neighbourhoods grow when they are too small. "
           "Where that "
           "succeeds, what was moved or is badly distorted is evened out by steps which keep every "
           "face positive.",
    .cite = "Garanzha et al. 2021, Foldover-free maps in 50 lines of code",
    .in = in,
    .out = out,
    .n_in = 1,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
