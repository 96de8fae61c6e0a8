/* What the input had at the places where the quads lie: numbers of vertices, faces and corners,
 * groups of faces, uvs of corners. */
#include <string.h>

#include "sdk/finish/transfer.h"

enum { CHUNK = 256, SAMPLES = 5 };

qc__transfer_spot qc__transfer_closest(const qc__transfer *t, const double x[3], int32_t from) {
    qc__transfer_spot s = {from < 0 || from >= t->mesh->n_faces ? 0 : from, {0, 0, 0}};
    t->closest->query(t->tree, x, &s.face, s.weight);
    return s;
}

static int32_t input_face(const qc__transfer *t, int32_t face) {
    return t->mesh->source_face ? t->mesh->source_face[face] : face;
}

int32_t qc__transfer_corner(const qc__transfer *t, int32_t face, int k) {
    const qc_polygon_mesh *in = t->input;
    const int32_t f = input_face(t, face);
    const double *x = t->mesh->position + 3 * (int64_t)t->mesh->face_vertex[3 * (int64_t)face + k];
    for (int32_t c = f < 0 ? 0 : in->face_offset[f]; f >= 0 && c < in->face_offset[f + 1]; c++)
        if (memcmp(in->position + 3 * (int64_t)in->face_vertex[c], x, 3 * sizeof *x) == 0) return c;
    return -1;
}

/* --- faces ----------------------------------------------------------------------------------- */

/* Faces of the input (-1 = none) under the centre of a quad and half-way to its corners. */
static void sample_faces(const qc__transfer *t, int64_t f, const double centre[3],
                         const qc__transfer_spot *middle, int32_t face[SAMPLES]) {
    face[0] = input_face(t, middle->face);
    for (int k = 0; k < 4; k++) {
        double inner[3];
        qc__quad_inside(t, f, k, 0.5, centre, inner);
        face[k + 1] = input_face(t, qc__transfer_closest(t, inner, middle->face).face);
    }
}

/* The sample whose value (of `width` numbers) most have; the first in a tie. */
static int most_common(const double *value[SAMPLES], int32_t width) {
    int best = 0, most = 0;
    for (int k = 0; k < SAMPLES; k++) {
        int n = 0;
        for (int i = 0; i < SAMPLES; i++)
            n += memcmp(value[i], value[k], (size_t)width * sizeof(double)) == 0;
        if (n > most) {
            most = n;
            best = k;
        }
    }
    return best;
}

static int32_t quad_group(const qc__transfer *t, const int32_t face[SAMPLES], uint8_t *mixed) {
    double group[SAMPLES];
    const double *value[SAMPLES];
    for (int k = 0; k < SAMPLES; k++) {
        group[k] = face[k] < 0 ? 0 : t->input->face_group[face[k]];
        value[k] = &group[k];
    }
    for (int k = 1; k < SAMPLES; k++) *mixed |= group[k] != group[0];
    return (int32_t)group[most_common(value, 1)];
}

/* Labels: the most common one; otherwise the mean. */
static void average(const qc__transferred *a, const int32_t face[SAMPLES], int64_t f) {
    const int32_t width = a->from->width;
    const double *value[SAMPLES];
    double *to = a->to + width * f;
    for (int k = 0; k < SAMPLES; k++)
        value[k] = a->from->value + (int64_t)width * (face[k] < 0 ? face[0] : face[k]);
    if (face[0] < 0) return;
    if (a->from->kind == QC_ATTRIBUTE_LABEL) {
        memcpy(to, value[most_common(value, width)], (size_t)width * sizeof *to);
        return;
    }
    double length = 0;
    for (int32_t j = 0; j < width; j++) {
        for (int k = 0; k < SAMPLES; k++) to[j] += value[k][j] / SAMPLES;
        length += to[j] * to[j];
    }
    if (a->from->kind == QC_ATTRIBUTE_DIRECTION)
        for (int32_t j = 0; j < width && length > 0; j++) to[j] /= sqrt(length);
}

/* --- corners --------------------------------------------------------------------------------- */

/* The place of corner k on the side of its quad: the face is that of a point inwards. */
static qc__transfer_spot corner_spot(const qc__transfer *t, int64_t f, int k,
                                     const double centre[3], int32_t from) {
    double inner[3], w[3];
    qc__quad_inside(t, f, k, QC__INWARDS, centre, inner);
    qc__transfer_spot s = qc__transfer_closest(t, inner, from);
    if (!qc__face_coordinates(t->mesh, s.face, qc__quad_corner(t, f, k), w)) return s;
    if (fmin(w[0], fmin(w[1], w[2])) < -1e-9) return s;
    for (int i = 0; i < 3; i++) s.weight[i] = fmax(w[i], 0);
    return s;
}

static bool has(const qc__transfer *t, int32_t at) {
    for (int32_t i = 0; i < t->n_attributes; i++)
        if (t->attribute[i].to && t->attribute[i].at == at) return true;
    return false;
}

/* Samples what is at vertices or corners at one of them. */
static void sample(const qc__transfer *t, int32_t at, const qc__transfer_spot *s, int64_t element) {
    for (int32_t i = 0; i < t->n_attributes; i++)
        if (t->attribute[i].to && t->attribute[i].at == at)
            qc__transfer_sample(t, &t->attribute[i], s, element);
}

static void visit_face(const qc__transfer *t, int64_t f, int32_t *from) {
    double centre[3] = {0, 0, 0};
    int32_t face[SAMPLES];
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) centre[i] += 0.25 * qc__quad_corner(t, f, k)[i];
    const qc__transfer_spot middle = qc__transfer_closest(t, centre, *from);
    *from = middle.face;
    if (t->chart) qc__transfer_uvs(t, f, centre, &middle);
    for (int k = 0; k < 4 && has(t, QC_AT_CORNER); k++) {
        const qc__transfer_spot s = corner_spot(t, f, k, centre, middle.face);
        sample(t, QC_AT_CORNER, &s, 4 * f + k);
    }
    if (!t->group && !has(t, QC_AT_FACE)) return;
    sample_faces(t, f, centre, &middle, face);
    if (t->group) t->group[f] = quad_group(t, face, &t->mixed[f]);
    for (int32_t i = 0; i < t->n_attributes; i++)
        if (t->attribute[i].to && t->attribute[i].at == QC_AT_FACE)
            average(&t->attribute[i], face, f);
}

static void visit_faces(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    int32_t from = 0;
    (void)worker;
    for (int64_t f = begin; f < end; f++) visit_face(arg, f, &from);
}

static void visit_vertices(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const qc__transfer *t = arg;
    int32_t from = 0;
    (void)worker;
    for (int64_t v = begin; v < end; v++) {
        const qc__transfer_spot s = qc__transfer_closest(t, t->quads->position + 3 * v, from);
        from = s.face;
        sample(t, QC_AT_VERTEX, &s, v);
    }
}

/* --- all of it ------------------------------------------------------------------------------- */

/* Gives the copy of the quads the arrays which are filled. */
static qc_status prepare(qc_ctx *ctx, qc__transfer *t) {
    const qc_polygon_mesh *in = t->input;
    qc_polygon_mesh *q = t->quads;
    qc_status status = QC_OK;
    if (in->face_group && !q->face_group) {
        t->group = q->face_group = QC__ZERO(ctx, int32_t, q->n_faces);
        t->mixed = QC__ZERO(ctx, uint8_t, q->n_faces);
        if (!t->group || !t->mixed) return QC_ERR_NOMEM;
        if (in->group_name)
            status = qc__polygon_name_groups(ctx, q, in->n_groups,
                                             (const char *const *)in->group_name, in->materials);
    }
    if (status == QC_OK && in->uv && !q->uv) status = qc__transfer_charts(ctx, t);
    if (status == QC_OK) status = qc__transfer_attributes(ctx, t);
    if (status != QC_OK) return status;
    return t->closest->build(t->closest, ctx, t->mesh->n_faces, t->mesh->position,
                             t->mesh->face_vertex, &t->tree);
}

static qc_status fill(qc_ctx *ctx, qc__transfer *t) {
    qc_polygon_mesh *q = t->quads;
    if (t->group || t->chart || has(t, QC_AT_FACE) || has(t, QC_AT_CORNER))
        qc__parallel_for(ctx, q->n_faces, CHUNK, visit_faces, t);
    if (has(t, QC_AT_VERTEX)) qc__parallel_for(ctx, q->n_vertices, CHUNK, visit_vertices, t);
    if (!t->chart) return QC_OK;
    return qc__number_corner_values(ctx, q->n_vertices, q->n_corners, q->face_vertex, 2, q->uv,
                                    q->corner_uv, q->uv, &q->n_uvs);
}

qc_status qc__quads_transfer(qc_ctx *ctx, const qc_polygon_mesh *input, const qc_mesh *mesh,
                             const qc_polygon_mesh *quads, qc_polygon_mesh **out, int32_t *n_mixed,
                             int32_t *first) {
    qc__transfer t = {.input = input, .mesh = mesh, .closest = &qc_closest_point_builtin};
    for (int32_t f = 0; f < quads->n_faces; f++)
        if (quads->face_offset[f + 1] - quads->face_offset[f] != 4)
            return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face %d is no quad", (int)f);
    qc_status status = qc_polygon_mesh_merge(ctx, 1, &quads, NULL, &t.quads);
    if (status == QC_OK) status = prepare(ctx, &t);
    if (status == QC_OK) status = fill(ctx, &t);
    *n_mixed = 0;
    *first = -1;
    for (int32_t f = quads->n_faces; status == QC_OK && t.mixed && f-- > 0;)
        if (t.mixed[f]) {
            ++*n_mixed;
            *first = f;
        }
    if (t.tree) t.closest->destroy(t.tree);
    qc__free(t.mixed);
    qc__free(t.chart);
    qc__free(t.attribute);
    if (status == QC_OK)
        *out = t.quads;
    else
        qc_object_release(t.quads);
    return status;
}

qc_status qc_quads_transfer(qc_ctx *ctx, const qc_polygon_mesh *input, const qc_mesh *mesh,
                            const qc_polygon_mesh *quads, qc_polygon_mesh **out) {
    int32_t n_mixed, first;
    return qc__quads_transfer(ctx, input, mesh, quads, out, &n_mixed, &first);
}
