/* A polygon mesh of unknown size, grown while a file is read. */
#include <string.h>

#include "internal.h"

void qc__soup_free(qc__soup *s) {
    void *arrays[] = {s->position,      s->uv,         s->corner_vertex, s->corner_uv, s->line,
                      s->face_begin,    s->face_line,  s->face_group,    s->normal,    s->attribute,
                      s->corner_normal, s->group_name, s->materials};
    for (int64_t i = 0; i < s->n_attribute; i++) qc__free(s->attribute[i].value);
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

bool qc__soup_normal(qc__soup *s, const double xyz[3]) {
    if (!ROOM(s, s->normal, s->n_normal, s->c_normal, 3)) return false;
    memcpy(s->normal + s->n_normal, xyz, 3 * sizeof *xyz);
    s->n_normal += 3;
    return true;
}

bool qc__soup_attribute_add(qc__soup *s, const char *name, size_t length, int32_t at, int32_t kind,
                            int32_t width, int32_t *index) {
    for (int64_t i = 0; i < s->n_attribute; i++) {
        const qc__soup_attribute *a = &s->attribute[i];
        if (a->at != at || a->length != length || memcmp(a->name, name, length) != 0) continue;
        *index = a->width == width ? (int32_t)i : -1;
        return true;
    }
    if (!ROOM(s, s->attribute, s->n_attribute, s->c_attribute, 1)) return false;
    *index = (int32_t)s->n_attribute;
    s->attribute[s->n_attribute++] =
        (qc__soup_attribute){name, length, at, kind, width, NULL, 0, 0};
    return true;
}

bool qc__soup_set(qc__soup *s, int32_t index, const double *x) {
    qc__soup_attribute *a = &s->attribute[index];
    const int64_t elements = a->at == QC_AT_VERTEX ? s->n_position / 3
                             : a->at == QC_AT_FACE ? s->n_face
                                                   : s->n_corner;
    const int64_t whole = elements * a->width;
    if (whole > a->capacity &&
        !qc__reserve(s->ctx, (void **)&a->value, &a->capacity, whole, sizeof *a->value))
        return false;
    for (; a->n < whole - a->width; a->n++) a->value[a->n] = 0;
    for (int32_t k = 0; k < a->width; k++) a->value[whole - a->width + k] = x[k];
    a->n = whole;
    return true;
}

bool qc__soup_group(qc__soup *s, const char *text, size_t n) {
    if (!ROOM(s, s->group_name, s->n_group_name, s->c_group_name, (int64_t)n + 1)) return false;
    memcpy(s->group_name + s->n_group_name, text, n);
    s->n_group_name += (int64_t)n + 1;
    s->group_name[s->n_group_name - 1] = 0;
    s->n_groups++;
    return true;
}

bool qc__soup_group_more(qc__soup *s, const char *text, size_t n) {
    if (!ROOM(s, s->group_name, s->n_group_name, s->c_group_name, (int64_t)n + 1)) return false;
    char *end = s->group_name + s->n_group_name;
    end[-1] = '\n';
    memcpy(end, text, n);
    end[n] = 0;
    s->n_group_name += (int64_t)n + 1;
    return true;
}

qc_status qc__soup_materials(qc__soup *s, const char *text, size_t n) {
    if (s->materials) return QC_OK;
    s->materials = QC__NEW(s->ctx, char, n + 1);
    if (!s->materials) return QC_ERR_NOMEM;
    memcpy(s->materials, text, n);
    s->materials[n] = 0;
    return QC_OK;
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

bool qc__soup_corner_normal(qc__soup *s, int64_t normal) {
    if (!ROOM(s, s->corner_normal, s->n_corner_normal, s->c_corner_normal,
              s->n_corner - s->n_corner_normal))
        return false;
    while (s->n_corner_normal + 1 < s->n_corner) s->corner_normal[s->n_corner_normal++] = -1;
    s->corner_normal[s->n_corner_normal++] = narrow(normal);
    return true;
}

bool qc__soup_line(qc__soup *s, int64_t a, int64_t b) {
    if (!ROOM(s, s->line, s->n_line, s->c_line, 2)) return false;
    s->line[s->n_line++] = narrow(a);
    s->line[s->n_line++] = narrow(b);
    return true;
}
