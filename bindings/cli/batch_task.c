/* Tasks: all that is needed to remesh one mesh of a batch, as JSON. */
#include "bindings/cli/batch.h"
#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *batch_text(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

double batch_number(const json_t *object, const char *key) {
    return json_number_value(json_object_get(object, key));
}

char *batch_format(const char *format, ...) {
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    const int length = vsnprintf(NULL, 0, format, args);
    char *text = length >= 0 ? malloc((size_t)length + 1) : NULL;
    if (text) vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(args);
    return text;
}

uint64_t batch_hash(uint64_t h, const void *data, size_t n) {
    h ^= 14695981039346656037u; /* FNV-1a; its basis at the beginning of each part */
    for (const unsigned char *byte = data; n > 0; n--, byte++) h = (h ^ *byte) * 1099511628211u;
    return h;
}

/* A file counts with its size and time, so that a changed one is noticed. */
static uint64_t mix_file(uint64_t h, const char *path) {
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return h;
    const int64_t state[] = {(int64_t)info.st_size, (int64_t)info.st_mtim.tv_sec,
                             (int64_t)info.st_mtim.tv_nsec};
    return batch_hash(h, state, sizeof state);
}

/* What the result depends on: version, input, options and the files they name. The number of
 * threads and the limits change no result. */
static uint64_t fingerprint(const char *input, const json_t *options, const batch_job *job) {
    const bool products[] = {job->uv, job->save_field, job->report};
    uint64_t h = batch_hash(0, qc_version(), strlen(qc_version()) + 1);
    size_t i;
    json_t *word;
    h = mix_file(batch_hash(h, input, strlen(input) + 1), input);
    h = batch_hash(h, products, sizeof products);
    json_array_foreach(options, i, word) {
        const char *text = json_string_value(word), *first = strchr(text, '='),
                   *last = strrchr(text, '=');
        if (strncmp(text, "--threads=", 10) == 0) continue;
        h = batch_hash(h, text, strlen(text) + 1);
        if (first) h = mix_file(h, first + 1);
        if (last != first) h = mix_file(h, last + 1); /* --set=step.file=... */
    }
    return h;
}

/* Replaces {name} by the mesh's name and {in} by its path without extension; free() it. */
static char *substitute(const char *text, const char *name, const char *input) {
    char *result = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&result, &size);
    if (!out) return NULL;
    const char *slash = strrchr(input, '/'), *dot = strrchr(input, '.');
    const int stem =
        (int)(dot && (!slash || dot > slash + 1) ? (size_t)(dot - input) : strlen(input));
    while (*text) {
        if (strncmp(text, "{name}", 6) == 0) {
            fputs(name, out);
            text += 6;
        } else if (strncmp(text, "{in}", 4) == 0) {
            fprintf(out, "%.*s", stem, input);
            text += 4;
        } else
            fputc(*text++, out);
    }
    return fclose(out) == 0 ? result : NULL;
}

static void append(json_t *list, char *owned) {
    json_array_append_new(list, owned ? json_string(owned) : NULL);
    free(owned);
}

/* An option of remesh which writes a file, and that file. */
static void product(json_t *command, json_t *outputs, const char *option, char *owned) {
    json_array_append_new(command, json_string(option));
    json_array_append_new(command, owned ? json_string(owned) : NULL);
    append(outputs, owned);
}

static json_t *task(const json_t *mesh, const batch_job *job) {
    const char *name = batch_text(mesh, "name"), *input = batch_text(mesh, "input"),
               *folder = job->folder;
    json_t *command = json_pack("[s,s,s]", job->program, "remesh", input), *outputs = json_array();
    json_t *options = json_array(), *word;
    size_t i;
    char key[24];
    json_array_foreach(job->options, i, word)
        append(options, substitute(json_string_value(word), name, input));
    snprintf(key, sizeof key, "%016" PRIx64, fingerprint(input, options, job));
    json_array_extend(command, options);
    json_decref(options);
    product(command, outputs, "-o", batch_format("%s/%s.%s", folder, name, job->extension));
    product(command, outputs, "--stats", batch_format("%s/%s.json", folder, name));
    if (job->uv)
        product(command, outputs, "--uv",
                batch_format("%s/uv/%s.%s", folder, name, job->extension));
    if (job->save_field)
        product(command, outputs, "--save-field",
                batch_format("%s/field/%s.rawfield", folder, name));
    if (job->report)
        product(command, outputs, "--report", batch_format("%s/report/%s.html", folder, name));
    return json_pack("{s:s,s:s,s:O,s:s,s:s,s:s,s:f,s:f,s:o,s:o}", "name", name, "input", input,
                     "bytes", json_object_get(mesh, "bytes"), "key", key, "folder", folder, "cwd",
                     job->cwd, "limit", job->limit, "memory", job->memory, "outputs", outputs,
                     "command", command);
}

json_t *batch_tasks(const json_t *meshes, const batch_job *job) {
    json_t *tasks = json_array(), *mesh;
    size_t i;
    json_array_foreach(meshes, i, mesh) json_array_append_new(tasks, task(mesh, job));
    if (json_array_size(tasks) == json_array_size(meshes)) return tasks;
    json_decref(tasks);
    return NULL;
}

char *batch_lines(const json_t *objects) {
    char *text = NULL;
    size_t size = 0, i;
    json_t *object;
    FILE *out = open_memstream(&text, &size);
    bool good = out != NULL;
    json_array_foreach(objects, i, object) {
        good = good && json_dumpf(object, out, JSON_COMPACT | JSON_REAL_PRECISION(12)) == 0;
        if (good) fputc('\n', out);
    }
    if (out && fclose(out) == 0 && good) return text;
    free(text);
    return NULL;
}

json_t *batch_read_lines(const char *path) {
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
    if (!file) return NULL;
    json_t *objects = json_array();
    char *line = NULL;
    size_t size = 0;
    while (getline(&line, &size, file) >= 0) {
        json_t *object = json_loads(line, 0, NULL);
        if (json_is_object(object)) json_array_append(objects, object);
        json_decref(object);
    }
    free(line);
    if (file != stdin) fclose(file);
    return objects;
}
