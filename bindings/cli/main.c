/* quadcover: quad meshes from triangle meshes. Dispatches to the commands. */
#include "bindings/cli/cli.h"
#include <string.h>

static const struct command {
    const char *name;
    int (*run)(int argc, const char **argv);
    const char *doc;
} commands[] = {
    {"remesh", cli_remesh, "triangle mesh in, pure quad mesh out"},
    {"extract", cli_extract, "quads of an integer-seamless parameterization (OBJ with vt)"},
    {"field", cli_field, "a smooth cross field of a triangle mesh"},
    {"check", cli_check, "validity and quality of a quad mesh"},
    {"pick", cli_pick, "what rays meet on a surface"},
    {"stages", cli_stages, "the registered stages, their ports and parameters"},
    {"shape", cli_shape, "one of the procedural surfaces"},
    {"batch", cli_batch, "many meshes, each in a process of its own"},
};
enum { N_COMMANDS = sizeof commands / sizeof *commands };

static void help(void) {
    printf("Usage: quadcover COMMAND [arguments]\n"
           "       quadcover COMMAND --help | --help | --version\n\nCommands:\n");
    for (size_t i = 0; i < N_COMMANDS; i++)
        printf("  %-9s %s\n", commands[i].name, commands[i].doc);
    printf("\n"
           "Example: quadcover remesh bunny.obj -o quads.obj --quads 6500 --stats stats.json\n\n"
           "'-' stands for standard input or output where a file is expected.\n"
           "Exit status: 0 done; 1 the computation failed; 2 wrong usage; 3 unusable input;\n"
           "130 interrupted. QC_PLUGIN_PATH: plugins to load, separated by ':'.\n");
}

static int unknown_command(const char *name) {
    const char *names[N_COMMANDS];
    for (size_t i = 0; i < N_COMMANDS; i++) names[i] = commands[i].name;
    const char *near = qc_closest_name(name, names, N_COMMANDS);
    return cli_error(EXIT_USAGE, "no command '%s'%s%s; see quadcover --help", name,
                     near ? "; closest: " : "", near ? near : "");
}

int main(int argc, char **argv) {
    if (argc < 2) return cli_error(EXIT_USAGE, "no command given; see quadcover --help");
    const char *name = argv[1];
    if (strcmp(name, "--version") == 0) {
        qc_ctx *ctx = NULL;
        if (qc_ctx_create(NULL, &ctx) != QC_OK) return EXIT_FAILED;
        printf("quadcover %s\nvector instructions: %s\n", qc_version(), qc_ctx_instructions(ctx));
        qc_ctx_free(ctx);
        return EXIT_DONE;
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        help();
        return EXIT_DONE;
    }
    for (size_t i = 0; i < N_COMMANDS; i++)
        if (strcmp(commands[i].name, name) == 0) {
            const int status = commands[i].run(argc - 1, (const char **)(uintptr_t)(argv + 1));
            if (fflush(stdout) != 0 && status == EXIT_DONE)
                return cli_error(EXIT_FAILED, "stdout: cannot write");
            return status;
        }
    return unknown_command(name);
}
