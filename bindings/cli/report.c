/* --report: one page which shows a run and works without a network (docs/report.md). The viewer is
 * part of the program; a run adds a JSON text and its arrays. */
#include "bindings/cli/report.h"
#include <stdlib.h>
#include <string.h>

static const char mark[] = "@QUADCOVER_DATA@";

/* Inside an element a '<' could end it; in JSON it only occurs in strings, where an escape means
 * the same. */
static void print_json(FILE *out, const char *json) {
    for (const char *c = json; *c; c++) {
        if (*c == '<')
            fputs("\\u003c", out);
        else
            fputc(*c, out);
    }
}

static char *page(const char *json, const char *arrays) {
    const char *at = strstr(cli_viewer, mark);
    char *text = NULL;
    size_t size = 0;
    FILE *out = at ? open_memstream(&text, &size) : NULL;
    if (!out) return NULL;
    fwrite(cli_viewer, 1, (size_t)(at - cli_viewer), out);
    fputs("<script id=\"report\" type=\"application/json\">", out);
    print_json(out, json);
    fputs("</script>\n<script id=\"geometry\" type=\"text/plain\">", out);
    fputs(arrays, out);
    fputs("</script>", out);
    fputs(at + strlen(mark), out);
    const bool good = !ferror(out);
    if (fclose(out) == 0 && good) return text;
    free(text);
    return NULL;
}

char *cli_report_page(const cli_session *session, const qc_remesh_result *result, const char *stats,
                      const char *command) {
    cli_arrays arrays = {NULL, NULL, 0, false};
    json_t *geometry = result->mesh ? cli_report_geometry(session->ctx, result, &arrays) : NULL;
    json_t *histograms = result->quads ? cli_histograms(result->quads) : json_null();
    json_t *numbers = json_loads(stats, 0, NULL);
    json_t *root = json_pack(
        "{s:o,s:s,s:o,s:o,s:o}", "stats", numbers, "command", command, "histograms", histograms,
        "trace", cli_report_trace(session->sample, session->n_samples), "geometry", geometry);
    char *json = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(12)) : NULL;
    char *packed = json ? cli_arrays_text(&arrays) : NULL;
    char *text = packed ? page(json, packed) : NULL;
    free(packed);
    free(json);
    json_decref(root);
    cli_arrays_free(&arrays);
    return text;
}
