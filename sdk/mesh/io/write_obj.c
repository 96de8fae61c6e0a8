/* Writing OBJ: v with colours, vt, vn, faces in their groups, segments; shortest round-trip
 * numbers. */
#include "output.h"
#include "sdk/mesh/internal.h"

#include <string.h>

typedef struct writer {
    qc__output *o;
    const qc_polygon_mesh *m;
    const qc_attribute *colour;
    int32_t n_normals;
    const double *normal;   /* 3 n_normals */
    double *distinct;       /* the same when they are of corners */
    int32_t *corner_normal; /* n_corners, -1 = none; NULL without normals */
} writer;

static bool is_zero(const double x[3]) {
    return x[0] == 0 && x[1] == 0 && x[2] == 0;
}

/* Normals of corners, of vertices otherwise. */
static qc_status find_normals(qc_ctx *ctx, writer *w) {
    const qc_polygon_mesh *m = w->m;
    const qc_attribute *split = qc_polygon_mesh_attribute(m, QC_AT_CORNER, "normal");
    const qc_attribute *a = split ? split : qc_polygon_mesh_attribute(m, QC_AT_VERTEX, "normal");
    if (!a || a->width != 3) return QC_OK;
    w->corner_normal = QC__NEW(ctx, int32_t, m->n_corners);
    if (split) w->distinct = QC__NEW(ctx, double, 3 * (int64_t)m->n_corners);
    if (!w->corner_normal || (split && !w->distinct)) return QC_ERR_NOMEM;
    for (int32_t c = 0; c < m->n_corners; c++) {
        const int32_t i = split ? c : m->face_vertex[c];
        w->corner_normal[c] = is_zero(a->value + 3 * (int64_t)i) ? -1 : i;
    }
    w->normal = split ? w->distinct : a->value;
    w->n_normals = m->n_vertices;
    if (!split) return QC_OK;
    return qc__number_corner_values(ctx, m->n_vertices, m->n_corners, m->face_vertex, 3, a->value,
                                    w->corner_normal, w->distinct, &w->n_normals);
}

/* v, v/vt, v//vn or v/vt/vn */
static void put_face(const writer *w, int32_t f) {
    const qc_polygon_mesh *m = w->m;
    qc__put_char(w->o, 'f');
    for (int32_t c = m->face_offset[f]; c < m->face_offset[f + 1]; c++) {
        const int32_t uv = m->corner_uv ? m->corner_uv[c] : -1;
        const int32_t normal = w->corner_normal ? w->corner_normal[c] : -1;
        qc__put_char(w->o, ' ');
        qc__put_int(w->o, m->face_vertex[c] + 1);
        if (uv < 0 && normal < 0) continue;
        qc__put_char(w->o, '/');
        if (uv >= 0) qc__put_int(w->o, uv + 1);
        if (normal < 0) continue;
        qc__put_char(w->o, '/');
        qc__put_int(w->o, normal + 1);
    }
    qc__put_char(w->o, '\n');
}

/* The statements of a face's group; number: room for those of one without. */
static const char *group_text(const qc_polygon_mesh *m, int32_t f, char number[32]) {
    const int32_t g = f < 0 ? 0 : m->face_group[f];
    if (g > 0 && g <= m->n_groups) return m->group_name[g - 1];
    if (g <= 0) return "";
    snprintf(number, 32, "g group%d", (int)g);
    return number;
}

/* Whether one of the lines begins with the word. */
static bool says(const char *text, const char *word) {
    const size_t n = strlen(word);
    for (; *text; text += strcspn(text, "\n"), text += *text == '\n')
        if (strncmp(text, word, n) == 0 && text[n] == ' ') return true;
    return false;
}

/* Statements stay in force until the next of their kind: one without a name ends them. */
static void put_group(const writer *w, int32_t f) {
    static const char *const kinds[] = {"o", "g", "usemtl"};
    const qc_polygon_mesh *m = w->m;
    char number[2][32];
    if (!m->face_group || m->face_group[f] == (f > 0 ? m->face_group[f - 1] : 0)) return;
    const char *before = group_text(m, f - 1, number[0]), *text = group_text(m, f, number[1]);
    for (int k = 0; k < 3; k++)
        if (says(before, kinds[k]) && !says(text, kinds[k])) qc__put_comment(w->o, "", kinds[k]);
    qc__put_comment(w->o, "", text);
}

static void put_vertex(const writer *w, int64_t v) {
    double x[6];
    memcpy(x, w->m->position + 3 * v, 3 * sizeof *x);
    if (w->colour) memcpy(x + 3, w->colour->value + w->colour->width * v, 3 * sizeof *x);
    qc__put_point(w->o, "v", x, w->colour ? 6 : 3);
}

static void put_segment(const writer *w, int64_t i) {
    qc__put_text(w->o, "l ", 2);
    qc__put_int(w->o, w->m->line[2 * i] + 1);
    qc__put_char(w->o, ' ');
    qc__put_int(w->o, w->m->line[2 * i + 1] + 1);
    qc__put_char(w->o, '\n');
}

/* Vertices, texture coordinates, normals, faces and lines are one sequence for progress and
 * cancelling. */
static bool put_mesh(qc_ctx *ctx, const writer *w) {
    const qc_polygon_mesh *m = w->m;
    const int64_t end[] = {m->n_vertices, m->uv ? m->n_uvs : 0, w->n_normals, m->n_faces,
                           m->line ? m->n_lines : 0};
    int64_t n = 0, i = 0;
    for (int k = 0; k < 5; k++) n += end[k];
    for (int k = 0; k < 5; k++)
        for (int64_t j = 0; j < end[k] && !w->o->failed; j++, i++) {
            if (k == 0) put_vertex(w, j);
            if (k == 1) qc__put_point(w->o, "vt", m->uv + 2 * j, 2);
            if (k == 2) qc__put_point(w->o, "vn", w->normal + 3 * j, 3);
            if (k == 3) put_group(w, (int32_t)j);
            if (k == 3) put_face(w, (int32_t)j);
            if (k == 4) put_segment(w, j);
            if (i % 16384 == 0 && !qc__progress(ctx, (double)i / (double)n)) return false;
        }
    return true;
}

qc_status qc__write_obj(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *mesh,
                        const char *comment) {
    writer w = {.o = o, .m = mesh};
    w.colour = qc_polygon_mesh_attribute(mesh, QC_AT_VERTEX, "colour");
    if (w.colour && w.colour->width < 3) w.colour = NULL;
    qc_status status = find_normals(ctx, &w);
    if (status == QC_OK) {
        qc__put_comment(o, "# ", comment);
        qc__put_comment(o, "", mesh->materials);
        if (!put_mesh(ctx, &w)) status = QC_ERR_CANCELLED;
    }
    qc__free(w.corner_normal);
    qc__free(w.distinct);
    return status;
}
