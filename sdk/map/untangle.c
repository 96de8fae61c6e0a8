/* Untangling: moves parameters near fold-overs until every face is positively oriented (ROBUST 6).
 *
 * Only a neighbourhood of the fold-overs moves, so that the rest of the map keeps its alignment; it grows
 * when it proves too small. Transitions and cones are kept by construction (reduced_map.h). */
#include "sdk/map/lbfgs.h"
#include "sdk/map/untangle_cones.h"
#include "sdk/map/untangle_energy.h"
#include <math.h>
#include <string.h>

static const double eps_floor = 1e-3, eps_slope = 0.04; /* eps^2 = floor^2 + slope min(0, det)^2    */
static const double good_det = 1e-4;                    /* faces below it count as folded           */
static const double star_scale = 0.3;                   /* of a star laid out anew                  */

typedef struct untangler {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    qc_untangle_options options;
    const int8_t *rotation; /* of the transitions, known from the first grid                        */
    qc__reduced_map *map;
    qc__guide guide; /* cross NULL: the map does not tell                                          */
    qc_complex *edge;
    qc_complex *hat;
    double *area;
    int32_t *distance; /* n_vertices: rings from the nearest bad face, -1 = far                      */
    int32_t *marked;   /* n_vertices: copy of distance                                               */
    int32_t *queue;    /* n_vertices */
    int32_t *local, *vertex; /* n_vertices */
    int32_t *face;           /* n_faces */
    uint8_t *frozen;         /* n_vertices: stars laid out anew keep still while the rest adapts         */
    int32_t *face_stamp;     /* n_faces: last patch a face was listed in                             */
    int32_t stamp;
} untangler;

/* --- neighbourhoods ----------------------------------------------------------------------------- */

static double face_det(const untangler *u, int32_t t) {
    qc_complex f[3];
    const qc_complex *hat = u->hat + 3 * (int64_t)t;
    double du[2] = {0, 0}, dv[2] = {0, 0};
    for (int32_t k = 0; k < 3; k++) {
        const int64_t c = 3 * (int64_t)t + k;
        f[k] = qc__reduced_map_corner(u->map, u->map->value[u->mesh->face_vertex[c]], c);
        du[0] += f[k].re * hat[k].re;
        du[1] += f[k].re * hat[k].im;
        dv[0] += f[k].im * hat[k].re;
        dv[1] += f[k].im * hat[k].im;
    }
    return du[0] * dv[1] - du[1] * dv[0];
}

static bool winds_wrong(const untangler *u, int32_t v) {
    return u->guide.cross && u->map->pinned[v] &&
           qc__guide_turns(&u->guide, v) != qc__map_turns(&u->guide, v);
}

static int32_t count_wrong_cones(const untangler *u) {
    int32_t wrong = 0;
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) wrong += winds_wrong(u, v);
    return wrong;
}

/* Lays out anew, freezes and marks the stars of cones which wind the wrong number of times. */
static int32_t mark_wrong_cones(untangler *u, int32_t *n_queue) {
    const qc_mesh *mesh = u->mesh;
    int32_t wrong = 0;
    memset(u->frozen, 0, (size_t)mesh->n_vertices);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!winds_wrong(u, v)) continue;
        wrong++;
        qc__lay_out_star(&u->guide, v, star_scale);
        u->distance[v] = 0;
        u->queue[(*n_queue)++] = v;
        const int32_t start = mesh->vertex_corner[v];
        int32_t c = start;
        do {
            u->frozen[mesh->face_vertex[qc_next(c)]] = 1;
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    return wrong;
}

/* Rings about the bad faces and cones, up to `rings`; returns the number of bad places. */
static int32_t mark_neighbourhood(untangler *u, int32_t rings) {
    const qc_mesh *mesh = u->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) u->distance[v] = -1;
    int32_t n = 0, bad = mark_wrong_cones(u, &n);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        if (face_det(u, t) > good_det) continue;
        bad++;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t v = mesh->face_vertex[3 * (int64_t)t + k];
            if (u->distance[v] < 0) {
                u->distance[v] = 0;
                u->queue[n++] = v;
            }
        }
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
static void collect_patch(untangler *u, int32_t seed, qc__patch *p) {
    const qc_mesh *mesh = u->mesh;
    int32_t n_vertices = 0, n_faces = 0;
    u->stamp++;
    u->local[seed] = n_vertices;
    u->vertex[n_vertices++] = seed;
    u->distance[seed] = -1;
    for (int32_t i = 0; i < n_vertices; i++) {
        const int32_t start = mesh->vertex_corner[u->vertex[i]];
        int32_t c = start;
        do {
            const int32_t t = c / 3;
            if (u->face_stamp[t] != u->stamp) {
                u->face_stamp[t] = u->stamp;
                u->face[n_faces++] = t;
            }
            for (int32_t k = 0; k < 3; k++) {
                const int32_t w = mesh->face_vertex[3 * (int64_t)t + k];
                if (u->distance[w] < 0 || u->map->pinned[w] || u->frozen[w]) continue;
                u->distance[w] = -1;
                u->local[w] = n_vertices;
                u->vertex[n_vertices++] = w;
            }
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    *p = (qc__patch){u->map,    u->hat,  u->area,  n_vertices, n_faces,
                     u->vertex, u->face, u->local, eps_floor};
}

/* --- one patch ---------------------------------------------------------------------------------- */

/* Preconditioner: the Laplacian of the patch in the charts of its vertices, complex Hermitian. */
typedef struct preconditioner {
    qc__patch *patch;
    qc_symbolic *symbolic;
    qc_factor *factor;
} preconditioner;

typedef struct entry {
    int32_t row;
    qc_complex value;
} entry;

static double patch_evaluate(void *user, const double *x, double *gradient) {
    const preconditioner *p = user;
    return qc__patch_energy(p->patch, x, gradient);
}

static qc_status patch_precondition(qc_ctx *ctx, void *user, double *x) {
    const preconditioner *p = user;
    return qc_solve(ctx, p->factor, 1, (qc_complex *)(void *)x);
}

/* Adds an off-diagonal entry of column j, merging duplicates: rows of a column are few. */
static void add_entry(entry *column, int32_t *n, int32_t row, qc_complex value) {
    int32_t i = 0;
    while (i < *n && column[i].row < row) i++;
    if (i < *n && column[i].row == row) {
        column[i].value.re += value.re;
        column[i].value.im += value.im;
        return;
    }
    memmove(column + i + 1, column + i, sizeof *column * (size_t)(*n - i));
    column[i] = (entry){row, value};
    ++*n;
}

/* Column j of the upper triangle; `column` has room for two entries a face at the vertex and one more. */
static int32_t laplacian_column(const qc__patch *p, int32_t j, entry *column) {
    const qc_mesh *mesh = p->map->mesh;
    const int32_t start = mesh->vertex_corner[p->vertex[j]];
    int32_t n = 0, c = start;
    double diagonal = 0;
    do {
        const int32_t t = c / 3;
        const qc_complex *hat = p->hat + 3 * (int64_t)t;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t b = 3 * t + k, i = p->local[mesh->face_vertex[b]];
            const double K = p->area[t] * (hat[c % 3].re * hat[k].re + hat[c % 3].im * hat[k].im);
            if (b == c) diagonal += K;
            if (b == c || i < 0 || i > j) continue;
            const qc_complex value = {K, 0}; /* conj(i^turn_i) K i^turn_j */
            add_entry(column, &n, i,
                      qc_quarter_turn(value, p->map->turn[c] - p->map->turn[b]));
        }
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    const qc_complex shifted = {diagonal * (1 + 1e-6), 0};
    add_entry(column, &n, j, shifted);
    return n;
}

static int32_t valence(const qc_mesh *mesh, int32_t v) {
    const int32_t start = mesh->vertex_corner[v];
    int32_t n = 0, c = start;
    do {
        n++;
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return n;
}

static qc_status factor_patch(qc_ctx *ctx, preconditioner *pre) {
    const qc__patch *p = pre->patch;
    const int32_t n = p->n_vertices;
    int64_t room = 0, largest = 0;
    for (int32_t j = 0; j < n; j++) {
        const int64_t need = 2 * (int64_t)valence(p->map->mesh, p->vertex[j]) + 2;
        room += need;
        if (need > largest) largest = need;
    }
    int64_t *colptr = QC__NEW(ctx, int64_t, n + 1);
    int32_t *row = QC__NEW(ctx, int32_t, room);
    qc_complex *value = QC__NEW(ctx, qc_complex, room);
    entry *column = QC__NEW(ctx, entry, largest);
    qc_status status = colptr && row && value && column ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int64_t at = 0;
        for (int32_t j = 0; j < n; j++) {
            colptr[j] = at;
            const int32_t entries = laplacian_column(p, j, column);
            for (int32_t i = 0; i < entries; i++, at++) {
                row[at] = column[i].row;
                value[at] = column[i].value;
            }
        }
        colptr[n] = at;
        const qc_hermitian A = {n, colptr, row, value};
        status = qc_analyze(ctx, &A, NULL, &pre->symbolic);
        if (status == QC_OK) status = qc_factorize(ctx, pre->symbolic, &A, &pre->factor);
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(value);
    qc__free(column);
    return status;
}

static qc_status untangle_patch(untangler *u, qc__patch *p) {
    qc_ctx *ctx = u->ctx;
    double *x = QC__NEW(ctx, double, 2 * (int64_t)p->n_vertices);
    if (!x) return QC_ERR_NOMEM;
    for (int32_t j = 0; j < p->n_vertices; j++) {
        x[2 * (int64_t)j] = u->map->value[p->vertex[j]].re;
        x[2 * (int64_t)j + 1] = u->map->value[p->vertex[j]].im;
    }
    preconditioner pre = {p, NULL, NULL};
    qc_status status = factor_patch(ctx, &pre);
    const qc__lbfgs_problem problem = {2 * (int64_t)p->n_vertices, &pre, patch_evaluate,
                                       patch_precondition};
    bool polished = false;
    double last = INFINITY;
    for (int32_t round = 0; round < u->options.max_rounds && status == QC_OK && !polished; round++) {
        const double least = qc__patch_min_det(p, x), below = least < 0 ? least : 0;
        polished = least > 0.01; /* one more round after the patch is clean */
        p->eps = sqrt(eps_floor * eps_floor + eps_slope * below * below);
        double energy = 0;
        status = qc__lbfgs(ctx, &problem, u->options.max_iterations, 1e-7, x, &energy, NULL);
        if (round > 0 && fabs(last - energy) <= 1e-6 * fabs(energy)) break;
        last = energy;
    }
    if (status == QC_OK)
        for (int32_t j = 0; j < p->n_vertices; j++)
            u->map->value[p->vertex[j]] =
                (qc_complex){x[2 * (int64_t)j], x[2 * (int64_t)j + 1]};
    qc_factor_free(pre.factor);
    qc_symbolic_free(pre.symbolic);
    qc__free(x);
    return status;
}

static qc_status untangle_marked(untangler *u) {
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (u->distance[v] < 0 || u->map->pinned[v] || u->frozen[v]) continue;
        qc__patch patch;
        collect_patch(u, v, &patch);
        const qc_status status = untangle_patch(u, &patch);
        for (int32_t j = 0; j < patch.n_vertices; j++) u->local[patch.vertex[j]] = -1;
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* All patches within `rings` of a fold-over; with stars laid out anew, first around and then with them. */
static qc_status untangle_rings(untangler *u, int32_t rings) {
    if (mark_neighbourhood(u, rings) == 0) return QC_OK;
    bool any_frozen = false;
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) any_frozen |= u->frozen[v] != 0;
    qc_status status = QC_OK;
    if (any_frozen) {
        memcpy(u->marked, u->distance, sizeof *u->marked * (size_t)u->mesh->n_vertices);
        status = untangle_marked(u);
        memcpy(u->distance, u->marked, sizeof *u->marked * (size_t)u->mesh->n_vertices);
        memset(u->frozen, 0, (size_t)u->mesh->n_vertices);
    }
    return status == QC_OK ? untangle_marked(u) : status;
}

/* --- the whole ---------------------------------------------------------------------------------- */

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
    u->marked = QC__NEW(u->ctx, int32_t, nv);
    u->frozen = QC__ZERO(u->ctx, uint8_t, nv);
    u->local = QC__NEW(u->ctx, int32_t, nv);
    u->vertex = QC__NEW(u->ctx, int32_t, nv);
    u->face = QC__NEW(u->ctx, int32_t, nf);
    u->face_stamp = QC__ZERO(u->ctx, int32_t, nf);
    if (!u->hat || !u->edge || !u->area || !u->distance || !u->queue || !u->marked || !u->frozen || !u->local || !u->vertex || !u->face ||
        !u->face_stamp)
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

static int64_t folds(const qc_grid_map *grid) {
    return (int64_t)grid->n_flipped + grid->n_degenerate;
}

/* Keeps `map` (taking it over) when it has fewer fold-overs than what is in *best. */
static qc_status keep_better(qc_ctx *ctx, qc_corner_map *map, qc_grid_map **best) {
    qc_grid_map *grid = NULL;
    const qc_status status = qc_grid_map_create(ctx, map, 0, &grid);
    qc_object_release(map);
    if (status != QC_OK) return status;
    if (folds(grid) < folds(*best)) {
        qc_object_release(*best);
        *best = grid;
    } else {
        qc_object_release(grid);
    }
    return QC_OK;
}

qc_status qc_map_untangle(qc_ctx *ctx, const qc_corner_map *map, const qc_untangle_options *options,
                          qc_corner_map **out) {
    static const int32_t rings[] = {4, 8, 16, 32, 64, 128};
    enum { GROWTHS = sizeof rings / sizeof *rings };
    untangler u = {.ctx = ctx, .mesh = map->mesh};
    u.options = (qc_untangle_options)QC_UNTANGLE_OPTIONS_INIT;
    if (options)
        memcpy(&u.options, options,
               options->struct_size < sizeof u.options ? options->struct_size : sizeof u.options);
    qc_grid_map *best = NULL;
    qc_status status = qc_grid_map_create(ctx, map, 0, &best);
    if (status != QC_OK) return status;
    if (folds(best) > 0) {
        const qc_grid_map *first = qc_object_retain(best);
        u.rotation = first->rotation;
        status = qc__reduced_map_create(ctx, best, &u.map);
        if (status == QC_OK) status = allocate(&u);
        if (status == QC_OK)
            status = qc__untangle_targets(ctx, map->mesh, unit_length(map), u.hat, u.area);
        if (status == QC_OK) status = make_guide(&u, map);
        for (int32_t i = 0; i < GROWTHS && status == QC_OK && folds(best) > 0; i++) {
            const qc__range outer =
                qc__range_begin(ctx, NULL, (double)i / GROWTHS, (i + 1.0) / GROWTHS);
            status = untangle_rings(&u, rings[i]);
            qc__range_end(ctx, outer);
            qc_corner_map *moved = NULL;
            if (count_wrong_cones(&u) > 0) continue;
            if (status == QC_OK) status = corners_of(&u, map, &moved);
            if (status == QC_OK) status = keep_better(ctx, moved, &best);
        }
        qc_object_release(first);
    }
    if (status == QC_OK) status = qc_grid_map_to_corner_map(ctx, best, map, out);
    qc_object_release(best);
    qc__reduced_map_free(u.map);
    void *const blocks[] = {u.hat, u.edge, u.area, u.distance, u.marked, u.frozen, u.queue, u.local, u.vertex, u.face,
                            u.face_stamp};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
