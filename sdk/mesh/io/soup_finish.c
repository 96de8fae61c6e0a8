/* What was read is checked and becomes a polygon mesh. */
#include <string.h>

#include "internal.h"
#include "sdk/mesh/internal.h"

static qc_status fail_at_face(qc__soup *s, qc__text *t, int64_t face, const char *text) {
    int64_t at = s->face_line[face];
    if (!s->binary) return qc__text_fail(t, at, "%s", text);
    return qc__fail(s->ctx, QC_ERR_INPUT, at, "%s: face %lld: %s", t->name, (long long)at, text);
}

static qc_status check_faces(qc__soup *s, qc__text *t) {
    int64_t nv = s->n_position / 3, nt = s->n_uv / 2;
    char text[160];
    for (int64_t f = 0; f < s->n_face; f++) {
        int64_t begin = s->face_begin[f];
        int64_t end = f + 1 < s->n_face ? s->face_begin[f + 1] : s->n_corner;
        if (end - begin < 3) {
            snprintf(text, sizeof text,
                     "a face has %d corners, at least 3 are needed; remove that face",
                     (int)(end - begin));
            return fail_at_face(s, t, f, text);
        }
        for (int64_t c = begin; c < end; c++) {
            int32_t v = s->corner_vertex[c], u = c < s->n_corner_uv ? s->corner_uv[c] : -1;
            if (v >= 0 && v < nv && u < nt) continue;
            bool vertex = v < 0 || v >= nv;
            /* OBJ counts from 1 */
            snprintf(
                text, sizeof text,
                "%s index %lld is out of range (%lld %s); the file is damaged, export it again",
                vertex ? "vertex" : "texture", (long long)(vertex ? v : u) + t->continued,
                (long long)(vertex ? nv : nt), vertex ? "vertices" : "texture coordinates");
            return fail_at_face(s, t, f, text);
        }
    }
    for (int64_t i = 0; i < s->n_line; i++)
        if (s->line[i] < 0 || s->line[i] >= nv)
            return qc__fail(s->ctx, QC_ERR_INPUT, i / 2,
                            "%s: vertex index %lld of line segment %lld is out of range (%lld "
                            "vertices); remove the `l` statements or export the file again",
                            t->name, (long long)s->line[i] + 1, (long long)(i / 2), (long long)nv);
    return QC_OK;
}

static qc_status check_counts(qc__soup *s, qc__text *t) {
    if (s->n_face == 0 && s->n_line == 0)
        return qc__fail(s->ctx, QC_ERR_INPUT, s->binary ? 0 : t->line,
                        "%s: the file has no faces (%lld vertices); a surface mesh is needed, "
                        "not points or curves",
                        t->name, (long long)(s->n_position / 3));
    if (s->n_position / 3 >= INT32_MAX || s->n_corner >= INT32_MAX / 2 ||
        s->n_uv / 2 >= INT32_MAX || s->n_line / 2 >= INT32_MAX)
        return qc__fail(s->ctx, QC_ERR_INPUT, s->n_face,
                        "%s: the mesh has more than 2^30 corners; split or simplify it", t->name);
    return QC_OK;
}

static void copy(void *to, const void *from, int64_t n, size_t size) {
    if (n > 0 && to && from) memcpy(to, from, (size_t)n * size);
}

static qc_status name_groups(qc__soup *s, qc_polygon_mesh *m) {
    const char **name = QC__NEW(s->ctx, const char *, s->n_groups);
    if (!name) return QC_ERR_NOMEM;
    const char *text = s->group_name;
    for (int32_t i = 0; i < s->n_groups; i++, text += strlen(text) + 1) name[i] = text;
    const qc_status status = qc__polygon_name_groups(s->ctx, m, s->n_groups, name, s->materials);
    qc__free(name);
    return status;
}

static qc_status add_attributes(qc__soup *s, qc_polygon_mesh *m) {
    qc_status status = QC_OK;
    for (int64_t i = 0; i < s->n_attribute && status == QC_OK; i++) {
        const qc__soup_attribute *a = &s->attribute[i];
        char *name = a->n > 0 ? QC__ZERO(s->ctx, char, a->length + 1) : NULL;
        double *value = NULL;
        if (a->n == 0) continue;
        if (!name) return QC_ERR_NOMEM;
        memcpy(name, a->name, a->length);
        status = qc_polygon_mesh_add_attribute(s->ctx, m, name, a->at, a->kind, a->width, &value);
        if (status == QC_OK) copy(value, a->value, a->n, sizeof(double));
        qc__free(name);
    }
    return status;
}

/* The normals of vertices when all corners at each have the same one. */
static bool normals_of_vertices(const qc_polygon_mesh *m, const double *corner, double *vertex) {
    for (int32_t c = 0; c < m->n_corners; c++)
        memcpy(vertex + 3 * (int64_t)m->face_vertex[c], corner + 3 * (int64_t)c,
               3 * sizeof *corner);
    for (int32_t c = 0; c < m->n_corners; c++)
        if (memcmp(vertex + 3 * (int64_t)m->face_vertex[c], corner + 3 * (int64_t)c,
                   3 * sizeof *corner) != 0)
            return false;
    return true;
}

/* vn of OBJ: normals of vertices if they can be. References to normals which are not there count
 * as none. */
static qc_status add_normals(qc__soup *s, qc_polygon_mesh *m) {
    double *corner = QC__ZERO(s->ctx, double, 3 * (int64_t)m->n_corners);
    double *vertex = QC__ZERO(s->ctx, double, 3 * (int64_t)m->n_vertices), *value = NULL;
    qc_status status = corner && vertex ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int64_t c = 0; c < s->n_corner_normal; c++)
            if (s->corner_normal[c] >= 0 && s->corner_normal[c] < s->n_normal / 3)
                memcpy(corner + 3 * c, s->normal + 3 * (int64_t)s->corner_normal[c],
                       3 * sizeof *corner);
        const bool whole = normals_of_vertices(m, corner, vertex);
        status =
            qc_polygon_mesh_add_attribute(s->ctx, m, "normal", whole ? QC_AT_VERTEX : QC_AT_CORNER,
                                          QC_ATTRIBUTE_DIRECTION, 3, &value);
        if (status == QC_OK)
            memcpy(value, whole ? vertex : corner,
                   3 * sizeof *value * (size_t)(whole ? m->n_vertices : m->n_corners));
    }
    qc__free(corner);
    qc__free(vertex);
    return status;
}

/* Equal uvs of the corners at a vertex become one, so that faces of one chart share them. */
static qc_status weld_uvs(qc__soup *s) {
    double *value = QC__ZERO(s->ctx, double, 2 * s->n_corner);
    int32_t n = 0;
    if (!value) return QC_ERR_NOMEM;
    for (int64_t c = 0; c < s->n_corner_uv; c++)
        if (s->corner_uv[c] >= 0)
            memcpy(value + 2 * c, s->uv + 2 * (int64_t)s->corner_uv[c], 2 * sizeof *value);
    const qc_status status =
        qc__number_corner_values(s->ctx, (int32_t)(s->n_position / 3), (int32_t)s->n_corner_uv,
                                 s->corner_vertex, 2, value, s->corner_uv, s->uv, &n);
    if (status == QC_OK) s->n_uv = 2 * (int64_t)n;
    qc__free(value);
    return status;
}

qc_status qc__soup_finish(qc__soup *s, qc__text *t, qc_polygon_mesh **out) {
    qc_status status = check_counts(s, t);
    if (status == QC_OK) status = check_faces(s, t);
    if (status == QC_OK && s->uv_by_corner) status = weld_uvs(s);
    if (status != QC_OK) return status;
    /* texture coordinates which no corner uses are not kept */
    int64_t n_uv = s->n_corner_uv > 0 ? s->n_uv : 0;
    qc_polygon_mesh *m;
    status = qc_polygon_mesh_create(
        s->ctx, (int32_t)(s->n_position / 3), (int32_t)s->n_face, (int32_t)s->n_corner,
        (int32_t)(n_uv / 2), (int32_t)(s->n_line / 2),
        QC_POLYGON_FACE_LINE | (s->has_groups ? (uint32_t)QC_POLYGON_FACE_GROUP : 0u), &m);
    if (status != QC_OK) return status;
    copy(m->position, s->position, s->n_position, sizeof(double));
    copy(m->face_offset, s->face_begin, s->n_face, sizeof(int32_t));
    m->face_offset[s->n_face] = (int32_t)s->n_corner;
    copy(m->face_vertex, s->corner_vertex, s->n_corner, sizeof(int32_t));
    copy(m->face_line, s->face_line, s->n_face, sizeof(int32_t));
    if (s->has_groups) copy(m->face_group, s->face_group, s->n_face, sizeof(int32_t));
    copy(m->line, s->line, s->n_line, sizeof(int32_t));
    if (n_uv > 0) {
        copy(m->uv, s->uv, n_uv, sizeof(double));
        copy(m->corner_uv, s->corner_uv, s->n_corner_uv, sizeof(int32_t));
        for (int64_t c = s->n_corner_uv; c < s->n_corner; c++) m->corner_uv[c] = -1;
    }
    if (s->n_groups > 0) status = name_groups(s, m);
    if (status == QC_OK) status = add_attributes(s, m);
    if (status == QC_OK && s->n_corner_normal > 0) status = add_normals(s, m);
    if (status == QC_OK)
        *out = m;
    else
        qc_object_release(m);
    return status;
}
