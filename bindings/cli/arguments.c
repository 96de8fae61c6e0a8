/* Command line parsing: our option tables on top of popt, with ranges and closest names. */
#include "bindings/cli/cli.h"
#include <errno.h>
#include <math.h>
#include <popt.h>
#include <stdlib.h>
#include <string.h>

enum { VALUE_HELP = 1, VALUE_FIRST = 2, ROOM = CLI_MOST_OPTIONS + 2 };

/* popt's table and the texts it allocated. */
typedef struct storage {
    struct poptOption table[ROOM]; /* those of the command, help, the end */
    char **text;
    const char **list[CLI_MOST_OPTIONS]; /* items of CLI_LIST options */
    const char **word;                   /* argv with the full command name */
    cli_given *given;                    /* fewer than there are words */
    int n_texts, n_lists, n_words, n_given;
    char command[64];
} storage;

/* false: there are too many. */
static bool fill_table(const cli_option *options, struct poptOption *table) {
    int n = 0;
    for (; options[n].name; n++) {
        const cli_option *o = &options[n];
        if (n == CLI_MOST_OPTIONS) return false;
        const struct poptOption entry = {
            o->name,    o->letter,       o->kind == CLI_FLAG ? POPT_ARG_NONE : POPT_ARG_STRING,
            NULL,       VALUE_FIRST + n, o->doc,
            o->argument};
        table[n] = entry;
    }
    const struct poptOption help = {"help",     'h',         POPT_ARG_NONE, NULL,
                                    VALUE_HELP, "this text", NULL};
    const struct poptOption end = POPT_TABLEEND;
    table[n] = help;
    table[n + 1] = end;
    return true;
}

static bool parse_number(const char *text, double *value) {
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value);
}

static int set_number(const cli_option *o, const char *text) {
    double value;
    if (!parse_number(text, &value) || (o->kind == CLI_INTEGER && value != floor(value)))
        return cli_error(EXIT_USAGE, "--%s: '%s' is not a%s number", o->name, text,
                         o->kind == CLI_INTEGER ? " whole" : "");
    if (value < o->min || value > o->max)
        return cli_error(EXIT_USAGE, "--%s: %s is out of range; use %g to %g", o->name, text,
                         o->min, o->max);
    if (o->kind == CLI_INTEGER)
        *(long long *)o->target = (long long)value;
    else
        *(double *)o->target = value;
    return -1;
}

static int set_choice(const cli_option *o, const char *text) {
    size_t n = 0;
    for (; o->choices[n]; n++)
        if (strcmp(o->choices[n], text) == 0) {
            *(int *)o->target = (int)n;
            return -1;
        }
    const char *near = qc_closest_name(text, o->choices, n);
    return cli_error(EXIT_USAGE, "--%s: no choice '%s'%s%s; use %s", o->name, text,
                     near ? "; closest: " : "", near ? near : "", o->argument);
}

/* Each option is given fewer times than there are words. */
static int set_list(const cli_option *o, const char *text, storage *s) {
    cli_list *list = o->target;
    if (!list->item) {
        list->item = calloc((size_t)s->n_words, sizeof *list->item);
        if (!list->item) return cli_error(EXIT_FAILED, "out of memory");
        s->list[s->n_lists++] = list->item;
    }
    list->item[list->n++] = text;
    return -1;
}

static int set(const cli_option *o, char *text, storage *s) {
    const cli_given given = {o, text};
    s->given[s->n_given++] = given;
    if (o->kind == CLI_FLAG) {
        *(bool *)o->target = true;
        return -1;
    }
    char **grown = realloc(s->text, ((size_t)s->n_texts + 1) * sizeof *grown);
    if (!grown || !text) {
        free(text);
        return cli_error(EXIT_FAILED, "out of memory");
    }
    s->text = grown;
    s->text[s->n_texts++] = text;
    switch (o->kind) {
    case CLI_REAL:
    case CLI_INTEGER:
        return set_number(o, text);
    case CLI_CHOICE:
        return set_choice(o, text);
    case CLI_LIST:
        return set_list(o, text, s);
    default:
        *(const char **)o->target = text;
        return -1;
    }
}

static int bad_option(poptContext context, const cli_option *options, int code) {
    const char *name = poptBadOption(context, POPT_BADOPTION_NOALIAS);
    if (code != POPT_ERROR_BADOPT) return cli_error(EXIT_USAGE, "%s: %s", name, poptStrerror(code));
    const char *names[ROOM];
    size_t n = 0;
    for (; options[n].name; n++) names[n] = options[n].name;
    names[n++] = "help";
    char bare[64];
    snprintf(bare, sizeof bare, "%.*s", (int)strcspn(name + strspn(name, "-"), "="),
             name + strspn(name, "-"));
    const char *near = qc_closest_name(bare, names, n);
    return cli_error(EXIT_USAGE, "no option '%s'%s%s; --help lists all", name,
                     near ? "; closest: --" : "", near ? near : "");
}

static int parse(poptContext context, const cli_option *options, const char *about, storage *s) {
    int value;
    while ((value = poptGetNextOpt(context)) >= 0) {
        if (value == VALUE_HELP) {
            poptPrintHelp(context, stdout, 0);
            printf("\n%s\n", about);
            return EXIT_DONE;
        }
        const int status = set(&options[value - VALUE_FIRST], poptGetOptArg(context), s);
        if (status >= 0) return status;
    }
    return value < -1 ? bad_option(context, options, value) : -1;
}

int cli_parse(int argc, const char **argv, const cli_option *options, int min_n, int max_n,
              const char *synopsis, const char *about, cli_arguments *out) {
    memset(out, 0, sizeof *out);
    storage *s = calloc(1, sizeof *s);
    const char **word = calloc((size_t)argc + 1, sizeof *word);
    cli_given *given = calloc((size_t)argc + 1, sizeof *given);
    if (!s || !word || !given) {
        free(s);
        free(word);
        free(given);
        return cli_error(EXIT_FAILED, "out of memory");
    }
    snprintf(s->command, sizeof s->command, "quadcover %s", argv[0]);
    memcpy(word, argv, (size_t)argc * sizeof *word);
    word[0] = s->command;
    s->word = word;
    s->given = given;
    s->n_words = argc;
    if (!fill_table(options, s->table)) {
        free(s->given);
        free(word);
        free(s);
        return cli_error(EXIT_FAILED, "%s: more options than there is room for", argv[0]);
    }
    poptContext context = poptGetContext(NULL, argc, word, s->table, 0);
    poptSetOtherOptionHelp(context, synopsis);
    out->context = context;
    out->memory = s;
    int status = parse(context, options, about, s);
    if (status < 0) {
        out->positional = poptGetArgs(context);
        while (out->positional && out->positional[out->n]) out->n++;
        out->given = s->given;
        out->n_given = s->n_given;
        if (out->n < min_n)
            status = cli_error(EXIT_USAGE, "missing argument; usage: quadcover %s %s", argv[0],
                               synopsis);
        else if (out->n > max_n)
            status = cli_error(EXIT_USAGE, "unexpected argument '%s'; usage: quadcover %s %s",
                               out->positional[max_n], argv[0], synopsis);
    }
    if (status >= 0) cli_arguments_free(out);
    return status;
}

void cli_arguments_free(cli_arguments *arguments) {
    storage *s = arguments->memory;
    poptFreeContext(arguments->context);
    if (s) {
        for (int i = 0; i < s->n_texts; i++) free(s->text[i]);
        for (int i = 0; i < s->n_lists; i++) free(s->list[i]);
        free(s->text);
        free(s->word);
        free(s->given);
    }
    free(s);
    memset(arguments, 0, sizeof *arguments);
}
