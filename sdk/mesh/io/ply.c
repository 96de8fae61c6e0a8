/* PLY: the data behind the header, ASCII or binary of either byte order. Elements and properties
 * other than coordinates, colours and quality of vertices and the corners of faces are skipped by
 * their declared types. */
#include "ply.h"

#include <math.h>
#include <string.h>

/* One scalar of a binary file; the bytes are there. */
static double decode(const char *p, int type, bool big) {
    unsigned char b[8];
    int n = qc__ply_size(type);
    for (int i = 0; i < n; i++) b[i] = (unsigned char)p[big ? n - 1 - i : i];
    uint64_t u = 0;
    for (int i = n - 1; i >= 0; i--) u = u << 8 | b[i];
    float f;
    double d;
    uint32_t u32 = (uint32_t)u;
    switch (type) {
    case QC__PLY_I8:
        return (double)u - (u >> 7 ? 256.0 : 0);
    case QC__PLY_I16:
        return (double)u - (u >> 15 ? 65536.0 : 0);
    case QC__PLY_I32:
        return (double)u - (u >> 31 ? 4294967296.0 : 0);
    case QC__PLY_F32:
        memcpy(&f, &u32, sizeof f);
        return (double)f;
    case QC__PLY_F64:
        memcpy(&d, &u, sizeof d);
        return d;
    default:
        return (double)u;
    }
}

typedef struct reader {
    qc__text *t;
    const qc__ply_header *h;
    const qc__ply_element *element;
    int64_t number; /* of the element */
} reader;

static qc_status fail_here(const reader *r, const char *text) {
    if (r->h->format == QC__PLY_ASCII)
        return qc__text_fail(r->t, r->t->line, "%s %lld of %lld: %s", r->element->name,
                             (long long)r->number, (long long)r->element->count, text);
    return qc__byte_fail(r->t, r->t->p, "%s %lld of %lld: %s", r->element->name,
                         (long long)r->number, (long long)r->element->count, text);
}

static const char TRUNCATED[] = "the data end too early; the file is cut off, export it again";

static qc_status take_scalar(const reader *r, int type, double *out) {
    qc__text *t = r->t;
    if (r->h->format == QC__PLY_ASCII) {
        qc__skip_space(t);
        if (t->p == t->end) return fail_here(r, TRUNCATED);
        if (!qc__take_double(t, out))
            return fail_here(r, "not a number; the file is damaged, export it again");
        return QC_OK;
    }
    if (t->end - t->p < qc__ply_size(type)) return fail_here(r, TRUNCATED);
    *out = decode(t->p, type, r->h->format == QC__PLY_BIG);
    t->p += qc__ply_size(type);
    return QC_OK;
}

static qc_status take_list(const reader *r, const qc__ply_property *p, qc__soup *s) {
    double n, v = 0;
    qc__text *t = r->t;
    bool corners = p->role == QC__PLY_CORNERS, binary = r->h->format != QC__PLY_ASCII;
    int64_t line = binary ? r->number : t->line;
    qc_status status = take_scalar(r, p->count_type, &n);
    if (status != QC_OK) return status;
    if (!(n >= 0) || n != floor(n))
        return fail_here(r, "negative length of a list; export it again");
    int64_t least = binary ? qc__ply_size(p->type) : 1;
    if (n > (double)(t->end - t->p) / (double)least) return fail_here(r, TRUNCATED);
    if (corners && n < 3) return fail_here(r, "fewer than 3 corners; remove that face");
    if (!corners && binary) {
        t->p += (int64_t)n * least;
        return QC_OK;
    }
    if (corners && !qc__soup_face(s, line, 0)) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < (int64_t)n; i++) {
        status = take_scalar(r, p->type, &v);
        if (status != QC_OK) return status;
        if (!corners) continue;
        if (!(v >= 0 && v < INT32_MAX) || v != floor(v))
            return fail_here(r, "a corner is no valid vertex index; the file is damaged, export it "
                                "again");
        if (!qc__soup_corner(s, (int64_t)v, -1)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

/* Full intensity: the largest value of an integer type, 1 of a floating one. */
static double full(int type) {
    return type == QC__PLY_U8 ? 255 : type == QC__PLY_U16 ? 65535 : 1;
}

static qc_status add_vertex(const reader *r, const double value[], unsigned found, qc__soup *s) {
    const unsigned rgb = 7u << QC__PLY_RED, quality = 1u << QC__PLY_QUALITY;
    if (!isfinite(value[0]) || !isfinite(value[1]) || !isfinite(value[2]))
        return fail_here(r, "a coordinate is not finite; remove that vertex or export it again");
    if (!qc__soup_vertex(s, value)) return QC_ERR_NOMEM;
    if ((found & rgb) == rgb && !qc__soup_colour(s, value + QC__PLY_RED)) return QC_ERR_NOMEM;
    if ((found & quality) && !qc__soup_quality(s, value[QC__PLY_QUALITY])) return QC_ERR_NOMEM;
    return QC_OK;
}

static qc_status take_element(const reader *r, qc__soup *s) {
    double value[QC__PLY_SKIP + 1] = {0}, x;
    unsigned found = 0;
    qc_status status = QC_OK;
    for (int64_t k = 0; k < r->element->n_properties && status == QC_OK; k++) {
        const qc__ply_property *p = &r->h->property[r->element->property + k];
        if (p->count_type != QC__PLY_NONE) {
            status = take_list(r, p, s);
            continue;
        }
        status = take_scalar(r, p->type, &x);
        if (status != QC_OK) break;
        const bool colour = p->role >= QC__PLY_RED && p->role <= QC__PLY_BLUE;
        value[p->role] = colour ? x / full(p->type) : x;
        if (isfinite(x)) found |= 1u << p->role;
    }
    if (status != QC_OK || strcmp(r->element->name, "vertex") != 0) return status;
    return add_vertex(r, value, found, s);
}

static qc_status take_elements(reader *r, qc__soup *s) {
    const qc__ply_element *e = r->element;
    bool binary = r->h->format != QC__PLY_ASCII;
    bool wanted = strcmp(e->name, "vertex") == 0 || strcmp(e->name, "face") == 0;
    if (e->n_properties == 0) return QC_OK;
    if (binary && !e->has_list &&
        !wanted) { /* check_header has compared with the size of the file */
        if (e->count > (r->t->end - r->t->p) / e->least_bytes) return fail_here(r, TRUNCATED);
        r->t->p += e->count * e->least_bytes;
        return QC_OK;
    }
    for (r->number = 0; r->number < e->count; r->number++) {
        qc_status status = take_element(r, s);
        if (status != QC_OK) return status;
        if (r->number % 16384 == 0 && !qc__text_progress(r->t)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

qc_status qc__read_ply(qc__text *t, qc__soup *s) {
    qc__ply_header h = {0};
    qc_status status = qc__ply_read_header(t, &h);
    s->binary = h.format != QC__PLY_ASCII;
    for (int64_t i = 0; i < h.n_elements && status == QC_OK; i++) {
        reader r = {t, &h, &h.element[i], 0};
        status = take_elements(&r, s);
    }
    qc__free(h.element);
    qc__free(h.property);
    return status;
}
