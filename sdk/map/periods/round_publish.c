/* The corner map that rounding makes: the best trial with its charts, features and energies. */
#include "sdk/map/periods/round.h"
#include "sdk/map/periods/features.h"

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

qc_status qc__round_publish(qc__rounding *r, qc_corner_map **out) {
    const qc_seamless_map *seamless = r->seamless;
    const int32_t n_faces = r->mesh->n_faces;
    qc_complex *cross = QC__NEW(r->ctx, qc_complex, n_faces);
    if (!cross) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < n_faces; t++)
        cross[t] = qc_quarter_turn(seamless->matching->field->x[t], -seamless->face_turn[t]);
    int8_t *rotation = QC__NEW(r->ctx, int8_t, r->mesh->n_edges);
    int8_t *axis = QC__NEW(r->ctx, int8_t, r->mesh->n_edges);
    qc_corner_map *map = NULL;
    qc_status status = rotation && axis ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) qc__round_charts(r, rotation, axis);
    if (status == QC_OK)
        status = qc_corner_map_create(r->ctx, r->mesh, &r->best[0].re,
                                      seamless->sizing->edge_length / r->best_scale, cross, &map);
    if (status == QC_OK) status = qc_corner_map_set_rotation(r->ctx, map, rotation);
    if (status == QC_OK && seamless->matching->axis)
        status = qc_corner_map_set_axis(r->ctx, map, axis);
    if (status == QC_OK) {
        for (int64_t c = 0; c < 3 * (int64_t)n_faces; c++) {
            r->trial[c].re = r->best_scale * r->f[c].re;
            r->trial[c].im = r->best_scale * r->f[c].im;
        }
        status = qc_corner_map_set_relaxed(r->ctx, map, &r->trial[0].re);
    }
    qc__free(rotation);
    qc__free(axis);
    qc__free(cross);
    if (status != QC_OK) {
        qc_object_release(map);
        return status;
    }
    const double square = r->best_scale * r->best_scale;
    map->field_energy = square * seamless->field_energy;
    map->curl_energy = square * r->curl_energy;
    map->harmonic_energy = r->harmonic;
    map->harmonic_energy_direct = r->harmonic_direct;
    map->iterations = r->moves;
    map->evaluations = r->evaluations;
    *out = map;
    return QC_OK;
}
