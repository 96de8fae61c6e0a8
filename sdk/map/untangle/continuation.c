/* Continuation: untangling on the way from the map before rounding, which rarely folds, to the
 * rounded one (docs/theory/untangling.md). */
#include "sdk/map/untangle/untangler.h"

#include <string.h>

typedef qc__untangler untangler;

static const double longest_step = 0.125, shortest_step = 0.125 / 8;

/* How far vertices go on the whole way. Cones which wind wrong in the rounded map take their stars
 * along: the harmonic displacement would fold them at once. */
static void plan_drift(untangler *u, const qc__reduced_map *relaxed, qc_complex *drift) {
    const qc__reduced_map *end = u->target;
    for (int32_t v = 0; v < u->mesh->n_vertices; v++)
        drift[v] = (qc_complex){end->value[v].re - relaxed->value[v].re,
                                end->value[v].im - relaxed->value[v].im};
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (!qc__is_wrong_cone(u, v)) continue;
        const int32_t start = u->mesh->vertex_corner[v];
        int32_t c = start;
        do {
            const int32_t n = qc_next(c), w = u->mesh->face_vertex[n];
            const qc_complex own = qc_quarter_turn(drift[v], end->turn[c]);
            const qc_complex there = {own.re + (end->offset[c].re - relaxed->offset[c].re) -
                                          (end->offset[n].re - relaxed->offset[n].re),
                                      own.im + (end->offset[c].im - relaxed->offset[c].im) -
                                          (end->offset[n].im - relaxed->offset[n].im)};
            const qc_complex d = qc_quarter_turn(there, -end->turn[n]);
            if (!(u->map->fixed[w] & 1)) drift[w].re = d.re;
            if (!(u->map->fixed[w] & 2)) drift[w].im = d.im;
            c = qc_corner_ccw(u->mesh, c);
        } while (c >= 0 && c != start);
    }
}

/* Moves the working map from `from` to `to` on the way from the relaxed (0) to the rounded map (1):
 * transitions and cones exactly, other vertices by their share of the difference. */
static void advance(untangler *u, const qc__reduced_map *relaxed, const qc_complex *drift,
                    double from, double to) {
    const qc__reduced_map *end = u->target;
    for (int64_t c = 0; c < 3 * (int64_t)u->mesh->n_faces; c++) {
        const qc_complex a = relaxed->offset[c], b = end->offset[c];
        u->map->offset[c] = (qc_complex){a.re + to * (b.re - a.re), a.im + to * (b.im - a.im)};
        if (to >= 1) u->map->offset[c] = b;
    }
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        const qc_complex a = relaxed->value[v], b = end->value[v], by = drift[v];
        qc_complex *p = &u->map->value[v];
        const uint8_t fixed = u->map->fixed[v];
        p->re = fixed & 1 ? (to >= 1 ? b.re : a.re + to * by.re) : p->re + (to - from) * by.re;
        p->im = fixed & 2 ? (to >= 1 ? b.im : a.im + to * by.im) : p->im + (to - from) * by.im;
    }
}

/* Continuation: the relaxed map rarely folds; on the way to the rounded one each step folds little,
 * so the cones keep their winding. A step that leaves fold-overs is taken back and halved, down to
 * shortest_step. */
static qc_status walk_from_relaxed(untangler *u, const qc__reduced_map *relaxed,
                                   const qc_complex *drift, qc_complex *stable) {
    const size_t size = sizeof *stable * (size_t)u->mesh->n_vertices;
    memcpy(u->map->value, relaxed->value, size);
    advance(u, relaxed, drift, 0, 0);
    int32_t bad = 0;
    qc_status status = qc__untangle_growing(u, QC__GROWTHS, 0.0, 0.1, &bad);
    double at = 0, step = longest_step;
    bool stuck = false;
    while (at < 1 && status == QC_OK && !qc__untangle_exhausted(u)) {
        const double to = at + step < 1 ? at + step : 1;
        memcpy(stable, u->map->value, size);
        advance(u, relaxed, drift, at, to);
        status = qc__untangle_growing(u, stuck ? 1 : 3, 0.1 + 0.7 * at, 0.1 + 0.7 * to, &bad);
        const bool folds = status == QC_OK && !stuck && qc__mark_neighbourhood(u, 0) > 0;
        if (folds && step > shortest_step) {
            memcpy(u->map->value, stable, size);
            step *= 0.5;
            continue;
        }
        stuck |= folds; /* smaller steps do not help either: walk on for the sake of the others */
        at = to;
        if (2 * step <= longest_step) step *= 2;
    }
    if (at < 1) advance(u, relaxed, drift, at, 1);
    return status;
}

qc_status qc__untangle_continue(untangler *u, const qc_corner_map *map, const qc_grid_map *grid) {
    qc__reduced_map *relaxed = NULL;
    qc_complex *stable = QC__NEW(u->ctx, qc_complex, u->mesh->n_vertices);
    qc_complex *drift = QC__NEW(u->ctx, qc_complex, u->mesh->n_vertices);
    qc_status status = stable && drift ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = qc__reduced_map_create(u->ctx, grid, map->relaxed, false, &relaxed);
    if (status == QC_OK) {
        plan_drift(u, relaxed, drift);
        status = walk_from_relaxed(u, relaxed, drift, stable);
    }
    qc__reduced_map_free(relaxed);
    qc__free(stable);
    qc__free(drift);
    return status;
}
