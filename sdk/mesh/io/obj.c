/* Wavefront OBJ: v with colours, vt, vn, f, l, mtllib, and o, g and usemtl as numbered groups;
 * everything else is skipped. */
#include "internal.h"

#include <math.h>
#include <string.h>

/* Groups: what o, g and usemtl said last, numbered from 1 in the order in which faces meet them. An
 * open hash over the text of all three. */
typedef struct group_names {
    struct {
        const char *p;
        size_t n;
    } said[3];  /* statements o, g and usemtl in force */
    bool fresh; /* they have changed since `number` was found */
    int32_t number;
    char *text; /* buffer */
    int64_t c_text;
    qc__soup *soup; /* keeps the texts */
    int64_t *name;  /* place of the text in soup->group_name */
    int32_t *slot;  /* hash table of numbers, 0 = empty */
    int64_t n, c_name;
    size_t n_slots; /* a power of two, or 0 */
} group_names;

static size_t hash_text(const char *p, size_t n) {
    uint64_t h = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < n; i++) h = (h ^ (unsigned char)p[i]) * UINT64_C(1099511628211);
    return (size_t)(h ^ (h >> 32));
}

static size_t group_slot(const group_names *g, const char *p, size_t n) {
    size_t i = hash_text(p, n) & (g->n_slots - 1);
    for (; g->slot[i]; i = (i + 1) & (g->n_slots - 1)) {
        const char *known = g->soup->group_name + g->name[g->slot[i] - 1];
        if (strncmp(known, p, n) == 0 && known[n] == 0) break;
    }
    return i;
}

static bool group_grow(qc_ctx *ctx, group_names *g) {
    size_t n_slots = g->n_slots ? 2 * g->n_slots : 64;
    int32_t *slot = QC__ZERO(ctx, int32_t, n_slots);
    if (!slot) return false;
    qc__free(g->slot);
    g->slot = slot;
    g->n_slots = n_slots;
    for (int32_t k = 0; k < g->n; k++) {
        const char *known = g->soup->group_name + g->name[k];
        slot[group_slot(g, known, strlen(known))] = k + 1;
    }
    return true;
}

/* Number of the group with text [p, p+n); 0 when memory ran out. */
static int32_t group_number(qc_ctx *ctx, group_names *g, const char *p, size_t n) {
    if ((size_t)(2 * g->n) >= g->n_slots && !group_grow(ctx, g)) return 0;
    size_t i = group_slot(g, p, n);
    if (g->slot[i]) return g->slot[i];
    if (!qc__reserve(ctx, (void **)&g->name, &g->c_name, g->n + 1, sizeof *g->name)) return 0;
    g->name[g->n] = g->soup->n_group_name;
    if (!qc__soup_group(g->soup, p, n)) return 0;
    g->n++;
    return g->slot[i] = (int32_t)g->n;
}

/* Sets the group of the next face; false when memory ran out. */
static bool group_update(qc_ctx *ctx, group_names *g) {
    int64_t n = 0;
    if (!g->fresh) return true;
    for (int k = 0; k < 3; k++) {
        if (g->said[k].n == 0) continue;
        if (!qc__reserve(ctx, (void **)&g->text, &g->c_text, n + 1 + (int64_t)g->said[k].n, 1))
            return false;
        if (n > 0) g->text[n++] = '\n';
        memcpy(g->text + n, g->said[k].p, g->said[k].n);
        n += (int64_t)g->said[k].n;
    }
    g->number = n > 0 ? group_number(ctx, g, g->text, (size_t)n) : 0;
    g->fresh = false;
    return n == 0 || g->number > 0;
}

static void group_free(group_names *g) {
    qc__free(g->text);
    qc__free(g->name);
    qc__free(g->slot);
}

/* An index as written (1-based, or negative from the end) to 0-based; forward references are
 * checked when the file has been read. */
static qc_status resolve(qc__text *t, int64_t i, int64_t n, const char *what, int64_t *out) {
    if (i == 0)
        return qc__text_fail(t, t->line, "%s index 0; OBJ counts from 1, export the file again",
                             what);
    *out = i > 0 ? i - 1 : n + i;
    if (*out < 0)
        return qc__text_fail(
            t, t->line, "%s index %lld is out of range (%lld read so far); export the file again",
            what, (long long)i, (long long)n);
    return QC_OK;
}

/* v, v/vt, v//vn or v/vt/vn; uv and normal = -1 when absent. */
static qc_status take_reference(qc__text *t, qc__soup *s, int64_t *vertex, int64_t *uv,
                                int64_t *normal) {
    char excerpt[QC__EXCERPT];
    int64_t i;
    *uv = *normal = -1;
    if (!qc__take_int(t, &i))
        return qc__text_fail(t, t->line, "'%s' is not a vertex index; export the file again",
                             qc__excerpt(t, excerpt));
    qc_status status = resolve(t, i, s->n_position / 3, "vertex", vertex);
    for (int k = 0; k < 2 && status == QC_OK && t->p < t->end && *t->p == '/'; k++) {
        t->p++;
        if (!qc__take_int(t, &i)) continue;
        if (k == 0)
            status = resolve(t, i, s->n_uv / 2, "texture", uv);
        else
            *normal = i > 0 ? i - 1 : s->n_normal / 3 + i;
    }
    if (status == QC_OK && t->p < t->end && *t->p == '/')
        return qc__text_fail(t, t->line,
                             "a corner is not v, v/vt, v//vn or v/vt/vn near '%s'; "
                             "export the file again",
                             qc__excerpt(t, excerpt));
    return status;
}

static bool line_goes_on(qc__text *t) {
    qc__skip_blanks(t);
    return !qc__at_line_end(t) && *t->p != '#';
}

static qc_status read_face(qc__text *t, qc__soup *s, group_names *g) {
    int64_t first = t->line, n = 0, vertex, uv, normal;
    if (!group_update(t->ctx, g) || !qc__soup_face(s, first, g->number)) return QC_ERR_NOMEM;
    for (; line_goes_on(t); n++) {
        qc_status status = take_reference(t, s, &vertex, &uv, &normal);
        if (status != QC_OK) return status;
        if (!qc__soup_corner(s, vertex, uv)) return QC_ERR_NOMEM;
        if (normal >= 0 && !qc__soup_corner_normal(s, normal)) return QC_ERR_NOMEM;
    }
    if (n < 3)
        return qc__text_fail(t, first,
                             "a face has %lld corners, at least 3 are needed; remove that "
                             "face",
                             (long long)n);
    return QC_OK;
}

static qc_status read_polyline(qc__text *t, qc__soup *s) {
    int64_t previous = -1, vertex, uv, normal;
    while (line_goes_on(t)) {
        qc_status status = take_reference(t, s, &vertex, &uv, &normal);
        if (status != QC_OK) return status;
        if (previous >= 0 && !qc__soup_line(s, previous, vertex)) return QC_ERR_NOMEM;
        previous = vertex;
    }
    return QC_OK;
}

/* x y z, and red, green, blue where there are six numbers. */
static qc_status read_vertex(qc__text *t, qc__soup *s) {
    double xyz[3], more[3];
    qc_status status = qc__take_point(t, "vertex", s->n_position / 3 + 1, xyz);
    if (status == QC_OK && !qc__soup_vertex(s, xyz)) status = QC_ERR_NOMEM;
    int n = 0;
    while (status == QC_OK && n < 3 && line_goes_on(t) && qc__take_double(t, &more[n]) &&
           isfinite(more[n]))
        n++;
    if (n < 3) return status;
    int32_t colour;
    return qc__soup_attribute_add(s, "colour", 6, QC_AT_VERTEX, QC_ATTRIBUTE_LINEAR, 3, &colour) &&
                   qc__soup_set(s, colour, more)
               ? QC_OK
               : QC_ERR_NOMEM;
}

/* What is not a number counts as 0. */
static qc_status read_normal(qc__text *t, qc__soup *s) {
    double x[3] = {0, 0, 0};
    for (int k = 0; k < 3 && line_goes_on(t); k++)
        if (!qc__take_double(t, &x[k]) || !isfinite(x[k])) x[k] = 0;
    return qc__soup_normal(s, x) ? QC_OK : QC_ERR_NOMEM;
}

static qc_status read_uv(qc__text *t, qc__soup *s) {
    double uv[2] = {0, 0};
    for (int k = 0; k < 2 && (k == 0 || line_goes_on(t)); k++) {
        qc__skip_blanks(t);
        if (!qc__take_double(t, &uv[k]) || !isfinite(uv[k]))
            return qc__text_fail(t, t->line,
                                 "texture coordinate %lld is not a finite number; remove "
                                 "the texture coordinates or export the file again",
                                 (long long)(s->n_uv / 2 + 1));
    }
    return qc__soup_uv(s, uv[0], uv[1]) ? QC_OK : QC_ERR_NOMEM;
}

/* Length of the statement without its comment and blanks at its end. */
static size_t statement_length(const qc__text *t, const char *statement) {
    const char *end = t->p;
    while (end < t->end && !qc__is_end(*end) && !(*end == '#' && qc__is_blank(end[-1]))) end++;
    while (end > statement && qc__is_blank(end[-1])) end--;
    return (size_t)(end - statement);
}

/* kind: 0 = o, 1 = g, 2 = usemtl; one without a name ends the one before. */
static void read_group(const qc__text *t, group_names *g, int kind, const char *statement) {
    const size_t n = statement_length(t, statement);
    g->said[kind].p = statement;
    g->said[kind].n = statement + n > t->p ? n : 0;
    g->fresh = true;
}

static bool is(const char *word, size_t n, const char *name) {
    return n == strlen(name) && memcmp(word, name, n) == 0;
}

static qc_status read_statement(qc__text *t, qc__soup *s, group_names *g) {
    static const char *const kinds[] = {"o", "g", "usemtl"};
    const char *word = t->p;
    size_t n = qc__word_length(t);
    t->p += n;
    if (is(word, n, "v")) return read_vertex(t, s);
    if (is(word, n, "f") || is(word, n, "fo")) return read_face(t, s, g); /* fo: its old name */
    if (is(word, n, "vt")) return read_uv(t, s);
    if (is(word, n, "vn")) return read_normal(t, s);
    if (is(word, n, "l")) return read_polyline(t, s);
    if (is(word, n, "mtllib")) return qc__soup_materials(s, word, statement_length(t, word));
    for (int kind = 0; kind < 3; kind++)
        if (is(word, n, kinds[kind])) read_group(t, g, kind, word);
    return QC_OK;
}

qc_status qc__read_obj(qc__text *t, qc__soup *s) {
    group_names groups = {.soup = s};
    qc_status status = QC_OK;
    t->continued = true;
    for (int64_t i = 0; status == QC_OK; i++) {
        qc__skip_blanks(t);
        if (t->p == t->end) break;
        bool comment = *t->p == '#';
        if (!comment && !qc__at_line_end(t)) status = read_statement(t, s, &groups);
        t->continued = !comment; /* a comment ends with its line */
        qc__skip_line(t);
        t->continued = true;
        if (status == QC_OK && i % 16384 == 0 && !qc__text_progress(t)) status = QC_ERR_CANCELLED;
    }
    group_free(&groups);
    return status;
}
