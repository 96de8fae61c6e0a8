/* Gathers the results of the components and merges them into one. */
#include <string.h>

#include "sdk/remesh/internal.h"

qc_status qc__collection_create(qc_ctx *ctx, int32_t n, qc__collection *out) {
    qc__collection all = {QC__ZERO(ctx, qc_polygon_mesh *, n), QC__ZERO(ctx, qc_polygon_mesh *, n),
                          QC__ZERO(ctx, qc_mesh *, n), QC__ZERO(ctx, qc_face_field *, n),
                          QC__ZERO(ctx, qc_report *, n)};
    *out = all;
    if (all.quads && all.uv && all.mesh && all.field && all.report) return QC_OK;
    qc__collection_clear(out, 0);
    return QC_ERR_NOMEM;
}

void qc__collection_clear(qc__collection *all, int32_t n) {
    for (int32_t c = 0; c < n; c++) {
        qc_object_release(all->quads[c]);
        qc_object_release(all->uv[c]);
        qc_object_release(all->mesh[c]);
        qc_object_release(all->field[c]);
        qc_object_release(all->report[c]);
    }
    qc__free(all->quads);
    qc__free(all->uv);
    qc__free(all->mesh);
    qc__free(all->field);
    qc__free(all->report);
    *all = (qc__collection){NULL, NULL, NULL, NULL, NULL};
}

/* The latest object of a type which the run itself made, with a reference; NULL when there is none.
 */
static void *made(const qc_bag *before, const qc_bag *bag, const char *type) {
    const void *object = qc_bag_latest(bag, type);
    return object == qc_bag_latest(before, type) ? NULL : qc_object_retain(object);
}

/* The latest field on the component itself, else the latest on a refinement of it, brought back. */
static qc_status field_on(qc_ctx *ctx, const qc_mesh *mesh, const qc_bag *bag,
                          qc_face_field **out) {
    const qc_face_field *latest = qc_bag_latest(bag, QC_TYPE_FACE_FIELD);
    for (uint32_t i = qc_bag_count(bag); i-- > 0;) {
        const qc_object *object = qc_bag_get(bag, qc_bag_name(bag, i));
        if (strcmp(object->type, QC_TYPE_FACE_FIELD) != 0) continue;
        const qc_face_field *field = (const qc_face_field *)object;
        if (field->mesh != mesh) continue;
        *out = qc_object_retain(field);
        return QC_OK;
    }
    return latest ? qc__source_field(ctx, mesh, latest, out) : QC_OK;
}

qc_status qc__collection_add(qc_ctx *ctx, qc__collection *all, int32_t c, const qc_mesh *mesh,
                             const qc_bag *before, const qc_bag *bag) {
    const qc_corner_map *map = qc_bag_latest(bag, QC_TYPE_CORNER_MAP);
    qc_polygon_mesh *quads = made(before, bag, QC_TYPE_POLYGON_MESH);
    const qc_status kept = quads ? qc__check_promises(ctx, mesh, quads) : QC_OK;
    if (kept != QC_OK) {
        qc_object_release(quads);
        return kept;
    }
    all->mesh[c] = qc_object_retain(map ? map->mesh : mesh);
    all->quads[c] = quads;
    all->report[c] = made(before, bag, QC_TYPE_REPORT);
    const qc_status status = field_on(ctx, mesh, bag, &all->field[c]);
    return status == QC_OK && map ? qc_corner_map_to_polygons(ctx, map, &all->uv[c]) : status;
}

/* Union of the parts which are there, in order; NULL when there is none. With source != NULL the
 * source faces, which count faces of source[c], become those of the input. */
static qc_status merge_polygons(qc_ctx *ctx, qc_polygon_mesh *const *part, int32_t n_parts,
                                qc_mesh *const *source, qc_polygon_mesh **out) {
    const qc_polygon_mesh **list = QC__NEW(ctx, const qc_polygon_mesh *, n_parts);
    const int32_t **map = QC__ZERO(ctx, const int32_t *, n_parts);
    qc_status status = list && map ? QC_OK : QC_ERR_NOMEM;
    int32_t n = 0;
    for (int32_t c = 0; status == QC_OK && c < n_parts; c++) {
        if (!part[c]) continue;
        map[n] = source ? source[c]->source_face : NULL;
        list[n++] = part[c];
    }
    if (n > 0) status = qc_polygon_mesh_merge(ctx, n, list, map, out);
    qc__free(list);
    qc__free(map);
    return status;
}

/* A component keeps the order of faces and corners, so crosses are copied as they are. */
static qc_status merge_field(qc_ctx *ctx, qc_face_field *const *part, const qc__parts *parts,
                             qc_face_field **out) {
    bool any = false;
    for (int32_t c = 0; c < parts->n; c++) any = any || part[c];
    if (!any) return QC_OK;
    qc_complex *x = QC__NEW(ctx, qc_complex, parts->mesh->n_faces);
    if (!x) return QC_ERR_NOMEM;
    for (int32_t c = 0; c < parts->n; c++)
        for (int32_t i = parts->face_start[c]; i < parts->face_start[c + 1]; i++)
            x[parts->face[i]] =
                part[c] ? part[c]->x[i - parts->face_start[c]] : (qc_complex){1.0, 0.0};
    const qc_status status = qc_face_field_create(ctx, parts->mesh, x, NULL, NULL, out);
    qc__free(x);
    return status;
}

static qc_status merge_reports(qc_ctx *ctx, const qc__collection *all, const qc__parts *parts,
                               bool quads, qc_report **out) {
    qc_report *sum;
    const qc_status status = qc_report_create(ctx, &sum);
    if (status != QC_OK) return status;
    for (int32_t c = 0; c < parts->n; c++)
        if (all->report[c]) qc_report_add(sum, all->report[c]);
    const qc_mesh *mesh = parts->mesh;
    sum->input.vertices = mesh->n_vertices;
    sum->input.faces = mesh->n_faces;
    sum->input.genus = mesh->genus;
    sum->input.boundaries = mesh->n_boundary_loops;
    sum->input.components = mesh->n_components;
    sum->quads.diagonal = mesh->diagonal;
    if (!quads) memset(&sum->quads, 0, sizeof sum->quads);
    *out = sum;
    return QC_OK;
}

qc_status qc__collection_merge(qc_ctx *ctx, const qc__collection *all, const qc__parts *parts,
                               qc_remesh_result *result) {
    qc_status status = merge_polygons(ctx, all->quads, parts->n, all->mesh, &result->quads);
    if (status == QC_OK && result->quads)
        status = qc__source_coordinates(ctx, all, parts, result->quads);
    if (status == QC_OK) status = merge_polygons(ctx, all->uv, parts->n, NULL, &result->uv);
    if (status == QC_OK) status = merge_field(ctx, all->field, parts, &result->field);
    if (status == QC_OK)
        status = merge_reports(ctx, all, parts, result->quads != NULL, &result->report);
    return status;
}
