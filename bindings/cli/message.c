/* Messages and exit statuses. */
#include "bindings/cli/cli.h"
#include <stdarg.h>
#include <string.h>

/* One write, one line: texts of files may hold newlines. */
static void print(const char *kind, const char *format, va_list args) {
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    for (char *c = text; *c; c++)
        if (*c == '\n' || *c == '\r') *c = ' ';
    fprintf(stderr, "quadcover: %s: %s\n", kind, text);
}

int cli_error(int status, const char *format, ...) {
    va_list args;
    va_start(args, format);
    print("error", format, args);
    va_end(args);
    return status;
}

void cli_warning(const char *format, ...) {
    va_list args;
    va_start(args, format);
    print("warning", format, args);
    va_end(args);
}

static int exit_status(qc_status status, int fallback) {
    switch (status) {
    case QC_ERR_CANCELLED:
        return EXIT_INTERRUPTED;
    case QC_ERR_INPUT:
    case QC_ERR_NON_MANIFOLD:
        return EXIT_INPUT;
    case QC_ERR_NOT_FOUND:
    case QC_ERR_WIRING:
    case QC_ERR_ABI:
        return EXIT_USAGE;
    default:
        return fallback;
    }
}

int cli_context_error(qc_ctx *ctx, const char *prefix, int fallback) {
    const qc_error *error = qc_ctx_error(ctx);
    const bool named = prefix && strncmp(error->text, prefix, strlen(prefix)) == 0;
    return cli_error(exit_status(error->status, fallback), "%s%s%s%s%s",
                     prefix && !named ? prefix : "", prefix && !named ? ": " : "", error->stage,
                     *error->stage ? ": " : "", error->text);
}

int cli_usage_error(qc_ctx *ctx, const char *prefix) {
    cli_context_error(ctx, prefix, EXIT_USAGE);
    return EXIT_USAGE;
}
