/* Corner maps as polygon meshes with one vt per corner (OBJ), and back. */
#include <string.h>

#include <qc/map.h>

#include "sdk/base/internal.h"
#include "sdk/map/pole_values.h"

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

/* Face t becomes a triangle, or the quad (a, b, q_j+1, q_j) where it has a tip. pole_tip: n_faces,
 * position in pole_corner or -1. value: of corner_uv. */
static void fill(const qc_corner_map *map, const qc__pole_values *poles, const int32_t *pole_tip,
                 const int32_t *corner_uv, qc_polygon_mesh *p) {
    const qc_mesh *m = map->mesh;
    int32_t n = 0;
    for (int32_t t = 0; t < m->n_faces; t++) {
        const int32_t j = pole_tip[t];
        p->face_offset[t] = n;
        for (int k = 0; k < (j < 0 ? 3 : 2); k++) {
            const int32_t c = j < 0    ? 3 * t + k
                              : k == 0 ? qc_next(m->pole_corner[j])
                                       : qc_prev(m->pole_corner[j]);
            p->face_vertex[n] = m->face_vertex[c];
            p->corner_uv[n++] = corner_uv[c];
            memcpy(p->uv + 2 * (int64_t)corner_uv[c], map->uv + 2 * (int64_t)c, 2 * sizeof(double));
        }
        if (j < 0) continue;
        p->face_vertex[n] = m->face_vertex[m->pole_corner[poles->next[j]]];
        p->corner_uv[n++] = poles->end_uv[j];
        p->face_vertex[n] = m->face_vertex[m->pole_corner[j]];
        p->corner_uv[n++] = corner_uv[m->pole_corner[j]];
        memcpy(p->uv + 2 * (int64_t)poles->end_uv[j], poles->end + 2 * (int64_t)j,
               2 * sizeof(double));
        memcpy(p->uv + 2 * (int64_t)corner_uv[m->pole_corner[j]], poles->start + 2 * (int64_t)j,
               2 * sizeof(double));
    }
    p->face_offset[m->n_faces] = n;
}

qc_status qc_corner_map_to_polygons(qc_ctx *ctx, const qc_corner_map *map, qc_polygon_mesh **out) {
    if (!map) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "map is NULL");
    const qc_mesh *m = map->mesh;
    const int32_t n_tips = m->n_poles > 0 ? m->pole_start[m->n_poles] : 0;
    int32_t *corner_uv = QC__NEW(ctx, int32_t, 3 * (int64_t)m->n_faces);
    int32_t *pole_tip = QC__NEW(ctx, int32_t, m->n_faces);
    qc__pole_values poles = {0};
    qc_polygon_mesh *p = NULL;
    qc_status status =
        corner_uv && pole_tip ? qc__pole_values_create(ctx, map, &poles) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int32_t n_uvs = number_uvs(map, corner_uv);
        qc__pole_values_number(map, &poles, corner_uv, &n_uvs);
        for (int32_t t = 0; t < m->n_faces; t++) pole_tip[t] = -1;
        for (int32_t j = 0; j < n_tips; j++) pole_tip[m->pole_corner[j] / 3] = j;
        status = qc_polygon_mesh_create(ctx, m->n_vertices, m->n_faces, 3 * m->n_faces + n_tips,
                                        n_uvs, 0, 0, &p);
    }
    if (status == QC_OK) {
        memcpy(p->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
        fill(map, &poles, pole_tip, corner_uv, p);
        *out = p;
    }
    qc__pole_values_free(&poles);
    qc__free(corner_uv);
    qc__free(pole_tip);
    return status;
}

/* The corner before which the two at the pole come: corners k + 2 and k + 3 of a quad are in one
 * place. -1 = none. */
static int32_t first_corner(const qc_polygon_mesh *soup, int32_t f) {
    const int32_t *v = soup->face_vertex + soup->face_offset[f];
    for (int32_t k = 0; k < 4; k++) {
        const int32_t p = v[(k + 2) & 3], q = v[(k + 3) & 3];
        if (p == q || memcmp(soup->position + 3 * (int64_t)p, soup->position + 3 * (int64_t)q,
                             3 * sizeof(double)) == 0)
            return k;
    }
    return -1;
}

static qc_status check_face(qc_ctx *ctx, const qc_polygon_mesh *soup, int32_t f) {
    const int32_t first = soup->face_offset[f], n = soup->face_offset[f + 1] - first;
    for (int k = 0; k < n; k++) {
        const int32_t v = soup->face_vertex[first + k], i = soup->corner_uv[first + k];
        if (v < 0 || v >= soup->n_vertices)
            return qc__fail(ctx, QC_ERR_INPUT, f, "face %d has vertex %d, valid are 0 to %d",
                            (int)f, (int)v, (int)soup->n_vertices - 1);
        if (i < 0 || i >= soup->n_uvs)
            return qc__fail(ctx, QC_ERR_INPUT, f,
                            "face %d has no texture coordinate at corner %d; a map needs a vt at "
                            "every corner",
                            (int)f, k);
    }
    if (n == 3 || (n == 4 && first_corner(soup, f) >= 0)) return QC_OK;
    return qc__fail(ctx, QC_ERR_INPUT, f,
                    "face %d has %d corners; a map needs triangles, or quads with two corners in "
                    "one place around a pole",
                    (int)f, (int)n);
}

static qc_status check_soup(qc_ctx *ctx, const qc_polygon_mesh *soup) {
    if (!soup) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "soup is NULL");
    if (!soup->uv || !soup->corner_uv || soup->n_uvs <= 0)
        return qc__fail(ctx, QC_ERR_INPUT, -1,
                        "the mesh has no texture coordinates; a map needs a vt at every corner");
    for (int32_t f = 0; f < soup->n_faces; f++) {
        const qc_status status = check_face(ctx, soup, f);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* The triangles of a soup: a quad at a pole becomes that of its two other corners and a tip between
 * the two at the pole, which gets a vertex of its own. */
typedef struct triangles {
    int32_t n_vertices;
    int32_t
        *face_vertex; /* 3 n_faces: vertices of the soup, or number of vertices + face for tips */
    uint8_t *tip;     /* 3 n_faces */
    double *uv;       /* 6 n_faces */
    int32_t *vertex;  /* n_vertices + n_faces of the soup: number in the mesh, -1 = unused */
    int32_t *source;  /* n_vertices: vertex of the soup */
    double *position; /* 3 n_vertices */
} triangles;

static void add_triangle(const qc_polygon_mesh *soup, int32_t f, triangles *t) {
    const int32_t first = soup->face_offset[f];
    const bool quad = soup->face_offset[f + 1] - first == 4;
    const int32_t from = quad ? first_corner(soup, f) : 0;
    for (int k = 0; k < 3; k++) {
        const int32_t c = 3 * f + k, i = first + (quad ? (from + k) & 3 : k);
        memcpy(t->uv + 2 * (int64_t)c, soup->uv + 2 * (int64_t)soup->corner_uv[i],
               2 * sizeof(double));
        t->face_vertex[c] = soup->face_vertex[i];
    }
    if (!quad) return;
    const double *q = soup->uv + 2 * (int64_t)soup->corner_uv[first + ((from + 3) & 3)];
    for (int i = 0; i < 2; i++)
        t->uv[2 * (3 * (int64_t)f + 2) + i] = 0.5 * (t->uv[2 * (3 * (int64_t)f + 2) + i] + q[i]);
    t->vertex[soup->n_vertices + f] = t->face_vertex[3 * f + 2]; /* for its position */
    t->face_vertex[3 * f + 2] = soup->n_vertices + f;
    t->tip[3 * f + 2] = 1;
}

/* Numbers the used vertices: those of the soup, then the tips. */
static void number_vertices(const qc_polygon_mesh *soup, triangles *t) {
    const int32_t n = soup->n_vertices + soup->n_faces;
    for (int32_t c = 0; c < 3 * soup->n_faces; c++)
        if (!t->tip[c]) t->vertex[t->face_vertex[c]] = 0;
    for (int32_t v = 0; v < n; v++) {
        if (t->vertex[v] < 0) continue;
        const int32_t source = v < soup->n_vertices ? v : t->vertex[v];
        memcpy(t->position + 3 * (int64_t)t->n_vertices, soup->position + 3 * (int64_t)source,
               3 * sizeof(double));
        t->source[t->n_vertices] = source;
        t->vertex[v] = t->n_vertices++;
    }
    for (int32_t c = 0; c < 3 * soup->n_faces; c++)
        t->face_vertex[c] = t->vertex[t->face_vertex[c]];
}

static qc_status triangulate(qc_ctx *ctx, const qc_polygon_mesh *soup, triangles *t) {
    const int64_t n_corners = 3 * (int64_t)soup->n_faces;
    const int64_t most = (int64_t)soup->n_vertices + soup->n_faces;
    t->face_vertex = QC__NEW(ctx, int32_t, n_corners);
    t->tip = QC__ZERO(ctx, uint8_t, n_corners);
    t->uv = QC__NEW(ctx, double, 2 * n_corners);
    t->vertex = QC__NEW(ctx, int32_t, most);
    t->source = QC__NEW(ctx, int32_t, most);
    t->position = QC__NEW(ctx, double, 3 * most);
    if (!t->face_vertex || !t->tip || !t->uv || !t->vertex || !t->source || !t->position)
        return QC_ERR_NOMEM;
    for (int64_t v = 0; v < most; v++) t->vertex[v] = -1;
    for (int32_t f = 0; f < soup->n_faces; f++) add_triangle(soup, f, t);
    number_vertices(soup, t);
    return QC_OK;
}

qc_status qc_corner_map_from_polygons(qc_ctx *ctx, const qc_polygon_mesh *soup,
                                      qc_corner_map **out) {
    qc_status status = check_soup(ctx, soup);
    if (status != QC_OK) return status;
    triangles t = {0};
    qc_mesh *mesh = NULL;
    status = triangulate(ctx, soup, &t);
    if (status == QC_OK) {
        bool same = t.n_vertices == soup->n_vertices;
        for (int32_t v = 0; v < t.n_vertices && same; v++) same = t.source[v] == v;
        status = qc_mesh_create_from(ctx, t.n_vertices, t.position, soup->n_faces, t.face_vertex,
                                     same ? NULL : t.source, NULL, &mesh);
    }
    if (status == QC_OK) status = qc_mesh_set_poles(ctx, mesh, t.tip);
    if (status == QC_OK) status = qc_corner_map_create(ctx, mesh, t.uv, 0, NULL, out);
    qc_object_release(mesh);
    void *const blocks[] = {t.face_vertex, t.tip, t.uv, t.vertex, t.source, t.position};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
