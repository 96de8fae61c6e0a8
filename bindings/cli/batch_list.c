/* The meshes of a batch: found in a folder or a list, and named. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "bindings/cli/batch.h"
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

typedef struct search {
    json_t *meshes, *seen;
    const char *skip;
} search;

static const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* From the last dot of the file name on; "" when there is none. */
static const char *extension(const char *path) {
    const char *base = base_name(path), *dot = strrchr(base, '.');
    return dot && dot > base ? dot : base + strlen(base);
}

static bool is_mesh(const char *path) {
    static const char *const known[] = {".obj", ".off", ".ply", ".stl"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(extension(path), known[i]) == 0) return true;
    return false;
}

/* A path which cannot be resolved stays as it is: its task says what is wrong with it. */
static int add(search *s, const char *path) {
    struct stat info;
    char *whole = realpath(path, NULL);
    const char *used = whole ? whole : path;
    const json_int_t bytes = stat(used, &info) == 0 ? (json_int_t)info.st_size : 0;
    json_t *mesh = json_pack("{s:s,s:I}", "input", used, "bytes", bytes);
    int status = EXIT_DONE;
    if (!mesh)
        status = cli_error(EXIT_INPUT, "%s: the name is not UTF-8; rename the file", path);
    else if (!json_object_get(s->seen, used)) {
        json_object_set_new(s->seen, used, json_true());
        json_array_append(s->meshes, mesh);
    }
    json_decref(mesh);
    free(whole);
    return status;
}

static int visible(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

/* Links to folders are not followed: they could lead back. */
static int walk(search *s, const char *folder) {
    struct dirent **entry = NULL;
    const int n = scandir(folder, &entry, visible, alphasort);
    if (n < 0) return cli_error(EXIT_INPUT, "%s: cannot read: %s", folder, strerror(errno));
    int status = EXIT_DONE;
    for (int i = 0; i < n; i++) {
        struct stat info;
        char *path = batch_format("%s/%s", folder, entry[i]->d_name);
        if (!path)
            status = cli_error(EXIT_FAILED, "out of memory");
        else if (status == EXIT_DONE && lstat(path, &info) == 0) {
            if (S_ISDIR(info.st_mode)) {
                if (strcmp(path, s->skip) != 0) status = walk(s, path);
            } else if (is_mesh(path) && stat(path, &info) == 0 && S_ISREG(info.st_mode))
                status = add(s, path);
        }
        free(path);
        free(entry[i]);
    }
    free(entry);
    return status;
}

static int read_list(search *s, const char *source) {
    const bool standard = strcmp(source, "-") == 0;
    FILE *file = standard ? stdin : fopen(source, "r");
    if (!file) return cli_error(EXIT_INPUT, "%s: cannot read: %s", source, strerror(errno));
    char *line = NULL;
    size_t size = 0;
    int status = EXIT_DONE;
    while (status == EXIT_DONE && getline(&line, &size, file) >= 0) {
        line[strcspn(line, "\r\n")] = '\0';
        if (*line) status = add(s, line);
    }
    free(line);
    if (!standard) fclose(file);
    return status;
}

static int find(search *s, const char *source) {
    struct stat info;
    if (strcmp(source, "-") == 0) return read_list(s, source);
    if (stat(source, &info) != 0)
        return cli_error(EXIT_INPUT, "%s: cannot read: %s", source, strerror(errno));
    if (!S_ISDIR(info.st_mode)) return is_mesh(source) ? add(s, source) : read_list(s, source);
    char *folder = realpath(source, NULL);
    const int status =
        !folder ? cli_error(EXIT_INPUT, "%s: %s", source, strerror(errno))
        : strcmp(folder, s->skip) == 0
            ? cli_error(EXIT_USAGE, "-o %s: results need a folder of their own", source)
            : walk(s, folder);
    free(folder);
    return status;
}

int batch_find(const char *source, const char *skip, json_t **out) {
    search s = {json_array(), json_object(), skip};
    int status = find(&s, source);
    if (status == EXIT_DONE && json_array_size(s.meshes) == 0)
        status =
            cli_error(EXIT_INPUT, "%s: no meshes; they end in .obj, .off, .ply or .stl", source);
    json_decref(s.seen);
    if (status == EXIT_DONE)
        *out = s.meshes;
    else
        json_decref(s.meshes);
    return status;
}

enum { FILE_NAME, PARENT, PARENT_AND_EXTENSION, HASH };

/* A file name has room for 255 bytes; no letter is torn. */
static int shorten(const char *text, ptrdiff_t length) {
    ptrdiff_t n = length > 60 ? 60 : length;
    while (n > 0 && n < length && ((unsigned char)text[n] & 0xc0) == 0x80) n--;
    return (int)n;
}

static char *name_at(const char *path, int level) {
    const char *base = base_name(path), *ext = extension(path);
    const int stem = shorten(base, ext - base);
    const char *parent = base > path ? base - 1 : base, *end = parent;
    while (parent > path && parent[-1] != '/') parent--;
    const int length = shorten(parent, end - parent);
    if (level == FILE_NAME) return batch_format("%.*s", stem, base);
    if (level == HASH)
        return batch_format("%.*s-%016" PRIx64, stem, base, batch_hash(0, path, strlen(path)));
    const int tail = level == PARENT || !*ext ? 0 : shorten(ext + 1, (ptrdiff_t)strlen(ext + 1));
    return batch_format("%.*s%s%.*s%s%.*s", length, parent, length ? "-" : "", stem, base,
                        tail ? "-" : "", tail, tail ? ext + 1 : "");
}

/* Names all meshes at their levels and raises those which share one. true: one was raised. */
static bool raise_levels(json_t *meshes, int *level) {
    json_t *count = json_object(), *mesh;
    size_t i;
    bool raised = false;
    json_array_foreach(meshes, i, mesh) {
        char *name = name_at(batch_text(mesh, "input"), level[i]);
        json_object_set_new(mesh, "name", name ? json_string(name) : NULL);
        const char *key = batch_text(mesh, "name");
        const json_int_t n = json_integer_value(json_object_get(count, key));
        json_object_set_new(count, key, json_integer(n + 1));
        free(name);
    }
    json_array_foreach(meshes, i, mesh) {
        const json_t *n = json_object_get(count, batch_text(mesh, "name"));
        if (json_integer_value(n) > 1 && level[i] < HASH) {
            level[i]++;
            raised = true;
        }
    }
    json_decref(count);
    return raised;
}

int batch_name(json_t *meshes) {
    int *level = calloc(json_array_size(meshes), sizeof *level);
    if (!level) return cli_error(EXIT_FAILED, "out of memory");
    while (raise_levels(meshes, level)) continue;
    free(level);
    return EXIT_DONE;
}
