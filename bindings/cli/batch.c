/* quadcover batch: many meshes, each in a process of its own, here or as tasks for other engines.
 */
#include "bindings/cli/batch.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char about[] =
    "Remeshes all meshes of a folder, of a text file with one path a line ('-' = stdin), or one "
    "mesh.\n"
    "OUTDIR gets NAME.obj, NAME.json (statistics), results.jsonl (a line a mesh) and "
    "summary.html.\n"
    "Each mesh has a process of its own: a crash or a limit costs that mesh only. The same "
    "command\n"
    "again does what is not done yet, or has other options or another input by now.\n\n"
    "All options of `remesh` are taken; {name} in them is the mesh's name, {in} its path without\n"
    "extension, as in --field '{in}.rawfield'. --uv, --save-field and --report take no file: they\n"
    "write OUTDIR/uv/NAME.obj, OUTDIR/field/NAME.rawfield and OUTDIR/report/NAME.html.\n\n"
    "--tasks T.jsonl with DIR or LIST writes the tasks and runs nothing; --slurm a job array for\n"
    "them, too. On any machine with the same files: `quadcover batch --tasks T.jsonl --run-task "
    "K`;\n"
    "in the end once: `quadcover batch --tasks T.jsonl --collect`.";
static const char synopsis[] = "DIR|LIST -o OUTDIR [options of batch and remesh]";

typedef struct parsing {
    int argc;
    const char **argv;
    batch_settings *settings;
    cli_arguments *arguments;
} parsing;

enum { N_OWN = 14, ROOM = CLI_MOST_OPTIONS + 1 };

/* Appends the options of remesh which batch has no meaning of its own for. false: too many. */
static bool append_remesh(cli_option *table, const cli_option *remesh) {
    int n = N_OWN;
    for (; remesh->name; remesh++) {
        bool own = strcmp(remesh->name, "stats") == 0; /* always written */
        for (int i = 0; i < N_OWN; i++) own = own || strcmp(remesh->name, table[i].name) == 0;
        if (own) continue;
        if (n == CLI_MOST_OPTIONS) return false;
        table[n++] = *remesh;
    }
    return true; /* the rest of the table is zero */
}

static int keep_options(batch_settings *s, const cli_option *table,
                        const cli_arguments *arguments) {
    s->options = json_array();
    for (int i = 0; i < arguments->n_given; i++) {
        const cli_given *given = &arguments->given[i];
        if (given->option < table + N_OWN) continue;
        const char *name = given->option->name;
        char *word =
            given->text ? batch_format("--%s=%s", name, given->text) : batch_format("--%s", name);
        if (strcmp(name, "format") == 0) s->format = given->text;
        s->threads = s->threads || strcmp(name, "threads") == 0;
        if (json_array_append_new(s->options, word ? json_string(word) : NULL) != 0) {
            free(word);
            return cli_error(EXIT_USAGE, "--%s: the value is not UTF-8", name);
        }
        free(word);
    }
    return -1;
}

static int parse(const cli_option *remesh, void *user) {
    parsing *p = user;
    batch_settings *s = p->settings;
    cli_option table[ROOM] = {
        {"output", 'o', CLI_TEXT, &s->output, 0, 0, NULL, "OUTDIR", "folder of the results"},
        {"jobs", 0, CLI_INTEGER, &s->jobs, 1, 4096, NULL, "N", "meshes at a time (default: cores)"},
        {"limit", 0, CLI_REAL, &s->limit, 0, 1e9, NULL, "SECONDS", "end a mesh which takes longer"},
        {"memory", 0, CLI_REAL, &s->memory, 0, 1e9, NULL, "MB",
         "end a mesh which has more resident memory"},
        {"again", 0, CLI_FLAG, &s->again, 0, 0, NULL, NULL, "do all again"},
        {"skip-failed", 0, CLI_FLAG, &s->skip_failed, 0, 0, NULL, NULL,
         "do not try again what failed with the same options"},
        {"uv", 0, CLI_FLAG, &s->uv, 0, 0, NULL, NULL, "write parameterizations"},
        {"save-field", 0, CLI_FLAG, &s->save_field, 0, 0, NULL, NULL, "write cross fields"},
        {"report", 0, CLI_FLAG, &s->report, 0, 0, NULL, NULL, "write pages with pictures"},
        {"tasks", 0, CLI_TEXT, &s->tasks, 0, 0, NULL, "T.jsonl", "write the tasks, or take them"},
        {"slurm", 0, CLI_TEXT, &s->slurm, 0, 0, NULL, "JOB.sh", "write a job array for the tasks"},
        {"run-task", 0, CLI_INTEGER, &s->run_task, 1, 1e9, NULL, "K", "run line K of the tasks"},
        {"collect", 0, CLI_FLAG, &s->collect, 0, 0, NULL, NULL, "gather what the tasks made"},
        {"progress", 0, CLI_CHOICE, &s->progress, 0, 0, cli_progress_names, "auto|plain|none",
         "auto: one line on a terminal; plain: a line a mesh; none"}};
    if (!append_remesh(table, remesh))
        return cli_error(EXIT_FAILED, "batch: more options than there is room for");
    int status = cli_parse(p->argc, p->argv, table, 0, 1, synopsis, about, p->arguments);
    if (status >= 0) return status;
    s->source = p->arguments->n > 0 ? p->arguments->positional[0] : NULL;
    status = keep_options(s, table, p->arguments);
    if (status >= 0) cli_arguments_free(p->arguments);
    return status;
}

static int check(const batch_settings *s) {
    if (s->run_task > 0 || s->collect) {
        if (!s->tasks || s->source || s->output || s->slurm || json_array_size(s->options) > 0)
            return cli_error(EXIT_USAGE, "--run-task and --collect take all from --tasks T.jsonl");
        return EXIT_DONE;
    }
    if (!s->source) return cli_error(EXIT_USAGE, "no meshes; usage: quadcover batch %s", synopsis);
    if (!s->output) return cli_error(EXIT_USAGE, "no folder for the results; give -o OUTDIR");
    if (s->memory > 0 && batch_resident(getpid()) <= 0)
        return cli_error(EXIT_USAGE, "--memory: this system does not tell how much a process has");
    if (s->again && s->skip_failed)
        return cli_error(EXIT_USAGE, "--again and --skip-failed exclude each other");
    if (s->slurm && s->tasks && strcmp(s->tasks, "-") == 0)
        return cli_error(EXIT_USAGE, "--slurm needs the tasks in a file");
    return EXIT_DONE;
}

int cli_batch(int argc, const char **argv) {
    batch_settings s;
    batch b;
    cli_arguments arguments;
    memset(&s, 0, sizeof s);
    memset(&b, 0, sizeof b);
    s.format = "auto";
    b.settings = &s;
    b.lock = -1;
    parsing p = {argc, argv, &s, &arguments};
    int status = cli_remesh_with_options(parse, &p);
    if (status >= 0) {
        json_decref(s.options);
        return status;
    }
    status = check(&s);
    if (status == EXIT_DONE) status = batch_do(&b);
    batch_free(&b);
    json_decref(s.options);
    cli_arguments_free(&arguments);
    return status;
}
