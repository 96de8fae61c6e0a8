/* What the properties of PLY elements mean: coordinates, uvs, groups, ends of edges, and all other
 * numbers as attributes. name_0, name_1, ... in a row are one attribute `name`. */
#include "ply.h"

#include <string.h>

enum { MOST_VALUES = 4096 }; /* of a file; what is beyond is not read */

typedef struct plan {
    qc__soup *s;
    qc__ply_header *h;
    qc__ply_element *e;
    qc__ply_property *p; /* of the element */
    int64_t n_slots;
    int32_t at;
} plan;

static qc__ply_property *find(const plan *a, const char *name) {
    for (int64_t i = 0; i < a->e->n_properties; i++) {
        qc__ply_property *p = &a->p[i];
        if (p->count_type == QC__PLY_NONE && p->slot < 0 && qc__ply_is(p, name)) return p;
    }
    return NULL;
}

/* Gives the scalars of these names the slots from `slot` on, if all are there. */
static bool take(const plan *a, int n, const char *const *name, int64_t slot) {
    for (int k = 0; k < n; k++)
        if (!find(a, name[k])) return false;
    for (int k = 0; k < n; k++) find(a, name[k])->slot = slot + k;
    return true;
}

static bool is_whole(const qc__ply_property *p) {
    return p->type < QC__PLY_F32;
}

/* Full intensity: the largest value of an integer type, 1 of a floating one. */
static double full(int type) {
    return type == QC__PLY_U8 ? 255 : type == QC__PLY_U16 ? 65535 : 1;
}

static qc_status add_value(plan *a, const char *name, size_t length, int32_t kind, int32_t width) {
    qc__ply_header *h = a->h;
    qc__ply_value v = {-1, width, a->n_slots};
    a->n_slots += width;
    if (!qc__reserve(a->s->ctx, (void **)&h->value, &h->c_values, h->n_values + 1,
                     sizeof *h->value) ||
        !qc__soup_attribute_add(a->s, name, length, a->at, kind, width, &v.index))
        return QC_ERR_NOMEM;
    if (v.index < 0) return QC_OK;
    h->value[h->n_values++] = v;
    a->e->n_values++;
    return QC_OK;
}

static qc_status take_colour(plan *a) {
    static const char *const rgba[] = {"red", "green", "blue", "alpha"};
    int n = 4;
    if (!take(a, 4, rgba, a->n_slots)) n = take(a, 3, rgba, a->n_slots) ? 3 : 0;
    if (n == 0) return QC_OK;
    for (int64_t i = 0; i < a->e->n_properties; i++)
        if (a->p[i].slot >= a->n_slots) a->p[i].full = full(a->p[i].type);
    return add_value(a, "colour", 6, QC_ATTRIBUTE_LINEAR, n);
}

static qc_status take_normal(plan *a) {
    static const char *const xyz[] = {"nx", "ny", "nz"};
    if (!take(a, 3, xyz, a->n_slots)) return QC_OK;
    return add_value(a, "normal", 6, QC_ATTRIBUTE_DIRECTION, 3);
}

/* Length of the name without _k at its end; 0 when that is not there. */
static size_t stem(const qc__ply_property *p, int64_t k) {
    char suffix[24];
    const size_t n = (size_t)snprintf(suffix, sizeof suffix, "_%lld", (long long)k);
    if (p->length <= n || memcmp(p->name + p->length - n, suffix, n) != 0) return 0;
    return p->length - n;
}

/* Number of properties from p on which are one attribute. */
static int64_t row(const qc__ply_property *p, const qc__ply_property *end) {
    const size_t length = stem(p, 0);
    int64_t n = 1;
    if (length == 0) return 1;
    for (; p + n < end; n++) {
        const qc__ply_property *q = p + n;
        if (q->count_type != QC__PLY_NONE || q->slot >= 0 || is_whole(q) != is_whole(p) ||
            stem(q, n) != length || memcmp(p->name, q->name, length) != 0)
            break;
    }
    return n;
}

/* A coordinate which the file gives twice. */
static bool is_repeated(const plan *a, const qc__ply_property *p) {
    return a->at == QC_AT_VERTEX &&
           (qc__ply_is(p, "x") || qc__ply_is(p, "y") || qc__ply_is(p, "z"));
}

static qc_status take_others(plan *a) {
    const qc__ply_property *end = a->p + a->e->n_properties;
    qc_status status = QC_OK;
    for (qc__ply_property *p = a->p; p < end && status == QC_OK; p++) {
        if (a->h->n_values >= MOST_VALUES) break;
        if (p->count_type != QC__PLY_NONE || p->slot >= 0 || p->length == 0 || is_repeated(a, p))
            continue;
        const int64_t n = row(p, end);
        const bool label = is_whole(p) && !qc__ply_is(p, "quality");
        for (int64_t k = 0; k < n; k++) p[k].slot = a->n_slots + k;
        status = add_value(a, p->name, n > 1 ? stem(p, 0) : p->length,
                           label ? QC_ATTRIBUTE_LABEL : QC_ATTRIBUTE_LINEAR, (int32_t)n);
        p += n - 1;
    }
    return status;
}

static void take_lists(const plan *a) {
    for (int64_t i = 0; i < a->e->n_properties; i++) {
        qc__ply_property *p = &a->p[i];
        if (p->count_type == QC__PLY_NONE) continue;
        if (qc__ply_is(p, "vertex_indices") || qc__ply_is(p, "vertex_index"))
            p->role = QC__PLY_CORNERS;
        else if (qc__ply_is(p, "texcoord"))
            p->role = QC__PLY_UVS;
        else if (!is_whole(p))
            p->role = QC__PLY_CORNER_VALUES;
        a->h->corner_uv |= p->role == QC__PLY_UVS;
    }
}

static void take_uvs(const plan *a) {
    static const char *const names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    for (int k = 0; k < 3 && !a->e->has_uv; k++) a->e->has_uv = take(a, 2, names[k], QC__PLY_U);
    a->h->vertex_uv |= a->e->has_uv;
}

static qc_status plan_element(plan *a) {
    static const char *const xyz[] = {"x", "y", "z"}, *const group[] = {"group"};
    static const char *const ends[] = {"vertex1", "vertex2"};
    const bool vertex = strcmp(a->e->name, "vertex") == 0, face = strcmp(a->e->name, "face") == 0;
    a->e->value = a->h->n_values;
    if (strcmp(a->e->name, "edge") == 0) a->e->has_ends = take(a, 2, ends, QC__PLY_ENDS);
    if (!vertex && !face) return QC_OK;
    a->at = vertex ? QC_AT_VERTEX : QC_AT_FACE;
    if (vertex) {
        take(a, 3, xyz, QC__PLY_X);
        take_uvs(a);
    } else {
        const qc__ply_property *p = find(a, "group");
        a->e->has_group = p && is_whole(p) && take(a, 1, group, QC__PLY_GROUP);
        take_lists(a);
    }
    qc_status status = take_normal(a);
    if (status == QC_OK) status = take_colour(a);
    return status == QC_OK ? take_others(a) : status;
}

qc_status qc__ply_plan(qc__soup *s, qc__ply_header *h) {
    qc_status status = QC_OK;
    for (int64_t i = 0; i < h->n_elements && status == QC_OK; i++) {
        plan a = {s, h, &h->element[i], NULL, QC__PLY_FREE, 0};
        if (a.e->n_properties == 0) continue;
        a.p = h->property + a.e->property;
        status = plan_element(&a);
        if (a.n_slots > h->n_slots) h->n_slots = a.n_slots;
    }
    h->vertex_uv &= !h->corner_uv;
    return status;
}
