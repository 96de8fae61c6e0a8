/* Stage qc.optimize.merge: 2007 paper, 4.2. */
#include <qc/optimize.h>
#include <qc/stages.h>

#include <stdio.h>

typedef struct params {
    double lambda;
} params;

static qc_status merge(const qc_run *run, const void *raw) {
    const params *p = raw;
    const qc_matching *before = run->input(run, "matching");
    qc_matching *out = NULL;
    double cost[2];
    const qc_status status = qc_matching_merge(run->ctx, before, p->lambda, INT32_MAX, cost, &out);
    if (status) return status;
    char text[128];
    snprintf(text, sizeof text, "%d branch points (before: %d), cost %.6g (before: %.6g)",
             (int)out->n_singular, (int)before->n_singular, cost[1], cost[0]);
    run->log(run, QC_LOG_INFO, text);
    return run->output(run, "matching", out);
}

static const qc_port in[] = {{"matching", QC_TYPE_MATCHING, 0, "cross field with its matching"}};
static const qc_port out[] = {{"matching", QC_TYPE_MATCHING, 0, "the same field, matched anew"}};
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 3, 0, 1e6, "rad",
                  "what a branch point costs against angles between matched directions: an edge on "
                  "the path costs up to pi / 2"),
};

const qc_stage qc_stage_optimize_merge = {
    QC_STAGE_SIZES,
    .id = "qc.optimize.merge",
    .version = "1.0",
    .brief = "Merges branch points along paths of changed matchings.",
    .doc = "The cost is lambda for each branch point plus the angle between matched directions at "
           "each edge. Turning the matching along a path of edges carries the index of a branch "
           "point to another one; the change that lowers the cost most is made first, as long as "
           "there is one. Indices stay between -2/4 and 1/4. The field keeps its directions.",
    .cite = "2007 paper, 4.2",
    .in = in,
    .out = out,
    .n_in = 1,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = merge,
};
