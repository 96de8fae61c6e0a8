/* bench_sparse [options] [mesh[:levels]...], levels being the number of midpoint subdivisions. */
#include "bench.h"

#include <popt.h>
#include <stdlib.h>
#include <string.h>

bench_arguments bench_parse(int argc, char **argv) {
    bench_arguments a = {.repeat = 5, .seconds = 20};
    const struct poptOption options[] = {
        {"only", 0, POPT_ARG_STRING, &a.only, 0, "meshes whose file name contains NAME", "NAME"},
        {"part", 0, POPT_ARG_STRING, &a.part, 0,
         "some of order, factor, solve, update, memory, with commas", "PARTS"},
        {"table", 0, POPT_ARG_STRING, &a.table, 0,
         "same: one ordering for all; own: each its own; default both", "NAME"},
        {"peers", 0, POPT_ARG_STRING, &a.peers, 0, "some of CHOLMOD, CXSparse, MUMPS", "NAMES"},
        {"repeat", 0, POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &a.repeat, 0, "rounds", "K"},
        {"seconds", 0, POPT_ARG_DOUBLE | POPT_ARGFLAG_SHOW_DEFAULT, &a.seconds, 0,
         "a library which has used them up gets no further round", "S"},
        {"flips", 0, POPT_ARG_INT, &a.flips, 0, "number of random edges; default by size", "K"},
        {"cache", 0, POPT_ARG_STRING, &a.cache, 0, "folder where fields are kept", "FOLDER"},
        {"json", 0, POPT_ARG_STRING, &a.json, 0, "also write all figures there", "FILE"},
        {"markdown", 0, POPT_ARG_NONE, &a.markdown, 0, "print Markdown", NULL},
        {"smoke", 0, POPT_ARG_NONE, &a.smoke, 0, "one round on a small generated mesh", NULL},
        POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = poptGetContext(NULL, argc, (const char **)argv, options, 0);
    poptSetOtherOptionHelp(context, "[options] [mesh[:levels]...]");
    const int code = poptGetNextOpt(context);
    if (code < -1)
        bench_die("%s: %s", poptBadOption(context, POPT_BADOPTION_NOALIAS), poptStrerror(code));
    a.mesh = poptGetArgs(context);
    a.storage = context;
    if (a.smoke) a.repeat = 1;
    return a;
}

void bench_arguments_clear(bench_arguments *a) {
    char *text[] = {a->only, a->part, a->table, a->peers, a->json, a->cache};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) free(text[i]);
    poptFreeContext(a->storage);
}

static unsigned parse_parts(const char *text) {
    static const struct {
        const char *name;
        unsigned part;
    } names[] = {{"order", PART_ORDER},
                 {"factor", PART_FACTOR},
                 {"solve", PART_SOLVE},
                 {"update", PART_UPDATE},
                 {"memory", PART_MEMORY}};
    unsigned parts = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!text || strstr(text, names[i].name)) parts |= names[i].part;
    if (parts == 0) bench_die("--part takes order, factor, solve, update, memory; not %s", text);
    return parts;
}

bench_effort bench_arguments_effort(const bench_arguments *a) {
    const bool same = !a->table || strcmp(a->table, "same") == 0;
    const bool own = !a->table || strcmp(a->table, "own") == 0;
    if (!same && !own) bench_die("--table takes same or own; not %s", a->table);
    return (bench_effort){parse_parts(a->part), a->repeat, a->seconds, same, own, a->peers};
}
