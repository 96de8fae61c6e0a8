/* Thesis Table 7.1: regularity of the quads of the Stanford bunny with about 6500 vertices, by the
 * three modes of branch point optimisation. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <qc/remesh.h>
#include <stdio.h>

enum { MODES = 3 };
/* Columns "QuadCover", "Relocation" and "Balancing". */
static const struct {
    const char *name;
    double vertices, branch_points, rsd_edge, rsd_angle, arap;
} THESIS[MODES] = {{"fast", 6535, 37, 18.2, 14.8, 0.50},
                   {"relocate", 6464, 59, 9.0, 8.0, 0.36},
                   {"best", 6506, 93, 8.1, 7.2, 0.33}};

typedef struct figures {
    double vertices, branch_points, rsd_edge, rsd_angle, arap, curl, harmonic, seconds;
} figures;

static double deviation(double n, double sum, double sum2) {
    return sqrt(fmax(sum2 / n - sum / n * (sum / n), 0));
}

static figures measure(const qc_report *r, double seconds) {
    const double right = acos(-1) / 2;
    const double mean = r->quads.edge_sum / r->quads.edges;
    return (figures){(double)r->quads.vertices,
                     (double)r->field.singularities,
                     100 * deviation(r->quads.edges, r->quads.edge_sum, r->quads.edge_sum2) / mean,
                     100 * deviation(r->quads.corners, r->quads.angle_sum, r->quads.angle_sum2) /
                         right,
                     r->uv.arap_sum / r->uv.area,
                     100 * r->energy.curl / r->energy.field,
                     100 * r->energy.harmonic / r->energy.field,
                     seconds};
}

static figures remesh(qc_ctx *ctx, const char *path, double quads, int32_t mode) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_remesh_result result = {0};
    qc_polygon_mesh *input = bench_read(ctx, path);
    options.quads = quads;
    options.mode = mode;
    bench_check(ctx, qc_registry_create(ctx, &registry));
    bench_check(ctx, qc_default_pipeline(ctx, registry, &options, &pipeline));
    const double begin = bench_clock().cpu;
    bench_check(ctx, qc_remesh(ctx, pipeline, input, NULL, &result));
    const figures f = measure(result.report, bench_clock().cpu - begin);
    qc_remesh_result_clear(&result);
    qc_object_release(input);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    return f;
}

/* comparable: the ratio says something. */
static void row(const char *name, bool comparable, const double thesis[MODES],
                const double ours[MODES]) {
    double cell[3 * MODES];
    for (int m = 0; m < MODES; m++) {
        cell[3 * m] = thesis[m];
        cell[3 * m + 1] = ours[m];
        cell[3 * m + 2] = comparable ? thesis[m] / ours[m] : NAN;
    }
    thesis_row(name, 3 * MODES, cell);
}

#define ROW(name, comparable, theirs, ours)                                                        \
    row(name, comparable, (double[]){THESIS[0].theirs, THESIS[1].theirs, THESIS[2].theirs},        \
        (double[]){f[0].ours, f[1].ours, f[2].ours})
#define OURS(name, ours) row(name, false, none, (double[]){f[0].ours, f[1].ours, f[2].ours})

void thesis_regularity(thesis_run *run) {
    static const char *const column[] = {"QuadCover",  "`fast`",     "ratio",
                                         "Relocation", "`relocate`", "ratio",
                                         "Balancing",  "`best`",     "ratio"};
    const double none[MODES] = {NAN, NAN, NAN};
    const char *path = thesis_mesh(run, "stanford-bunny.obj");
    figures f[MODES];
    for (int m = 0; m < MODES; m++) f[m] = remesh(run->ctx, path, run->quick ? 1000 : 6500, m);
    thesis_head("", 3 * MODES, column);
    ROW("vertices", false, vertices, vertices);
    ROW("branch points", true, branch_points, branch_points);
    ROW("RSD edge, %", true, rsd_edge, rsd_edge);
    ROW("RSD angle, %", true, rsd_angle, rsd_angle);
    ROW("ARAP", false, arap, arap);
    OURS("E_D, % of the field", curl);
    OURS("E_H, % of the field", harmonic);
    OURS("CPU s, whole pipeline", seconds);
}
