/* The `quadcover` program: shared helpers of its commands. Uses the public headers only. */
#ifndef QC_CLI_H
#define QC_CLI_H

#include <qc/qc.h>
#include <stdio.h>

#if defined(__GNUC__)
#define CLI_PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))
#else
#define CLI_PRINTF(fmt, first)
#endif

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_INPUT = 3, EXIT_INTERRUPTED = 130 };

/* --- messages: one line each on stderr ----------------------------------------------------- */

/* "quadcover: error: ..."; returns status. */
int cli_error(int status, const char *format, ...) CLI_PRINTF(2, 3);
/* "quadcover: warning: ..." */
void cli_warning(const char *format, ...) CLI_PRINTF(1, 2);
/* The same for a problem of the command line, whatever the library calls it: EXIT_USAGE. */
int cli_usage_error(qc_ctx *ctx, const char *prefix);
/* The context's last error, prefixed by its stage; returns the exit status: fallback, or
 * EXIT_INTERRUPTED, or EXIT_INPUT when the data are to blame. prefix (may be NULL): the file. */
int cli_context_error(qc_ctx *ctx, const char *prefix, int fallback);

/* --- arguments (popt) ---------------------------------------------------------------------- */

enum { CLI_MOST_OPTIONS = 64 }; /* of a command */
enum { CLI_FLAG, CLI_TEXT, CLI_REAL, CLI_INTEGER, CLI_CHOICE, CLI_LIST };

typedef struct cli_list {
    int n;
    const char **item;
} cli_list;

typedef struct cli_option {
    const char *name; /* without dashes */
    char letter;      /* 0 = none */
    int kind;
    void *target; /* bool, const char *, double, long long, int (position in choices), cli_list */
    double min, max;
    const char *const *choices; /* NULL-terminated */
    const char *argument, *doc;
} cli_option;

typedef struct cli_given {
    const cli_option *option;
    const char *text; /* NULL for a flag */
} cli_given;

typedef struct cli_arguments {
    int n, n_given;
    const char **positional;
    const cli_given *given; /* the options in the order of the command line */
    void *context, *memory; /* owned */
} cli_arguments;

/* Parses argv (argv[0] = the command). Returns -1 to go on, else the exit status (0 after --help,
 * EXIT_USAGE after an error message). options ends with name == NULL; min_n .. max_n positional
 * arguments are expected. synopsis: "IN -o OUT.obj [options]"; about: paragraphs for --help. */
int cli_parse(int argc, const char **argv, const cli_option *options, int min_n, int max_n,
              const char *synopsis, const char *about, cli_arguments *out);
void cli_arguments_free(cli_arguments *arguments);
/* Does something with a table of options while the variables it sets exist. */
typedef int cli_options_user(const cli_option *options, void *user);

/* --- sessions: context, progress, interruption --------------------------------------------- */

enum { CLI_PROGRESS_AUTO = 0, CLI_PROGRESS_PLAIN, CLI_PROGRESS_NONE };
extern const char *const cli_progress_names[];

/* A point of a curve of qc_ctx_options.sample. */
typedef struct cli_sample {
    char step[32], curve[32];
    double x, y;
} cli_sample;

typedef struct cli_session {
    qc_ctx *ctx;
    cli_sample *sample;
    size_t n_samples;
    int progress;
    double start, time_limit; /* seconds; 0 = none */
    bool out_of_time, line_open;
    double last_time;
    char last_stage[64];
    char **warning;
    int n_warnings;
} cli_session;

/* What every command that computes takes: threads 0 = all cores, time_limit 0 = none. */
typedef struct cli_common {
    long long threads;
    double time_limit;
    int progress;
} cli_common;
#define CLI_COMMON_OPTIONS(c)                                                                      \
    {"threads",    0,   CLI_INTEGER,                                                               \
     &(c).threads, 0,   256,                                                                       \
     NULL,         "N", "threads; 0 = all cores (default); never changes a result"},               \
        {"time-limit",                                                                             \
         0,                                                                                        \
         CLI_REAL,                                                                                 \
         &(c).time_limit,                                                                          \
         0,                                                                                        \
         1e9,                                                                                      \
         NULL,                                                                                     \
         "SECONDS",                                                                                \
         "aim at this time: improve less; 0 = none (default)"},                                    \
    {                                                                                              \
        "progress", 0, CLI_CHOICE, &(c).progress, 0, 0, cli_progress_names, "auto|plain|none",     \
            "auto: one line on a terminal; plain: lines; none"                                     \
    }
int cli_session_open(cli_session *session, const cli_common *common);
void cli_session_close(cli_session *session);
/* Prints a warning and keeps it for the statistics. */
void cli_session_warn(cli_session *session, const char *format, ...) CLI_PRINTF(2, 3);
/* Ends the progress line. */
void cli_session_quiet(cli_session *session);
/* The exit status for a failed call: interruption and time limit first, then as cli_context_error.
 */
int cli_session_error(cli_session *session, const char *prefix, int fallback);
/* The same for a run on the input: a file which cannot be opened is unusable input as well. */
int cli_run_error(cli_session *session, const char *input);
/* Ctrl-C and SIGTERM set what cli_interrupted tells; a second one ends the program. */
void cli_catch_interrupts(void);
bool cli_interrupted(void);
double cli_seconds(void);

/* --- files --------------------------------------------------------------------------------- */

/* EXIT_DONE when a file can be made at path (NULL and "-" are fine), else an error message. */
int cli_check_writable(const char *path);
/* Writes text to path through a temporary and a rename; "-" = stdout. */
int cli_write_text(const char *path, const char *text);
int cli_write_bytes(const char *path, const char *bytes, size_t n);
/* Formats of meshes, for an option of kind CLI_CHOICE: numbers are QC_FORMAT_... */
extern const char *const cli_format_names[];
#define CLI_FORMAT_OPTION(target)                                                                  \
    {                                                                                              \
        "format", 0, CLI_CHOICE, &(target), 0, 0, cli_format_names, "auto|obj|off|ply|ply-ascii",  \
            "of meshes written; auto: by extension (default)"                                      \
    }
/* Reads a mesh; EXIT_INPUT on failure. */
int cli_read_mesh(cli_session *session, const char *path, qc_polygon_mesh **out);

typedef struct cli_rays {
    int32_t n_strokes, n_rays;
    int32_t *offset; /* n_strokes + 1 */
    double *ray;     /* 6 n_rays: origin, direction */
} cli_rays;
/* Reads camera rays; EXIT_INPUT on failure. Free them in any case. */
int cli_read_rays(const char *path, cli_rays *out);
void cli_rays_free(cli_rays *rays);
/* The ray caster offered last: that of a plugin when one is loaded. All give the same answers. */
const qc_ray_caster *cli_ray_caster(const qc_registry *registry);
/* Traces the rays of a file onto *mesh, which is replaced by one with the strokes as lines. */
int cli_add_strokes(cli_session *session, const qc_registry *registry, const char *path,
                    qc_polygon_mesh **mesh);

/* --- pipelines ----------------------------------------------------------------------------- */

/* Registry with the plugins of the list and of QC_PLUGIN_PATH. */
int cli_registry(qc_ctx *ctx, const cli_list *plugins, qc_registry **out);
/* Applies STEP.PARAM=VALUE settings. */
int cli_pipeline_settings(qc_ctx *ctx, qc_pipeline *pipeline, const cli_list *settings);
/* Builds the default pipeline or reads `file`, then applies STEP.PARAM=VALUE settings. */
int cli_pipeline(qc_ctx *ctx, qc_registry *registry, const char *file,
                 const qc_default_pipeline_options *options, const cli_list *settings,
                 qc_pipeline **out);

/* --- figures ------------------------------------------------------------------------------- */

/* The statistics with the warnings and the time of the session; stats has the other times. False
 * after an error of the context; else free *json with qc_text_free. */
bool cli_stats(const cli_session *session, const qc_report *report, const qc_pipeline *pipeline,
               const char *input, const char *mode, const qc_stats_options *stats, char **json);
/* The page of --report; free() it. stats: the text of qc_stats_json. NULL: it cannot be made. */
char *cli_report_page(const cli_session *session, const qc_remesh_result *result, const char *stats,
                      const char *command);

/* --- commands: argv[0] is the command's name ----------------------------------------------- */

int cli_remesh(int argc, const char **argv);
/* The options of remesh for a command which passes them on. */
int cli_remesh_with_options(cli_options_user *use, void *user);
int cli_extract(int argc, const char **argv);
int cli_field(int argc, const char **argv);
int cli_check(int argc, const char **argv);
int cli_pick(int argc, const char **argv);
int cli_stages(int argc, const char **argv);
int cli_shape(int argc, const char **argv);
int cli_batch(int argc, const char **argv);

/* The registered stages as JSON; free() it. name NULL = all. */
char *cli_stages_json(qc_registry *registry, const qc_stage *one);

#endif
