/* Untangling: moves parameters near fold-overs until every face is positively oriented
 * (docs/theory/untangling.md).
 *
 * Only a neighbourhood of the fold-overs moves, so that the rest of the map keeps its alignment; it
 * grows when it proves too small. Transitions and cones are kept by construction (reduced_map.h).
 * Where the map before rounding is known, the way starts there. */
#include "sdk/map/untangle/untangler.h"

#include <math.h>
#include <string.h>

typedef qc__untangler untangler;

/* Evaluations of the whole map, at most, on the way from the relaxed map and at its end. */
static const int64_t walk_effort = 1000, end_effort = 1000;

static qc_status allocate(untangler *u) {
    const int32_t nv = u->mesh->n_vertices, nf = u->mesh->n_faces;
    u->hat = QC__NEW(u->ctx, qc_complex, 3 * (int64_t)nf);
    u->edge = QC__NEW(u->ctx, qc_complex, 3 * (int64_t)nf);
    u->area = QC__NEW(u->ctx, double, nf);
    u->distance = QC__NEW(u->ctx, int32_t, nv);
    u->queue = QC__NEW(u->ctx, int32_t, nv);
    u->active = QC__NEW(u->ctx, int32_t, nv);
    u->x = QC__NEW(u->ctx, double, 2 * (int64_t)nv);
    u->saved = QC__NEW(u->ctx, qc_complex, nv);
    u->frozen = QC__ZERO(u->ctx, uint8_t, nv);
    u->local = QC__NEW(u->ctx, int32_t, nv);
    u->vertex = QC__NEW(u->ctx, int32_t, nv);
    u->face = QC__NEW(u->ctx, int32_t, nf);
    u->face_stamp = QC__ZERO(u->ctx, int32_t, nf);
    if (!u->hat || !u->edge || !u->area || !u->distance || !u->queue || !u->active || !u->x ||
        !u->saved || !u->frozen || !u->local || !u->vertex || !u->face || !u->face_stamp)
        return QC_ERR_NOMEM;
    for (int32_t v = 0; v < nv; v++) u->local[v] = -1;
    return QC_OK;
}

/* Length of a parameter unit when the map does not tell: from the areas. */
static double unit_length(const qc_corner_map *map) {
    if (map->edge_length > 0) return map->edge_length;
    double area = 0;
    for (int32_t t = 0; t < map->mesh->n_faces; t++) {
        const double *p = map->uv + 6 * (int64_t)t;
        area += 0.5 * fabs((p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]));
    }
    return area > 0 ? sqrt(map->mesh->area / area) : 1.0;
}

static qc_status make_guide(untangler *u, const qc_corner_map *map) {
    const qc_status status = qc_tangent_edges(u->ctx, u->mesh, u->edge);
    if (status != QC_OK) return status;
    for (int64_t c = 0; c < 3 * (int64_t)u->mesh->n_faces; c++) {
        u->edge[c].re /= u->unit;
        u->edge[c].im /= u->unit;
    }
    u->guide = (qc__guide){u->map, u->rotation, map->cross, u->edge};
    return QC_OK;
}

/* Whether the guiding field makes other than a full turn about v, or than half a turn on an aligned
 * boundary. */
static bool has_index(const untangler *u, int32_t v) {
    if (!qc_vertex_on_boundary(u->mesh, v)) return qc__guide_turns(&u->guide, v) != 4;
    return u->map->fixed[v] != 0 && qc__guide_turns(&u->guide, v) != 2;
}

/* Cones of full turns have no holonomy; the guiding field tells them, and they stay on their
 * lattice point. */
static void pin_full_turns(untangler *u) {
    for (int32_t v = 0; v < u->mesh->n_vertices && u->guide.cross; v++) {
        if (qc__pinned(u->map, v) || !has_index(u, v)) continue;
        u->map->fixed[v] = u->target->fixed[v] = QC__FIXED;
        const qc_complex p = {rint(u->target->value[v].re), rint(u->target->value[v].im)};
        u->map->value[v] = u->target->value[v] = p;
    }
}

static qc_status prepare(untangler *u, const qc_corner_map *map, const qc_grid_map *grid) {
    u->rotation = grid->rotation;
    u->axis = grid->axis;
    u->unit = unit_length(map);
    qc_status status = qc__reduced_map_create(u->ctx, grid, map->uv, true, &u->target);
    if (status == QC_OK) status = qc__reduced_map_create(u->ctx, grid, map->uv, true, &u->map);
    if (status == QC_OK) status = qc__poll(u->ctx);
    if (status == QC_OK) status = allocate(u);
    if (status == QC_OK)
        status =
            qc__untangle_targets(u->ctx, map->mesh, u->unit, qc__thick_targets, u->hat, u->area);
    if (status == QC_OK) status = qc__poll(u->ctx);
    if (status == QC_OK) status = make_guide(u, map);
    if (status == QC_OK) status = qc__poll(u->ctx);
    if (status == QC_OK) pin_full_turns(u);
    return status;
}

static void release(untangler *u) {
    qc__reduced_map_free(u->map);
    qc__reduced_map_free(u->target);
    void *const blocks[] = {u->hat,    u->edge,   u->area, u->distance,   u->queue,
                            u->local,  u->vertex, u->face, u->face_stamp, u->frozen,
                            u->active, u->x,      u->saved};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

static qc_status corners_of(untangler *u, const qc_corner_map *like, qc_corner_map **out) {
    const int64_t n_corners = 3 * (int64_t)u->mesh->n_faces;
    double *uv = QC__NEW(u->ctx, double, 2 * n_corners);
    if (!uv) return QC_ERR_NOMEM;
    for (int64_t c = 0; c < n_corners; c++) {
        const qc_complex f =
            qc__reduced_map_corner(u->map, u->map->value[u->mesh->face_vertex[c]], c);
        uv[2 * c] = f.re;
        uv[2 * c + 1] = f.im;
    }
    qc_corner_map *map = NULL;
    qc_status status =
        qc_corner_map_create(u->ctx, u->mesh, uv, like->edge_length, like->cross, &map);
    if (status == QC_OK) status = qc_corner_map_set_rotation(u->ctx, map, u->rotation);
    if (status == QC_OK && u->axis) status = qc_corner_map_set_axis(u->ctx, map, u->axis);
    qc__free(uv);
    if (status != QC_OK) {
        qc_object_release(map);
        return status;
    }
    *out = map;
    return QC_OK;
}

/* The exact grid of the moved map; a state which the grid refuses, or which has more fold-overs on
 * it, gives way to the one before. */
static qc_status exact_result(untangler *u, const qc_corner_map *map, const qc_grid_map *before,
                              qc_corner_map **out) {
    qc_corner_map *moved = NULL;
    qc_grid_map *after = NULL;
    qc_status status = corners_of(u, map, &moved);
    if (status == QC_OK) status = qc_grid_map_create(u->ctx, moved, 0, &after);
    qc_object_release(moved);
    if (status == QC_ERR_FAILED) {
        qc__log(u->ctx, QC_LOG_WARNING, "untangling is undone: %s", qc_ctx_error(u->ctx)->text);
        status = QC_OK;
        qc__clear_error(u->ctx);
    }
    const bool better =
        after && after->n_flipped + after->n_degenerate <= before->n_flipped + before->n_degenerate;
    if (status == QC_OK)
        status = qc_grid_map_to_corner_map(u->ctx, better ? after : before, map, out);
    qc_object_release(after);
    return status;
}

static bool is_positive(const untangler *u) {
    for (int32_t t = 0; t < u->mesh->n_faces; t++)
        if (!(qc__face_det(u->map, u->hat, t) > 0)) return false;
    return true;
}

qc_status qc_map_untangle(qc_ctx *ctx, const qc_corner_map *map, const qc_untangle_options *options,
                          qc_corner_map **out) {
    untangler u = {.ctx = ctx, .mesh = map->mesh};
    u.options = (qc_untangle_options)QC_UNTANGLE_OPTIONS_INIT;
    if (options)
        memcpy(&u.options, options,
               options->struct_size < sizeof u.options ? options->struct_size : sizeof u.options);
    qc_grid_map *before = NULL;
    qc_status status = qc_grid_map_create(ctx, map, 0, &before);
    if (status != QC_OK) return status;
    status = prepare(&u, map, before);
    int32_t bad = 0;
    if (status == QC_OK && before->n_flipped + before->n_degenerate > 0)
        bad = qc__mark_neighbourhood(&u, 0);
    u.work_limit = walk_effort * map->mesh->n_faces;
    if (status == QC_OK && bad > 0 && map->relaxed) status = qc__untangle_continue(&u, map, before);
    u.work_limit = u.work + end_effort * map->mesh->n_faces;
    if (status == QC_OK && bad > 0) status = qc__untangle_growing(&u, QC__GROWTHS, 0.8, 1.0, &bad);
    if (status == QC_OK && u.options.relax > 0 && is_positive(&u)) status = qc__relax_uneven(&u);
    if (status == QC_OK) status = exact_result(&u, map, before, out);
    qc_object_release(before);
    release(&u);
    return status;
}
