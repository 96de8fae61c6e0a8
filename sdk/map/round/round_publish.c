/* The corner map that rounding makes: the best trial with its charts, features and energies. */
#include "sdk/map/round/round.h"
#include "sdk/map/seams/features.h"

void qc__round_charts(const qc__rounding *r, int8_t *rotation, int8_t *axis) {
    const qc_matching *matching = r->seamless->matching;
    const qc_cover cover = {r->mesh, matching->m};
    const qc__features features = {&cover, r->seamless->face_turn, matching->axis};
    for (int32_t e = 0; e < r->mesh->n_edges; e++) {
        const int32_t h = r->mesh->edge_halfedge[2 * (int64_t)e];
        rotation[e] = 0;
        if (r->mesh->twin[h] >= 0)
            rotation[e] = (int8_t)qc__combed_rotation(&cover, r->seamless->face_turn, h);
        if (!matching->axis) continue;
        axis[e] = qc__is_feature(&features, h) ? (int8_t)qc__feature_direction(&features, h) : -1;
    }
}

/* The cross of face t in the gauge of the map. */
static qc_complex cross_of(const qc__rounding *r, int32_t t) {
    return qc_quarter_turn(r->seamless->matching->field->x[t], -r->seamless->face_turn[t]);
}

static qc_status attach(qc__rounding *r, qc_corner_map *map, const int8_t *rotation,
                        const int8_t *axis) {
    const qc_status status = qc_corner_map_set_rotation(r->ctx, map, rotation);
    return status == QC_OK && axis ? qc_corner_map_set_axis(r->ctx, map, axis) : status;
}

/* The map before rounding, scaled; r->trial serves as space. */
static qc_status attach_relaxed(qc__rounding *r, qc_corner_map *map) {
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces; c++) {
        r->trial[c].re = r->best_scale * r->f[c].re;
        r->trial[c].im = r->best_scale * r->f[c].im;
    }
    return qc_corner_map_set_relaxed(r->ctx, map, &r->trial[0].re);
}

static qc_status make_map(qc__rounding *r, double length, qc_complex *cross, qc_corner_map **map) {
    int8_t *rotation = QC__NEW(r->ctx, int8_t, r->mesh->n_edges);
    int8_t *axis = QC__NEW(r->ctx, int8_t, r->mesh->n_edges);
    qc_status status = rotation && axis ? QC_OK : QC_ERR_NOMEM;
    for (int32_t t = 0; t < r->mesh->n_faces; t++) cross[t] = cross_of(r, t);
    if (status == QC_OK) {
        qc__round_charts(r, rotation, axis);
        status = qc_corner_map_create(r->ctx, r->mesh, &r->best[0].re, length, cross, map);
    }
    if (status == QC_OK)
        status = attach(r, *map, rotation, r->seamless->matching->axis ? axis : NULL);
    if (status == QC_OK && !r->quantized) status = attach_relaxed(r, *map);
    qc__free(rotation);
    qc__free(axis);
    return status;
}

static qc_status make_imprinted(qc__rounding *r, double length, qc_complex *cross,
                                qc_corner_map **map) {
    const qc__imprint *p = &r->imprint;
    for (int32_t t = 0; t < p->mesh->n_faces; t++)
        cross[t] = qc__pair(qc__complex(cross_of(r, p->parent[t])) * qc__complex(p->turn[t]));
    const qc_status status = qc_corner_map_create(r->ctx, p->mesh, p->uv, length, cross, map);
    return status == QC_OK ? attach(r, *map, p->rotation, p->axis) : status;
}

qc_status qc__round_publish(qc__rounding *r, qc_corner_map **out) {
    const qc_seamless_map *seamless = r->seamless;
    const qc_mesh *mesh = r->imprint.mesh ? r->imprint.mesh : r->mesh;
    const double length = seamless->sizing->edge_length / r->best_scale;
    const double square = r->best_scale * r->best_scale;
    qc_complex *cross = QC__NEW(r->ctx, qc_complex, mesh->n_faces);
    if (!cross) return QC_ERR_NOMEM;
    qc_corner_map *map = NULL;
    const qc_status status =
        r->imprint.mesh ? make_imprinted(r, length, cross, &map) : make_map(r, length, cross, &map);
    qc__free(cross);
    if (status != QC_OK) {
        qc_object_release(map);
        return status;
    }
    map->field_energy = square * seamless->field_energy;
    map->curl_energy = square * r->curl_energy;
    map->harmonic_energy = r->harmonic;
    map->harmonic_energy_direct = r->harmonic_direct;
    map->iterations = r->moves;
    map->evaluations = r->evaluations;
    *out = map;
    return QC_OK;
}
