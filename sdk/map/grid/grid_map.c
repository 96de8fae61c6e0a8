/* Exact integer-grid maps on a fixed-point grid (docs/theory/exact-grid.md). */
#include <math.h>
#include <string.h>

#include "sdk/map/grid/internal.h"

enum { MAX_BITS = 24 };

static void grid_map_destroy(qc_object *object) {
    qc_grid_map *g = (qc_grid_map *)object;
    qc_object_release(g->mesh);
    qc__free((void *)(uintptr_t)g->uv);
    qc__free((void *)(uintptr_t)g->rotation);
    qc__free((void *)(uintptr_t)g->translation);
    qc__free((void *)(uintptr_t)g->holonomy);
    qc__free((void *)(uintptr_t)g->axis);
    qc__free(g);
}

/* Copies the parameters; a component which lies farther from the origin than it is wide is shifted
 * there by an integer (an automorphism of the grid). low, high: 2 n_components each. */
static void center(const qc_corner_map *map, double *low, double *high, double *uv) {
    const qc_mesh *m = map->mesh;
    for (int32_t i = 0; i < 2 * m->n_components; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
    }
    for (int64_t i = 0; i < 6 * (int64_t)m->n_faces; i++) {
        const int64_t k = 2 * (int64_t)m->face_component[i / 6] + i % 2;
        low[k] = fmin(low[k], map->uv[i]);
        high[k] = fmax(high[k], map->uv[i]);
    }
    for (int32_t i = 0; i < 2 * m->n_components; i++) {
        const double middle = 0.5 * low[i] + 0.5 * high[i];
        low[i] = fabs(middle) > high[i] - low[i] + 16 ? round(middle) : 0; /* now the shift */
    }
    for (int64_t i = 0; i < 6 * (int64_t)m->n_faces; i++)
        uv[i] = map->uv[i] - low[2 * (int64_t)m->face_component[i / 6] + i % 2];
}

/* Largest number of fraction bits with |coordinate| < 2^30, some lattice steps to spare. */
static qc_status choose_bits(qc__grid_build *b) {
    double extent = 0;
    int64_t where = 0;
    for (int64_t i = 0; i < 6 * (int64_t)b->mesh->n_faces; i++)
        if (fabs(b->uv[i]) > extent) {
            extent = fabs(b->uv[i]);
            where = i / 6;
        }
    b->bits = MAX_BITS;
    while (b->bits >= 4 && ldexp(extent + 4, b->bits) >= 1073741824.0) b->bits--;
    if (b->bits >= 4) return QC_OK;
    return qc__fail(b->ctx, QC_ERR_FAILED, where,
                    "face %d has a parameter of %.3g; the grid holds at most 6e7 quads across, try "
                    "a coarser density",
                    (int)where, extent);
}

static void count_orientations(qc_grid_map *g) {
    int32_t first_degenerate = -1;
    g->first_flipped = -1;
    for (int32_t t = 0; t < g->mesh->n_faces; t++) {
        const int64_t area = qc_grid_map_orientation(g, t);
        if (area > 0) continue;
        if (area < 0 && g->n_flipped++ == 0) g->first_flipped = t;
        if (area == 0 && g->n_degenerate++ == 0) first_degenerate = t;
    }
    if (g->first_flipped < 0) g->first_flipped = first_degenerate;
}

static qc_status build(qc__grid_build *b, qc_grid_map *g) {
    const qc_mesh *m = b->mesh;
    g->uv = b->grid_uv = QC__NEW(b->ctx, int32_t, 6 * (size_t)m->n_faces);
    g->rotation = b->rotation = QC__ZERO(b->ctx, int8_t, m->n_edges);
    g->translation = b->translation = QC__ZERO(b->ctx, int32_t, 2 * (size_t)m->n_edges);
    g->holonomy = b->holonomy = QC__ZERO(b->ctx, int8_t, m->n_vertices);
    if (!g->uv || !g->rotation || !g->translation || !g->holonomy) return QC_ERR_NOMEM;
    qc_status status = choose_bits(b);
    if (status == QC_OK) status = qc__grid_seams(b);
    if (status == QC_OK) status = qc__grid_features(b);
    g->axis = b->axis;
    if (status == QC_OK) status = qc__grid_vertices(b);
    if (status == QC_OK) status = qc__grid_check_features(b);
    g->bits = b->bits;
    if (status == QC_OK) status = qc__grid_repair(b->ctx, g, b->grid_uv);
    if (status == QC_OK) count_orientations(g);
    return status;
}

qc_status qc_grid_map_create(qc_ctx *ctx, const qc_corner_map *map, double tolerance,
                             qc_grid_map **out) {
    if (!map) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "map is NULL");
    if (!(tolerance >= 0) || tolerance >= 0.5)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "tolerance is %g; give 0 (= 0.05) or a number below 0.5", tolerance);
    const qc_mesh *m = map->mesh;
    qc_grid_map *g = QC__ZERO(ctx, qc_grid_map, 1);
    if (!g) return QC_ERR_NOMEM;
    qc_object_init(&g->object, QC_TYPE_GRID_MAP, grid_map_destroy);
    g->mesh = qc_object_retain(m);
    double *uv = QC__NEW(ctx, double, 6 * (size_t)m->n_faces);
    double *low = QC__NEW(ctx, double, 2 * (size_t)m->n_components);
    double *high = QC__NEW(ctx, double, 2 * (size_t)m->n_components);
    qc_status status = uv && low && high ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        center(map, low, high, uv);
        qc__grid_build b = {.ctx = ctx,
                            .mesh = m,
                            .uv = uv,
                            .known_rotation = map->rotation,
                            .known_axis = map->axis,
                            .tolerance = tolerance > 0 ? tolerance : 0.05};
        status = build(&b, g);
    }
    qc__free(uv);
    qc__free(low);
    qc__free(high);
    if (status == QC_OK)
        *out = g;
    else
        qc_object_release(g);
    return status;
}

qc_status qc_grid_map_to_corner_map(qc_ctx *ctx, const qc_grid_map *grid, const qc_corner_map *like,
                                    qc_corner_map **out) {
    if (!grid) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "grid is NULL");
    if (like && like->mesh->n_faces != grid->mesh->n_faces)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "grid has %d faces, like has %d",
                        (int)grid->mesh->n_faces, (int)like->mesh->n_faces);
    const int64_t n = 6 * (int64_t)grid->mesh->n_faces;
    double *uv = QC__NEW(ctx, double, n);
    if (!uv) return QC_ERR_NOMEM;
    const double scale = ldexp(1.0, -grid->bits);
    for (int64_t i = 0; i < n; i++) uv[i] = scale * grid->uv[i];
    qc_corner_map *map = NULL;
    qc_status status = qc_corner_map_create(ctx, grid->mesh, uv, like ? like->edge_length : 0,
                                            like ? like->cross : NULL, &map);
    qc__free(uv);
    if (status == QC_OK) status = qc_corner_map_set_rotation(ctx, map, grid->rotation);
    if (status == QC_OK && grid->axis) status = qc_corner_map_set_axis(ctx, map, grid->axis);
    if (status != QC_OK) {
        qc_object_release(map);
        return status;
    }
    if (like) {
        map->field_energy = like->field_energy;
        map->curl_energy = like->curl_energy;
        map->harmonic_energy = like->harmonic_energy;
        map->harmonic_energy_direct = like->harmonic_energy_direct;
        map->iterations = like->iterations;
        map->evaluations = like->evaluations;
    }
    *out = map;
    return QC_OK;
}
