/* The line of a mesh of a batch: what became of it, in figures and words. */
#include "bindings/cli/batch.h"
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>

/* JSON holds UTF-8 only; messages may quote anything. */
static json_t *readable(char *text) {
    json_t *string = json_string(text);
    if (string) return string;
    for (char *c = text; *c; c++)
        if ((unsigned char)*c >= 128) *c = '?';
    return json_string(text);
}

/* The last error which the process printed, or its last line. */
static json_t *message(const batch_worker *w, int *warnings) {
    static const char error[] = "quadcover: error: ", warning[] = "quadcover: warning: ";
    char *path = batch_format("%s/messages", w->work), *line = NULL;
    FILE *file = path ? fopen(path, "r") : NULL;
    json_t *text = NULL;
    size_t size = 0;
    bool found = false;
    while (file && getline(&line, &size, file) >= 0) {
        line[strcspn(line, "\r\n")] = '\0';
        const bool is_error = strncmp(line, error, strlen(error)) == 0;
        *warnings += strncmp(line, warning, strlen(warning)) == 0;
        if (!*line || (found && !is_error)) continue;
        found = is_error;
        json_decref(text);
        text = readable(line + (is_error ? strlen(error) : 0));
    }
    if (file) fclose(file);
    free(line);
    free(path);
    return text;
}

static const char *status_word(const batch_worker *w, int ended) {
    if (w->verdict) return w->verdict;
    if (WIFSIGNALED(ended)) return "crashed";
    if (WEXITSTATUS(ended) == EXIT_DONE) return "done";
    return WEXITSTATUS(ended) == EXIT_INPUT ? "input" : "failed";
}

static json_t *reason(const batch_worker *w, int ended, json_t *said) {
    const double limit = batch_number(w->task, "limit"), memory = batch_number(w->task, "memory");
    char *text = NULL;
    if (w->verdict && strcmp(w->verdict, "timeout") == 0)
        text = batch_format("more than %g s", limit);
    else if (w->verdict)
        text = batch_format("more than %g MB", memory);
    else if (WIFSIGNALED(ended))
        text = batch_format("ended by signal %d", WTERMSIG(ended));
    if (!text) return said ? said : json_string("");
    json_t *result = json_string(text);
    json_decref(said);
    free(text);
    return result;
}

/* Figures of the statistics which are worth comparing. */
static void add_figures(json_t *line, const char *path) {
    static const char *const figures[] = {"irregular", "rsd_edge", "rsd_angle",
                                          "min_scaled_jacobian", "hausdorff_rel"};
    json_t *stats = json_load_file(path, 0, NULL), *quads = json_object_get(stats, "quads");
    json_object_set(line, "quads", json_object_get(quads, "faces"));
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        json_object_set(line, figures[i], json_object_get(quads, figures[i]));
    json_decref(stats);
}

static double seconds(struct timeval t) {
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

json_t *batch_make_line(const batch_worker *w, int ended, const struct rusage *usage,
                        bool written) {
    const json_t *outputs = json_object_get(w->task, "outputs");
    const double spent = cli_seconds() - w->start;
    const char *status = written ? status_word(w, ended) : "failed";
    int warnings = 0;
    json_t *said = message(w, &warnings),
           *text = written ? reason(w, ended, said) : json_string("cannot write the results");
    if (!written) json_decref(said);
    json_t *line = json_pack(
        "{s:O,s:O,s:O,s:O,s:s,s:i,s:o,s:f,s:f,s:f,s:i}", "name", json_object_get(w->task, "name"),
        "input", json_object_get(w->task, "input"), "bytes", json_object_get(w->task, "bytes"),
        "key", json_object_get(w->task, "key"), "status", status, "exit",
        WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended), "message", text, "seconds",
        spent, "cpu_seconds", seconds(usage->ru_utime) + seconds(usage->ru_stime), "peak_rss_mb",
        (double)usage->ru_maxrss / 1024, "warnings", warnings);
    if (line && batch_line_done(line)) {
        add_figures(line, json_string_value(json_array_get(outputs, 1)));
        json_object_set(line, "output", json_array_get(outputs, 0));
    }
    return line;
}
