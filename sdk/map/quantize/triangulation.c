/* The triangulation which an exact map starts with (see triangulation.h). */
#include "sdk/map/quantize/triangulation.h"

#include <string.h>

void qc__triangulation_clear(qc__triangulation *T) {
    void *const blocks[] = {T->vector,   T->image,        T->twin,        T->origin,
                            T->rotation, T->axis,         T->dead,        T->spoke,
                            T->place,    T->first_marker, T->next_marker, T->turn};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

void qc__triangulation_free(qc__triangulation *T) {
    if (T) qc__triangulation_clear(T);
    qc__free(T);
}

static qc_status allocate(qc__triangulation *T) {
    const int64_t n = T->n_triangles, nv = T->mesh->n_vertices;
    T->vector = QC__NEW(T->ctx, qc__point, 3 * n);
    T->twin = QC__NEW(T->ctx, int32_t, 3 * n);
    T->origin = QC__NEW(T->ctx, int32_t, 3 * n);
    T->rotation = QC__NEW(T->ctx, int8_t, 3 * n);
    T->axis = QC__NEW(T->ctx, int8_t, 3 * n);
    T->dead = QC__ZERO(T->ctx, uint8_t, n);
    T->spoke = QC__NEW(T->ctx, int32_t, nv);
    T->first_marker = QC__NEW(T->ctx, int32_t, n);
    T->next_marker = QC__NEW(T->ctx, int32_t, n);
    T->place = QC__NEW(T->ctx, qc__point, n);
    T->turn = QC__ZERO(T->ctx, int8_t, n);
    return T->vector && T->twin && T->origin && T->rotation && T->axis && T->dead && T->spoke &&
                   T->first_marker && T->next_marker && T->place && T->turn
               ? QC_OK
               : QC_ERR_NOMEM;
}

static qc__point value(const qc__exact_map *map, int32_t corner) {
    const int64_t *p = map->uv + 2 * (int64_t)corner;
    return (qc__point){p[0], p[1]};
}

/* The marker is a quarter of the way from each of two corners and half of it from the first one of
 * halfedge 3t: exact in quarters of a unit. */
static void copy_face(qc__triangulation *T, const qc__exact_map *map, int32_t t) {
    const qc_mesh *m = T->mesh;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        const int32_t e = m->halfedge_edge[h], g = m->twin[h];
        const qc__point d = qc__minus(value(map, qc_prev(h)), value(map, qc_next(h)));
        const int r = g < 0 ? 0 : map->rotation[e];
        T->vector[h] = (qc__point){4 * d.u, 4 * d.v};
        T->twin[h] = g;
        T->origin[h] = qc_halfedge_start(m, h);
        T->rotation[h] = (int8_t)((m->edge_halfedge[2 * (int64_t)e] == h ? r : 4 - r) & 3);
        T->axis[h] = (int8_t)qc__feature_direction(m, map->rotation, map->axis, h);
        T->spoke[T->origin[h]] = h;
    }
    const qc__point a = T->vector[3 * t], b = T->vector[3 * t + 2];
    T->place[t] = (qc__point){(a.u - b.u) / 4, (a.v - b.v) / 4};
    T->first_marker[t] = t;
    T->next_marker[t] = -1;
}

static qc_status check_face(const qc__triangulation *T, int32_t t) {
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        const qc__point d = T->vector[h];
        if (T->axis[h] >= 0) {
            const qc__point along = qc__turn_point(d, 4 - T->axis[h]);
            if (along.u <= 0 || along.v != 0)
                return qc__fail(T->ctx, QC_ERR_FAILED, T->mesh->halfedge_edge[h],
                                "the feature at edge %d is off its isoline",
                                (int)T->mesh->halfedge_edge[h]);
        }
        if (T->twin[h] < 0) continue;
        const qc__point back = qc__plus(qc__turn_point(d, T->rotation[h]), T->vector[T->twin[h]]);
        if (back.u != 0 || back.v != 0)
            return qc__fail(T->ctx, QC_ERR_FAILED, T->mesh->halfedge_edge[h],
                            "the transition across edge %d is not exact",
                            (int)T->mesh->halfedge_edge[h]);
    }
    if (qc__area_sign(T->vector[3 * t], T->vector[3 * t + 1]) <= 0)
        return qc__fail(T->ctx, QC_ERR_FAILED, t, "face %d of the map is not positive", (int)t);
    return QC_OK;
}

qc_status qc__triangulation_create(qc_ctx *ctx, const qc__exact_map *map, qc__triangulation **out) {
    qc__triangulation *T = QC__ZERO(ctx, qc__triangulation, 1);
    if (!T) return QC_ERR_NOMEM;
    T->ctx = ctx;
    T->mesh = map->mesh;
    T->n_triangles = map->mesh->n_faces;
    qc_status status = allocate(T);
    for (int32_t t = 0; t < T->n_triangles && status == QC_OK; t++) copy_face(T, map, t);
    for (int32_t t = 0; t < T->n_triangles && status == QC_OK; t++) status = check_face(T, t);
    if (status == QC_OK)
        *out = T;
    else
        qc__triangulation_free(T);
    return status;
}

int32_t qc__first_spoke(const qc__triangulation *T, int32_t v) {
    const int32_t start = T->spoke[v];
    int32_t h = start;
    for (int32_t g = qc__spoke_cw(T, h); g >= 0; g = qc__spoke_cw(T, h)) {
        h = g;
        if (h == start) break;
    }
    return h;
}
