/* The Hodge step: from a matched cross field to a locally integrable field and its integral on the cut
 * surface (thesis 4.1; 2007 paper, section 4, eq. (9)). */
#include "sdk/base/internal.h"
#include <qc/map.h>
#include <string.h>

static void seamless_map_destroy(qc_object *object) {
    qc_seamless_map *map = (qc_seamless_map *)object;
    qc_object_release(map->matching);
    qc_object_release(map->sizing);
    qc__free((void *)(uintptr_t)map->z);
    qc__free((void *)(uintptr_t)map->cut);
    qc__free((void *)(uintptr_t)map->face_turn);
    qc__free((void *)(uintptr_t)map->f);
    qc__free(map);
}

/* z = conj(x) e / length in each face. */
static qc_status scaled_form(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                             qc_complex *z) {
    const qc_mesh *mesh = matching->field->mesh;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (int64_t)mesh->n_faces);
    double *scale = QC__NEW(ctx, double, mesh->n_faces);
    qc_status status = edge && scale ? qc_tangent_edges(ctx, mesh, edge) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t t = 0; t < mesh->n_faces; t++)
            scale[t] = 1.0 / (sizing->length ? sizing->length[t] : sizing->edge_length);
        status = qc_form_from_cross(ctx, mesh, edge, matching->field->x, scale, z);
    }
    qc__free(edge);
    qc__free(scale);
    return status;
}

/* Shortest cut graph with the cones as base vertices (thesis 4.2). */
static qc_status cut_at_cones(qc_ctx *ctx, const qc_matching *matching, const qc_cover *cover,
                              uint8_t *cut) {
    const qc_mesh *mesh = cover->mesh;
    uint8_t *base = QC__ZERO(ctx, uint8_t, mesh->n_vertices);
    int8_t *shift = QC__NEW(ctx, int8_t, mesh->n_vertices);
    qc_status status = base && shift ? qc_cover_shifts(ctx, cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            base[v] = !qc_vertex_on_boundary(mesh, v) && (shift[v] != 0 || matching->index4[v] != 0);
        status = qc_mesh_cut_graph(ctx, mesh, NULL, base, cut);
    }
    qc__free(base);
    qc__free(shift);
    return status;
}

qc_status qc_seamless_map_create(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                                 qc_seamless_map **out) {
    const qc_mesh *mesh = matching->field->mesh;
    if (sizing->mesh != mesh)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "field and sizing belong to different meshes");
    const qc_cover cover = {mesh, matching->m};
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    double *cotangent = QC__NEW(ctx, double, n_corners);
    qc_complex *z = QC__NEW(ctx, qc_complex, n_corners), *f = QC__NEW(ctx, qc_complex, n_corners);
    uint8_t *cut = QC__NEW(ctx, uint8_t, mesh->n_edges);
    int8_t *face_turn = QC__NEW(ctx, int8_t, mesh->n_faces);
    qc_seamless_map *map = QC__ZERO(ctx, qc_seamless_map, 1);
    qc_status status = cotangent && z && f && cut && face_turn && map ? QC_OK : QC_ERR_NOMEM;
    double field_energy = 0, curl_energy = 0;
    if (status == QC_OK)
        status = qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL);
    if (status == QC_OK) status = scaled_form(ctx, matching, sizing, z);
    if (status == QC_OK) {
        field_energy = 0.5 * qc_form_product(mesh, cotangent, z, z).re;
        qc__range outer = qc__range_begin(ctx, NULL, 0.0, 0.7);
        status = qc_hodge_remove_curl(ctx, &cover, cotangent, z, z, NULL, &curl_energy);
        qc__range_end(ctx, outer);
    }
    if (status == QC_OK) status = cut_at_cones(ctx, matching, &cover, cut);
    if (status == QC_OK) status = qc_cover_comb(ctx, &cover, cut, face_turn, NULL, NULL);
    if (status == QC_OK) {
        double residual = 0;
        status = qc_form_integrate(ctx, &cover, cut, face_turn, z, f, &residual);
        if (status == QC_OK && !(residual <= 1e-6))
            status = qc__fail(ctx, QC_ERR_FAILED, -1,
                              "the field is not integrable (mismatch %g); the mesh may have faces of "
                              "almost no area",
                              residual);
    }
    qc__free(cotangent);
    if (status != QC_OK) {
        qc__free(z);
        qc__free(f);
        qc__free(cut);
        qc__free(face_turn);
        qc__free(map);
        return status;
    }
    qc_object_init(&map->object, QC_TYPE_SEAMLESS_MAP, seamless_map_destroy);
    map->matching = qc_object_retain(matching);
    map->sizing = qc_object_retain(sizing);
    map->z = z;
    map->cut = cut;
    map->face_turn = face_turn;
    map->f = f;
    map->field_energy = field_energy;
    map->curl_energy = curl_energy;
    *out = map;
    return QC_OK;
}
