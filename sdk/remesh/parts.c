/* The connected components of a mesh as meshes of their own, all in linear time. */
#include <math.h>

#include "sdk/remesh/internal.h"

static int32_t component_of_vertex(const qc_mesh *m, int32_t v) {
    return m->face_component[m->vertex_corner[v] / 3];
}

/* start[c] .. start[c+1]-1 of `item`, by counting; start has n + 2 entries while filling. */
static void bucket(int32_t n_items, const int32_t *group, int32_t n, int32_t *start,
                   int32_t *item) {
    for (int32_t i = 0; i < n_items; i++) start[group[i] + 2]++;
    for (int32_t c = 0; c < n; c++) start[c + 2] += start[c + 1];
    for (int32_t i = 0; i < n_items; i++) item[start[group[i] + 1]++] = i;
}

qc_status qc__parts_create(qc_ctx *ctx, const qc_mesh *mesh, qc__parts *out) {
    const int32_t n = mesh->n_components;
    qc__parts p = {mesh, n, NULL, NULL, NULL, NULL, NULL, NULL};
    double *face_area = QC__NEW(ctx, double, mesh->n_faces);
    int32_t *group = QC__NEW(ctx, int32_t, mesh->n_vertices);
    p.face_start = QC__ZERO(ctx, int32_t, (int64_t)n + 2);
    p.vertex_start = QC__ZERO(ctx, int32_t, (int64_t)n + 2);
    p.face = QC__NEW(ctx, int32_t, mesh->n_faces);
    p.vertex = QC__NEW(ctx, int32_t, mesh->n_vertices);
    p.local = QC__NEW(ctx, int32_t, mesh->n_vertices);
    p.area = QC__ZERO(ctx, double, n);
    qc_status status = QC_ERR_NOMEM;
    if (face_area && group && p.face_start && p.vertex_start && p.face && p.vertex && p.local &&
        p.area)
        status = qc_mesh_geometry(ctx, mesh, NULL, face_area, NULL, NULL, NULL, NULL);
    if (status == QC_OK) {
        bucket(mesh->n_faces, mesh->face_component, n, p.face_start, p.face);
        for (int32_t v = 0; v < mesh->n_vertices; v++) group[v] = component_of_vertex(mesh, v);
        bucket(mesh->n_vertices, group, n, p.vertex_start, p.vertex);
        for (int32_t i = 0; i < mesh->n_vertices; i++)
            p.local[p.vertex[i]] = i - p.vertex_start[group[p.vertex[i]]];
        for (int32_t t = 0; t < mesh->n_faces; t++) p.area[mesh->face_component[t]] += face_area[t];
        *out = p;
    } else {
        qc__parts_clear(&p);
    }
    qc__free(face_area);
    qc__free(group);
    return status;
}

void qc__parts_clear(qc__parts *parts) {
    qc__free(parts->face_start);
    qc__free(parts->face);
    qc__free(parts->vertex_start);
    qc__free(parts->vertex);
    qc__free(parts->local);
    qc__free(parts->area);
    *parts = (qc__parts){NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL};
}

qc_status qc__parts_mesh(qc_ctx *ctx, const qc__parts *parts, int32_t c, qc_mesh **out) {
    const qc_mesh *m = parts->mesh;
    const int32_t *face = parts->face + parts->face_start[c];
    const int32_t *vertex = parts->vertex + parts->vertex_start[c];
    const int32_t n_faces = parts->face_start[c + 1] - parts->face_start[c];
    const int32_t n_vertices = parts->vertex_start[c + 1] - parts->vertex_start[c];
    double *position = QC__NEW(ctx, double, 3 * (int64_t)n_vertices);
    int32_t *face_vertex = QC__NEW(ctx, int32_t, 3 * (int64_t)n_faces);
    int32_t *source_vertex = QC__NEW(ctx, int32_t, n_vertices);
    int32_t *source_face = QC__NEW(ctx, int32_t, n_faces);
    qc_status status = QC_ERR_NOMEM;
    if (position && face_vertex && source_vertex && source_face) {
        for (int32_t i = 0; i < n_vertices; i++) {
            for (int k = 0; k < 3; k++)
                position[3 * (int64_t)i + k] = m->position[3 * (int64_t)vertex[i] + k];
            source_vertex[i] = m->source_vertex ? m->source_vertex[vertex[i]] : vertex[i];
        }
        for (int32_t i = 0; i < n_faces; i++) {
            for (int k = 0; k < 3; k++)
                face_vertex[3 * (int64_t)i + k] =
                    parts->local[m->face_vertex[3 * (int64_t)face[i] + k]];
            source_face[i] = m->source_face ? m->source_face[face[i]] : face[i];
        }
        status = qc_mesh_create_from(ctx, n_vertices, position, n_faces, face_vertex, source_vertex,
                                     source_face, out);
    }
    qc__free(position);
    qc__free(face_vertex);
    qc__free(source_vertex);
    qc__free(source_face);
    return status;
}
