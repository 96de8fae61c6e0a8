/* Stage qc.optimize.balance: step 4 of Algorithm 6.1. */
#include "stages/optimize/common.h"

typedef struct params {
    double lambda, pair_cost, spacing, gain;
    int64_t neighbours, rounds, evaluations;
} params;

QC__OPTIMIZE_PORTS
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "", QC__LAMBDA_DOC),
    QC_PARAM_REAL(params, pair_cost, 0.5, 0, 1e6, "quad area",
                  "expected fall of the rounding error E_H when a pair is cancelled"),
    QC_PARAM_REAL(params, spacing, 1, 0, 100, "quad",
                  "pairs nearer than this are cancelled at any price; the others do not move "
                  "nearer than this"),
    QC_PARAM_REAL(params, gain, 0.03, 0, 1e6, "quad area",
                  "smallest fall of E_D for which a branch point is moved"),
    QC_PARAM_INT(params, neighbours, 3, 1, 100, "",
                 "nearest branch points of opposite sign which are tried for each one"),
    QC_PARAM_INT(params, rounds, 8, 1, 1000, "", "of cancelling and moving, at most"),
    QC_PARAM_INT(params, evaluations, 1000, 0, 1e9, "",
                 "of E_D for moving, at most, in each round"),
};

static qc_status balance(const qc_run *r, const params *p, qc_distortion *d) {
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    qc_cancel_options cancel = QC_CANCEL_OPTIONS_INIT;
    cancel.neighbours = (int32_t)p->neighbours;
    cancel.increase = p->pair_cost;
    cancel.spacing = p->spacing * qc__quad_length(r);
    cancel.most = s.whole;
    qc_reduce_options move = QC_REDUCE_OPTIONS_INIT;
    move.evaluations = p->evaluations;
    move.spacing = cancel.spacing;
    move.gain = p->gain;
    for (int64_t i = 0; i < p->rounds; i++) {
        int32_t cancelled = 0;
        qc_status status = qc_distortion_cancel(r->ctx, d, &cancel, &cancelled);
        if (status || (cancelled == 0 && i > 0)) return status;
        status = qc_distortion_reduce(r->ctx, d, &move);
        if (status) return status;
    }
    return QC_OK;
}

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_distortion *d = NULL;
    const qc_status status = qc__optimize_begin(r, p->lambda, &d);
    return status ? status : qc__optimize_end(r, balance(r, p, d), d);
}

const qc_stage qc_stage_optimize_balance = {
    QC_STAGE_SIZES,
    .id = "qc.optimize.balance",
    .version = "1.0",
    .brief = "Cancels branch points which cost more rounding error than they save curl.",
    .doc = "The rounding error E_H grows linearly with the number of branch points: tr(P) / 24 "
           "before optimisation, with P_ii between 2 and 3 for each of the two real conditions of "
           "a branch point. A pair is cancelled when E_D rises by less than E_H is expected to "
           "fall; the others are then moved without creating new ones, and so on until nothing "
           "is cancelled.",
    .cite = "thesis 6.4, Algorithm 6.1, step 4",
    .in = in,
    .out = out,
    .n_in = 2,
    .n_out = 2,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
