/* What a batch shows on stderr while it runs. */
#include "bindings/cli/batch.h"

static void print_duration(FILE *out, double seconds) {
    const long s = (long)(seconds + 0.5);
    if (s < 3600)
        fprintf(out, "%ld:%02ld", s / 60, s % 60);
    else
        fprintf(out, "%ld h %02ld", s / 3600, s / 60 % 60);
}

/* "3 of 10 meshes, 1 failed, 0:20 left": what is left by the sizes of the files. */
static void print_state(const batch *b) {
    fprintf(stderr, "%zu of %zu meshes", b->ended, json_array_size(b->pending));
    if (json_array_size(b->failed) > 0) fprintf(stderr, ", %zu failed", json_array_size(b->failed));
    if (b->bytes_ended <= 0) return;
    fputs(", ", stderr);
    print_duration(stderr, (cli_seconds() - b->start) * (b->bytes / b->bytes_ended - 1));
    fputs(" left", stderr);
}

void batch_show_state(void *user, int running) {
    batch *b = user;
    if (!b->on_terminal || cli_seconds() - b->last_shown < 0.5) return;
    b->last_shown = cli_seconds();
    fputs("\r\033[K", stderr);
    print_state(b);
    fprintf(stderr, ", %d at work", running);
    b->line_open = true;
}

void batch_quiet(batch *b) {
    if (b->line_open) fputs("\r\033[K", stderr);
    b->line_open = false;
}

void batch_show(batch *b, const json_t *line) {
    batch_quiet(b);
    if (b->settings->progress == CLI_PROGRESS_PLAIN) {
        fprintf(stderr, "quadcover: %s: %s, %.1f s; ", batch_text(line, "name"),
                batch_text(line, "status"), batch_number(line, "seconds"));
        print_state(b);
        fputc('\n', stderr);
    } else if (b->on_terminal && !batch_line_done(line))
        cli_warning("%s: %s: %s", batch_text(line, "name"), batch_text(line, "status"),
                    batch_text(line, "message"));
}
