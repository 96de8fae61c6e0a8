/* Period matrices of real surfaces (thesis 6.3.2). */
#include "tests/bench/thesis/thesis.h"

#include <qc/map.h>
#include <stdlib.h>

#include "sdk/map/periods/period_matrix.h"

static double *period_matrix(qc_ctx *ctx, const qc_seamless_map *map, int32_t *n) {
    const qc_matching *matching = map->matching;
    const qc_mesh *mesh = matching->field->mesh;
    const qc_cover cover = {mesh, matching->m};
    double *cotangent = NEW(double, 3 * mesh->n_faces);
    qc__seams *seams = NULL;
    qc__periods *periods = NULL;
    bench_check(ctx, qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL));
    bench_check(ctx, qc__seams_create(ctx, &cover, map->cut, map->face_turn, matching->index4,
                                      matching->axis, &seams));
    bench_check(ctx, qc__seams_solve(ctx, seams, QC_LATTICE_QUADS));
    bench_check(ctx, qc__periods_create(ctx, seams, cotangent, NULL, &periods));
    *n = seams->n_free;
    double *P = NEW(double, (int64_t)*n **n);
    bench_check(ctx, qc__period_matrix(ctx, periods, P));
    qc__periods_free(periods);
    qc__seams_free(seams);
    free(cotangent);
    return P;
}

double *thesis_period_matrix(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                             int32_t *n) {
    qc_seamless_map *map = NULL;
    bench_check(ctx, qc_seamless_map_create(ctx, matching, sizing, NULL, &map));
    double *P = period_matrix(ctx, map, n);
    qc_object_release(map);
    return P;
}
