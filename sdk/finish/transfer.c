/* What the input had at the places where the quads lie: colours of vertices, groups of faces, uvs
 * of corners. */
#include <string.h>

#include "sdk/finish/internal.h"

enum { CHUNK = 256 };
/* Of the way from a corner to the centre of its quad: far enough to tell the side of a seam. */
#define INWARDS 1e-3

typedef struct spot {
    int32_t face; /* of the mesh */
    double weight[3];
} spot;

typedef struct transfer {
    const qc_polygon_mesh *input, *quads;
    const qc_mesh *mesh;
    const qc_closest_point *closest;
    qc_closest_tree *tree;
    int32_t *chart;  /* n_uvs of the input: parent in its chart (union-find) */
    double *colour;  /* 3 n_vertices  */
    int32_t *group;  /* n_faces */
    double *uv;      /* 2 n_corners ... */
    uint8_t *has_uv; /* ... and whether the quad has uvs at all */
} transfer;

static spot closest_spot(const transfer *t, const double x[3], int32_t from) {
    spot s = {from < 0 || from >= t->mesh->n_faces ? 0 : from, {0, 0, 0}};
    t->closest->query(t->tree, x, &s.face, s.weight);
    return s;
}

static int32_t input_face(const transfer *t, int32_t face) {
    return t->mesh->source_face ? t->mesh->source_face[face] : face;
}
static int32_t input_vertex(const transfer *t, int32_t face, int k) {
    const int32_t v = t->mesh->face_vertex[3 * (int64_t)face + k];
    return t->mesh->source_vertex ? t->mesh->source_vertex[v] : v;
}

/* Corner of the input which became corner k of a face: repair welds vertices, so it is known by
 * its place. -1 = none. */
static int32_t input_corner(const transfer *t, int32_t face, int k) {
    const qc_polygon_mesh *in = t->input;
    const int32_t f = input_face(t, face);
    const double *x = t->mesh->position + 3 * (int64_t)t->mesh->face_vertex[3 * (int64_t)face + k];
    for (int32_t c = f < 0 ? 0 : in->face_offset[f]; f >= 0 && c < in->face_offset[f + 1]; c++)
        if (memcmp(in->position + 3 * (int64_t)in->face_vertex[c], x, 3 * sizeof *x) == 0) return c;
    return -1;
}

/* uvs at the corners of a face, and their chart; false when there are none. */
static bool face_uvs(const transfer *t, int32_t face, double uv[3][2], int32_t *chart) {
    for (int k = 0; k < 3; k++) {
        const int32_t c = input_corner(t, face, k), i = c < 0 ? -1 : t->input->corner_uv[c];
        if (i < 0) return false;
        memcpy(uv[k], t->input->uv + 2 * (int64_t)i, 2 * sizeof(double));
        *chart = i;
        while (t->chart[*chart] != *chart) *chart = t->chart[*chart];
    }
    return true;
}

static void blend(double uv[3][2], const double w[3], double out[2]) {
    for (int i = 0; i < 2; i++) out[i] = w[0] * uv[0][i] + w[1] * uv[1][i] + w[2] * uv[2][i];
}

/* The map of the quad's centre, which is continued to its corners. */
typedef struct chart_at {
    int32_t face, chart;
    double uv[3][2], centre[2];
} chart_at;

/* uv at a spot, when it is of the same chart and near where the chart of the centre goes on. */
static bool same_side(const transfer *t, const chart_at *c, const spot *s, const double x[3],
                      double out[2]) {
    double uv[3][2], w[3], expected[2], off = 0, far = 0;
    int32_t chart;
    if (!face_uvs(t, s->face, uv, &chart) || chart != c->chart) return false;
    if (!qc__face_coordinates(t->mesh, c->face, x, w)) return false;
    blend((double(*)[2])c->uv, w, expected);
    blend(uv, s->weight, out);
    for (int i = 0; i < 2; i++) {
        off += (out[i] - expected[i]) * (out[i] - expected[i]);
        far += (expected[i] - c->centre[i]) * (expected[i] - c->centre[i]);
    }
    return off <= far;
}

static bool quad_uvs(const transfer *t, int32_t f, const double centre[3], const spot *middle,
                     double uv[4][2]) {
    chart_at c = {.face = middle->face};
    if (!face_uvs(t, c.face, c.uv, &c.chart)) return false;
    blend(c.uv, middle->weight, c.centre);
    for (int k = 0; k < 4; k++) {
        const double *x = t->quads->position + 3 * (int64_t)t->quads->face_vertex[4 * f + k];
        spot s = closest_spot(t, x, c.face);
        if (same_side(t, &c, &s, x, uv[k])) continue;
        double inner[3];
        for (int i = 0; i < 3; i++) inner[i] = x[i] + INWARDS * (centre[i] - x[i]);
        s = closest_spot(t, inner, c.face);
        if (!same_side(t, &c, &s, x, uv[k])) return false;
    }
    return true;
}

/* The group which most of the corners, drawn inwards, and the centre have; the centre's in a tie.
 */
static int32_t quad_group(const transfer *t, int32_t f, const double centre[3],
                          const spot *middle) {
    int32_t group[5], best = 0, most = 0;
    for (int k = 0; k < 5; k++) {
        spot s = *middle;
        if (k > 0) {
            const double *x =
                t->quads->position + 3 * (int64_t)t->quads->face_vertex[4 * f + k - 1];
            double inner[3];
            for (int i = 0; i < 3; i++) inner[i] = 0.5 * (x[i] + centre[i]);
            s = closest_spot(t, inner, middle->face);
        }
        const int32_t face = input_face(t, s.face);
        group[k] = face < 0 ? 0 : t->input->face_group[face];
    }
    for (int k = 0; k < 5; k++) {
        int32_t n = 0;
        for (int i = 0; i < 5; i++) n += group[i] == group[k];
        if (n > most) {
            most = n;
            best = group[k];
        }
    }
    return best;
}

static void visit_faces(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const transfer *t = arg;
    int32_t from = 0;
    (void)worker;
    for (int64_t f = begin; f < end; f++) {
        double centre[3] = {0, 0, 0};
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < 3; i++)
                centre[i] +=
                    0.25 * t->quads->position[3 * (int64_t)t->quads->face_vertex[4 * f + k] + i];
        const spot middle = closest_spot(t, centre, from);
        from = middle.face;
        if (t->group) t->group[f] = quad_group(t, (int32_t)f, centre, &middle);
        if (t->uv)
            t->has_uv[f] = quad_uvs(t, (int32_t)f, centre, &middle, (double(*)[2])(t->uv + 8 * f));
    }
}

static void visit_vertices(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const transfer *t = arg;
    int32_t from = 0;
    (void)worker;
    for (int64_t v = begin; v < end; v++) {
        const spot s = closest_spot(t, t->quads->position + 3 * v, from);
        from = s.face;
        for (int i = 0; i < 3; i++) {
            t->colour[3 * v + i] = 0;
            for (int k = 0; k < 3; k++) {
                const int32_t w = input_vertex(t, s.face, k);
                if (w >= 0)
                    t->colour[3 * v + i] += s.weight[k] * t->input->colour[3 * (int64_t)w + i];
            }
        }
    }
}

/* Equal uvs at a vertex become one. last[v]: the latest one at vertex v; next: earlier ones. */
static void share_uvs(const transfer *t, qc_polygon_mesh *q, int32_t *last, int32_t *next) {
    for (int32_t v = 0; v < q->n_vertices; v++) last[v] = -1;
    for (int32_t c = 0; c < q->n_corners; c++) {
        const double *uv = t->uv + 2 * (int64_t)c;
        q->corner_uv[c] = -1;
        if (!t->has_uv[c / 4]) continue;
        int32_t i = last[q->face_vertex[c]];
        while (i >= 0 && memcmp(q->uv + 2 * (int64_t)i, uv, 2 * sizeof *uv) != 0) i = next[i];
        if (i < 0) {
            i = q->n_uvs++;
            memcpy(q->uv + 2 * (int64_t)i, uv, 2 * sizeof *uv);
            next[i] = last[q->face_vertex[c]];
            last[q->face_vertex[c]] = i;
        }
        q->corner_uv[c] = i;
    }
}

static qc_status attach_uvs(qc_ctx *ctx, const transfer *t, qc_polygon_mesh *q) {
    int32_t *last = QC__NEW(ctx, int32_t, q->n_vertices);
    int32_t *next = QC__NEW(ctx, int32_t, q->n_corners);
    q->uv = QC__NEW(ctx, double, 2 * (int64_t)q->n_corners);
    q->corner_uv = QC__NEW(ctx, int32_t, q->n_corners);
    const qc_status status = last && next && q->uv && q->corner_uv ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) share_uvs(t, q, last, next);
    qc__free(last);
    qc__free(next);
    return status;
}

/* Moves what was found to a copy of the quads. */
static qc_status publish(qc_ctx *ctx, transfer *t, qc_polygon_mesh **out) {
    qc_polygon_mesh *q = NULL;
    qc_status status = qc_polygon_mesh_merge(ctx, 1, &t->quads, NULL, &q);
    if (status != QC_OK) return status;
    if (t->colour && !q->colour) {
        q->colour = t->colour;
        t->colour = NULL;
    }
    if (t->group && !q->face_group) {
        q->face_group = t->group;
        t->group = NULL;
        if (t->input->group_name)
            status = qc__polygon_name_groups(ctx, q, t->input->n_groups,
                                             (const char *const *)t->input->group_name,
                                             t->input->materials);
    }
    if (status == QC_OK && t->uv && !q->uv) status = attach_uvs(ctx, t, q);
    if (status == QC_OK)
        *out = q;
    else
        qc_object_release(q);
    return status;
}

static qc_status prepare(qc_ctx *ctx, transfer *t) {
    const qc_polygon_mesh *in = t->input, *q = t->quads;
    bool ok = true;
    if (in->colour) ok = (t->colour = QC__NEW(ctx, double, 3 * (int64_t)q->n_vertices)) != NULL;
    if (in->face_group) ok = ok && (t->group = QC__NEW(ctx, int32_t, q->n_faces));
    if (in->uv) {
        ok = ok && (t->uv = QC__ZERO(ctx, double, 2 * (int64_t)q->n_corners));
        ok = ok && (t->has_uv = QC__ZERO(ctx, uint8_t, q->n_faces));
        ok = ok && (t->chart = QC__NEW(ctx, int32_t, in->n_uvs));
    }
    if (!ok) return QC_ERR_NOMEM;
    if (t->chart) {
        qc__sets_init(t->chart, in->n_uvs);
        for (int32_t f = 0; f < in->n_faces; f++)
            for (int32_t c = in->face_offset[f]; c + 1 < in->face_offset[f + 1]; c++)
                if (in->corner_uv[c] >= 0 && in->corner_uv[c + 1] >= 0)
                    qc__sets_unite(t->chart, in->corner_uv[c], in->corner_uv[c + 1]);
    }
    return t->closest->build(t->closest, ctx, t->mesh->n_faces, t->mesh->position,
                             t->mesh->face_vertex, &t->tree);
}

qc_status qc_quads_transfer(qc_ctx *ctx, const qc_polygon_mesh *input, const qc_mesh *mesh,
                            const qc_polygon_mesh *quads, qc_polygon_mesh **out) {
    transfer t = {
        .input = input, .quads = quads, .mesh = mesh, .closest = &qc_closest_point_builtin};
    for (int32_t f = 0; f < quads->n_faces; f++)
        if (quads->face_offset[f + 1] - quads->face_offset[f] != 4)
            return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face %d is no quad", (int)f);
    qc_status status = prepare(ctx, &t);
    if (status == QC_OK) {
        if (t.group || t.uv) qc__parallel_for(ctx, quads->n_faces, CHUNK, visit_faces, &t);
        if (t.colour) qc__parallel_for(ctx, quads->n_vertices, CHUNK, visit_vertices, &t);
        status = publish(ctx, &t, out);
    }
    if (t.tree) t.closest->destroy(t.tree);
    qc__free(t.chart);
    qc__free(t.colour);
    qc__free(t.group);
    qc__free(t.uv);
    qc__free(t.has_uv);
    return status;
}
