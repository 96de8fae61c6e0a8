/* bench_sparse: qc/sparse.h against CHOLMOD, CXSparse, METIS and MUMPS on the matrices of qc.hodge.
 * Usage: bench_sparse [options] mesh[:levels]... where levels counts midpoint subdivisions. */
#include "bench.h"

#include <popt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void bench_die(const char *format, ...) {
    va_list list;
    va_start(list, format);
    fputs("bench_sparse: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    exit(1);
}

void bench_check(qc_ctx *ctx, qc_status status) {
    if (status != QC_OK)
        bench_die("%s: %s", qc_status_name(status), ctx ? qc_ctx_error(ctx)->text : "no context");
}

void *bench_alloc(size_t count, size_t size) {
    void *p = calloc(count ? count : 1, size);
    if (!p) bench_die("no memory");
    return p;
}

/* OpenMP (in CHOLMOD) and OpenBLAS read their number of threads when they are loaded. */
static void one_thread_in_peers(char **argv) {
    static const char *const variable[] = {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT",
                                           "OPENBLAS_NUM_THREADS"};
    bool set = true;
    for (int i = 0; i < 3; i++) {
        const char *value = getenv(variable[i]);
        if (value && strcmp(value, "1") == 0) continue;
        setenv(variable[i], "1", 1);
        set = false;
    }
    if (!set) execv("/proc/self/exe", argv);
}

typedef struct arguments {
    char *only, *parts, *table, *json, *cache;
    int repeat, flips, markdown, smoke, subdivide;
    double seconds;
    const char **mesh;
} arguments;

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

static poptContext parse(int argc, char **argv, arguments *a) {
    const struct poptOption options[] = {
        {"only", 0, POPT_ARG_STRING, &a->only, 0, "meshes whose name contains NAME", "NAME"},
        {"part", 0, POPT_ARG_STRING, &a->parts, 0,
         "some of order, factor, solve, update, memory; with commas", "PARTS"},
        {"table", 0, POPT_ARG_STRING, &a->table, 0,
         "same or own: one ordering for all, or each "
         "its own; default both",
         "NAME"},
        {"repeat", 0, POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &a->repeat, 0, "rounds", "K"},
        {"seconds", 0, POPT_ARG_DOUBLE | POPT_ARGFLAG_SHOW_DEFAULT, &a->seconds, 0,
         "no further round for a library which has used this time up", "S"},
        {"flips", 0, POPT_ARG_INT, &a->flips, 0, "number of random edges; default by size", "K"},
        {"subdivide", 0, POPT_ARG_INT, &a->subdivide, 0,
         "midpoint subdivisions of every mesh given without :LEVELS", "N"},
        {"cache", 0, POPT_ARG_STRING, &a->cache, 0, "folder where fields are kept", "FOLDER"},
        {"json", 0, POPT_ARG_STRING, &a->json, 0, "also write all figures there", "FILE"},
        {"markdown", 0, POPT_ARG_NONE, &a->markdown, 0, "print Markdown", NULL},
        {"smoke", 0, POPT_ARG_NONE, &a->smoke, 0, "one round on a small generated mesh", NULL},
        POPT_AUTOHELP POPT_TABLEEND};
    poptContext context = poptGetContext(NULL, argc, (const char **)argv, options, 0);
    poptSetOtherOptionHelp(context, "[options] mesh[:levels]...");
    const int code = poptGetNextOpt(context);
    if (code < -1)
        bench_die("%s: %s", poptBadOption(context, POPT_BADOPTION_NOALIAS), poptStrerror(code));
    a->mesh = poptGetArgs(context);
    return context;
}

static int32_t flips_for(int32_t faces) {
    return faces < 100000 ? 200 : faces < 500000 ? 50 : 10;
}

/* spec: path[:levels], or NULL. Returns false when --only leaves it out. */
static bool compare_mesh(qc_ctx *ctx, const arguments *a, const char *spec, const bench_limits *l,
                         bench_comparison *out) {
    char path[1024] = "generated", name[64];
    snprintf(path, sizeof path, "%s", spec ? spec : "generated");
    char *colon = strrchr(path, ':');
    const int32_t levels = colon ? atoi(colon + 1) : a->subdivide;
    if (colon) *colon = 0;
    const char *slash = strrchr(path, '/');
    snprintf(name, sizeof name, "%.40s%.*s", slash ? slash + 1 : path, levels ? 32 : 0,
             levels == 1 ? ", subdivided" : ", subdivided twice or more");
    if (a->only && !strstr(name, a->only)) return false;
    const bench_effort effort = {parse_parts(a->parts), a->repeat, a->seconds,
                                 !a->table || strcmp(a->table, "same") == 0,
                                 !a->table || strcmp(a->table, "own") == 0};
    qc_matching *matching = bench_surface(ctx, spec ? path : NULL, levels, a->cache);
    const int32_t faces = matching->field->mesh->n_faces;
    bench_matrix *M =
        bench_make_matrix(ctx, name, matching, a->flips ? a->flips : flips_for(faces));
    qc_object_release(matching);
    bench_compare(ctx, M, l, &effort, out);
    bench_matrix_free(M);
    return true;
}

int main(int argc, char **argv) {
    arguments a = {.repeat = 5, .seconds = 20};
    one_thread_in_peers(argv);
    poptContext context = parse(argc, argv, &a);
    const int format = a.markdown ? FORMAT_MARKDOWN : FORMAT_TEXT;
    if (a.smoke) a.repeat = 1;
    int32_t count = a.smoke, done = 0;
    while (!a.smoke && a.mesh && a.mesh[count]) count++;
    if (count == 0) bench_die("no mesh given; try --help");
    qc_ctx *ctx = NULL;
    bench_check(NULL, qc_ctx_create(NULL, &ctx));
    const bench_limits l = bench_measure_limits();
    bench_print_limits(&l, format);
    bench_comparison *results = NEW(bench_comparison, count);
    for (int32_t i = 0; i < count; i++)
        if (compare_mesh(ctx, &a, a.smoke ? NULL : a.mesh[i], &l, &results[done]))
            bench_print_comparison(&results[done++], format);
    if (a.json) bench_write_json(a.json, &l, done, results);
    free(results);
    qc_ctx_free(ctx);
    poptFreeContext(context);
    return 0;
}
