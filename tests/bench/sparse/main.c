/* bench_sparse: qc/sparse.h against CHOLMOD, CXSparse, METIS and MUMPS on the matrices of qc.hodge.
 * The meshes one after the other. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "test_data.h"

const char *const bench_program = "bench_sparse";

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

/* Meshes of 7k, 20k, 69k, 86k, 346k and 1.4M faces among the test data. */
static const char *const standard[] = {"bunny.off",       "rocker-arm.obj",  "stanford-bunny.obj",
                                       "armadillo.obj:0", "armadillo.obj:1", "armadillo.obj:2"};
enum { STANDARD = sizeof standard / sizeof *standard };
/* Density the fields are made for. */
static const double QUADS = 10000;

static int32_t count_meshes(const bench_arguments *a) {
    int32_t count = 0;
    if (a->smoke) return 1;
    if (!a->mesh) return STANDARD;
    while (a->mesh[count]) count++;
    return count;
}

/* path[:levels] of mesh i; false when there is none: a small one is made. */
static bool mesh_spec(const bench_arguments *a, int32_t i, char spec[TEST_DATA_PATH]) {
    char name[64];
    if (a->smoke) return false;
    if (a->mesh) {
        snprintf(spec, TEST_DATA_PATH, "%s", a->mesh[i]);
        return true;
    }
    snprintf(name, sizeof name, "meshes/%s", standard[i]);
    test_data(name, spec);
    return true;
}

static int32_t flips_for(int32_t faces) {
    return faces < 100000 ? 200 : faces < 500000 ? 50 : 30;
}

/* Returns false when --only leaves it out. */
static bool compare_mesh(qc_ctx *ctx, const bench_arguments *a, int32_t i, const bench_limits *l,
                         bench_comparison *out) {
    const bench_effort effort = bench_arguments_effort(a);
    char path[TEST_DATA_PATH] = "", name[64];
    const bool file = mesh_spec(a, i, path);
    const char *slash = strrchr(path, '/'), *stem = file ? (slash ? slash + 1 : path) : "generated";
    if (a->only && !strstr(stem, a->only)) return false;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(stem, ".:"), stem);
    char *colon = strrchr(path, ':');
    const int32_t levels = colon ? atoi(colon + 1) : 0;
    if (colon) *colon = 0;
    const bench_source source = {file ? path : NULL, QUADS, levels, a->cache};
    qc_matching *matching = bench_surface(ctx, &source);
    const int32_t faces = matching->field->mesh->n_faces;
    bench_matrix *M =
        bench_make_matrix(ctx, name, matching, a->flips ? a->flips : flips_for(faces));
    qc_object_release(matching);
    bench_compare(ctx, M, l, &effort, out);
    bench_matrix_free(M);
    return true;
}

int main(int argc, char **argv) {
    one_thread_in_peers(argv);
    bench_arguments a = bench_parse(argc, argv);
    const int format = a.markdown ? FORMAT_MARKDOWN : FORMAT_TEXT;
    const int32_t count = count_meshes(&a);
    int32_t done = 0;
    qc_ctx *ctx = NULL;
    bench_check(NULL, qc_ctx_create(NULL, &ctx));
    const bench_limits l = bench_measure_limits();
    bench_comparison *results = NEW(bench_comparison, count);
    bench_print_limits(&l, format);
    for (int32_t i = 0; i < count; i++) {
        if (!compare_mesh(ctx, &a, i, &l, &results[done])) continue;
        if (!a.markdown) bench_print_comparison(&results[done], format);
        done++;
    }
    bench_print_summary(done, results, format);
    for (int32_t i = 0; a.markdown && i < done; i++) bench_print_comparison(&results[i], format);
    if (a.json) bench_write_json(a.json, &l, done, results);
    free(results);
    qc_ctx_free(ctx);
    bench_arguments_clear(&a);
    return 0;
}
