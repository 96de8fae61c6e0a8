/* Untangling: moves parameters near fold-overs until every face is positively oriented
 * (docs/theory/untangling.md).
 *
 * Only a neighbourhood of the fold-overs moves, so that the rest of the map keeps its alignment; it
 * grows when it proves too small. Transitions and cones are kept by construction (reduced_map.h).
 * Where the map before rounding is known, the way starts there. */
#include "sdk/map/untangle/lbfgs.h"
#include "sdk/map/untangle/cones.h"
#include "sdk/map/untangle/energy.h"
#include <math.h>
#include <string.h>

static const double good_det = 1e-4; /* faces below it count as folded           */
static const double longest_step = 0.125, shortest_step = 0.125 / 8; /* of the continuation */
static const double moved_far = 1e-6; /* parameter units: less is rounding on the way */
/* Evaluations of the whole map, at most, on the way from the relaxed map and at its end. */
static const int64_t walk_effort = 1000, end_effort = 1000;
enum {
    GROWTHS = 5, /* of the neighbourhood: 3, 6, 12, 24, 48 rings */
    RELAXED_RINGS = 4
};
/* Of stars laid out anew, by growth: crowded cones want small ones, stretched places large ones. */
static const double star_scale[GROWTHS] = {0.3, 0.6, 0.1, 1.0, 0.03};

typedef struct untangler {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    qc_untangle_options options;
    const int8_t *rotation;  /* of the transitions, known from the first grid  */
    const int8_t *axis;      /* of the features, or NULL                       */
    qc__reduced_map *map;    /* moves */
    qc__reduced_map *target; /* the rounded map */
    qc__guide guide;         /* cross NULL: the map does not tell         */
    qc_complex *edge;
    qc_complex *hat;
    double *area;
    int32_t *distance; /* n_vertices: rings from the nearest bad face, -1 = far */
    int32_t *queue;    /* n_vertices */
    int32_t *local;    /* n_vertices: number in the patch, -1                                   */
    int32_t *vertex;   /* n_vertices: of the patch                                             */
    int32_t n_patch;
    int32_t *face; /* n_faces: of the patch                                                */
    int32_t n_patch_faces;
    int32_t *face_stamp; /* n_faces: last patch a face was listed in                             */
    int32_t stamp;
    uint8_t *frozen; /* n_vertices: stars laid out anew keep still while the rest adapts         */
    double star_scale;
    int32_t *active;   /* n_vertices: of the patch, without the frozen ones                    */
    double *x;         /* 2 n_vertices                                                         */
    qc_complex *saved; /* n_vertices: values of the patch before it was touched                */
    int64_t work, work_limit; /* faces whose energy was evaluated: so far, at most             */
} untangler;

/* --- neighbourhoods --------------------------------------------------------------------------- */

static bool winds_wrong(const untangler *u, int32_t v) {
    return u->guide.cross && qc__pinned(u->map, v) &&
           qc__guide_turns(&u->guide, v) != qc__map_turns(&u->guide, v);
}

static void mark(untangler *u, int32_t v, int32_t *n_queue) {
    if (u->distance[v] >= 0) return;
    u->distance[v] = 0;
    u->queue[(*n_queue)++] = v;
}

/* Rings about the folded faces and the wrong cones, up to `rings`; returns the number of bad
 * places. */
static int32_t mark_neighbourhood(untangler *u, int32_t rings) {
    const qc_mesh *mesh = u->mesh;
    int32_t n = 0, bad = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) u->distance[v] = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!winds_wrong(u, v)) continue;
        bad++;
        mark(u, v, &n);
    }
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        if (qc__face_det(u->map, u->hat, t) > good_det) continue;
        bad++;
        for (int32_t k = 0; k < 3; k++) mark(u, mesh->face_vertex[3 * (int64_t)t + k], &n);
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = u->queue[i], start = mesh->vertex_corner[v];
        if (u->distance[v] >= rings) continue;
        int32_t c = start;
        do {
            for (int32_t k = 1; k < 3; k++) {
                const int32_t w = mesh->face_vertex[3 * (c / 3) + (c % 3 + k) % 3];
                if (u->distance[w] >= 0) continue;
                u->distance[w] = u->distance[v] + 1;
                u->queue[n++] = w;
            }
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    return bad;
}

/* Collects the connected patch of marked, movable vertices around `seed`, unmarking them. */
static void collect_patch(untangler *u, int32_t seed) {
    const qc_mesh *mesh = u->mesh;
    u->stamp++;
    u->n_patch = u->n_patch_faces = 0;
    u->vertex[u->n_patch++] = seed;
    u->distance[seed] = -1;
    for (int32_t i = 0; i < u->n_patch; i++) {
        const int32_t start = mesh->vertex_corner[u->vertex[i]];
        int32_t c = start;
        do {
            const int32_t t = c / 3;
            if (u->face_stamp[t] != u->stamp) {
                u->face_stamp[t] = u->stamp;
                u->face[u->n_patch_faces++] = t;
            }
            for (int32_t k = 0; k < 3; k++) {
                const int32_t w = mesh->face_vertex[3 * (int64_t)t + k];
                if (u->distance[w] < 0 || qc__pinned(u->map, w)) continue;
                u->distance[w] = -1;
                u->vertex[u->n_patch++] = w;
            }
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
}

/* --- one patch -------------------------------------------------------------------------------- */

static void freeze_star(untangler *u, int32_t v, uint8_t value) {
    const int32_t start = u->mesh->vertex_corner[v];
    int32_t c = start;
    do {
        u->frozen[u->mesh->face_vertex[qc_next(c)]] = value;
        c = qc_corner_ccw(u->mesh, c);
    } while (c >= 0 && c != start);
}

/* Lays out anew and freezes the stars of wrong cones on the faces of the patch; returns whether
 * there are. */
static bool lay_out_wrong_cones(untangler *u) {
    bool any = false;
    for (int32_t i = 0; i < 3 * u->n_patch_faces; i++) {
        const int32_t v = u->mesh->face_vertex[3 * (int64_t)u->face[i / 3] + i % 3];
        if (qc_vertex_on_boundary(u->mesh, v) || !winds_wrong(u, v)) continue;
        any = true;
        qc__lay_out_star(&u->guide, v, u->star_scale);
        freeze_star(u, v, 1);
    }
    return any;
}

/* Folded faces of the patch, and wrong cones once for each of their faces. */
static int32_t count_bad(const untangler *u) {
    int32_t bad = 0;
    for (int32_t i = 0; i < u->n_patch_faces; i++) {
        const int32_t t = u->face[i];
        bad += qc__face_det(u->map, u->hat, t) <= 0;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t v = u->mesh->face_vertex[3 * (int64_t)t + k];
            bad += winds_wrong(u, v);
        }
    }
    return bad;
}

static qc_status untangle_step(untangler *u, qc__patch *patch) {
    return qc__patch_minimise(u->ctx, patch, &u->options, u->x);
}

static qc_status relax_step(untangler *u, qc__patch *patch) {
    return qc__patch_relax(u->ctx, patch, u->options.relax, u->x);
}

/* Lowers an energy over the vertices of the patch which are not frozen. */
static qc_status descend(untangler *u, qc_status (*step)(untangler *, qc__patch *)) {
    int32_t n = 0;
    for (int32_t j = 0; j < u->n_patch; j++) {
        const int32_t v = u->vertex[j];
        u->local[v] = -1;
        if (u->frozen[v]) continue;
        u->local[v] = n;
        u->active[n] = v;
        u->x[2 * (int64_t)n] = u->map->value[v].re;
        u->x[2 * (int64_t)n + 1] = u->map->value[v].im;
        n++;
    }
    qc__patch patch = {.map = u->map,
                       .hat = u->hat,
                       .area = u->area,
                       .n_vertices = n,
                       .n_faces = u->n_patch_faces,
                       .vertex = u->active,
                       .face = u->face,
                       .local = u->local,
                       .work = u->work,
                       .work_limit = u->work_limit};
    const qc_status status = n > 0 ? step(u, &patch) : QC_OK;
    u->work = patch.work;
    for (int32_t j = 0; j < n; j++) {
        const int32_t v = u->active[j];
        if (status == QC_OK)
            u->map->value[v] = (qc_complex){u->x[2 * (int64_t)j], u->x[2 * (int64_t)j + 1]};
        u->local[v] = -1;
    }
    return status;
}

/* Untangles the collected patch as far as possible; a patch which does not improve stays as it was.
 */
static qc_status untangle_patch(untangler *u) {
    const int32_t before = count_bad(u);
    for (int32_t j = 0; j < u->n_patch; j++) u->saved[j] = u->map->value[u->vertex[j]];
    qc_status status = QC_OK;
    if (lay_out_wrong_cones(u)) {
        status = descend(u, untangle_step);
        for (int32_t i = 0; i < 3 * u->n_patch_faces; i++)
            u->frozen[u->mesh->face_vertex[3 * (int64_t)u->face[i / 3] + i % 3]] = 0;
    }
    if (status == QC_OK) status = descend(u, untangle_step);
    const int32_t after = status == QC_OK ? count_bad(u) : before;
    if (after >= before && after > 0)
        for (int32_t j = 0; j < u->n_patch; j++) u->map->value[u->vertex[j]] = u->saved[j];
    return status;
}

static bool exhausted(const untangler *u) {
    return u->work >= u->work_limit;
}

/* All patches within `rings` of a bad place; *bad = how many there were. */
static qc_status untangle_rings(untangler *u, int32_t rings, int32_t *bad) {
    *bad = mark_neighbourhood(u, rings);
    for (int32_t v = 0; v<u->mesh->n_vertices && * bad> 0 && !exhausted(u); v++) {
        if (u->distance[v] < 0 || qc__pinned(u->map, v)) continue;
        collect_patch(u, v);
        const qc_status status = untangle_patch(u);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* --- evening out ------------------------------------------------------------------------------ */

/* Vertices which moved from the rounded map have distance 0, rings about them more, others -1. */
static void mark_moved(untangler *u) {
    const qc_mesh *mesh = u->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const qc_complex a = u->map->value[v], b = u->target->value[v];
        u->distance[v] = hypot(a.re - b.re, a.im - b.im) > moved_far ? 0 : -1;
    }
    for (int32_t i = 0; i < RELAXED_RINGS; i++)
        for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
            const int32_t v = qc_halfedge_start(mesh, h), w = qc_halfedge_end(mesh, h);
            if (u->distance[v] == i && u->distance[w] < 0) u->distance[w] = i + 1;
            if (u->distance[w] == i && u->distance[v] < 0) u->distance[v] = i + 1;
        }
}

/* Lowers the symmetric Dirichlet energy over what untangling moved: no face collapses on the way,
 * so none is turned over and no cone changes its winding. */
static qc_status relax_moved(untangler *u) {
    mark_moved(u);
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (u->distance[v] < 0 || qc__pinned(u->map, v)) continue;
        collect_patch(u, v);
        const qc_status status = descend(u, relax_step);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* --- the whole -------------------------------------------------------------------------------- */

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
    const double unit = unit_length(map);
    for (int64_t c = 0; c < 3 * (int64_t)u->mesh->n_faces; c++) {
        u->edge[c].re /= unit;
        u->edge[c].im /= unit;
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
    qc_status status = qc__reduced_map_create(u->ctx, grid, map->uv, true, &u->target);
    if (status == QC_OK) status = qc__reduced_map_create(u->ctx, grid, map->uv, true, &u->map);
    if (status == QC_OK) status = allocate(u);
    if (status == QC_OK)
        status = qc__untangle_targets(u->ctx, map->mesh, unit_length(map), u->hat, u->area);
    if (status == QC_OK) status = make_guide(u, map);
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

/* The exact grid of the moved map; a state the grid refuses gives way to the one before. */
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
    if (status == QC_OK)
        status = qc_grid_map_to_corner_map(u->ctx, after ? after : before, map, out);
    qc_object_release(after);
    return status;
}

/* Until no bad place is left, with growing neighbourhoods. */
static qc_status untangle_growing(untangler *u, int32_t growths, double lo, double hi,
                                  int32_t *bad) {
    qc_status status = QC_OK;
    *bad = 1;
    for (int32_t i = 0, rings = 3; i < growths && status == QC_OK && *bad > 0; i++, rings *= 2) {
        const double width = (hi - lo) / growths;
        const qc__range outer = qc__range_begin(u->ctx, NULL, lo + i * width, lo + (i + 1) * width);
        u->star_scale = star_scale[i];
        status = untangle_rings(u, rings, bad);
        qc__range_end(u->ctx, outer);
    }
    return status;
}

/* How far vertices go on the whole way. Cones which wind wrong in the rounded map take their stars
 * along: the harmonic displacement would fold them at once. */
static void plan_drift(untangler *u, const qc__reduced_map *relaxed, qc_complex *drift) {
    const qc__reduced_map *end = u->target;
    for (int32_t v = 0; v < u->mesh->n_vertices; v++)
        drift[v] = (qc_complex){end->value[v].re - relaxed->value[v].re,
                                end->value[v].im - relaxed->value[v].im};
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (!winds_wrong(u, v)) continue;
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
    qc_status status = untangle_growing(u, GROWTHS, 0.0, 0.1, &bad);
    double at = 0, step = longest_step;
    bool stuck = false;
    while (at < 1 && status == QC_OK && !exhausted(u)) {
        const double to = at + step < 1 ? at + step : 1;
        memcpy(stable, u->map->value, size);
        advance(u, relaxed, drift, at, to);
        status = untangle_growing(u, stuck ? 1 : 3, 0.1 + 0.7 * at, 0.1 + 0.7 * to, &bad);
        const bool folds = status == QC_OK && !stuck && mark_neighbourhood(u, 0) > 0;
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

static qc_status continue_from(untangler *u, const qc_corner_map *map, const qc_grid_map *grid) {
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

static bool is_mended(untangler *u) {
    return mark_neighbourhood(u, 0) == 0;
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
    if (status == QC_OK) bad = mark_neighbourhood(&u, 0);
    const int32_t bad_before = bad;
    u.work_limit = walk_effort * map->mesh->n_faces;
    if (status == QC_OK && bad > 0 && map->relaxed) status = continue_from(&u, map, before);
    u.work_limit = u.work + end_effort * map->mesh->n_faces;
    if (status == QC_OK && bad > 0) status = untangle_growing(&u, GROWTHS, 0.8, 1.0, &bad);
    if (status == QC_OK && bad_before > 0 && u.options.relax > 0 && is_mended(&u))
        status = relax_moved(&u);
    if (status == QC_OK) status = exact_result(&u, map, before, out);
    qc_object_release(before);
    release(&u);
    return status;
}
