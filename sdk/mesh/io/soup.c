/* A polygon mesh of unknown size, grown while a file is read, checked and published at the end. */
#include <string.h>

#include "internal.h"
#include "sdk/mesh/internal.h"

void qc__soup_free(qc__soup *s) {
    void *arrays[] = {s->position, s->uv,         s->corner_vertex, s->corner_uv,
                      s->line,     s->face_begin, s->face_line,     s->face_group,
                      s->colour,   s->quality,    s->group_name,    s->materials};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
}

/* Room for `more` entries of a growing array; the test for room is inline, growing is not. */
#define ROOM(s, array, n, capacity, more)                                                          \
    ((n) + (more) <= (capacity) ||                                                                 \
     qc__reserve((s)->ctx, (void **)&(array), &(capacity), (n) + (more), sizeof *(array)))

bool qc__soup_vertex(qc__soup *s, const double xyz[3]) {
    if (!ROOM(s, s->position, s->n_position, s->c_position, 3)) return false;
    memcpy(s->position + s->n_position, xyz, 3 * sizeof *xyz);
    s->n_position += 3;
    return true;
}

static bool set_last(qc__soup *s, double **array, int64_t *n, int64_t *capacity, int width,
                     const double *x) {
    const int64_t whole = s->n_position / 3 * width;
    if (whole > *capacity && !qc__reserve(s->ctx, (void **)array, capacity, whole, sizeof **array))
        return false;
    for (; *n < whole - width; ++*n) (*array)[*n] = 0;
    for (int k = 0; k < width; k++) (*array)[whole - width + k] = x[k];
    *n = whole;
    return true;
}

bool qc__soup_colour(qc__soup *s, const double rgb[3]) {
    return set_last(s, &s->colour, &s->n_colour, &s->c_colour, 3, rgb);
}

bool qc__soup_quality(qc__soup *s, double quality) {
    return set_last(s, &s->quality, &s->n_quality, &s->c_quality, 1, &quality);
}

bool qc__soup_group(qc__soup *s, const char *text, size_t n) {
    if (!ROOM(s, s->group_name, s->n_group_name, s->c_group_name, (int64_t)n + 1)) return false;
    memcpy(s->group_name + s->n_group_name, text, n);
    s->n_group_name += (int64_t)n + 1;
    s->group_name[s->n_group_name - 1] = 0;
    s->n_groups++;
    return true;
}

bool qc__soup_uv(qc__soup *s, double u, double v) {
    if (!ROOM(s, s->uv, s->n_uv, s->c_uv, 2)) return false;
    s->uv[s->n_uv++] = u;
    s->uv[s->n_uv++] = v;
    return true;
}

/* Indices beyond 32 bits cannot be valid: they become INT32_MAX and are refused with the range. */
static int32_t narrow(int64_t i) {
    return i > INT32_MAX ? INT32_MAX : i < INT32_MIN ? INT32_MIN : (int32_t)i;
}

bool qc__soup_face(qc__soup *s, int64_t line, int32_t group) {
    if (!ROOM(s, s->face_begin, s->n_face, s->c_face_begin, 1) ||
        !ROOM(s, s->face_line, s->n_face, s->c_face_line, 1) ||
        !ROOM(s, s->face_group, s->n_face, s->c_face_group, 1))
        return false;
    s->face_begin[s->n_face] = narrow(s->n_corner);
    s->face_line[s->n_face] = narrow(line);
    s->face_group[s->n_face++] = group;
    s->has_groups |= group != 0;
    return true;
}

bool qc__soup_corner(qc__soup *s, int64_t vertex, int64_t uv) {
    if (!ROOM(s, s->corner_vertex, s->n_corner, s->c_corner, 1)) return false;
    s->corner_vertex[s->n_corner++] = narrow(vertex);
    if (uv < 0 && s->n_corner_uv == 0) return true;
    if (!ROOM(s, s->corner_uv, s->n_corner_uv, s->c_corner_uv, s->n_corner - s->n_corner_uv))
        return false;
    while (s->n_corner_uv + 1 < s->n_corner) s->corner_uv[s->n_corner_uv++] = -1;
    s->corner_uv[s->n_corner_uv++] = narrow(uv);
    return true;
}

bool qc__soup_line(qc__soup *s, int64_t a, int64_t b) {
    if (!ROOM(s, s->line, s->n_line, s->c_line, 2)) return false;
    s->line[s->n_line++] = narrow(a);
    s->line[s->n_line++] = narrow(b);
    return true;
}

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

qc_status qc__soup_finish(qc__soup *s, qc__text *t, qc_polygon_mesh **out) {
    qc_status status = check_counts(s, t);
    if (status == QC_OK) status = check_faces(s, t);
    if (status != QC_OK) return status;
    /* texture coordinates which no corner uses are not kept */
    int64_t n_uv = s->n_corner_uv > 0 ? s->n_uv : 0;
    qc_polygon_mesh *m;
    status = qc_polygon_mesh_create(
        s->ctx, (int32_t)(s->n_position / 3), (int32_t)s->n_face, (int32_t)s->n_corner,
        (int32_t)(n_uv / 2), (int32_t)(s->n_line / 2),
        QC_POLYGON_FACE_LINE | (s->has_groups ? (uint32_t)QC_POLYGON_FACE_GROUP : 0u) |
            (s->n_colour > 0 ? (uint32_t)QC_POLYGON_COLOUR : 0u) |
            (s->n_quality > 0 ? (uint32_t)QC_POLYGON_QUALITY : 0u),
        &m);
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
    copy(m->colour, s->colour, s->n_colour, sizeof(double));
    copy(m->quality, s->quality, s->n_quality, sizeof(double));
    if (s->n_groups > 0) status = name_groups(s, m);
    if (status == QC_OK)
        *out = m;
    else
        qc_object_release(m);
    return status;
}
