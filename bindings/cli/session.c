/* A run of the program: context, progress display, Ctrl-C and the time limit. */
#include "bindings/cli/cli.h"
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

const char *const cli_progress_names[] = {"auto", "plain", "none", NULL};

static volatile sig_atomic_t interrupted;

/* SA_RESETHAND: a second Ctrl-C ends the program at once. */
static void on_signal(int number) {
    (void)number;
    interrupted = 1;
}

void cli_catch_interrupts(void) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = (int)SA_RESETHAND;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool cli_interrupted(void) {
    return interrupted != 0;
}

double cli_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Steps end early to meet the limit; a run which is so much later than that is given up. */
static double latest(const cli_session *s) {
    return 1.5 * s->time_limit;
}

static void show(cli_session *s, const char *stage, double fraction) {
    const double now = cli_seconds();
    const bool new_stage = strcmp(stage, s->last_stage) != 0;
    if (now - s->last_time < (s->progress == CLI_PROGRESS_PLAIN ? 1.0 : 0.1) && !new_stage) return;
    s->last_time = now;
    snprintf(s->last_stage, sizeof s->last_stage, "%s", stage);
    const char *detail = qc_ctx_progress_detail(s->ctx);
    if (s->progress == CLI_PROGRESS_PLAIN) {
        fprintf(stderr, "quadcover: %3.0f %% %s%s%s\n", 100 * fraction, stage, *detail ? ": " : "",
                detail);
        return;
    }
    fprintf(stderr, "\r\033[K%3.0f %% %s%s%s", 100 * fraction, stage, *detail ? ": " : "", detail);
    s->line_open = true;
}

static bool on_progress(void *user, const char *stage, double fraction) {
    cli_session *s = user;
    if (s->progress != CLI_PROGRESS_NONE) show(s, stage, fraction);
    if (s->time_limit > 0 && cli_seconds() - s->start > latest(s)) s->out_of_time = true;
    return !interrupted && !s->out_of_time;
}

void cli_session_warn(cli_session *s, const char *format, ...) {
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    cli_session_quiet(s);
    cli_warning("%s", text);
    char *copy = strdup(text);
    char **grown = copy ? realloc(s->warning, ((size_t)s->n_warnings + 1) * sizeof *grown) : NULL;
    if (!grown) {
        free(copy);
        return;
    }
    s->warning = grown;
    s->warning[s->n_warnings++] = copy;
}

/* Room doubles at powers of two. A curve ends where memory does. */
static void on_sample(void *user, const char *stage, const char *curve, double x, double y) {
    cli_session *s = user;
    const size_t n = s->n_samples;
    if ((n & (n - 1)) == 0) {
        cli_sample *grown = realloc(s->sample, (n ? 2 * n : 1) * sizeof *grown);
        if (!grown) return;
        s->sample = grown;
    }
    cli_sample *point = &s->sample[s->n_samples++];
    snprintf(point->step, sizeof point->step, "%s", stage);
    snprintf(point->curve, sizeof point->curve, "%s", curve);
    point->x = x;
    point->y = y;
}

static void on_log(void *user, int32_t level, const char *stage, const char *text) {
    if (level < QC_LOG_WARNING) return;
    const bool named = strncmp(text, stage, strlen(stage)) == 0; /* "" is a prefix of all */
    cli_session_warn(user, "%s%s%s", named ? "" : stage, named ? "" : ": ", text);
}

int cli_session_open(cli_session *session, const cli_common *common) {
    memset(session, 0, sizeof *session);
    session->start = cli_seconds();
    session->time_limit = common->time_limit;
    session->progress = common->progress == CLI_PROGRESS_AUTO && !isatty(STDERR_FILENO)
                            ? CLI_PROGRESS_NONE
                            : common->progress;
    cli_catch_interrupts();
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = (uint32_t)common->threads;
    options.progress = on_progress;
    options.log = on_log;
    options.sample = on_sample;
    options.user = session;
    const qc_status status = qc_ctx_create(&options, &session->ctx);
    if (status != QC_OK) return cli_error(EXIT_FAILED, "%s", qc_status_name(status));
    if (session->time_limit > 0) qc_ctx_set_time_budget(session->ctx, session->time_limit);
    return EXIT_DONE;
}

void cli_session_close(cli_session *session) {
    cli_session_quiet(session);
    for (int i = 0; i < session->n_warnings; i++) free(session->warning[i]);
    free(session->warning);
    free(session->sample);
    qc_ctx_free(session->ctx);
    session->ctx = NULL;
}

void cli_session_quiet(cli_session *session) {
    if (session->line_open) fputs("\r\033[K", stderr);
    session->line_open = false;
}

bool cli_stats(const cli_session *session, const qc_report *report, const qc_pipeline *pipeline,
               const char *input, const char *mode, const qc_stats_options *stats, char **json) {
    qc_stats_options o = QC_STATS_OPTIONS_INIT;
    o.input = input;
    o.mode = mode;
    o.total = cli_seconds() - session->start;
    o.read = stats->read;
    o.write = stats->write;
    o.n_warnings = session->n_warnings;
    o.warning = (const char *const *)session->warning;
    return qc_stats_json(session->ctx, report, pipeline, &o, json) == QC_OK;
}

int cli_session_error(cli_session *session, const char *prefix, int fallback) {
    cli_session_quiet(session);
    if (interrupted) return cli_error(EXIT_INTERRUPTED, "interrupted");
    if (session->out_of_time)
        return cli_error(EXIT_FAILED, "%s: time limit of %g s reached",
                         qc_ctx_error(session->ctx)->stage, session->time_limit);
    return cli_context_error(session->ctx, prefix, fallback);
}

/* A run writes nothing: a file which it cannot open is one that a parameter names. */
int cli_run_error(cli_session *session, const char *input) {
    const bool file = qc_ctx_error(session->ctx)->status == QC_ERR_IO;
    return cli_session_error(session, input, file ? EXIT_INPUT : EXIT_FAILED);
}
