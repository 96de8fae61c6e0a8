/* Corner maps as polygon meshes with one vt per corner (OBJ), and back. */
#include <string.h>

#include <qc/map.h>

#include "sdk/base/internal.h"

static bool same_uv(const qc_corner_map *map, int32_t c, int32_t d) {
    const double *p = map->uv + 2 * (int64_t)c, *q = map->uv + 2 * (int64_t)d;
    return p[0] == q[0] && p[1] == q[1];
}

/* Numbers the parameters: corners of one vertex which follow each other in its fan share an entry
 * when their values are equal. corner_uv: 3 n_faces. Returns the number of entries. */
static int32_t number_uvs(const qc_corner_map *map, int32_t *corner_uv) {
    const qc_mesh *m = map->mesh;
    int32_t n = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const int32_t first = m->vertex_corner[v];
        corner_uv[first] = n++;
        int32_t last = first;
        for (int32_t c = qc_corner_ccw(m, first); c >= 0 && c != first; c = qc_corner_ccw(m, c)) {
            if (same_uv(map, c, last))
                corner_uv[c] = corner_uv[last];
            else if (same_uv(map, c, first))
                corner_uv[c] = corner_uv[first];
            else
                corner_uv[c] = n++;
            last = c;
        }
    }
    return n;
}

qc_status qc_corner_map_to_polygons(qc_ctx *ctx, const qc_corner_map *map, qc_polygon_mesh **out) {
    if (!map) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "map is NULL");
    const qc_mesh *m = map->mesh;
    const int32_t n_corners = 3 * m->n_faces;
    int32_t *corner_uv = QC__NEW(ctx, int32_t, n_corners);
    if (!corner_uv) return QC_ERR_NOMEM;
    const int32_t n_uvs = number_uvs(map, corner_uv);
    qc_polygon_mesh *p = NULL;
    const qc_status status =
        qc_polygon_mesh_create(ctx, m->n_vertices, m->n_faces, n_corners, n_uvs, 0, 0, &p);
    if (status == QC_OK) {
        memcpy(p->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
        memcpy(p->face_vertex, m->face_vertex, sizeof(int32_t) * (size_t)n_corners);
        memcpy(p->corner_uv, corner_uv, sizeof(int32_t) * (size_t)n_corners);
        for (int32_t t = 0; t <= m->n_faces; t++) p->face_offset[t] = 3 * t;
        for (int32_t c = 0; c < n_corners; c++)
            memcpy(p->uv + 2 * (int64_t)corner_uv[c], map->uv + 2 * (int64_t)c, 2 * sizeof(double));
        *out = p;
    }
    qc__free(corner_uv);
    return status;
}

static qc_status check_soup(qc_ctx *ctx, const qc_polygon_mesh *soup) {
    if (!soup) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "soup is NULL");
    if (!soup->uv || !soup->corner_uv || soup->n_uvs <= 0)
        return qc__fail(ctx, QC_ERR_INPUT, -1,
                        "the mesh has no texture coordinates; a map needs a vt at every corner");
    for (int32_t f = 0; f < soup->n_faces; f++) {
        const int32_t first = soup->face_offset[f], n = soup->face_offset[f + 1] - first;
        if (n != 3)
            return qc__fail(ctx, QC_ERR_INPUT, f, "face %d has %d corners; a map needs triangles",
                            (int)f, (int)n);
        for (int k = 0; k < 3; k++) {
            const int32_t v = soup->face_vertex[first + k], i = soup->corner_uv[first + k];
            if (v < 0 || v >= soup->n_vertices)
                return qc__fail(ctx, QC_ERR_INPUT, f, "face %d has vertex %d, valid are 0 to %d",
                                (int)f, (int)v, (int)soup->n_vertices - 1);
            if (i < 0 || i >= soup->n_uvs)
                return qc__fail(ctx, QC_ERR_INPUT, f,
                                "face %d has no texture coordinate at corner %d; a map needs a vt "
                                "at every corner",
                                (int)f, k);
        }
    }
    return QC_OK;
}

/* Drops the vertices without faces. vertex: number of each soup vertex in the mesh, then its source
 * numbers; returns the number kept. */
static int32_t compact(const qc_polygon_mesh *soup, int32_t *vertex, int32_t *source,
                       double *position) {
    int32_t n = 0;
    for (int32_t v = 0; v < soup->n_vertices; v++) vertex[v] = -1;
    for (int32_t c = 0; c < 3 * soup->n_faces; c++) vertex[soup->face_vertex[c]] = 0;
    for (int32_t v = 0; v < soup->n_vertices; v++) {
        if (vertex[v] < 0) continue;
        memcpy(position + 3 * (int64_t)n, soup->position + 3 * (int64_t)v, 3 * sizeof(double));
        source[n] = v;
        vertex[v] = n++;
    }
    return n;
}

qc_status qc_corner_map_from_polygons(qc_ctx *ctx, const qc_polygon_mesh *soup,
                                      qc_corner_map **out) {
    qc_status status = check_soup(ctx, soup);
    if (status != QC_OK) return status;
    const int32_t n_corners = 3 * soup->n_faces;
    int32_t *vertex = QC__NEW(ctx, int32_t, soup->n_vertices);
    int32_t *source = QC__NEW(ctx, int32_t, soup->n_vertices);
    int32_t *face_vertex = QC__NEW(ctx, int32_t, n_corners);
    double *position = QC__NEW(ctx, double, 3 * (size_t)soup->n_vertices);
    double *uv = QC__NEW(ctx, double, 2 * (size_t)n_corners);
    qc_mesh *mesh = NULL;
    if (!vertex || !source || !face_vertex || !position || !uv) status = QC_ERR_NOMEM;
    if (status == QC_OK) {
        const int32_t n = compact(soup, vertex, source, position);
        for (int32_t c = 0; c < n_corners; c++) {
            face_vertex[c] = vertex[soup->face_vertex[c]];
            memcpy(uv + 2 * (int64_t)c, soup->uv + 2 * (int64_t)soup->corner_uv[c],
                   2 * sizeof(double));
        }
        status = qc_mesh_create_from(ctx, n, position, soup->n_faces, face_vertex,
                                     n < soup->n_vertices ? source : NULL, NULL, &mesh);
    }
    if (status == QC_OK) status = qc_corner_map_create(ctx, mesh, uv, 0, NULL, out);
    qc_object_release(mesh);
    qc__free(vertex);
    qc__free(source);
    qc__free(face_vertex);
    qc__free(position);
    qc__free(uv);
    return status;
}
