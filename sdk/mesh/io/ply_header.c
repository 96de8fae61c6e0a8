/* The header of PLY: format, elements, properties, comments, up to end_header. */
#include "ply.h"

#include <string.h>

int qc__ply_size(int type) {
    static const int size[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return size[type];
}

static int take_type(qc__text *t) {
    static const struct {
        const char *name;
        int type;
    } types[] = {{"char", QC__PLY_I8},    {"int8", QC__PLY_I8},     {"uchar", QC__PLY_U8},
                 {"uint8", QC__PLY_U8},   {"short", QC__PLY_I16},   {"int16", QC__PLY_I16},
                 {"ushort", QC__PLY_U16}, {"uint16", QC__PLY_U16},  {"int", QC__PLY_I32},
                 {"int32", QC__PLY_I32},  {"uint", QC__PLY_U32},    {"uint32", QC__PLY_U32},
                 {"float", QC__PLY_F32},  {"float32", QC__PLY_F32}, {"double", QC__PLY_F64},
                 {"float64", QC__PLY_F64}};
    qc__skip_blanks(t);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (qc__take_word(t, types[i].name)) return types[i].type;
    return QC__PLY_NONE;
}

static qc_status read_format(qc__text *t, qc__ply_header *h) {
    char excerpt[QC__EXCERPT];
    qc__skip_blanks(t);
    if (qc__take_word(t, "ascii"))
        h->format = QC__PLY_ASCII;
    else if (qc__take_word(t, "binary_little_endian"))
        h->format = QC__PLY_LITTLE;
    else if (qc__take_word(t, "binary_big_endian"))
        h->format = QC__PLY_BIG;
    else
        return qc__text_fail(t, t->line,
                             "unknown PLY format '%s'; save it as ascii or "
                             "binary_little_endian",
                             qc__excerpt(t, excerpt));
    return QC_OK;
}

static qc_status read_element(qc__text *t, qc__ply_header *h) {
    char excerpt[QC__EXCERPT];
    if (!qc__reserve(t->ctx, (void **)&h->element, &h->c_elements, h->n_elements + 1,
                     sizeof *h->element))
        return QC_ERR_NOMEM;
    qc__ply_element *e = &h->element[h->n_elements];
    *e = (qc__ply_element){.line = t->line, .property = h->n_properties};
    qc__skip_blanks(t);
    size_t n = qc__word_length(t);
    memcpy(e->name, t->p, n < sizeof e->name - 1 ? n : sizeof e->name - 1);
    t->p += n;
    qc__skip_blanks(t);
    if (n == 0 || !qc__take_int(t, &e->count) || e->count < 0)
        return qc__text_fail(t, t->line,
                             "an element needs a name and a count, found '%s'; export the "
                             "file again",
                             qc__excerpt(t, excerpt));
    h->n_elements++;
    return QC_OK;
}

bool qc__ply_is(const qc__ply_property *p, const char *name) {
    size_t i = 0;
    for (; i < p->length && name[i]; i++) {
        const char c = p->name[i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != name[i]) return false;
    }
    return i == p->length && !name[i];
}

static qc_status read_property(qc__text *t, qc__ply_header *h) {
    char excerpt[QC__EXCERPT];
    if (h->n_elements == 0)
        return qc__text_fail(t, t->line, "a property before any element; export the file again");
    if (!qc__reserve(t->ctx, (void **)&h->property, &h->c_properties, h->n_properties + 1,
                     sizeof *h->property))
        return QC_ERR_NOMEM;
    qc__ply_element *e = &h->element[h->n_elements - 1];
    qc__ply_property p = {0};
    qc__skip_blanks(t);
    bool list = qc__take_word(t, "list");
    if (list) p.count_type = (uint8_t)take_type(t);
    bool count_ok = !list || (p.count_type != QC__PLY_NONE && p.count_type < QC__PLY_F32);
    if (count_ok) p.type = (uint8_t)take_type(t);
    if (!count_ok || p.type == QC__PLY_NONE)
        return qc__text_fail(t, t->line, "unknown property type '%s'; export the file again",
                             qc__excerpt(t, excerpt));
    qc__skip_blanks(t);
    p.name = t->p;
    p.length = qc__word_length(t);
    p.slot = -1;
    p.full = 1;
    e->has_list |= list;
    e->least_bytes += qc__ply_size(list ? p.count_type : p.type);
    e->n_properties++;
    h->property[h->n_properties++] = p;
    return QC_OK;
}

/* Behind end_header the line ends as the first line does: CR alone must not swallow a data byte. */
static void skip_header_end(qc__text *t) {
    const char *first = t->begin + 3;
    bool lone_cr = *first == '\r' && (first + 1 == t->end || first[1] != '\n');
    while (t->p < t->end && !qc__is_end(*t->p)) t->p++;
    if (lone_cr)
        t->p += t->p < t->end;
    else {
        t->p += t->p < t->end && *t->p == '\r';
        t->p += t->p < t->end && *t->p == '\n';
    }
    t->line++;
}

static qc_status check_header(qc__text *t, const qc__ply_header *h) {
    for (int64_t i = 0; i < h->n_elements; i++) {
        const qc__ply_element *e = &h->element[i];
        /* an element takes its bytes, or at least a digit and a blank for every property */
        int64_t least = h->format == QC__PLY_ASCII ? 2 * e->n_properties : e->least_bytes;
        if (least > 0 && e->count > (t->end - t->p + 1) / least)
            return qc__text_fail(t, e->line,
                                 "the header promises %lld elements '%s' but only %lld "
                                 "bytes follow; the file is cut off, export it again",
                                 (long long)e->count, e->name, (long long)(t->end - t->p));
        int coordinates = 0;
        bool corners = false;
        for (int64_t k = 0; k < e->n_properties; k++) {
            const qc__ply_property *p = &h->property[e->property + k];
            coordinates += p->slot >= QC__PLY_X && p->slot < QC__PLY_X + 3;
            corners |= p->role == QC__PLY_CORNERS;
        }
        if ((strcmp(e->name, "vertex") == 0 && coordinates != 3) ||
            (strcmp(e->name, "face") == 0 && !corners))
            return qc__text_fail(
                t, e->line, "element '%s' lacks %s; export the file again", e->name,
                e->name[0] == 'v' ? "a property x, y or z" : "the list vertex_indices");
    }
    return QC_OK;
}

/* "group 3 g wheel", "mtllib a.mtl": what OBJ files say of groups. Statements of one group follow
 * each other and groups come in order; anything else is a comment of no meaning. */
static qc_status read_comment(qc__text *t, qc__soup *s) {
    int64_t group;
    qc__skip_blanks(t);
    const char *begin = t->p, *end = begin;
    while (end < t->end && !qc__is_end(*end)) end++;
    if (qc__take_word(t, "mtllib")) return qc__soup_materials(s, begin, (size_t)(end - begin));
    if (!qc__take_word(t, "group")) return QC_OK;
    qc__skip_blanks(t);
    if (!qc__take_int(t, &group)) return QC_OK;
    qc__skip_blanks(t);
    if (group == s->n_groups + 1)
        return qc__soup_group(s, t->p, (size_t)(end - t->p)) ? QC_OK : QC_ERR_NOMEM;
    if (group != s->n_groups || group == 0) return QC_OK;
    return qc__soup_group_more(s, t->p, (size_t)(end - t->p)) ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__ply_read_header(qc__text *t, qc__soup *s, qc__ply_header *h) {
    qc_status status = QC_OK;
    char excerpt[QC__EXCERPT];
    h->format = -1;
    for (qc__skip_line(t); status == QC_OK; qc__skip_line(t)) {
        qc__skip_blanks(t);
        if (t->p == t->end)
            return qc__text_fail(t, t->line,
                                 "the PLY header has no end_header; the file is cut off, "
                                 "export it again");
        if (qc__take_word(t, "end_header")) break;
        if (qc__take_word(t, "format"))
            status = read_format(t, h);
        else if (qc__take_word(t, "element"))
            status = read_element(t, h);
        else if (qc__take_word(t, "property"))
            status = read_property(t, h);
        else if (qc__take_word(t, "comment"))
            status = read_comment(t, s);
        else if (!qc__at_line_end(t) && !qc__take_word(t, "obj_info"))
            status = qc__text_fail(t, t->line, "unknown PLY statement '%s'; export the file again",
                                   qc__excerpt(t, excerpt));
    }
    if (status != QC_OK) return status;
    if (h->format < 0)
        return qc__text_fail(t, t->line, "the PLY header has no format; export the file again");
    skip_header_end(t);
    status = qc__ply_plan(s, h);
    return status == QC_OK ? check_header(t, h) : status;
}
