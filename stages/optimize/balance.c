/* Stage qc.optimize.balance: step 4 of Algorithm 6.1. */
#include <math.h>
#include <stdio.h>

#include "stages/optimize/common.h"

typedef struct params {
    double lambda, pair_cost, spacing, gain;
    int64_t count, neighbours, rounds, evaluations;
    bool measure;
} params;

QC__OPTIMIZE_PORTS
static const qc_param table[] = {
    QC_PARAM_REAL(params, lambda, 0.9, 0, 1, "", QC__LAMBDA_DOC),
    QC_PARAM_REAL(params, pair_cost, 0.5, 0, 1e6, "quad area",
                  "expected fall of the rounding error E_H when a pair is cancelled; with measure "
                  "the first price"),
    QC_PARAM_BOOL(params, measure, true,
                  "rounds what each price leaves, and asks higher prices while E_D + E_H falls"),
    QC_PARAM_INT(params, count, 0, 0, 1e9, "",
                 "cancels the cheapest pairs until so many branch points are left; 0 = by price"),
    QC_PARAM_REAL(params, spacing, 1, 0, 100, "quad",
                  "pairs nearer than this are cancelled at any price; the others do not move "
                  "nearer than this"),
    QC_PARAM_REAL(params, gain, 0.03, 0, 1e6, "quad area",
                  "smallest fall of E_D for which a branch point is moved"),
    QC_PARAM_INT(params, neighbours, 3, 1, 100, "",
                 "nearest branch points of opposite sign which are tried for each one"),
    QC_PARAM_INT(params, rounds, 16, 1, 1000, "", "of cancelling and moving, at most, for a price"),
    QC_PARAM_INT(params, evaluations, 1000, 0, 1e9, "",
                 "of E_D for moving, at most, in each round"),
};

/* Prices rise by this factor as long as the sum falls. */
static const double RISE = 1.6;
enum {
    PRICES = 20,
    FEW = 64 /* a round which cancels fewer than one of so many points is the last for a price */
};

/* Pairs to cancel before the others are moved: a quarter of as many as all points, or half of what
 * is too much when a count is wanted. */
static int64_t some_pairs(const params *p, const qc_distortion *d) {
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    if (p->count > 0) return s.branch_points > p->count ? (s.branch_points - p->count + 3) / 4 : 0;
    return s.branch_points / 4 + 1;
}

/* Cancels pairs which cost E_D less than the price and moves the others, until nothing is
 * cancelled. *cancelled: pairs in all. */
static qc_status balance(const qc_run *r, const params *p, double price, qc_distortion *d,
                         int64_t *cancelled) {
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    qc_cancel_options cancel = QC_CANCEL_OPTIONS_INIT;
    cancel.neighbours = (int32_t)p->neighbours;
    cancel.increase = p->count > 0 ? s.whole : price;
    cancel.spacing = p->spacing * qc__quad_length(r);
    cancel.most = s.whole;
    qc_reduce_options move = QC_REDUCE_OPTIONS_INIT;
    move.evaluations = p->evaluations;
    move.spacing = cancel.spacing;
    move.gain = p->gain;
    move.patience = 32;
    *cancelled = 0;
    for (int64_t i = 0; i < p->rounds; i++) {
        int32_t now = 0;
        cancel.pairs = some_pairs(p, d);
        if (cancel.pairs == 0) return QC_OK;
        qc_distortion_get_state(d, &s);
        qc_status status = qc_distortion_cancel(r->ctx, d, &cancel, &now);
        *cancelled += now;
        if (status || (now == 0 && i > 0)) return status;
        status = qc_distortion_reduce(r->ctx, d, &move);
        const bool few = p->count == 0 && 2 * (int64_t)FEW * now < s.branch_points;
        if (status || few) return status;
    }
    return QC_OK;
}

static void log_price(const qc_run *r, double price, int32_t points, double sum) {
    char text[120];
    snprintf(text, sizeof text, "price %.2f: %d branch points, E_D + E_H = %.3f %% of the field",
             price, (int)points, 100 * sum);
    r->log(r, QC_LOG_INFO, text);
}

/* Figure 6.5 from the right: the state of least E_D + E_H on the way to fewer branch points. */
static qc_status find_balance(const qc_run *r, const params *p, qc_distortion *d,
                              qc_matching **best) {
    double price = p->pair_cost, least = INFINITY;
    bool falls = true;
    qc_status status = QC_OK;
    for (int32_t i = 0; i < PRICES && falls; i++, price *= RISE) {
        int64_t cancelled = 0;
        double sum = INFINITY;
        qc_matching *matching = NULL;
        status = balance(r, p, price, d, &cancelled);
        if (status || qc_ctx_out_of_time(r->ctx)) break;
        if (cancelled == 0 && i > 0) continue;
        status = qc_distortion_matching(r->ctx, d, &matching);
        if (!status) status = qc__error_sum(r, matching, &sum);
        if (status) {
            qc_object_release(matching);
            break;
        }
        log_price(r, price, matching->n_singular, sum);
        falls = sum < least;
        if (falls || !*best) {
            qc_object_release(*best);
            *best = matching;
            least = sum;
        } else {
            qc_object_release(matching);
        }
    }
    return status;
}

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    int64_t cancelled = 0;
    qc_distortion *d = NULL;
    qc_matching *best = NULL;
    qc_status status = qc__optimize_begin(r, p->lambda, &d);
    if (status) return status;
    if (p->measure && p->count == 0)
        status = find_balance(r, p, d, &best);
    else
        status = balance(r, p, p->pair_cost, d, &cancelled);
    return qc__optimize_end(r, status, d, best);
}

const qc_stage qc_stage_optimize_balance = {
    QC_STAGE_SIZES,
    .id = "qc.optimize.balance",
    .version = "1.1",
    .brief = "Cancels branch points which cost more rounding error than they save curl.",
    .doc = "A pair of branch points is cancelled when E_D rises by less than its price; the others "
           "are then moved without creating new ones, and so on until nothing is cancelled. The "
           "map at that state is rounded, which gives E_H by the period matrix; the price rises "
           "while E_D + E_H falls, and the state of the least sum is kept. A coarse grid is left "
           "with fewer branch points than a fine one, as E_D grows with the number of quads and "
           "E_H does not.",
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
