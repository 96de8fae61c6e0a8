/* Contexts: creation, errors, log and progress. */
#include "sdk/base/context_private.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static void *default_resize(void *user, void *p, size_t old_size, size_t new_size) {
    (void)user;
    (void)old_size;
    if (new_size == 0) {
        free(p);
        return NULL;
    }
    return p ? realloc(p, new_size) : qc__large_block(new_size);
}

static uint32_t online_cores(void) {
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > 256 ? 256 : (uint32_t)n;
}

qc_status qc_ctx_create(const qc_ctx_options *options, qc_ctx **out) {
    if (!out) return QC_ERR_ARGUMENT;
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    if (options) {
        if (options->struct_size < sizeof(uint32_t) * 2) return QC_ERR_ABI;
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    }
    if (!o.resize) o.resize = default_resize;
    qc__isa isa;
    const qc_status status = qc__isa_select(o.instructions, &isa);
    if (status != QC_OK) return status;
    qc_ctx *ctx = o.resize(o.user, NULL, 0, sizeof *ctx);
    if (!ctx) return QC_ERR_NOMEM;
    memset(ctx, 0, sizeof *ctx);
    ctx->resize = o.resize;
    ctx->log = o.log;
    ctx->progress = o.progress;
    ctx->sample = o.sample;
    ctx->user = o.user;
    ctx->isa = isa;
    ctx->threads = o.threads == 0 ? online_cores() : o.threads > 256 ? 256 : o.threads;
    ctx->range = (qc__range){0.0, 1.0, "", 0};
    atomic_init(&ctx->cancelled, false);
    qc_ctx_set_time_budget(ctx, -1);
    qc__clear_error(ctx);
    *out = ctx;
    return QC_OK;
}

void qc_ctx_free(qc_ctx *ctx) {
    if (!ctx) return;
    qc__pool_free(ctx->pool);
    ctx->resize(ctx->user, ctx, sizeof *ctx, 0);
}

const qc_error *qc_ctx_error(const qc_ctx *ctx) {
    return &ctx->error;
}
uint32_t qc_ctx_threads(const qc_ctx *ctx) {
    return ctx->threads;
}
qc__isa qc__ctx_isa(const qc_ctx *ctx) {
    return ctx->isa;
}
const char *qc_ctx_instructions(const qc_ctx *ctx) {
    return qc__isa_name(ctx->isa);
}
const char *qc_version(void) {
    return QC_VERSION_STRING;
}

const char *qc_status_name(qc_status status) {
    static const char *const names[] = {"ok",
                                        "wrong argument",
                                        "out of memory",
                                        "cancelled",
                                        "not positive definite",
                                        "not a manifold",
                                        "incompatible version",
                                        "unusable input",
                                        "input/output error",
                                        "not found",
                                        "ports do not fit",
                                        "failed",
                                        "not supported"};
    const size_t n = sizeof names / sizeof *names;
    return status > 0 || (size_t)(-(int64_t)status) >= n ? "unknown status" : names[-status];
}

void qc__clear_error(qc_ctx *ctx) {
    ctx->stage_text[0] = ctx->error_text[0] = '\0';
    ctx->error = (qc_error){QC_OK, -1, ctx->stage_text, ctx->error_text};
}

static void record(qc_ctx *ctx, qc_status status, int64_t where, const char *format, va_list args) {
    char text[sizeof ctx->error_text]; /* the arguments may point into the old text */
    vsnprintf(text, sizeof text, format, args);
    for (char *c = text; *c; c++)
        if (*c == '\n' || *c == '\r') *c = ' ';
    memcpy(ctx->error_text, text, sizeof text);
    snprintf(ctx->stage_text, sizeof ctx->stage_text, "%s", ctx->range.stage);
    ctx->error = (qc_error){status, where, ctx->stage_text, ctx->error_text};
}

qc_status qc__fail(qc_ctx *ctx, qc_status status, int64_t where, const char *format, ...) {
    va_list args;
    va_start(args, format);
    record(ctx, status, where, format, args);
    va_end(args);
    return status;
}

qc_status qc_ctx_fail(qc_ctx *ctx, qc_status status, int64_t where, const char *text) {
    return qc__fail(ctx, status == QC_OK ? QC_ERR_FAILED : status, where, "%s", text ? text : "");
}

qc_status qc__nomem(qc_ctx *ctx) {
    return qc__fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
}

void qc__log(qc_ctx *ctx, int32_t level, const char *format, ...) {
    if (!ctx->log) return;
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    ctx->log(ctx->user, level, ctx->range.stage, text);
}

bool qc__progress(qc_ctx *ctx, double fraction) {
    if (!ctx->progress) return true;
    const double f = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
    double whole = ctx->range.lo + f * (ctx->range.hi - ctx->range.lo);
    if (ctx->range.depth > 0) whole = ctx->furthest = fmax(whole, ctx->furthest);
    const bool go_on = ctx->progress(ctx->user, ctx->range.stage, whole);
    atomic_store(&ctx->cancelled, !go_on);
    if (go_on) return true;
    qc__fail(ctx, QC_ERR_CANCELLED, -1, "cancelled");
    return false;
}

qc_status qc__poll(qc_ctx *ctx) {
    return qc__progress(ctx, 0) ? QC_OK : QC_ERR_CANCELLED;
}

void qc__detail(qc_ctx *ctx, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(ctx->detail, sizeof ctx->detail, format, args);
    va_end(args);
}

void qc_ctx_sample(qc_ctx *ctx, const char *curve, double x, double y) {
    if (ctx->sample) ctx->sample(ctx->user, ctx->range.stage, curve, x, y);
}

const char *qc_ctx_progress_detail(const qc_ctx *ctx) {
    return ctx->detail;
}

bool qc_ctx_progress(qc_ctx *ctx, double fraction) {
    return qc__progress(ctx, fraction);
}

bool qc__cancelled(const qc_ctx *ctx) {
    return atomic_load_explicit(&ctx->cancelled, memory_order_relaxed);
}

qc__range qc__range_begin(qc_ctx *ctx, const char *stage, double lo, double hi) {
    const qc__range outer = ctx->range;
    const double width = outer.hi - outer.lo;
    ctx->range = (qc__range){outer.lo + lo * width, outer.lo + hi * width,
                             stage ? stage : outer.stage, outer.depth + 1};
    if (outer.depth == 0) ctx->furthest = ctx->range.lo;
    if (stage) ctx->detail[0] = '\0';
    return outer;
}

void qc__range_end(qc_ctx *ctx, qc__range outer) {
    ctx->range = outer;
}

double qc__now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
