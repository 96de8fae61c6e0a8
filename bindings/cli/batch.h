/* Parts of `quadcover batch` (docs/batch.md): many meshes, each in a process of its own.
 *
 * A task is a JSON object which says all about one mesh; a line is a JSON object with what became
 * of it. Both are docs/batch.md's formats: tasks.jsonl and results.jsonl hold nothing else. */
#ifndef QC_CLI_BATCH_H
#define QC_CLI_BATCH_H

#include "bindings/cli/cli.h"
#include <jansson.h>
#include <sys/types.h>

/* The field of an object as text, "" when there is none. */
const char *batch_text(const json_t *object, const char *key);
double batch_number(const json_t *object, const char *key);
/* format as printf; free() it. NULL: out of memory. */
char *batch_format(const char *format, ...) CLI_PRINTF(1, 2);

/* Mixes bytes into a hash, which begins as 0. */
uint64_t batch_hash(uint64_t hash, const void *data, size_t n);

/* --- which meshes ---------------------------------------------------------------------------- */

/* Paths of meshes: those in a folder and below it, sorted (hidden ones and `skip` left out), those
 * of a text file with one a line ("-" = stdin), or one mesh. Each once. After an error message: its
 * status. *out: array of {input, bytes}. */
int batch_find(const char *source, const char *skip, json_t **out);
/* Adds "name" to each: its file name without extension, more of its path where that is not
 * unique. */
int batch_name(json_t *meshes);

/* --- tasks ----------------------------------------------------------------------------------- */

typedef struct batch_job {
    const char *folder, *cwd; /* absolute */
    const char *program;      /* path of this program */
    json_t *options;          /* array of words for `remesh` */
    const char *extension;    /* of meshes: "obj" */
    bool uv, save_field, report;
    double limit, memory; /* seconds, megabytes; 0 = none */
} batch_job;
/* Makes the tasks of the meshes; NULL: out of memory. */
json_t *batch_tasks(const json_t *meshes, const batch_job *job);
/* All tasks as text, one a line; free() it. */
char *batch_lines(const json_t *objects);
/* The objects of a file with one a line; lines which are none are left out. NULL: cannot read. */
json_t *batch_read_lines(const char *path);
/* Writes a job array for Slurm which runs all tasks of a file. */
int batch_write_slurm(const char *path, const char *tasks_path, const json_t *tasks,
                      const char *program);

/* --- running --------------------------------------------------------------------------------- */

typedef struct batch_worker {
    pid_t pid; /* 0 = free */
    json_t *task;
    char *work; /* folder of its files, locked while it is used */
    int lock;
    double start, kill_at;
    const char *verdict; /* NULL, or why it was ended */
} batch_worker;
/* Starts `remesh` for a task. false: no process can be started. */
bool batch_worker_start(batch_worker *worker, json_t *task, const char *program);
/* Ends a worker which is over a limit. */
void batch_worker_watch(batch_worker *worker);
void batch_worker_stop(batch_worker *worker, const char *verdict);
/* Waits for a worker without blocking. true: it has ended, its outputs are in place when it
 * succeeded, and *line is its line (NULL: interrupted, or out of memory). */
bool batch_worker_ended(batch_worker *worker, json_t **line);
/* The line of a worker which has ended as wait() says; written: its outputs are in place, if it
 * succeeded. */
struct rusage;
json_t *batch_make_line(const batch_worker *worker, int ended, const struct rusage *usage,
                        bool written);
/* Resident megabytes of a process; 0 where the system does not tell. */
double batch_resident(pid_t pid);
/* Removes what dead programs left in the folder of a batch. */
void batch_remove_leftovers(const char *folder);

typedef struct batch_events {
    /* Each line once, in the order of their ends; a status other than EXIT_DONE ends the run. */
    int (*line)(void *user, const json_t *task, json_t *line);
    void (*tick)(void *user, int running); /* about ten times a second; may be NULL */
    void *user;
} batch_events;
/* Runs all tasks, `jobs` at a time. */
int batch_run(const json_t *tasks, int jobs, const char *program, const batch_events *events);

/* --- results --------------------------------------------------------------------------------- */

/* name -> line of all meshes with results in a folder, including those of other machines, which are
 * taken into results.jsonl. NULL after a message. */
json_t *batch_results_open(const char *folder);
int batch_results_append(const char *folder, json_t *results, json_t *line);
/* Leaves exactly one line a mesh. */
int batch_results_write(const char *folder, const json_t *results);
/* The line of one task where no collector runs. */
char *batch_part_path(const json_t *task);
/* The line belongs to the task as it is now. line may be NULL. */
bool batch_current(const json_t *task, const json_t *line);
/* It does, is one of success, and what it made is there. */
bool batch_succeeded(const json_t *task, const json_t *line);
/* The line of a success which nobody has collected yet; and of any. NULL: none. */
json_t *batch_part(const json_t *task);
json_t *batch_known(const json_t *task);
bool batch_line_done(const json_t *line);
/* Removes what earlier runs of a task have left and this one has not made. */
void batch_tidy(const json_t *task, bool done);

/* --- pictures -------------------------------------------------------------------------------- */

/* Draws the result of a task for the summary; without memory or a mesh there is no picture. */
void batch_draw(const json_t *task);
char *batch_picture_path(const char *folder, const char *name);

/* --- summary --------------------------------------------------------------------------------- */

/* Writes summary.html about all results of a folder; tasks without one are counted. */
int batch_write_summary(const char *folder, const json_t *tasks, const json_t *results);

/* --- the command ----------------------------------------------------------------------------- */

/* The command line. */
typedef struct batch_settings {
    const char *source, *output, *tasks, *slurm;
    long long jobs, run_task;
    double limit, memory;
    bool again, skip_failed, uv, save_field, report, collect;
    int progress;
    json_t *options;    /* for remesh */
    const char *format; /* among them; "auto" */
    bool threads;       /* among them */
} batch_settings;

/* A run of tasks of one folder. */
typedef struct batch {
    const batch_settings *settings;
    char *folder, *cwd, *program, *tasks_path;
    int lock;
    json_t *tasks, *pending, *results, *failed;
    size_t ended;
    double start, bytes, bytes_ended, last_shown;
    bool on_terminal, line_open;
} batch;

/* Does what the settings say. */
int batch_do(batch *b);
void batch_free(batch *b);
/* Lines on stderr: what a mesh came to, how far all are. */
void batch_show(batch *b, const json_t *line);
void batch_show_state(void *b, int running);
void batch_quiet(batch *b);

#endif
