/* uvs of quads which lie in one chart: the map of the quad's centre is continued to its corners. */
#include <string.h>

#include "sdk/finish/transfer.h"

/* uvs at the corners of a face, and their chart; false when there are none. */
static bool face_uvs(const qc__transfer *t, int32_t face, double uv[3][2], int32_t *chart) {
    for (int k = 0; k < 3; k++) {
        const int32_t c = qc__transfer_corner(t, face, k), i = c < 0 ? -1 : t->input->corner_uv[c];
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

typedef struct chart_at {
    int32_t face, chart;
    double uv[3][2], centre[2];
} chart_at;

/* uv at a spot, when it is of the same chart and near where the chart of the centre goes on. */
static bool same_side(const qc__transfer *t, const chart_at *c, const qc__transfer_spot *s,
                      const double x[3], double out[2]) {
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

static bool quad_uvs(const qc__transfer *t, int64_t f, const double centre[3],
                     const qc__transfer_spot *middle, double uv[4][2]) {
    chart_at c = {.face = middle->face};
    if (!face_uvs(t, c.face, c.uv, &c.chart)) return false;
    blend(c.uv, middle->weight, c.centre);
    for (int k = 0; k < 4; k++) {
        const double *x = qc__quad_corner(t, f, k);
        double inner[3];
        qc__transfer_spot s = qc__transfer_closest(t, x, c.face);
        if (same_side(t, &c, &s, x, uv[k])) continue;
        qc__quad_inside(t, f, k, QC__INWARDS, centre, inner);
        s = qc__transfer_closest(t, inner, c.face);
        if (!same_side(t, &c, &s, x, uv[k])) return false;
    }
    return true;
}

void qc__transfer_uvs(const qc__transfer *t, int64_t f, const double centre[3],
                      const qc__transfer_spot *middle) {
    double(*uv)[2] = (double(*)[2])(t->quads->uv + 8 * f);
    const bool found = quad_uvs(t, f, centre, middle, uv);
    for (int64_t c = 4 * f; c < 4 * f + 4; c++) t->quads->corner_uv[c] = found ? (int32_t)c : -1;
}

qc_status qc__transfer_charts(qc_ctx *ctx, qc__transfer *t) {
    const qc_polygon_mesh *in = t->input;
    qc_polygon_mesh *q = t->quads;
    t->chart = QC__NEW(ctx, int32_t, in->n_uvs);
    q->uv = QC__ZERO(ctx, double, 2 * (int64_t)q->n_corners);
    q->corner_uv = QC__NEW(ctx, int32_t, q->n_corners);
    if (!t->chart || !q->uv || !q->corner_uv) return QC_ERR_NOMEM;
    qc__sets_init(t->chart, in->n_uvs);
    for (int32_t f = 0; f < in->n_faces; f++)
        for (int32_t c = in->face_offset[f]; c + 1 < in->face_offset[f + 1]; c++)
            if (in->corner_uv[c] >= 0 && in->corner_uv[c + 1] >= 0)
                qc__sets_unite(t->chart, in->corner_uv[c], in->corner_uv[c + 1]);
    return QC_OK;
}
