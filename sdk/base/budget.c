/* Time budgets: how long steps may improve what is valid already. A step gets half of what is left
 * after a reserve for those to come, which are expected to take as long as those before which had
 * nothing to give up. */
#include "sdk/base/context_private.h"

#include <math.h>

static const double SHARE = 0.5;

void qc_ctx_set_time_budget(qc_ctx *ctx, double seconds) {
    ctx->time = (qc__time){INFINITY, INFINITY, 0, 0, false, false};
    if (seconds >= 0) ctx->time.end = qc__now() + seconds;
}

qc__time qc__time_share(qc_ctx *ctx, double share) {
    const qc__time outer = ctx->time;
    const double now = qc__now();
    if (outer.end < INFINITY) ctx->time.end = now + share * fmax(outer.end - now, 0);
    ctx->time.fixed = 0;
    return outer;
}

qc__time qc__time_begin_step(qc_ctx *ctx) {
    const qc__time outer = ctx->time;
    qc__time *t = &ctx->time;
    t->start = qc__now();
    t->asked = t->late = false;
    if (t->end < INFINITY) t->step_end = t->start + SHARE * fmax(t->end - t->fixed - t->start, 0);
    return outer;
}

void qc__time_end_step(qc_ctx *ctx, qc__time outer) {
    if (!ctx->time.asked) outer.fixed += qc__now() - ctx->time.start;
    ctx->time = outer;
}

void qc__time_end_share(qc_ctx *ctx, qc__time outer) {
    ctx->time = outer;
}

double qc__time_left(const qc_ctx *ctx) {
    return fmax(ctx->time.step_end - qc__now(), 0);
}

bool qc_ctx_out_of_time(qc_ctx *ctx) {
    return qc__out_of_time(ctx);
}

bool qc__out_of_time(qc_ctx *ctx) {
    qc__time *t = &ctx->time;
    t->asked = true;
    if (!(t->step_end < INFINITY) || qc__now() < t->step_end) return false;
    if (!t->late)
        qc__log(ctx, QC_LOG_WARNING, "ended early for lack of time, with the best so far");
    t->late = true;
    return true;
}
