/* qc_quads_relax: squares, or rectangles, by a local-global method on the surface
 * (stages/finish/finish.md). */
#include <string.h>

#include "sdk/finish/internal.h"

enum { IMPROVE_ROUNDS = 10 /* of each kind in turn */ };

/* In edge lengths: a gap which does not count. */
#define NO_GAP 1e-3
/* Vertices of quads with a gap beyond this part of the largest one stay; the second is tried where
 * the first does not keep the largest from growing. */
static const double pinned_part[] = {0.6, 0.3};
enum { ATTEMPTS = sizeof pinned_part / sizeof *pinned_part };

static qc_status check(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *q) {
    for (int32_t f = 0; f < q->n_faces; f++)
        if (q->face_offset[f + 1] - q->face_offset[f] != 4)
            return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face %d is no quad; only quads are relaxed",
                            (int)f);
    for (int32_t v = 0; q->source_face && v < q->n_vertices; v++)
        if (q->source_face[v] < -1 || q->source_face[v] >= mesh->n_faces)
            return qc__fail(ctx, QC_ERR_ARGUMENT, v,
                            "vertex %d comes from face %d of a mesh with %d faces; give the mesh "
                            "the quads were made from",
                            (int)v, (int)q->source_face[v], (int)mesh->n_faces);
    return QC_OK;
}

/* Vertices without a source get the closest point as theirs; they move there with their first
 * step. */
static void find_spots(qc__relaxation *r) {
    const qc_polygon_mesh *q = r->quads;
    for (int32_t v = 0; v < q->n_vertices; v++) {
        qc__spot *spot = &r->spot[v];
        spot->face = q->source_face ? q->source_face[v] : -1;
        spot->arc = 0;
        if (spot->face < 0) {
            spot->face = 0;
            r->closest->query(r->tree, r->position + 3 * (int64_t)v, &spot->face, spot->weight);
        } else {
            memcpy(spot->weight, q->source_barycentric + 3 * (int64_t)v, sizeof spot->weight);
        }
    }
}

static qc_status prepare(qc_ctx *ctx, const uint8_t *feature, qc__relaxation *r) {
    const qc_mesh *m = r->mesh;
    const int64_t n = r->quads->n_vertices, n_faces = r->quads->n_faces;
    r->normal = QC__NEW(ctx, double, 3 * (int64_t)m->n_faces);
    r->position = QC__NEW(ctx, double, 3 * n);
    r->spot = QC__NEW(ctx, qc__spot, n);
    r->anchor = QC__NEW(ctx, int32_t, n);
    r->size = QC__NEW(ctx, double, n_faces);
    r->ratio = QC__NEW(ctx, double, n_faces);
    r->rectangle = QC__NEW(ctx, qc__rectangle, n_faces);
    r->scratch = QC__NEW(ctx, double, n_faces);
    r->pinned = QC__ZERO(ctx, uint8_t, n);
    if (!r->normal || !r->position || !r->spot || !r->anchor || !r->size || !r->ratio ||
        !r->rectangle || !r->scratch || !r->pinned)
        return QC_ERR_NOMEM;
    memcpy(r->position, r->quads->position, (size_t)(3 * n) * sizeof *r->position);
    qc_status status = qc_mesh_geometry(ctx, m, NULL, NULL, NULL, NULL, r->normal, NULL);
    if (status == QC_OK)
        status =
            r->closest->build(r->closest, ctx, m->n_faces, m->position, m->face_vertex, &r->tree);
    if (status == QC_OK) status = qc__neighbours_create(ctx, r->quads, &r->around);
    if (status == QC_OK) status = qc__curves_create(ctx, m, feature, &r->curves);
    if (status != QC_OK) return status;
    find_spots(r);
    qc__measure_sizes(ctx, r);
    return qc__find_anchors(ctx, r);
}

static void clear(qc__relaxation *r) {
    if (r->tree) r->closest->destroy(r->tree);
    qc__neighbours_clear(&r->around);
    qc__curves_clear(&r->curves);
    qc__free(r->normal);
    qc__free(r->position);
    qc__free(r->spot);
    qc__free(r->anchor);
    qc__free(r->size);
    qc__free(r->ratio);
    qc__free(r->rectangle);
    qc__free(r->scratch);
    qc__free(r->pinned);
}

/* The largest gap, but not less than one which counts. */
static double largest(const qc__relaxation *r, const double *gap) {
    double most = 0, size = 0;
    for (int32_t f = 0; f < r->quads->n_faces; f++) {
        most = fmax(most, gap[f]);
        size += r->size[f] / r->quads->n_faces;
    }
    return fmax(most, NO_GAP * size);
}

static void pin(qc__relaxation *r, const double *gap, double limit) {
    for (int32_t f = 0; f < r->quads->n_faces; f++)
        for (int k = 0; gap[f] > limit && k < 4; k++)
            r->pinned[r->quads->face_vertex[4 * (int64_t)f + k]] = 1;
}

static void restart(qc__relaxation *r, const qc__spot *start) {
    const size_t n = (size_t)r->quads->n_vertices;
    memcpy(r->position, r->quads->position, 3 * n * sizeof *r->position);
    memcpy(r->spot, start, n * sizeof *r->spot);
}

static double least_quality(const qc__relaxation *r) {
    double least = 1;
    for (int32_t f = 0; f < r->quads->n_faces; f++) least = fmin(least, qc__quad_quality(r, f));
    return least;
}

static qc_status iterate(qc_ctx *ctx, int32_t rounds, qc__relaxation *r) {
    qc__visit *const kind[] = {qc__towards_squares, qc__improve_all, qc__improve_worst};
    const int32_t n = rounds + 2 * IMPROVE_ROUNDS;
    qc_status status = QC_OK;
    for (int32_t i = 0; i < n && status == QC_OK; i++) {
        const qc__range outer = qc__range_begin(ctx, NULL, (double)i / n, (i + 1.0) / n);
        const int32_t phase = i < rounds ? 0 : 1 + (i - rounds) / IMPROVE_ROUNDS;
        if (phase > 0 && (i - rounds) % IMPROVE_ROUNDS == 0) r->least = least_quality(r);
        status = qc__visit_all(ctx, r, kind[phase]);
        qc__range_end(ctx, outer);
    }
    return status;
}

static qc_status measure(qc_ctx *ctx, double from, double *gap, int32_t *nearest,
                         const qc__relaxation *r) {
    const qc__range outer = qc__range_begin(ctx, NULL, from, from + 0.1);
    const qc_status status = qc__measure_gaps(ctx, r, gap, nearest);
    qc__range_end(ctx, outer);
    return status;
}

/* Relaxes from the start with more and more vertices pinned, until the largest gap does not grow.
 * Where the quality of quads demands that it grows it does. */
static qc_status relax(qc_ctx *ctx, int32_t rounds, const qc__spot *start, double *first,
                       int32_t *nearest, qc__relaxation *r) {
    qc_status status = measure(ctx, 0, first, nearest, r);
    const double limit = largest(r, first);
    bool done = false;
    for (int i = 0; i < ATTEMPTS && !done && status == QC_OK; i++) {
        const double share = 0.8 / ATTEMPTS, begin = 0.1 + share * i;
        const qc__range outer = qc__range_begin(ctx, NULL, begin, begin + share - 0.1);
        pin(r, first, pinned_part[i] * limit);
        restart(r, start);
        status = iterate(ctx, rounds, r);
        qc__range_end(ctx, outer);
        if (status == QC_OK) status = measure(ctx, begin + share - 0.1, r->scratch, nearest, r);
        done = largest(r, r->scratch) <= limit * (1 + 1e-12);
    }
    if (status != QC_OK) return status;
    const qc__range outer = qc__range_begin(ctx, NULL, 0.9, 1);
    status = qc__quads_untangle(ctx, largest(r, r->scratch) * (1 + 1e-12), nearest, r);
    qc__range_end(ctx, outer);
    return status;
}

static qc_status run(qc_ctx *ctx, int32_t rounds, qc__relaxation *r) {
    const int64_t n = r->quads->n_vertices;
    qc__spot *start = QC__NEW(ctx, qc__spot, n);
    double *first = QC__NEW(ctx, double, r->quads->n_faces);
    int32_t *nearest = QC__NEW(ctx, int32_t, r->mesh->n_vertices);
    qc_status status = start && first && nearest ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        memcpy(start, r->spot, (size_t)n * sizeof *start);
        status = relax(ctx, rounds, start, first, nearest, r);
    }
    qc__free(start);
    qc__free(first);
    qc__free(nearest);
    return status;
}

/* Lines whose first vertex slides begin on another edge of the surface. */
static void set_source_edges(const qc__relaxation *r, qc_polygon_mesh *q) {
    for (int32_t i = 0; q->source_edge && r->quads->source_edge && i < q->n_lines; i++) {
        const int32_t v = q->line[2 * (int64_t)i];
        q->source_edge[i] = r->anchor[v] < 0
                                ? r->quads->source_edge[i]
                                : qc__curve_edge(&r->curves, r->anchor[v], r->spot[v].arc);
    }
}

/* The same quads at the new places. */
static qc_status publish(qc_ctx *ctx, const qc__relaxation *r, qc_polygon_mesh **out) {
    const int64_t n = r->quads->n_vertices;
    qc_polygon_mesh *q = NULL;
    const qc_status status = qc_polygon_mesh_merge(ctx, 1, &r->quads, NULL, &q);
    if (status != QC_OK) return status;
    if (!q->source_face) q->source_face = QC__NEW(ctx, int32_t, n);
    if (!q->source_barycentric) q->source_barycentric = QC__NEW(ctx, double, 3 * n);
    if (!q->source_face || !q->source_barycentric) {
        qc_object_release(q);
        return QC_ERR_NOMEM;
    }
    set_source_edges(r, q);
    memcpy(q->position, r->position, (size_t)(3 * n) * sizeof *q->position);
    for (int64_t v = 0; v < n; v++) {
        q->source_face[v] = r->spot[v].face;
        memcpy(q->source_barycentric + 3 * v, r->spot[v].weight, sizeof r->spot[v].weight);
    }
    *out = q;
    return QC_OK;
}

qc_status qc_quads_relax(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads,
                         const qc_relax_options *options, qc_polygon_mesh **out) {
    qc_relax_options o = QC_RELAX_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    qc__relaxation r = {.mesh = mesh,
                        .quads = quads,
                        .quality = o.quality,
                        .uniformity = o.uniformity,
                        .rectangles = o.rectangles,
                        .closest = o.closest ? o.closest : &qc_closest_point_builtin};
    qc_status status = check(ctx, mesh, quads);
    if (status == QC_OK) status = prepare(ctx, o.feature, &r);
    if (status == QC_OK && o.rounds > 0 && quads->n_faces > 0) status = run(ctx, o.rounds, &r);
    if (status == QC_OK) status = publish(ctx, &r, out);
    clear(&r);
    return status;
}
