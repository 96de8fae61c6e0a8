/* Stage qc.optimize.curl: steps 2 and 3 of Algorithm 6.1. */
#include "stages/optimize/common.h"

typedef struct params {
    double lambda, spacing, gain, seconds;
    int64_t evaluations, patience;
    bool create;
} params;

QC__OPTIMIZE_PORTS
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "", QC__LAMBDA_DOC),
    QC_PARAM_BOOL(params, create, false,
                  "new pairs of branch points may appear; off: they move and cancel only"),
    QC_PARAM_REAL(params, spacing, 1, 0, 100, "quad",
                  "branch points do not move nearer to each other than this"),
    QC_PARAM_REAL(params, gain, 0.03, 0, 1e6, "quad area",
                  "smallest fall of E_D for which a flip is made"),
    QC_PARAM_INT(params, evaluations, 20000, 0, 1e9, "", "of E_D, at most"),
    QC_PARAM_REAL(params, seconds, 0, 0, 1e9, "s",
                  "ends with what there is after this time; 0 = none. The result then depends on "
                  "the machine"),
    QC_PARAM_INT(params, patience, 96, 1, 1e9, "",
                 "ends after so many trials in a row without gain"),
};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_distortion *d = NULL;
    qc_status status = qc__optimize_begin(r, p->lambda, &d);
    if (status) return status;
    qc_reduce_options options = QC_REDUCE_OPTIONS_INIT;
    options.create = p->create;
    options.spacing = p->spacing * qc__quad_length(r);
    options.gain = p->gain;
    options.evaluations = p->evaluations;
    options.patience = p->patience;
    options.seconds = p->seconds;
    status = qc_distortion_reduce(r->ctx, d, &options);
    return qc__optimize_end(r, status, d, NULL);
}

const qc_stage qc_stage_optimize_curl = {
    QC_STAGE_SIZES,
    .id = "qc.optimize.curl",
    .version = "1.0",
    .brief = "Moves (and creates) branch points such that the curl of the field falls.",
    .doc = "Edges are sorted by their share |Re(conj(v_e) r_e)| / 2 of E_D = 1/2 |X_C|^2. From the "
           "top the matching of each is changed by one turn so that |theta| falls, the smoothest "
           "field for it computed and E_D evaluated; what lowers E_D stays. Several edges are "
           "tried at a time, and those that pay are changed together. Every change kept was "
           "verified by an exact evaluation.",
    .cite = "thesis 6.2.1, 6.2.2, Algorithm 6.1, steps 2 and 3",
    .in = in,
    .out = out,
    .n_in = 2,
    .n_out = 2,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
