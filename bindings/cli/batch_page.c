/* summary.html of a batch: failures first, then all meshes with links and figures, and how long
 * they took. One file, no scripts, no requests. */
#include "bindings/cli/batch.h"
#include "bindings/cli/report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "style-src 'unsafe-inline'; img-src data:\">\n"
    "<title>QuadCover batch</title>\n<style>\n"
    ":root{color-scheme:light dark}\n"
    "body{font:15px/1.45 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem}\n"
    "table{border-collapse:collapse;width:100%}\n"
    "th,td{text-align:right;padding:.25rem .6rem;border-bottom:1px solid #8884}\n"
    "th{position:sticky;top:0;background:Canvas}\n"
    "th:first-child,td:first-child,.text{text-align:left}\n"
    "td.text{overflow-wrap:anywhere}\n"
    "svg text{font-size:12px;fill:currentColor;text-anchor:middle}\n"
    ".bar{fill:#3b7dd8}.bad{color:#c33}\n</style></head><body>\n";

static void print_text(FILE *out, const char *text) {
    for (; *text; text++) switch (*text) {
        case '<':
            fputs("&lt;", out);
            break;
        case '&':
            fputs("&amp;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*text, out);
        }
}

/* A link to a file of the folder, where there is one. */
static void print_link(FILE *out, const char *folder, const char *file, const char *text) {
    char *path = batch_format("%s/%s", folder, file);
    const bool there = path && access(path, R_OK) == 0;
    free(path);
    if (there) {
        fputs("<a href=\"", out);
        for (const char *c = file; *c; c++)
            fprintf(out, strchr(" \"#%&<>?\\^`{|}:'", *c) ? "%%%02X" : "%c", (unsigned char)*c);
        fputs("\">", out);
    }
    print_text(out, text);
    if (there) fputs("</a>", out);
}

/* A picture inside the page, where there is one. */
static void print_picture(FILE *out, const char *folder, const char *name) {
    unsigned char bytes[16384];
    char *path = batch_picture_path(folder, name);
    FILE *file = path ? fopen(path, "rb") : NULL;
    const size_t n = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    char *text = n > 0 ? cli_base64(bytes, n) : NULL;
    if (text) fprintf(out, "<img alt=\"\" src=\"data:image/png;base64,%s\">", text);
    if (file) fclose(file);
    free(text);
    free(path);
}

static void print_number(FILE *out, const json_t *line, const char *key, int digits) {
    const json_t *value = json_object_get(line, key);
    fputs("<td>", out);
    if (json_is_number(value)) fprintf(out, "%.*f", digits, json_number_value(value));
}

static void print_failures(FILE *out, const json_t *lines) {
    json_t *line;
    size_t i;
    bool open = false;
    json_array_foreach(lines, i, line) {
        if (batch_line_done(line)) continue;
        if (!open)
            fputs("<h2>Failures</h2>\n<table><tr><th>mesh<th class=\"text\">what"
                  "<th class=\"text\">message<th>s<th>MB\n",
                  out);
        open = true;
        fputs("<tr><td class=\"text\">", out);
        print_text(out, batch_text(line, "name"));
        fputs("<td class=\"text bad\">", out);
        print_text(out, batch_text(line, "status"));
        fputs("<td class=\"text\">", out);
        print_text(out, batch_text(line, "message"));
        print_number(out, line, "seconds", 1);
        print_number(out, line, "peak_rss_mb", 0);
        fputc('\n', out);
    }
    if (open) fputs("</table>\n", out);
}

static void print_done(FILE *out, const char *folder, const json_t *lines) {
    static const struct {
        const char *key, *title;
        int digits;
    } column[] = {{"quads", "quads", 0},
                  {"irregular", "irregular", 0},
                  {"rsd_edge", "RSD edge %", 1},
                  {"rsd_angle", "RSD angle %", 1},
                  {"min_scaled_jacobian", "min. Jacobian", 2},
                  {"warnings", "warnings", 0},
                  {"seconds", "s", 1},
                  {"peak_rss_mb", "MB", 0}};
    enum { N = sizeof column / sizeof *column };
    json_t *line;
    size_t i;
    fputs("<h2>Meshes</h2>\n<table><tr><th><th class=\"text\">mesh<th class=\"text\">", out);
    for (int c = 0; c < N; c++) fprintf(out, "<th>%s", column[c].title);
    fputc('\n', out);
    json_array_foreach(lines, i, line) {
        if (!batch_line_done(line)) continue;
        const char *name = batch_text(line, "name");
        const char *mesh = strrchr(batch_text(line, "output"), '/');
        char *report = batch_format("report/%s.html", name);
        fputs("<tr><td>", out);
        print_picture(out, folder, name);
        fputs("<td class=\"text\">", out);
        if (mesh) print_link(out, folder, mesh + 1, name);
        fputs("<td class=\"text\">", out);
        char *path = report ? batch_format("%s/%s", folder, report) : NULL;
        if (path && access(path, R_OK) == 0) print_link(out, folder, report, "report");
        for (int c = 0; c < N; c++) print_number(out, line, column[c].key, column[c].digits);
        fputc('\n', out);
        free(path);
        free(report);
    }
    fputs("</table>\n", out);
}

/* How many meshes took how long: bins of half a decade from 0.1 s to 3 hours. */
static void print_times(FILE *out, const json_t *lines) {
    enum { BINS = 11, HEIGHT = 120, WIDTH = 60 };
    static const char *const edge[BINS - 1] = {"0.1 s", "0.3 s", "1 s",   "3 s",    "10 s",
                                               "32 s",  "100 s", "5 min", "17 min", "53 min"};
    int count[BINS] = {0}, most = 1;
    json_t *line;
    size_t i;
    json_array_foreach(lines, i, line) {
        const double bin = floor(2 * (log10(fmax(batch_number(line, "seconds"), 1e-9)) + 1)) + 1;
        const int b = bin < 0 ? 0 : bin > BINS - 1 ? BINS - 1 : (int)bin;
        if (++count[b] > most) most = count[b];
    }
    fprintf(out, "<h2>Times</h2>\n<svg width=\"%d\" height=\"%d\" role=\"img\">", WIDTH * BINS,
            HEIGHT + 40);
    for (int b = 0; b < BINS; b++) {
        const int height = HEIGHT * count[b] / most, x = WIDTH * b;
        fprintf(out, "<rect class=\"bar\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>", x + 2,
                HEIGHT + 18 - height, WIDTH - 4, height);
        if (b < BINS - 1)
            fprintf(out, "<text x=\"%d\" y=\"%d\">%s</text>", x + WIDTH, HEIGHT + 36, edge[b]);
        if (count[b] > 0)
            fprintf(out, "<text x=\"%d\" y=\"%d\">%d</text>", x + WIDTH / 2, HEIGHT + 12 - height,
                    count[b]);
    }
    fputs("</svg>\n", out);
}

static int by_name(const void *a, const void *b) {
    return strcmp(batch_text(*(json_t *const *)a, "name"), batch_text(*(json_t *const *)b, "name"));
}

/* All lines of the folder by name. */
static json_t *sorted_lines(const json_t *results) {
    const size_t n = json_object_size(results);
    json_t **list = calloc(n + 1, sizeof(json_t *)), *lines = json_array(), *line;
    const char *name;
    size_t i = 0;
    if (!list) return lines;
    json_object_foreach((json_t *)(uintptr_t)results, name, line) list[i++] = line;
    qsort(list, n, sizeof(json_t *), by_name);
    for (i = 0; i < n; i++) json_array_append(lines, list[i]);
    free(list);
    return lines;
}

static size_t count_missing(const json_t *tasks, const json_t *results) {
    json_t *task;
    size_t i, n = 0;
    json_array_foreach(tasks, i, task) n += !json_object_get(results, batch_text(task, "name"));
    return n;
}

static void print_page(FILE *out, const char *folder, const json_t *lines, size_t missing) {
    json_t *line;
    size_t i, done = 0;
    double seconds = 0, quads = 0;
    json_array_foreach(lines, i, line) {
        done += batch_line_done(line);
        seconds += batch_number(line, "seconds");
        quads += batch_number(line, "quads");
    }
    fputs(head, out);
    fprintf(out,
            "<h1>%zu of %zu meshes</h1>\n<p>%zu failed, %zu not run. %.0f quads, %.1f s of work, "
            "quadcover %s.</p>\n",
            done, i + missing, i - done, missing, quads, seconds, qc_version());
    print_failures(out, lines);
    print_times(out, lines);
    print_done(out, folder, lines);
    fputs("</body></html>\n", out);
}

int batch_write_summary(const char *folder, const json_t *tasks, const json_t *results) {
    char *text = NULL, *path = batch_format("%s/summary.html", folder);
    size_t size = 0;
    json_t *lines = sorted_lines(results);
    FILE *out = path ? open_memstream(&text, &size) : NULL;
    if (out) print_page(out, folder, lines, count_missing(tasks, results));
    const int status = out && fclose(out) == 0 ? cli_write_text(path, text)
                                               : cli_error(EXIT_FAILED, "out of memory");
    free(text);
    free(path);
    json_decref(lines);
    return status;
}
