/* Periods by quantization (docs/theory/quantization.md): the aligned map, made exact, gives
 * integers for which an injective map exists; the harmonic map with these periods is what rounding
 * makes of them. */
#include <math.h>
#include <string.h>

#include "sdk/map/round/round.h"
#include "sdk/map/periods/snap.h"

static const double read_tolerance = 1e-3; /* of the integers read from the values */
static const double noteworthy = 0.1;      /* more quads than asked for ... */
static const double most_times = 8;        /* ... and too many of them */
static const double few = 0.01;            /* edges of an open boundary, by quad */

typedef struct quantizing {
    qc__rounding *r;
    int32_t bits;
    int64_t *uv;    /* 6 n_faces */
    double *values; /* 6 n_faces */
    int8_t *rotation, *axis;
    uint8_t *point;       /* n_vertices */
    uint8_t *placed;      /* n_faces */
    int32_t *queue;       /* n_faces */
    qc_complex *feasible; /* 3 n_faces: the values, continuous off the cut */
} quantizing;

static qc_status make_exact(quantizing *q) {
    qc__rounding *r = q->r;
    const int64_t n = 3 * (int64_t)r->mesh->n_faces;
    int32_t folded = 0;
    memcpy(r->trial, r->f, sizeof *r->trial * (size_t)n);
    memcpy(r->target, r->period, sizeof *r->target * (size_t)r->seams->n_free);
    const qc_status status = qc__snap(r->ctx, r->seams, r->trial, r->target, &q->bits, &folded);
    for (int64_t c = 0; c < n && status == QC_OK; c++) {
        q->uv[2 * c] = (int64_t)ldexp(r->trial[c].re, q->bits);
        q->uv[2 * c + 1] = (int64_t)ldexp(r->trial[c].im, q->bits);
    }
    return status;
}

static void mark_points(quantizing *q) {
    const qc__rounding *r = q->r;
    for (int32_t v = 0; v < r->mesh->n_vertices; v++)
        q->point[v] = r->seams->vertex_cone[v] >= 0 || r->seamless->matching->index4[v] != 0;
}

/* Shifts the charts of the faces, the first of each part of the cut surface staying, until the
 * values are continuous off the cut. f: 3 n_faces. */
static void join_charts(quantizing *q, qc_complex *f) {
    const qc_mesh *m = q->r->mesh;
    for (int64_t c = 0; c < 3 * (int64_t)m->n_faces; c++)
        f[c] = (qc_complex){q->values[2 * c], q->values[2 * c + 1]};
    memset(q->placed, 0, (size_t)m->n_faces);
    for (int32_t first = 0; first < m->n_faces; first++) {
        int32_t n = 0;
        if (q->placed[first]) continue;
        q->queue[n++] = first;
        q->placed[first] = 1;
        for (int32_t i = 0; i < n; i++)
            for (int32_t h = 3 * q->queue[i]; h < 3 * q->queue[i] + 3; h++) {
                const int32_t g = m->twin[h];
                if (g < 0 || q->r->seams->edge_segment[m->halfedge_edge[h]] >= 0) continue;
                if (q->placed[g / 3]) continue;
                const double du = rint(f[qc_next(h)].re - f[qc_prev(g)].re);
                const double dv = rint(f[qc_next(h)].im - f[qc_prev(g)].im);
                for (int32_t c = g / 3 * 3; c < g / 3 * 3 + 3; c++) {
                    f[c].re += du;
                    f[c].im += dv;
                }
                q->placed[g / 3] = 1;
                q->queue[n++] = g / 3;
            }
    }
}

/* r->rounded from the values. */
static qc_status read_integers(quantizing *q) {
    qc__rounding *r = q->r;
    join_charts(q, q->feasible);
    const qc_status status = qc__seams_read(r->ctx, r->seams, q->feasible, r->rounded);
    for (int32_t j = 0; j < r->seams->n_free && status == QC_OK; j++) {
        const double integer = rint(r->rounded[j]), off = fabs(r->rounded[j] - integer);
        if (off > read_tolerance)
            return qc__fail(r->ctx, QC_ERR_FAILED, -1,
                            "quantization: period %d is %g off an integer", (int)j, off);
        r->rounded[j] = integer;
    }
    return status;
}

static void warn_density(const qc__rounding *r, double wanted, double made) {
    if (wanted > 0 && made > (1 + noteworthy) * wanted)
        qc__log(r->ctx, QC_LOG_WARNING,
                "singularities and features are too close for %.0f quads; %.0f are made", wanted,
                made);
}

/* On the refined mesh the harmonic map is what it is on the faces of the old one, and the feasible
 * one is that of the coarse complex, in the charts which were joined. */
static qc_status blend_imprint(quantizing *q) {
    const qc__rounding *r = q->r;
    const qc__imprint *p = &r->imprint;
    const int64_t n = 3 * (int64_t)p->mesh->n_faces;
    qc_complex *smooth = QC__NEW(r->ctx, qc_complex, n);
    qc_complex *feasible = QC__NEW(r->ctx, qc_complex, n);
    qc_complex *f = QC__NEW(r->ctx, qc_complex, n);
    qc_status status = smooth && feasible && f ? QC_OK : QC_ERR_NOMEM;
    for (int64_t c = 0; c < n && status == QC_OK; c++) {
        const int64_t first = 3 * (int64_t)p->parent[c / 3];
        const qc_complex *old = r->best + first, shifted = q->feasible[first];
        smooth[c] = (qc_complex){0, 0};
        for (int k = 0; k < 3; k++) {
            smooth[c].re += p->weight[3 * c + k] * old[k].re;
            smooth[c].im += p->weight[3 * c + k] * old[k].im;
        }
        feasible[c] = (qc_complex){p->uv[2 * c] + shifted.re - q->values[2 * first],
                                   p->uv[2 * c + 1] + shifted.im - q->values[2 * first + 1]};
    }
    if (status == QC_OK) status = qc__round_blend(r, p->mesh, smooth, feasible, f);
    for (int64_t c = 0; c < n && status == QC_OK; c++) {
        p->uv[2 * c] = f[c].re;
        p->uv[2 * c + 1] = f[c].im;
    }
    qc__free(smooth);
    qc__free(feasible);
    qc__free(f);
    return status;
}

/* Vertices of boundaries which are no features stay in the coarse complex, so their edges take
 * about a unit each: whether they are few, or not much shorter on average at this scale. */
static bool fits_boundary(const quantizing *q, double scale) {
    const qc__rounding *r = q->r;
    double length = 0;
    int32_t n = 0;
    for (int32_t h = 0; h < 3 * r->mesh->n_faces; h++) {
        const int32_t e = r->mesh->halfedge_edge[h];
        if (r->mesh->twin[h] >= 0 || (r->seamless->matching->axis && q->axis[e] >= 0)) continue;
        const qc_complex a = r->f[qc_next(h)], b = r->f[qc_prev(h)];
        length += scale * hypot(b.re - a.re, b.im - a.im);
        n++;
    }
    const double quads = scale * scale * qc__round_area(r->f, r->mesh->n_faces);
    return n <= few * quads || n <= most_times * length;
}

static qc_status quantize(quantizing *q, bool *done) {
    qc__rounding *r = q->r;
    const double sized = r->options.refine * r->seamless->sizing->target_quads;
    const double area = qc__round_area(r->f, r->mesh->n_faces);
    const double scale = sized > 0 ? sqrt(sized / area) : sqrt(r->options.refine);
    qc__round_charts(r, q->rotation, q->axis);
    if (!fits_boundary(q, scale)) {
        qc__log(r->ctx, QC_LOG_INFO, "no quantization: edges of the open boundary are too short");
        return QC_OK;
    }
    qc_status status = make_exact(q);
    mark_points(q);
    const int8_t *axis = r->seamless->matching->axis ? q->axis : NULL;
    const qc__exact_map map = {r->mesh, q->uv, q->bits, q->rotation, axis, q->point};
    double made = 0, quads;
    if (status == QC_OK)
        status = qc__quantize(r->ctx, &map, scale, sized, q->values, &made, &r->imprint);
    if (status == QC_ERR_FAILED) {
        qc__log(r->ctx, QC_LOG_INFO, "no quantization: %s", qc_ctx_error(r->ctx)->text);
        qc__clear_error(r->ctx);
        return QC_OK;
    }
    if (status == QC_OK && sized > 0 && made > most_times * sized) {
        qc__log(r->ctx, QC_LOG_INFO, "no quantization: it would take %.0f quads", made);
        qc__imprint_free(&r->imprint);
        return QC_OK;
    }
    if (status == QC_OK) status = read_integers(q);
    if (status != QC_OK) return status;
    r->coarse = false;
    r->collisions = 0;
    r->best_scale = 0;
    *done = r->quantized = true;
    warn_density(r, sized, made);
    status = qc__round_extend(r, sqrt(made / area), sized, NULL, &quads);
    if (status != QC_OK || !qc__round_folds(r)) {
        qc__imprint_free(&r->imprint);
        return status;
    }
    return blend_imprint(q);
}

bool qc__round_can_quantize(const qc__rounding *r) {
    return r->options.quantize != QC_QUANTIZE_NEVER && r->options.lattice == QC_LATTICE_QUADS &&
           r->mesh->n_poles == 0 && r->seams->n_free > 0;
}

qc_status qc__round_quantized(qc__rounding *r, bool *done) {
    const int64_t n_faces = r->mesh->n_faces;
    *done = false;
    if (!qc__round_can_quantize(r)) return QC_OK;
    quantizing q = {.r = r,
                    .uv = QC__NEW(r->ctx, int64_t, 6 * n_faces),
                    .values = QC__NEW(r->ctx, double, 6 * n_faces),
                    .rotation = QC__NEW(r->ctx, int8_t, r->mesh->n_edges),
                    .axis = QC__NEW(r->ctx, int8_t, r->mesh->n_edges),
                    .point = QC__NEW(r->ctx, uint8_t, r->mesh->n_vertices),
                    .placed = QC__NEW(r->ctx, uint8_t, n_faces),
                    .queue = QC__NEW(r->ctx, int32_t, n_faces),
                    .feasible = QC__NEW(r->ctx, qc_complex, 3 * n_faces)};
    const bool room =
        q.uv && q.values && q.rotation && q.axis && q.point && q.placed && q.queue && q.feasible;
    const qc_status status = room ? quantize(&q, done) : QC_ERR_NOMEM;
    void *const blocks[] = {q.uv,    q.values, q.rotation, q.axis,
                            q.point, q.placed, q.queue,    q.feasible};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
