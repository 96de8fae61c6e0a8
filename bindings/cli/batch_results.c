/* results.jsonl: one line a mesh. While a batch runs lines are appended, the last one of a mesh
 * counts; at its start and its end the file is written anew, whole: a torn or an old line never
 * stays. */
#include "bindings/cli/batch.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool batch_line_done(const json_t *line) {
    return strcmp(batch_text(line, "status"), "done") == 0;
}

char *batch_part_path(const json_t *task) {
    return batch_format("%s/.batch/%s.json", batch_text(task, "folder"), batch_text(task, "name"));
}

bool batch_current(const json_t *task, const json_t *line) {
    return line && strcmp(batch_text(task, "key"), batch_text(line, "key")) == 0;
}

bool batch_succeeded(const json_t *task, const json_t *line) {
    json_t *output;
    size_t i;
    if (!batch_current(task, line) || !batch_line_done(line)) return false;
    json_array_foreach(json_object_get(task, "outputs"), i,
                       output) if (access(json_string_value(output), R_OK) != 0) return false;
    return true;
}

json_t *batch_part(const json_t *task) {
    char *path = batch_part_path(task);
    json_t *line = path ? json_load_file(path, 0, NULL) : NULL;
    free(path);
    if (batch_succeeded(task, line)) return line;
    json_decref(line);
    return NULL;
}

json_t *batch_known(const json_t *task) {
    json_t *known = batch_part(task), *line;
    char *path = batch_format("%s/results.jsonl", batch_text(task, "folder"));
    json_t *lines = !known && path ? batch_read_lines(path) : NULL;
    size_t i;
    json_array_foreach(lines, i,
                       line) if (strcmp(batch_text(line, "name"), batch_text(task, "name")) == 0 &&
                                 !known && batch_succeeded(task, line)) known = json_incref(line);
    json_decref(lines);
    free(path);
    return known;
}

static bool is_output(const json_t *task, const char *path) {
    json_t *output;
    size_t i;
    json_array_foreach(json_object_get(task, "outputs"), i,
                       output) if (strcmp(json_string_value(output), path) == 0) return true;
    return false;
}

void batch_tidy(const json_t *task, bool done) {
    static const char *const kind[][2] = {
        {"", ".obj"},        {"", ".off"},    {"", ".ply"},    {"", ".json"},
        {"uv/", ".obj"},     {"uv/", ".off"}, {"uv/", ".ply"}, {"field/", ".rawfield"},
        {"report/", ".html"}};
    const char *folder = batch_text(task, "folder"), *name = batch_text(task, "name");
    for (size_t i = 0; i < sizeof kind / sizeof *kind; i++) {
        char *path = batch_format("%s/%s%s%s", folder, kind[i][0], name, kind[i][1]);
        if (path && !(done && is_output(task, path))) unlink(path);
        free(path);
    }
    char *picture = batch_picture_path(folder, name);
    if (picture && !done) unlink(picture);
    free(picture);
}

/* Another machine may have run a mesh twice: the first success counts. */
static void merge(json_t *results, json_t *line) {
    const char *name = batch_text(line, "name");
    const json_t *known = json_object_get(results, name);
    if (*name && !(batch_current(line, known) && batch_line_done(known)))
        json_object_set(results, name, line);
}

typedef void part_visitor(json_t *results, const char *path);

static void read_part(json_t *results, const char *path) {
    json_t *line = json_load_file(path, 0, NULL);
    if (line) merge(results, line);
    json_decref(line);
}

static void remove_part(json_t *results, const char *path) {
    (void)results;
    unlink(path);
}

static int is_part(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0;
}

/* The lines which processes without a collector left, by name. */
static void each_part(const char *folder, part_visitor *visit, json_t *results) {
    struct dirent **entry = NULL;
    char *parts = batch_format("%s/.batch", folder);
    const int n = parts ? scandir(parts, &entry, is_part, alphasort) : 0;
    for (int i = 0; i < n; i++) {
        char *path = batch_format("%s/%s", parts, entry[i]->d_name);
        if (path) visit(results, path);
        free(path);
        free(entry[i]);
    }
    free(entry);
    free(parts);
}

int batch_results_write(const char *folder, const json_t *results) {
    json_t *lines = json_array(), *line;
    const char *name;
    json_object_foreach((json_t *)(uintptr_t)results, name, line) json_array_append(lines, line);
    char *path = batch_format("%s/results.jsonl", folder), *text = batch_lines(lines);
    const int status =
        path && text ? cli_write_text(path, text) : cli_error(EXIT_FAILED, "out of memory");
    free(path);
    free(text);
    json_decref(lines);
    return status;
}

json_t *batch_results_open(const char *folder) {
    char *path = batch_format("%s/results.jsonl", folder);
    json_t *lines = path ? batch_read_lines(path) : NULL, *results = json_object(), *line;
    size_t i;
    json_array_foreach(lines, i, line) json_object_set(results, batch_text(line, "name"), line);
    json_object_del(results, "");
    each_part(folder, read_part, results);
    json_decref(lines);
    free(path);
    if (batch_results_write(folder, results) != EXIT_DONE) {
        json_decref(results);
        return NULL;
    }
    each_part(folder, remove_part, NULL);
    return results;
}

int batch_results_append(const char *folder, json_t *results, json_t *line) {
    json_t *one = json_pack("[O]", line);
    char *path = batch_format("%s/results.jsonl", folder), *text = one ? batch_lines(one) : NULL;
    const int fd = path && text ? open(path, O_WRONLY | O_APPEND | O_CREAT, 0666) : -1;
    const size_t length = text ? strlen(text) : 0;
    const bool good = fd >= 0 && write(fd, text, length) == (ssize_t)length;
    const int reason = errno;
    if (good) json_object_set(results, batch_text(line, "name"), line);
    if (fd >= 0) close(fd);
    free(text);
    free(path);
    json_decref(one);
    return good ? EXIT_DONE
                : cli_error(EXIT_FAILED, "%s/results.jsonl: cannot write: %s", folder,
                            strerror(reason));
}
