/* The header of a written PLY file: names and types of all that vertices, faces and edges have. */
#include <stdarg.h>

#include "write_ply.h"

static void QC__PRINTF(2, 3) put_line(qc__ply_writer *w, const char *format, ...) {
    char text[256];
    va_list args;
    va_start(args, format);
    const int n = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    qc__put_text(w->o, text, n < 0 ? 0 : (size_t)n < sizeof text ? (size_t)n : sizeof text - 1);
}

static void put_count(qc__ply_writer *w, const char *element, int32_t n) {
    put_line(w, "element %s %d\n", element, (int)n);
}

/* A name without blanks, shortened. */
static void plain_name(const char *name, char out[128]) {
    snprintf(out, 128, "%.120s", name);
    for (char *c = out; *c; c++)
        if ((unsigned char)*c <= ' ') *c = '_';
}

static void declare(qc__ply_writer *w, const qc_attribute *a, const char *type) {
    static const char *const rgba[] = {"red", "green", "blue", "alpha"};
    static const char *const xyz[] = {"nx", "ny", "nz"};
    const bool normal = strcmp(a->name, "normal") == 0 && a->width == 3;
    char name[128], numbered[144];
    plain_name(a->name, name);
    for (int32_t j = 0; j < a->width; j++) {
        snprintf(numbered, sizeof numbered, "%s_%d", name, (int)j);
        put_line(w, "property %s %s\n", type,
                 qc__ply_is_colour(a) ? rgba[j]
                 : normal             ? xyz[j]
                 : a->width > 1       ? numbered
                                      : name);
    }
}

static void declare_all(qc__ply_writer *w, const char *const *types, int32_t at) {
    for (int32_t k = 0; k < w->m->n_attributes; k++)
        if (w->m->attribute[k].at == at) declare(w, &w->m->attribute[k], types[k]);
}

static void put_groups(qc__ply_writer *w) {
    for (int32_t g = 0; g < w->m->n_groups; g++) {
        char prefix[32];
        snprintf(prefix, sizeof prefix, "comment group %d ", (int)g + 1);
        qc__put_comment(w->o, prefix, w->m->group_name[g]);
    }
    qc__put_comment(w->o, "comment ", w->m->materials);
}

static void put_face_header(qc__ply_writer *w, const char *const *types) {
    const qc_polygon_mesh *m = w->m;
    char name[128];
    put_count(w, "face", m->n_faces);
    put_line(w, "property list %s int vertex_indices\n", w->count);
    if (m->uv && !w->vertex_uv) put_line(w, "property list %s double texcoord\n", w->count);
    for (int32_t k = 0; k < m->n_attributes; k++) {
        if (m->attribute[k].at != QC_AT_CORNER) continue;
        plain_name(m->attribute[k].name, name);
        put_line(w, "property list %s double %s\n", w->count, name);
    }
    if (m->face_group) put_line(w, "property int group\n");
    declare_all(w, types, QC_AT_FACE);
}

void qc__ply_write_header(qc__ply_writer *w, const char *const *types, const char *comment) {
    static const char *const xyz[] = {"x", "y", "z"}, *const st[] = {"s", "t"};
    put_line(w, "ply\nformat %s 1.0\n", w->ascii ? "ascii" : "binary_little_endian");
    qc__put_comment(w->o, "comment ", comment);
    put_groups(w);
    put_count(w, "vertex", w->m->n_vertices);
    for (int k = 0; k < 3; k++) put_line(w, "property double %s\n", xyz[k]);
    for (int k = 0; w->vertex_uv && k < 2; k++) put_line(w, "property double %s\n", st[k]);
    declare_all(w, types, QC_AT_VERTEX);
    put_face_header(w, types);
    if (w->m->n_lines > 0) {
        put_count(w, "edge", w->m->n_lines);
        put_line(w, "property int vertex1\nproperty int vertex2\n");
    }
    put_line(w, "end_header\n");
}
