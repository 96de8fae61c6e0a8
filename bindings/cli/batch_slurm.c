/* A job array for Slurm which runs the tasks of a batch. */
#include "bindings/cli/batch.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LARGEST_ARRAY = 1000 }; /* Slurm's own default allows indices below 1001 */

/* In single quotes for the shell. */
static void quote(FILE *out, const char *text) {
    fputc('\'', out);
    for (; *text; text++) fputs(*text == '\'' ? "'\\''" : (char[]){*text, 0}, out);
    fputc('\'', out);
}

/* Threads of a task as its options say; 1 without. */
static int threads(const json_t *task) {
    json_t *word;
    size_t i;
    int n = 1;
    json_array_foreach(json_object_get(task, "command"), i,
                       word) if (strncmp(json_string_value(word), "--threads=", 10) == 0) n =
        atoi(json_string_value(word) + 10);
    return n > 0 ? n : 1;
}

static void print(FILE *out, const char *tasks_path, const json_t *tasks, const char *program) {
    const json_t *first = json_array_get(tasks, 0);
    const int n = (int)json_array_size(tasks), size = n < LARGEST_ARRAY ? n : LARGEST_ARRAY;
    const double limit = batch_number(first, "limit"), memory = batch_number(first, "memory");
    fprintf(out, "#!/bin/sh\n#SBATCH --job-name=quadcover\n#SBATCH --array=1-%d\n", size);
    fprintf(out, "#SBATCH --cpus-per-task=%d\n", threads(first));
    if (memory > 0) fprintf(out, "#SBATCH --mem=%.0fM\n", memory + 256);
    if (limit > 0)
        fprintf(out, "#SBATCH --time=%.0f\n", (limit + 60) * ((n + size - 1) / size) / 60 + 1);
    fprintf(out, "# Each element of the array runs every %dth task, from its own number on.\n",
            size);
    fprintf(out, "status=0\ntask=${SLURM_ARRAY_TASK_ID:?run this by sbatch}\n");
    fprintf(out, "while [ \"$task\" -le %d ]; do\n    ", n);
    quote(out, program);
    fputs(" batch --tasks ", out);
    quote(out, tasks_path);
    fprintf(out, " --run-task \"$task\" || status=1\n    task=$((task + %d))\ndone\nexit $status\n",
            size);
}

int batch_write_slurm(const char *path, const char *tasks_path, const json_t *tasks,
                      const char *program) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return cli_error(EXIT_FAILED, "out of memory");
    print(out, tasks_path, tasks, program);
    const int status =
        fclose(out) == 0 ? cli_write_text(path, text) : cli_error(EXIT_FAILED, "out of memory");
    free(text);
    return status;
}
