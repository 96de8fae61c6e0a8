/* Untangling patch by patch within rings about the bad places, more of them until none is left
 * (docs/theory/untangling.md). */
#include "sdk/map/untangle/untangler.h"

typedef qc__untangler untangler;

/* Of stars laid out anew, by growth: crowded cones want small ones, stretched places large ones. */
static const double star_scale[QC__GROWTHS] = {0.3, 0.6, 0.1, 1.0, 0.03};

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
        if (qc_vertex_on_boundary(u->mesh, v) || !qc__is_wrong_cone(u, v)) continue;
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
            bad += qc__is_wrong_cone(u, v);
        }
    }
    return bad;
}

static qc_status untangle_step(untangler *u, qc__patch *patch) {
    return qc__patch_minimise(u->ctx, patch, &u->options, u->x);
}

qc_status qc__descend(untangler *u, qc_status (*step)(untangler *, qc__patch *)) {
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
        status = qc__descend(u, untangle_step);
        for (int32_t i = 0; i < 3 * u->n_patch_faces; i++)
            u->frozen[u->mesh->face_vertex[3 * (int64_t)u->face[i / 3] + i % 3]] = 0;
    }
    if (status == QC_OK) status = qc__descend(u, untangle_step);
    const int32_t after = status == QC_OK ? count_bad(u) : before;
    if (after >= before && after > 0)
        for (int32_t j = 0; j < u->n_patch; j++) u->map->value[u->vertex[j]] = u->saved[j];
    return status;
}

bool qc__untangle_exhausted(const untangler *u) {
    return u->work >= u->work_limit;
}

/* All patches within `rings` of a bad place; *bad = how many there were. */
static qc_status untangle_rings(untangler *u, int32_t rings, int32_t *bad) {
    *bad = qc__mark_neighbourhood(u, rings);
    for (int32_t v = 0; v<u->mesh->n_vertices && * bad> 0 && !qc__untangle_exhausted(u); v++) {
        if (u->distance[v] < 0 || qc__pinned(u->map, v)) continue;
        qc__collect_patch(u, v);
        const qc_status status = untangle_patch(u);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

qc_status qc__untangle_growing(untangler *u, int32_t growths, double lo, double hi, int32_t *bad) {
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
