/* Named numbers of the input at a place of its surface: interpolated with barycentric coordinates,
 * so that weights which sum to 1 still do; directions made unit vectors; labels those of the
 * nearest vertex; of joints with weights the heaviest ones. */
#include <string.h>

#include "sdk/finish/transfer.h"

enum { MOST_JOINTS = 16 };

/* --- what is transferred --------------------------------------------------------------------- */

/* Element of the input which an attribute of vertices or corners has at corner k of a face; -1 =
 * none. */
static int32_t element_at(const qc__transfer *t, const qc_attribute *a, int32_t face, int k) {
    const int32_t c = qc__transfer_corner(t, face, k);
    if (a->at == QC_AT_CORNER) return c;
    if (c >= 0) return t->input->face_vertex[c];
    const int32_t v = t->mesh->face_vertex[3 * (int64_t)face + k];
    return t->mesh->source_vertex ? t->mesh->source_vertex[v] : v;
}

/* Whether repair has merged vertices with different values: then the sides of a crease differ. */
static bool is_split(const qc__transfer *t, const qc_attribute *a) {
    const qc_mesh *m = t->mesh;
    const size_t size = (size_t)a->width * sizeof(double);
    for (int64_t h = 0; m->source_vertex && h < 3 * (int64_t)m->n_faces; h++) {
        const int32_t v = m->source_vertex[m->face_vertex[h]];
        const int32_t w = element_at(t, a, (int32_t)(h / 3), (int)(h % 3));
        if (v >= 0 && w >= 0 && v != w &&
            memcmp(a->value + (int64_t)a->width * v, a->value + (int64_t)a->width * w, size) != 0)
            return true;
    }
    return false;
}

/* The weights of joints. */
static const qc_attribute *weights_of(const qc__transfer *t, const qc_attribute *joints) {
    const char *name = strcmp(joints->name, "joint") == 0    ? "weight"
                       : strcmp(joints->name, "joints") == 0 ? "weights"
                                                             : NULL;
    if (!name || joints->at != QC_AT_VERTEX || joints->width > MOST_JOINTS) return NULL;
    const qc_attribute *w = qc_polygon_mesh_attribute(t->input, QC_AT_VERTEX, name);
    return w && w->width == joints->width ? w : NULL;
}

static qc_status add(qc_ctx *ctx, qc__transfer *t, const qc_attribute *from, qc__transferred *out) {
    out->from = from;
    out->at = from->at;
    if (from->at == QC_AT_VERTEX && from->kind == QC_ATTRIBUTE_DIRECTION && is_split(t, from))
        out->at = QC_AT_CORNER;
    if (qc_polygon_mesh_attribute(t->quads, out->at, from->name)) return QC_OK; /* kept */
    return qc_polygon_mesh_add_attribute(ctx, t->quads, from->name, out->at, from->kind,
                                         from->width, &out->to);
}

/* Joints take their weights along. */
static void pair(qc__transfer *t) {
    for (int32_t i = 0; i < t->n_attributes; i++) {
        qc__transferred *joints = &t->attribute[i];
        joints->weight_from = joints->to ? weights_of(t, joints->from) : NULL;
        for (int32_t k = 0; joints->weight_from && k < t->n_attributes; k++) {
            if (t->attribute[k].from != joints->weight_from) continue;
            joints->weight = t->attribute[k].to;
            t->attribute[k].to = NULL;
        }
    }
}

qc_status qc__transfer_attributes(qc_ctx *ctx, qc__transfer *t) {
    const int32_t n = t->input->n_attributes;
    t->attribute = QC__ZERO(ctx, qc__transferred, n);
    qc_status status = t->attribute ? QC_OK : QC_ERR_NOMEM;
    for (int32_t i = 0; i < n && status == QC_OK; i++)
        status = add(ctx, t, &t->input->attribute[i], &t->attribute[i]);
    if (status != QC_OK) return status;
    t->n_attributes = n;
    pair(t);
    return QC_OK;
}

/* --- values ---------------------------------------------------------------------------------- */

static void unit(double *x, int32_t n) {
    double length = 0;
    for (int32_t j = 0; j < n; j++) length += x[j] * x[j];
    for (int32_t j = 0; j < n && length > 0; j++) x[j] /= sqrt(length);
}

typedef struct influence {
    double joint, weight;
} influence;

/* The weights of the three corners together; returns how many joints they have. */
static int gather(const qc__transferred *a, const int32_t v[3], const double w[3],
                  influence all[3 * MOST_JOINTS]) {
    int n = 0;
    for (int k = 0; k < 3; k++)
        for (int32_t j = 0; v[k] >= 0 && j < a->from->width; j++) {
            const int64_t at = (int64_t)a->from->width * v[k] + j;
            const double joint = a->from->value[at], weight = w[k] * a->weight_from->value[at];
            int i = 0;
            while (i < n && all[i].joint != joint) i++;
            if (i == n) all[n++] = (influence){joint, 0};
            all[i].weight += weight;
        }
    return n;
}

/* The heaviest joints, scaled such that their weights sum up to what all do. */
static void sample_joints(const qc__transferred *a, const int32_t v[3], const double w[3],
                          double *joint, double *weight) {
    const int32_t width = a->from->width;
    influence all[3 * MOST_JOINTS];
    const int n = gather(a, v, w, all);
    double whole = 0, kept = 0;
    for (int i = 0; i < n; i++) whole += all[i].weight;
    for (int32_t j = 0; j < width && j < n; j++) {
        int best = j;
        for (int i = j + 1; i < n; i++)
            if (all[i].weight > all[best].weight ||
                (all[i].weight == all[best].weight && all[i].joint < all[best].joint))
                best = i;
        const influence found = all[best];
        all[best] = all[j];
        all[j] = found;
        joint[j] = found.weight > 0 ? found.joint : 0;
        weight[j] = found.weight;
        kept += found.weight;
    }
    for (int32_t j = 0; j < width && kept > 0 && kept != whole; j++) weight[j] *= whole / kept;
}

void qc__transfer_sample(const qc__transfer *t, const qc__transferred *a,
                         const qc__transfer_spot *s, int64_t element) {
    const qc_attribute *from = a->from;
    const int32_t width = from->width;
    double *to = a->to + width * element, w[3], sum = 0;
    int32_t v[3], heaviest = 0;
    for (int k = 0; k < 3; k++) {
        v[k] = element_at(t, from, s->face, k);
        w[k] = v[k] < 0 ? 0 : s->weight[k];
        sum += w[k];
        if (w[k] > w[heaviest]) heaviest = k;
    }
    if (a->weight) {
        sample_joints(a, v, w, to, a->weight + width * element);
        return;
    }
    const bool label = from->kind == QC_ATTRIBUTE_LABEL;
    for (int k = 0; k < 3; k++) {
        const double share = label ? k == heaviest : sum > 0 ? w[k] / sum : 0;
        for (int32_t j = 0; v[k] >= 0 && j < width; j++)
            to[j] += share * from->value[(int64_t)width * v[k] + j];
    }
    if (from->kind == QC_ATTRIBUTE_DIRECTION) unit(to, width);
}
