/* Writing PLY, as text or binary little endian: vertices, faces and feature edges with all
 * attributes, uvs, groups and their names. Colours are bytes, labels int, the rest double. */
#include <math.h>

#include "write_ply.h"

/* --- numbers --------------------------------------------------------------------------------- */

static void put_bytes(qc__ply_writer *w, uint64_t bits, size_t n) {
    char bytes[8];
    for (size_t i = 0; i < n; i++) bytes[i] = (char)(unsigned char)(bits >> (8 * i));
    qc__put_text(w->o, bytes, n);
}

static void put_blank(qc__ply_writer *w) {
    if (w->begun) qc__put_char(w->o, ' ');
    w->begun = true;
}

/* uchar or int */
static void put_whole(qc__ply_writer *w, int32_t x, bool is_byte) {
    if (!w->ascii) {
        put_bytes(w, (uint32_t)x, is_byte ? 1 : 4);
        return;
    }
    put_blank(w);
    if (x < 0) qc__put_char(w->o, '-');
    qc__put_int(w->o, x < 0 ? (int32_t)(0 - (uint32_t)x) : x);
}

static void put_real(qc__ply_writer *w, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (!w->ascii) {
        put_bytes(w, bits, sizeof bits);
        return;
    }
    put_blank(w);
    qc__put_double(w->o, x);
}

static void end_line(qc__ply_writer *w) {
    if (w->ascii) qc__put_char(w->o, '\n');
    w->begun = false;
}

static void put_length(qc__ply_writer *w, int32_t n) {
    put_whole(w, n, strcmp(w->count, "uchar") == 0);
}

/* --- the elements ---------------------------------------------------------------------------- */

static void put_value(qc__ply_writer *w, const qc_attribute *a, const char *type, double x) {
    if (qc__ply_is_colour(a))
        put_whole(w, (int32_t)(255 * fmin(fmax(x, 0), 1) + 0.5), true);
    else if (*type == 'i')
        put_whole(w, (int32_t)x, false);
    else
        put_real(w, x);
}

/* The values of element i; types[k] is the type of attribute k. */
static void put_values(qc__ply_writer *w, const char *const *types, int32_t at, int64_t i) {
    for (int32_t k = 0; k < w->m->n_attributes; k++) {
        const qc_attribute *a = &w->m->attribute[k];
        for (int32_t j = 0; a->at == at && j < a->width; j++)
            put_value(w, a, types[k], a->value[a->width * i + j]);
    }
}

static void put_vertex(qc__ply_writer *w, const char *const *types, int64_t v) {
    for (int k = 0; k < 3; k++) put_real(w, w->m->position[3 * v + k]);
    for (int k = 0; w->vertex_uv && k < 2; k++) {
        const int32_t i = w->vertex_uv[v];
        put_real(w, i < 0 ? 0 : w->m->uv[2 * (int64_t)i + k]);
    }
    put_values(w, types, QC_AT_VERTEX, v);
    end_line(w);
}

/* uvs of a face whose corners all have one; an empty list otherwise. */
static void put_uvs(qc__ply_writer *w, int32_t begin, int32_t end) {
    bool all = true;
    for (int32_t c = begin; c < end; c++) all = all && w->m->corner_uv[c] >= 0;
    put_length(w, all ? 2 * (end - begin) : 0);
    for (int32_t c = begin; all && c < end; c++)
        for (int k = 0; k < 2; k++) put_real(w, w->m->uv[2 * (int64_t)w->m->corner_uv[c] + k]);
}

static void put_face(qc__ply_writer *w, const char *const *types, int64_t f) {
    const qc_polygon_mesh *m = w->m;
    const int32_t begin = m->face_offset[f], end = m->face_offset[f + 1];
    put_length(w, end - begin);
    for (int32_t c = begin; c < end; c++) put_whole(w, m->face_vertex[c], false);
    if (m->uv && !w->vertex_uv) put_uvs(w, begin, end);
    for (int32_t k = 0; k < m->n_attributes; k++) {
        const qc_attribute *a = &m->attribute[k];
        if (a->at != QC_AT_CORNER) continue;
        put_length(w, a->width * (end - begin));
        for (int64_t i = (int64_t)a->width * begin; i < (int64_t)a->width * end; i++)
            put_real(w, a->value[i]);
    }
    if (m->face_group) put_whole(w, m->face_group[f], false);
    put_values(w, types, QC_AT_FACE, f);
    end_line(w);
}

static bool put_elements(qc_ctx *ctx, qc__ply_writer *w, const char *const *types) {
    const qc_polygon_mesh *m = w->m;
    const int64_t nv = m->n_vertices, nf = m->n_faces, n = nv + nf + m->n_lines;
    for (int64_t i = 0; i < n && !w->o->failed; i++) {
        if (i < nv)
            put_vertex(w, types, i);
        else if (i < nv + nf)
            put_face(w, types, i - nv);
        else {
            for (int k = 0; k < 2; k++) put_whole(w, m->line[2 * (i - nv - nf) + k], false);
            end_line(w);
        }
        if (i % 16384 == 0 && !qc__progress(ctx, (double)i / (double)n)) return false;
    }
    return true;
}

/* --- what fits the format -------------------------------------------------------------------- */

/* One uv for each vertex, when every corner has one and no vertex two. */
static qc_status find_vertex_uvs(qc_ctx *ctx, qc__ply_writer *w) {
    const qc_polygon_mesh *m = w->m;
    int32_t *found = m->uv ? QC__NEW(ctx, int32_t, m->n_vertices) : NULL;
    bool one = found != NULL;
    if (m->uv && !found) return QC_ERR_NOMEM;
    for (int32_t v = 0; one && v < m->n_vertices; v++) found[v] = -1;
    for (int32_t c = 0; one && c < m->n_corners; c++) {
        int32_t *i = &found[m->face_vertex[c]];
        one = m->corner_uv[c] >= 0 && (*i < 0 || *i == m->corner_uv[c]);
        *i = m->corner_uv[c];
    }
    if (one)
        w->vertex_uv = found;
    else
        qc__free(found);
    return QC_OK;
}

/* Lengths of lists are bytes as long as they can. */
static const char *count_type(const qc_polygon_mesh *m) {
    int64_t widest = 2, most = 0;
    for (int32_t k = 0; k < m->n_attributes; k++)
        if (m->attribute[k].at == QC_AT_CORNER && m->attribute[k].width > widest)
            widest = m->attribute[k].width;
    for (int32_t f = 0; f < m->n_faces; f++) {
        const int64_t n = widest * (m->face_offset[f + 1] - m->face_offset[f]);
        if (n > most) most = n;
    }
    return most < 256 ? "uchar" : "int";
}

/* Names which would be read as something else. */
static qc_status check_names(qc_ctx *ctx, const qc_polygon_mesh *m) {
    for (int32_t k = 0; k < m->n_attributes; k++) {
        const qc_attribute *a = &m->attribute[k];
        const bool coordinate =
            a->at == QC_AT_VERTEX && strchr("xyz", a->name[0]) && a->name[1] == 0;
        const bool group =
            a->at == QC_AT_FACE && a->kind == QC_ATTRIBUTE_LABEL && strcmp(a->name, "group") == 0;
        if (a->width == 1 && (coordinate || group))
            return qc__fail(ctx, QC_ERR_ARGUMENT, k,
                            "an attribute '%s' cannot be written as PLY, where that has a meaning; "
                            "rename it",
                            a->name);
    }
    return QC_OK;
}

/* Whole numbers of 32 bits. */
static bool is_int(const qc_polygon_mesh *m, const qc_attribute *a) {
    const int64_t n = (int64_t)a->width * qc_polygon_mesh_elements(m, a->at);
    if (a->kind != QC_ATTRIBUTE_LABEL) return false;
    for (int64_t i = 0; i < n; i++)
        if (!(fabs(a->value[i]) <= INT32_MAX) || a->value[i] != floor(a->value[i])) return false;
    return true;
}

static const char *type_of(const qc__ply_writer *w, const qc_attribute *a) {
    return qc__ply_is_colour(a) ? "uchar" : is_int(w->m, a) ? "int" : "double";
}

qc_status qc__write_ply(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *m, bool ascii,
                        const char *comment) {
    qc__ply_writer w = {.o = o, .m = m, .ascii = ascii, .count = count_type(m)};
    const char **types = QC__NEW(ctx, const char *, m->n_attributes);
    qc_status status = types ? check_names(ctx, m) : QC_ERR_NOMEM;
    if (status == QC_OK) status = find_vertex_uvs(ctx, &w);
    if (status == QC_OK) {
        for (int32_t k = 0; k < m->n_attributes; k++) types[k] = type_of(&w, &m->attribute[k]);
        qc__ply_write_header(&w, types, comment);
        if (!put_elements(ctx, &w, types)) status = QC_ERR_CANCELLED;
    }
    qc__free(types);
    qc__free(w.vertex_uv);
    return status;
}
