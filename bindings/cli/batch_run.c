/* The work of a batch: tasks chosen, run here or written for others, and gathered. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "bindings/cli/batch.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static char *find_program(void) {
    char path[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", path, sizeof path - 1);
    if (n <= 0) return strdup("quadcover"); /* looked up in PATH */
    path[n] = '\0';
    return strdup(path);
}

static int cores(void) {
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (int)n : 1;
}

/* How many of n meshes run at a time. */
static int jobs(const batch *b, size_t n) {
    const int most = b->settings->jobs > 0 ? (int)b->settings->jobs : cores();
    return n > 0 && n < (size_t)most ? (int)n : most;
}

/* Makes and locks the folder: two batches would write the same files. */
static int open_folder(batch *b, const char *path) {
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return cli_error(EXIT_FAILED, "%s: cannot make the folder: %s", path, strerror(errno));
    b->folder = realpath(path, NULL);
    b->lock = b->folder ? open(b->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (b->lock < 0) return cli_error(EXIT_FAILED, "%s: %s", path, strerror(errno));
    if (flock(b->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return cli_error(EXIT_FAILED, "%s: another batch is at work in it", path);
    return EXIT_DONE;
}

static void settle(const json_t *task, const json_t *line) {
    batch_tidy(task, batch_line_done(line));
    if (batch_line_done(line)) batch_draw(task);
}

/* Wrong usage is that of all meshes: nothing is recorded. */
static int on_line(void *user, const json_t *task, json_t *line) {
    batch *b = user;
    if (b->ended == 0 && json_integer_value(json_object_get(line, "exit")) == EXIT_USAGE)
        return cli_error(EXIT_USAGE, "%s: %s", batch_text(line, "name"),
                         batch_text(line, "message"));
    const int status = batch_results_append(b->folder, b->results, line);
    b->ended++;
    b->bytes_ended += batch_number(line, "bytes");
    settle(task, line);
    if (!batch_line_done(line)) json_array_append(b->failed, line);
    batch_show(b, line);
    return status;
}

/* The end of a batch: the failures in one line. */
static int conclude(const batch *b, const char *missing) {
    enum { NAMED = 5 };
    const size_t n = json_array_size(b->failed);
    char names[400] = "";
    for (size_t i = 0; i < n && i < NAMED; i++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "",
                 batch_text(json_array_get(b->failed, i), "name"));
    }
    if (n == 0) return EXIT_DONE;
    return cli_error(EXIT_FAILED, "%zu of %zu meshes %s: %s%s; see %s/summary.html", n,
                     json_array_size(b->tasks), missing, names, n > NAMED ? ", ..." : "",
                     b->folder);
}

/* What is to be done. Finished failures which are skipped count as failures. */
static json_t *choose(const batch *b) {
    json_t *pending = json_array(), *task;
    size_t i;
    json_array_foreach(b->tasks, i, task) {
        json_t *line = json_object_get(b->results, batch_text(task, "name"));
        const bool current = !b->settings->again && batch_current(task, line);
        if (current && !batch_line_done(line) && b->settings->skip_failed)
            json_array_append(b->failed, line);
        else if (!current || !batch_succeeded(task, line))
            json_array_append(pending, task);
    }
    return pending;
}

/* Of files in a format; "ply-ascii" is PLY, too. */
static const char *extension(const char *format) {
    if (strncmp(format, "ply", 3) == 0) return "ply";
    return strcmp(format, "off") == 0 ? "off" : "obj";
}

static int make_tasks(batch *b) {
    const batch_settings *s = b->settings;
    json_t *meshes = NULL;
    int status = batch_find(s->source, b->folder, &meshes);
    if (status == EXIT_DONE) status = batch_name(meshes);
    if (!s->threads) {
        const int share = s->tasks || s->slurm ? 1 : cores() / jobs(b, json_array_size(meshes));
        char *word = batch_format("--threads=%d", share > 0 ? share : 1);
        json_array_append_new(s->options, word ? json_string(word) : NULL);
        free(word);
    }
    const batch_job job = {b->folder, b->cwd,        b->program, s->options, extension(s->format),
                           s->uv,     s->save_field, s->report,  s->limit,   s->memory};
    if (status == EXIT_DONE && !(b->tasks = batch_tasks(meshes, &job)))
        status = cli_error(EXIT_FAILED, "out of memory, or a path is not UTF-8");
    json_decref(meshes);
    return status;
}

static int run_here(batch *b) {
    const batch_settings *s = b->settings;
    const batch_events events = {on_line, batch_show_state, b};
    json_t *task;
    size_t i;
    batch_remove_leftovers(b->folder);
    json_array_foreach(b->pending, i, task) b->bytes += batch_number(task, "bytes");
    b->start = cli_seconds();
    b->on_terminal = s->progress == CLI_PROGRESS_AUTO && isatty(STDERR_FILENO);
    const int status =
        batch_run(b->pending, jobs(b, json_array_size(b->pending)), b->program, &events);
    batch_quiet(b);
    batch_remove_leftovers(b->folder);
    int written = batch_results_write(b->folder, b->results);
    if (written == EXIT_DONE) written = batch_write_summary(b->folder, b->tasks, b->results);
    return status != EXIT_DONE ? status : written != EXIT_DONE ? written : conclude(b, "failed");
}

static int write_tasks(batch *b) {
    const batch_settings *s = b->settings;
    if (json_array_size(b->pending) == 0)
        return cli_error(EXIT_FAILED, "%s: nothing is left to do", b->folder);
    b->tasks_path = s->tasks ? strdup(s->tasks) : batch_format("%s/tasks.jsonl", b->folder);
    char *text = batch_lines(b->pending), *whole = NULL;
    int status = text && b->tasks_path ? cli_write_text(b->tasks_path, text)
                                       : cli_error(EXIT_FAILED, "out of memory");
    free(text);
    if (status == EXIT_DONE && s->slurm) {
        whole = realpath(b->tasks_path, NULL);
        status = whole ? batch_write_slurm(s->slurm, whole, b->pending, b->program)
                       : cli_error(EXIT_FAILED, "%s: %s", b->tasks_path, strerror(errno));
    }
    free(whole);
    return status;
}

static int run_all(batch *b) {
    const batch_settings *s = b->settings;
    int status = open_folder(b, s->output);
    if (status == EXIT_DONE) status = make_tasks(b);
    if (status == EXIT_DONE && !(b->results = batch_results_open(b->folder))) status = EXIT_FAILED;
    if (status != EXIT_DONE) return status;
    b->pending = choose(b);
    return s->tasks || s->slurm ? write_tasks(b) : run_here(b);
}

/* The line of a task which runs without a collector waits in a file of its own. */
static int keep_part(const json_t *task, const json_t *line) {
    char *path = batch_part_path(task), *text = json_dumps(line, JSON_COMPACT);
    const int status =
        path && text ? cli_write_text(path, text) : cli_error(EXIT_FAILED, "out of memory");
    free(path);
    free(text);
    settle(task, line);
    return status;
}

/* A failure here is none where the same task has succeeded elsewhere. */
static int on_part(void *user, const json_t *task, json_t *line) {
    (void)user;
    json_t *known = batch_line_done(line) ? NULL : batch_known(task);
    int status = known ? EXIT_DONE : keep_part(task, line);
    char *text = json_dumps(known ? known : line, JSON_COMPACT);
    if (text) printf("%s\n", text);
    if (status == EXIT_DONE && !known && !batch_line_done(line))
        status = cli_error(EXIT_FAILED, "%s: %s: %s", batch_text(line, "name"),
                           batch_text(line, "status"), batch_text(line, "message"));
    free(text);
    json_decref(known);
    return status;
}

static int run_task(batch *b) {
    const size_t k = (size_t)b->settings->run_task;
    json_t *task = json_array_get(b->tasks, k - 1);
    if (!task)
        return cli_error(EXIT_USAGE, "--run-task %zu: the tasks are 1 to %zu", k,
                         json_array_size(b->tasks));
    const batch_events events = {on_part, NULL, b};
    b->pending = json_pack("[O]", task);
    json_t *line = batch_part(task);
    const int status =
        line ? on_part(b, task, line) : batch_run(b->pending, 1, b->program, &events);
    json_decref(line);
    return status;
}

static int collect(batch *b) {
    json_t *task;
    size_t i;
    int status = open_folder(b, batch_text(json_array_get(b->tasks, 0), "folder"));
    if (status == EXIT_DONE && !(b->results = batch_results_open(b->folder))) status = EXIT_FAILED;
    if (status != EXIT_DONE) return status;
    json_array_foreach(b->tasks, i, task) {
        json_t *line = json_object_get(b->results, batch_text(task, "name"));
        if (!batch_succeeded(task, line)) json_array_append(b->failed, task);
    }
    batch_remove_leftovers(b->folder);
    status = batch_write_summary(b->folder, b->tasks, b->results);
    return status == EXIT_DONE ? conclude(b, "failed or were not run") : status;
}

int batch_do(batch *b) {
    const batch_settings *s = b->settings;
    b->cwd = realpath(".", NULL);
    b->program = find_program();
    b->failed = json_array();
    if (!b->cwd || !b->program) return cli_error(EXIT_FAILED, "cannot tell where this runs");
    if (s->run_task == 0 && !s->collect) return run_all(b);
    b->tasks = batch_read_lines(s->tasks);
    if (json_array_size(b->tasks) == 0)
        return cli_error(EXIT_USAGE, "%s: no tasks; write them with quadcover batch --tasks",
                         s->tasks);
    return s->collect ? collect(b) : run_task(b);
}

void batch_free(batch *b) {
    json_t *const owned[] = {b->tasks, b->pending, b->results, b->failed};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) json_decref(owned[i]);
    free(b->folder);
    free(b->cwd);
    free(b->program);
    free(b->tasks_path);
    if (b->lock >= 0) close(b->lock);
}
