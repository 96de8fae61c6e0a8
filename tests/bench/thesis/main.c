/* bench_thesis [--quick] [--figures FOLDER] [--list] [PART ...]: prints the named parts, all
 * without names. Meshes come from QC_TEST_DATA. */
#include "tests/bench/thesis/thesis.h"

#include <stdio.h>
#include <string.h>

#include "tests/test_data.h"

const char *const bench_program = "bench_thesis";

static const struct {
    const char *name, *title;
    void (*run)(thesis_run *run);
} parts[] = {
    {"table-6.1", "Table 6.1: time of an evaluation of E_D", thesis_evaluation},
    {"figure-6.1", "Figure 6.1: E_D and branch points over evaluations", thesis_descent},
    {"rounding", "6.3.3: ways to round periods", thesis_rounding},
    {"figure-6.5", "Figures 6.5 and 6.6: errors over the number of branch points", thesis_balance},
    {"table-7.1", "Table 7.1: regularity of the quads", thesis_regularity},
};
enum { PARTS = (int)(sizeof parts / sizeof *parts) };

const char *thesis_mesh(const thesis_run *run, const char *name) {
    static char path[TEST_DATA_PATH];
    char file[256];
    if (run->quick) return NULL;
    snprintf(file, sizeof file, "meshes/%s", name);
    return test_data(file, path);
}

static bool progress(void *user, const char *stage, double fraction) {
    const thesis_run *run = user;
    (void)stage;
    (void)fraction;
    if (run->watch) run->watch(run->watch_user);
    return true;
}

static bool run_part(thesis_run *run, const char *name) {
    bool found = false;
    for (int i = 0; i < PARTS; i++) {
        if (name && strcmp(name, parts[i].name) != 0) continue;
        parts[i].run(run);
        fflush(stdout);
        found = true;
    }
    return found;
}

int main(int argc, char **argv) {
    thesis_run run = {0};
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    int first = 1;
    for (; first < argc && strncmp(argv[first], "--", 2) == 0; first++) {
        const char *option = argv[first];
        if (strcmp(option, "--quick") == 0) {
            run.quick = true;
        } else if (strcmp(option, "--figures") == 0 && first + 1 < argc) {
            run.figures = argv[++first];
        } else if (strcmp(option, "--list") == 0) {
            for (int i = 0; i < PARTS; i++) printf("%-12s %s\n", parts[i].name, parts[i].title);
            return 0;
        } else {
            bench_die("unknown option %s", option);
        }
    }
    options.threads = 1;
    options.progress = progress;
    options.user = &run;
    bench_check(NULL, qc_ctx_create(&options, &run.ctx));
    for (int i = first; i < argc; i++)
        if (!run_part(&run, argv[i])) bench_die("no part %s; --list names them", argv[i]);
    if (first == argc) run_part(&run, NULL);
    qc_ctx_free(run.ctx);
    return 0;
}
