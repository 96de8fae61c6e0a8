/* quadcover stages: what is registered, as text, JSON or Markdown. */
#include "bindings/cli/cli.h"
#include <stdlib.h>
#include <string.h>

static const char *const type_names[] = {"", "bool", "int", "real", "enum", "text"};

/* "0.5", "true", "fast": the default as one would write it after --set. */
static void print_default(const qc_param *p, char *text, size_t size) {
    if (p->type == QC_ENUM)
        snprintf(text, size, "%s", p->choices[(int)p->def]);
    else if (p->type == QC_BOOL)
        snprintf(text, size, "%s", p->def != 0 ? "true" : "false");
    else if (p->type == QC_TEXT)
        snprintf(text, size, "(none)");
    else
        snprintf(text, size, "%g", p->def);
}

static void print_range(const qc_param *p, char *text, size_t size) {
    text[0] = '\0';
    if (p->type == QC_INT || p->type == QC_REAL) snprintf(text, size, "%g to %g", p->min, p->max);
    if (p->type == QC_TEXT && p->choices) snprintf(text, size, "names a %s", p->choices[0]);
    if (p->type != QC_ENUM) return;
    size_t used = 0;
    for (int i = 0; p->choices[i] && used < size; i++)
        used +=
            (size_t)snprintf(text + used, size - used, "%s%s", i > 0 ? ", " : "", p->choices[i]);
}

static void print_ports(const qc_stage *stage, uint32_t n,
                        const qc_port *(*port)(const qc_stage *, uint32_t), const char *heading) {
    if (n > 0) printf("%s:\n", heading);
    for (uint32_t i = 0; i < n; i++) {
        const qc_port *p = port(stage, i);
        printf("  %-14s %-20s %s%s\n", p->name, p->type,
               p->flags & QC_PORT_OPTIONAL ? "(optional) " : "", p->doc);
    }
}

static void print_stage(const qc_stage *stage) {
    printf("%s %s - %s\n\n%s\n\nSource: %s\n\n", stage->id, stage->version, stage->brief,
           stage->doc, stage->cite);
    print_ports(stage, stage->n_in, qc_stage_in, "Inputs");
    print_ports(stage, stage->n_out, qc_stage_out, "Outputs");
    if (stage->n_params > 0) printf("Parameters:\n");
    for (uint32_t i = 0; i < stage->n_params; i++) {
        const qc_param *p = qc_stage_param(stage, i);
        char def[64], range[256];
        print_default(p, def, sizeof def);
        print_range(p, range, sizeof range);
        printf("  %-16s %-5s default %s%s%s%s%s%s\n      %s\n", p->name, type_names[p->type], def,
               *p->unit ? " " : "", p->unit, *range ? " (" : "", range, *range ? ")" : "", p->doc);
    }
}

static void markdown_ports(const qc_stage *stage, uint32_t n,
                           const qc_port *(*port)(const qc_stage *, uint32_t),
                           const char *heading) {
    if (n > 0) printf("| %s | type | |\n|---|---|---|\n", heading);
    for (uint32_t i = 0; i < n; i++) {
        const qc_port *p = port(stage, i);
        printf("| `%s` | `%s` | %s%s |\n", p->name, p->type,
               p->flags & QC_PORT_OPTIONAL ? "optional: " : "", p->doc);
    }
    if (n > 0) printf("\n");
}

static void print_markdown(const qc_stage *stage) {
    printf("## %s\n\n%s (version %s). Source: %s.\n\n%s\n\n", stage->id, stage->brief,
           stage->version, stage->cite, stage->doc);
    markdown_ports(stage, stage->n_in, qc_stage_in, "input");
    markdown_ports(stage, stage->n_out, qc_stage_out, "output");
    if (stage->n_params > 0)
        printf("| parameter | type | default | range | unit | |\n|---|---|---|---|---|---|\n");
    for (uint32_t i = 0; i < stage->n_params; i++) {
        const qc_param *p = qc_stage_param(stage, i);
        char def[64], range[256];
        print_default(p, def, sizeof def);
        print_range(p, range, sizeof range);
        printf("| `%s` | %s | %s | %s | %s | %s |\n", p->name, type_names[p->type], def, range,
               p->unit, p->doc);
    }
    if (stage->n_params > 0) printf("\n");
}

static int print_json(qc_registry *registry, const qc_stage *one) {
    char *text = cli_stages_json(registry, one);
    if (!text) return cli_error(EXIT_FAILED, "cannot print the stages");
    printf("%s\n", text);
    free(text);
    return EXIT_DONE;
}

static int print(qc_registry *registry, const qc_stage *one, bool json, bool markdown) {
    if (json) return print_json(registry, one);
    if (one && !markdown) {
        print_stage(one);
        return EXIT_DONE;
    }
    if (one) {
        print_markdown(one);
        return EXIT_DONE;
    }
    if (markdown) printf("# Stages\n\n");
    for (uint32_t i = 0; i < qc_registry_count(registry); i++) {
        const qc_stage *stage = qc_registry_stage(registry, i);
        if (markdown)
            print_markdown(stage);
        else
            printf("%-20s %-5s %s\n", stage->id, stage->version, stage->brief);
    }
    return EXIT_DONE;
}

int cli_stages(int argc, const char **argv) {
    static const char about[] = "Lists the registered stages, those of plugins included; with "
                                "NAME: its ports and parameters.";
    bool json = false, markdown = false;
    cli_list plugin = {0, NULL};
    cli_common common = {1, 0, CLI_PROGRESS_NONE};
    cli_session session;
    cli_arguments arguments;
    const cli_option options[] = {
        {"json", 0, CLI_FLAG, &json, 0, 0, NULL, NULL, "print JSON"},
        {"markdown", 0, CLI_FLAG, &markdown, 0, 0, NULL, NULL, "print Markdown"},
        {"plugin", 0, CLI_LIST, &plugin, 0, 0, NULL, "X.so", "load a plugin"},
        {NULL, 0, 0, NULL, 0, 0, NULL, NULL, NULL}};
    int status = cli_parse(argc, argv, options, 0, 1, "[NAME] [options]", about, &arguments);
    if (status >= 0) return status;
    qc_registry *registry = NULL;
    const qc_stage *one = NULL;
    status = cli_session_open(&session, &common);
    if (status == EXIT_DONE) status = cli_registry(session.ctx, &plugin, &registry);
    if (status == EXIT_DONE && arguments.n == 1 &&
        qc_registry_find(registry, arguments.positional[0], &one) != QC_OK)
        status = cli_usage_error(session.ctx, NULL);
    if (status == EXIT_DONE) status = print(registry, one, json, markdown);
    qc_registry_free(registry);
    if (session.ctx) cli_session_close(&session);
    cli_arguments_free(&arguments);
    return status;
}
