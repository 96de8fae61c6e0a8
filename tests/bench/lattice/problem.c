/* Period matrices of real surfaces. */
#include "tests/bench/lattice/bench.h"

#include <math.h>
#include <qc/field.h>
#include <qc/map.h>
#include <qc/shape.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/map/periods/period_matrix.h"

static const double QUADS = 10000;

static qc_mesh *read_surface(qc_ctx *ctx, const char *path) {
    qc_mesh *mesh = NULL;
    if (!path) {
        qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
        options.resolution = 1000;
        options.noise = 0.1;
        bench_check(ctx, qc_shape_create(ctx, "genus", &options, &mesh));
        return mesh;
    }
    qc_polygon_mesh *soup = NULL;
    qc_repair_report *report = NULL;
    bench_check(ctx, qc_polygon_mesh_read(ctx, path, &soup));
    bench_check(ctx, qc_mesh_repair(ctx, soup, &mesh, &report));
    qc_object_release(soup);
    qc_object_release(report);
    return mesh;
}

/* Stages qc.field.curvature and qc.field.smooth with their defaults, and qc.matching. */
static qc_matching *smooth_field(qc_ctx *ctx, const qc_mesh *mesh) {
    const double quad = sqrt(mesh->area / QUADS);
    const size_t F = (size_t)mesh->n_faces;
    qc_complex *x = calloc(F, sizeof *x), *guide = calloc(F, sizeof *x);
    double *kappa = calloc(2 * F, sizeof *kappa), *weight = calloc(F, sizeof *weight);
    uint8_t *trusted = calloc(F, sizeof *trusted);
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    bench_check(ctx, qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN,
                                        fmax(2 * mesh->mean_edge_length, 1.5 * quad), x, kappa));
    bench_check(ctx, qc_field_stability(ctx, mesh, x, kappa, weight));
    bench_check(ctx, qc_field_extend(ctx, mesh, weight, 0.3, x, trusted));
    memcpy(guide, x, F * sizeof *x);
    bench_check(ctx, qc_field_smoothest(ctx, mesh, weight, trusted, 1, 0.5 * quad, x));
    bench_check(ctx, qc_field_smooth(ctx, mesh, guide, weight, trusted, 0.5, 20, x));
    bench_check(ctx, qc_field_separate(ctx, mesh, 0.7 * quad, trusted, x, NULL));
    bench_check(ctx, qc_face_field_create(ctx, mesh, x, NULL, NULL, &field));
    bench_check(ctx, qc_matching_create(ctx, field, NULL, &matching));
    free(x);
    free(guide);
    free(kappa);
    free(weight);
    free(trusted);
    qc_object_release(field);
    return matching;
}

static double *period_matrix(qc_ctx *ctx, const qc_seamless_map *map, int32_t *n) {
    const qc_matching *matching = map->matching;
    const qc_mesh *mesh = matching->field->mesh;
    const qc_cover cover = {mesh, matching->m};
    double *cotangent = malloc(3 * (size_t)mesh->n_faces * sizeof *cotangent);
    qc__seams *seams = NULL;
    qc__periods *periods = NULL;
    bench_check(ctx, qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL));
    bench_check(ctx,
                qc__seams_create(ctx, &cover, map->cut, map->face_turn, matching->index4, &seams));
    bench_check(ctx, qc__seams_solve(ctx, seams, QC_LATTICE_QUADS));
    bench_check(ctx,
                qc__periods_create(ctx, &cover, seams, cotangent, map->face_turn, NULL, &periods));
    *n = 2 * seams->n_free;
    double *P = malloc((size_t)*n * (size_t)*n * sizeof *P + 1);
    bench_check(ctx, qc__period_matrix(ctx, periods, P));
    qc__periods_free(periods);
    qc__seams_free(seams);
    free(cotangent);
    return P;
}

double *bench_period_matrix(qc_ctx *ctx, const char *path, int32_t *n) {
    qc_mesh *mesh = read_surface(ctx, path);
    qc_matching *matching = smooth_field(ctx, mesh);
    qc_sizing *sizing = NULL;
    qc_seamless_map *map = NULL;
    bench_check(ctx, qc_sizing_create(ctx, mesh, sqrt(mesh->area / QUADS), QUADS, NULL, &sizing));
    bench_check(ctx, qc_seamless_map_create(ctx, matching, sizing, NULL, &map));
    double *P = period_matrix(ctx, map, n);
    qc_object_release(map);
    qc_object_release(sizing);
    qc_object_release(matching);
    qc_object_release(mesh);
    return P;
}
