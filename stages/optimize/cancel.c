/* Stage qc.optimize.cancel: step 1 of Algorithm 6.1. */
#include "stages/optimize/common.h"

typedef struct params {
    double lambda, spacing;
    int64_t neighbours;
} params;

QC__OPTIMIZE_PORTS
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "", QC__LAMBDA_DOC),
    QC_PARAM_INT(params, neighbours, 3, 1, 100, "",
                 "nearest branch points of opposite sign which are tried for each one"),
    QC_PARAM_REAL(params, spacing, 0.7, 0, 100, "quad",
                  "pairs nearer than this are cancelled even when E_D rises; 0 = none"),
};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_distortion *d = NULL;
    qc_status status = qc__optimize_begin(r, p->lambda, &d);
    if (status) return status;
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    qc_cancel_options options = QC_CANCEL_OPTIONS_INIT;
    options.neighbours = (int32_t)p->neighbours;
    options.spacing = p->spacing * qc__quad_length(r);
    options.most = s.whole;
    status = qc_distortion_cancel(r->ctx, d, &options, NULL);
    return qc__optimize_end(r, status, d, NULL);
}

const qc_stage qc_stage_optimize_cancel = {
    QC_STAGE_SIZES,
    .id = "qc.optimize.cancel",
    .version = "1.0",
    .brief = "Cancels pairs of branch points where that lowers the distortion.",
    .doc = "For each branch point the nearest ones of opposite sign are tried: its index is "
           "carried to them along edges, the smoothest field for the new matching computed and "
           "E_D measured. Pairs are cancelled in order of the change of E_D.",
    .cite = "thesis 6.2.2, Algorithm 6.1, step 1",
    .in = in,
    .out = out,
    .n_in = 2,
    .n_out = 2,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
