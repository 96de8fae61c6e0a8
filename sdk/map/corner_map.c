/* Corner maps: one parameter (u, v) per corner of every face. */
#include <math.h>
#include <string.h>

#include <qc/map.h>

#include "sdk/base/internal.h"

static void corner_map_destroy(qc_object *object) {
    qc_corner_map *map = (qc_corner_map *)object;
    qc_object_release(map->mesh);
    qc__free((void *)(uintptr_t)map->uv);
    qc__free((void *)(uintptr_t)map->cross);
    qc__free((void *)(uintptr_t)map->rotation);
    qc__free((void *)(uintptr_t)map->axis);
    qc__free((void *)(uintptr_t)map->relaxed);
    qc__free(map);
}

static qc_status check_input(qc_ctx *ctx, const qc_mesh *mesh, const double *uv, double edge_length,
                             const qc_complex *cross) {
    if (!mesh || !uv) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "mesh or uv is NULL");
    if (!(edge_length >= 0) || !isfinite(edge_length))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "edge_length is %g; give a positive length or 0 for unknown", edge_length);
    for (int64_t c = 0; c < 3 * (int64_t)mesh->n_faces; c++)
        if (!isfinite(uv[2 * c]) || !isfinite(uv[2 * c + 1]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, c / 3,
                            "corner %d of face %d has a parameter which is not finite",
                            (int)(c % 3), (int)(c / 3));
    for (int32_t t = 0; cross && t < mesh->n_faces; t++)
        if (!isfinite(cross[t].re) || !isfinite(cross[t].im))
            return qc__fail(ctx, QC_ERR_ARGUMENT, t, "the cross of face %d is not finite", (int)t);
    return QC_OK;
}

qc_status qc_corner_map_create(qc_ctx *ctx, const qc_mesh *mesh, const double *uv,
                               double edge_length, const qc_complex *cross, qc_corner_map **out) {
    const qc_status status = check_input(ctx, mesh, uv, edge_length, cross);
    if (status != QC_OK) return status;
    const size_t n = (size_t)mesh->n_faces;
    qc_corner_map *map = QC__ZERO(ctx, qc_corner_map, 1);
    double *uv_copy = QC__NEW(ctx, double, 6 * n);
    qc_complex *cross_copy = cross ? QC__NEW(ctx, qc_complex, n) : NULL;
    if (!map || !uv_copy || (cross && !cross_copy)) {
        qc__free(map);
        qc__free(uv_copy);
        qc__free(cross_copy);
        return QC_ERR_NOMEM;
    }
    memcpy(uv_copy, uv, 6 * n * sizeof *uv);
    if (cross) memcpy(cross_copy, cross, n * sizeof *cross);
    qc_object_init(&map->object, QC_TYPE_CORNER_MAP, corner_map_destroy);
    map->mesh = qc_object_retain(mesh);
    map->uv = uv_copy;
    map->cross = cross_copy;
    map->edge_length = edge_length;
    *out = map;
    return QC_OK;
}

/* A copy of n_edges entries in place of *slot. */
static qc_status replace_by_copy(qc_ctx *ctx, const qc_mesh *mesh, const int8_t *values,
                                 const int8_t **slot) {
    int8_t *copy = QC__NEW(ctx, int8_t, mesh->n_edges);
    if (!copy) return QC_ERR_NOMEM;
    memcpy(copy, values, sizeof *copy * (size_t)mesh->n_edges);
    qc__free((void *)(uintptr_t)*slot);
    *slot = copy;
    return QC_OK;
}

qc_status qc_corner_map_set_rotation(qc_ctx *ctx, qc_corner_map *map, const int8_t *rotation) {
    return replace_by_copy(ctx, map->mesh, rotation, &map->rotation);
}

qc_status qc_corner_map_set_axis(qc_ctx *ctx, qc_corner_map *map, const int8_t *axis) {
    return replace_by_copy(ctx, map->mesh, axis, &map->axis);
}

qc_status qc_corner_map_set_relaxed(qc_ctx *ctx, qc_corner_map *map, const double *uv) {
    const size_t n = 6 * (size_t)map->mesh->n_faces;
    double *copy = QC__NEW(ctx, double, n);
    if (!copy) return QC_ERR_NOMEM;
    memcpy(copy, uv, n * sizeof *copy);
    qc__free((void *)(uintptr_t)map->relaxed);
    map->relaxed = copy;
    return QC_OK;
}
