/* PLY: the data behind the header, ASCII or binary of either byte order. What the plan has no use
 * for is skipped by its declared type. */
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

/* A list of the element at hand: numbers number[begin] .. number[begin + n - 1]. */
typedef struct list {
    qc__ply_property *property;
    int64_t begin, n;
} list;

typedef struct reader {
    qc__text *t;
    qc__soup *s;
    const qc__ply_header *h;
    const qc__ply_element *element;
    int64_t number, line; /* of the element */
    double *slot;         /* h->n_slots */
    list *list;
    double *value; /* of the lists */
    int64_t n_lists, n_values, c_lists, c_values;
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

static bool is_index(double v) {
    return v >= 0 && v < INT32_MAX && v == floor(v);
}

static qc_status take_values(reader *r, const qc__ply_property *p, int64_t n) {
    const bool wanted = p->role != QC__PLY_SKIP, corners = p->role == QC__PLY_CORNERS;
    double v = 0;
    if (wanted && !qc__reserve(r->t->ctx, (void **)&r->value, &r->c_values, r->n_values + n,
                               sizeof *r->value))
        return QC_ERR_NOMEM;
    for (int64_t i = 0; i < n; i++) {
        const qc_status status = take_scalar(r, p->type, &v);
        if (status != QC_OK) return status;
        if (corners && !is_index(v))
            return fail_here(r, "a corner is no valid vertex index; the file is damaged, export it "
                                "again");
        if (wanted) r->value[r->n_values++] = isfinite(v) ? v : 0;
    }
    return QC_OK;
}

static qc_status take_list(reader *r, qc__ply_property *p) {
    double n;
    qc__text *t = r->t;
    const bool corners = p->role == QC__PLY_CORNERS, binary = r->h->format != QC__PLY_ASCII;
    const int64_t line = binary ? r->number : t->line;
    qc_status status = take_scalar(r, p->count_type, &n);
    if (status != QC_OK) return status;
    if (!(n >= 0) || n != floor(n))
        return fail_here(r, "negative length of a list; export it again");
    int64_t least = binary ? qc__ply_size(p->type) : 1;
    if (n > (double)(t->end - t->p) / (double)least) return fail_here(r, TRUNCATED);
    if (corners && n < 3) return fail_here(r, "fewer than 3 corners; remove that face");
    if (p->role == QC__PLY_SKIP && binary) {
        t->p += (int64_t)n * least;
        return QC_OK;
    }
    if (!qc__reserve(t->ctx, (void **)&r->list, &r->c_lists, r->n_lists + 1, sizeof *r->list))
        return QC_ERR_NOMEM;
    if (corners) r->line = line;
    r->list[r->n_lists++] = (list){p, r->n_values, (int64_t)n};
    return take_values(r, p, (int64_t)n);
}

static qc_status add_values(const reader *r) {
    for (int64_t i = 0; i < r->element->n_values; i++) {
        const qc__ply_value *v = &r->h->value[r->element->value + i];
        if (!qc__soup_set(r->s, v->index, r->slot + v->slot)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static qc_status add_vertex(const reader *r) {
    const double *x = r->slot + QC__PLY_X, *uv = r->slot + QC__PLY_U;
    for (int i = 0; i < 3; i++)
        if (!isfinite(x[i]))
            return fail_here(r,
                             "a coordinate is not finite; remove that vertex or export it again");
    if (!qc__soup_vertex(r->s, x)) return QC_ERR_NOMEM;
    if (r->h->vertex_uv && !qc__soup_uv(r->s, uv[0], uv[1])) return QC_ERR_NOMEM;
    return add_values(r);
}

static const list *find_list(const reader *r, int role) {
    for (int64_t i = 0; i < r->n_lists; i++)
        if (r->list[i].property->role == role) return &r->list[i];
    return NULL;
}

/* The attributes of corner k of the face's n; the first face with values tells how many a corner
 * has. */
static qc_status add_corner_values(const reader *r, int64_t k, int64_t n) {
    for (int64_t i = 0; i < r->n_lists; i++) {
        const list *l = &r->list[i];
        qc__ply_property *p = l->property;
        int32_t index = -1;
        if (p->role != QC__PLY_CORNER_VALUES || l->n == 0 || l->n % n != 0 || l->n / n > 64)
            continue;
        const bool normal = qc__ply_is(p, "normal");
        if (!qc__soup_attribute_add(r->s, p->name, p->length, QC_AT_CORNER,
                                    normal ? QC_ATTRIBUTE_DIRECTION : QC_ATTRIBUTE_LINEAR,
                                    (int32_t)(l->n / n), &index))
            return QC_ERR_NOMEM;
        if (index >= 0 && !qc__soup_set(r->s, index, r->value + l->begin + k * (l->n / n)))
            return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static qc_status add_face(const reader *r) {
    const list *corners = find_list(r, QC__PLY_CORNERS), *uvs = find_list(r, QC__PLY_UVS);
    const double group = r->element->has_group ? r->slot[QC__PLY_GROUP] : 0;
    qc__soup *s = r->s;
    if (!corners) return QC_OK;
    if (!qc__soup_face(s, r->line, is_index(group) ? (int32_t)group : 0)) return QC_ERR_NOMEM;
    if (uvs && uvs->n != 2 * corners->n) uvs = NULL;
    for (int64_t k = 0; k < corners->n; k++) {
        const int64_t v = (int64_t)r->value[corners->begin + k];
        int64_t uv = r->h->vertex_uv ? v : -1;
        if (uvs) {
            const double *x = r->value + uvs->begin + 2 * k;
            uv = s->n_uv / 2;
            s->uv_by_corner = true;
            if (!qc__soup_uv(s, x[0], x[1])) return QC_ERR_NOMEM;
        }
        if (!qc__soup_corner(s, v, uv)) return QC_ERR_NOMEM;
        const qc_status status = add_corner_values(r, k, corners->n);
        if (status != QC_OK) return status;
    }
    return add_values(r);
}

static qc_status add_edge(const reader *r) {
    const double *end = r->slot + QC__PLY_ENDS;
    if (!is_index(end[0]) || !is_index(end[1]))
        return fail_here(r,
                         "an end is no valid vertex index; the file is damaged, export it again");
    return qc__soup_line(r->s, (int64_t)end[0], (int64_t)end[1]) ? QC_OK : QC_ERR_NOMEM;
}

static bool is_vertex(const qc__ply_element *e) {
    return strcmp(e->name, "vertex") == 0;
}
static bool is_face(const qc__ply_element *e) {
    return strcmp(e->name, "face") == 0;
}

static qc_status take_element(reader *r) {
    double x;
    qc_status status = QC_OK;
    r->n_lists = r->n_values = 0;
    for (int64_t k = 0; k < r->element->n_properties && status == QC_OK; k++) {
        qc__ply_property *p = &r->h->property[r->element->property + k];
        if (p->count_type != QC__PLY_NONE) {
            status = take_list(r, p);
            continue;
        }
        status = take_scalar(r, p->type, &x);
        if (status != QC_OK || p->slot < 0) continue;
        const bool coordinate = p->slot < QC__PLY_U && is_vertex(r->element);
        r->slot[p->slot] = isfinite(x) || coordinate ? x / p->full : 0;
    }
    if (status != QC_OK) return status;
    if (is_vertex(r->element)) return add_vertex(r);
    if (is_face(r->element)) return add_face(r);
    return r->element->has_ends ? add_edge(r) : QC_OK;
}

static qc_status take_elements(reader *r) {
    const qc__ply_element *e = r->element;
    bool binary = r->h->format != QC__PLY_ASCII;
    bool wanted = is_vertex(e) || is_face(e) || e->has_ends;
    if (e->n_properties == 0) return QC_OK;
    if (binary && !e->has_list &&
        !wanted) { /* check_header has compared with the size of the file */
        if (e->count > (r->t->end - r->t->p) / e->least_bytes) return fail_here(r, TRUNCATED);
        r->t->p += e->count * e->least_bytes;
        return QC_OK;
    }
    for (r->number = 0; r->number < e->count; r->number++) {
        qc_status status = take_element(r);
        if (status != QC_OK) return status;
        if (r->number % 16384 == 0 && !qc__text_progress(r->t)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

qc_status qc__read_ply(qc__text *t, qc__soup *s) {
    qc__ply_header h = {0};
    reader r = {.t = t, .s = s, .h = &h};
    qc_status status = qc__ply_read_header(t, s, &h);
    s->binary = h.format != QC__PLY_ASCII;
    if (status == QC_OK && !(r.slot = QC__ZERO(t->ctx, double, h.n_slots + QC__PLY_FREE)))
        status = QC_ERR_NOMEM;
    for (int64_t i = 0; i < h.n_elements && status == QC_OK; i++) {
        r.element = &h.element[i];
        status = take_elements(&r);
    }
    void *arrays[] = {h.element, h.property, h.value, r.slot, r.list, r.value};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    return status;
}
