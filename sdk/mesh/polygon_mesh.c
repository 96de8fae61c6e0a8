/* Storage of polygon meshes. */
#include <string.h>

#include "sdk/mesh/internal.h"

static void polygon_mesh_destroy(qc_object *object) {
    qc_polygon_mesh *p = (qc_polygon_mesh *)object;
    qc__free(p->position);
    qc__free(p->face_offset);
    qc__free(p->face_vertex);
    qc__free(p->uv);
    qc__free(p->corner_uv);
    qc__free(p->line);
    qc__free(p->face_line);
    qc__free(p->face_group);
    qc__free(p->source_face);
    qc__free(p->source_barycentric);
    qc__free(p->group_name);
    qc__free(p->materials);
    qc__free(p->source_edge);
    qc__polygon_free_attributes(p);
    qc__free(p);
}

static bool allocate(qc_ctx *ctx, qc_polygon_mesh *p, uint32_t flags) {
    size_t vertices = (size_t)p->n_vertices, faces = (size_t)p->n_faces;
    bool ok = (p->position = QC__ZERO(ctx, double, 3 * vertices)) != NULL;
    ok = ok && (p->face_offset = QC__ZERO(ctx, int32_t, faces + 1));
    ok = ok && (p->face_vertex = QC__ZERO(ctx, int32_t, p->n_corners));
    if (p->n_uvs > 0) {
        ok = ok && (p->uv = QC__ZERO(ctx, double, 2 * (size_t)p->n_uvs));
        ok = ok && (p->corner_uv = QC__ZERO(ctx, int32_t, p->n_corners));
    }
    if (p->n_lines > 0) ok = ok && (p->line = QC__ZERO(ctx, int32_t, 2 * (size_t)p->n_lines));
    if (flags & QC_POLYGON_FACE_LINE) ok = ok && (p->face_line = QC__ZERO(ctx, int32_t, faces));
    if (flags & QC_POLYGON_FACE_GROUP) ok = ok && (p->face_group = QC__ZERO(ctx, int32_t, faces));
    if (flags & QC_POLYGON_SOURCE) {
        ok = ok && (p->source_face = QC__ZERO(ctx, int32_t, vertices));
        ok = ok && (p->source_barycentric = QC__ZERO(ctx, double, 3 * vertices));
        if (p->n_lines > 0) ok = ok && (p->source_edge = QC__ZERO(ctx, int32_t, p->n_lines));
    }
    return ok;
}

/* One block: the pointers, then the texts. */
qc_status qc__polygon_name_groups(qc_ctx *ctx, qc_polygon_mesh *p, int32_t n,
                                  const char *const *name, const char *materials) {
    size_t size = (size_t)n * sizeof(char *);
    for (int32_t i = 0; i < n; i++) size += strlen(name[i]) + 1;
    char **names = qc__malloc(ctx, size, 1);
    char *copy = materials ? QC__NEW(ctx, char, strlen(materials) + 1) : NULL;
    if (!names || (materials && !copy)) {
        qc__free(names);
        qc__free(copy);
        return QC_ERR_NOMEM;
    }
    char *to = (char *)(names + n);
    for (int32_t i = 0; i < n; i++) {
        names[i] = strcpy(to, name[i]);
        to += strlen(name[i]) + 1;
    }
    if (copy) strcpy(copy, materials);
    qc__free(p->group_name);
    qc__free(p->materials);
    p->n_groups = n;
    p->group_name = names;
    p->materials = copy;
    return QC_OK;
}

qc_status qc_polygon_mesh_create(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces,
                                 int32_t n_corners, int32_t n_uvs, int32_t n_lines, uint32_t flags,
                                 qc_polygon_mesh **out) {
    if (n_vertices < 0 || n_faces < 0 || n_corners < 0 || n_uvs < 0 || n_lines < 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "a polygon mesh of negative size");
    qc_polygon_mesh *p = QC__ZERO(ctx, qc_polygon_mesh, 1);
    if (!p) return QC_ERR_NOMEM;
    qc_object_init(&p->object, QC_TYPE_POLYGON_MESH, polygon_mesh_destroy);
    p->n_vertices = n_vertices;
    p->n_faces = n_faces;
    p->n_corners = n_corners;
    p->n_uvs = n_uvs;
    p->n_lines = n_lines;
    if (!allocate(ctx, p, flags)) {
        qc_object_release(p);
        return QC_ERR_NOMEM;
    }
    *out = p;
    return QC_OK;
}
