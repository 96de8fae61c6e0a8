/* Edge lengths which change over the surface: given by a file, painted, or bounded by the
 * curvature, limited in how fast they grow, and different along the two principal directions. */
#include <math.h>
#include <string.h>

#include "sdk/mesh/internal.h"
#include "size_file.h"
#include "stretch.h"

/* --- paint and curvature ---------------------------------------------------------------------- */

/* NULL = none */
static const qc_attribute *paint_of(const qc_size_options *o) {
    const qc_attribute *a =
        o->input ? qc_polygon_mesh_attribute(o->input, QC_AT_VERTEX, "quality") : NULL;
    return a && a->width == 1 ? a : NULL;
}

static void paint(const qc_mesh *mesh, const qc_size_options *o, double *length) {
    const double least = 1 / (o->range * o->range), most = o->range * o->range;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double q = qc__corner_mean(mesh, t, paint_of(o)->value, o->input->n_vertices);
        length[t] /= sqrt(fmin(fmax(isfinite(q) ? q : 1, least), most));
    }
}

/* length <= turn / |kappa| in both directions: the surface turns by at most `turn` along an edge.
 */
static void bend(const qc_mesh *mesh, const qc_size_options *o, const qc_complex *x,
                 const double *kappa, const qc_complex *stretch, double *length) {
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double longer = exp(qc__stretch_along(stretch[t], x[t]));
        const double k =
            fmax(fabs(kappa[2 * (int64_t)t]) * longer, fabs(kappa[2 * (int64_t)t + 1]) / longer);
        if (k * length[t] > o->turn) length[t] = fmax(o->turn / k, length[t] / o->range);
    }
}

/* --- gradation -------------------------------------------------------------------------------- */

/* The largest function below `key` which grows by at most `slope` times the length of an edge:
 * min over w of key[w] + slope d(v, w), by Dijkstra's algorithm from all vertices. */
static qc_status limit_growth(qc_ctx *ctx, const qc_mesh *m, double slope, double *key) {
    qc__heap heap;
    qc_status status = qc__heap_create(ctx, m->n_vertices, key, &heap);
    if (status != QC_OK) return status;
    for (int32_t v = 0; v < m->n_vertices; v++) qc__heap_push(&heap, v);
    for (int64_t i = 0; heap.n > 0; i++) {
        if (i % 65536 == 0 && !qc__progress(ctx, (double)i / m->n_vertices)) {
            status = QC_ERR_CANCELLED;
            break;
        }
        const int32_t v = qc__heap_pop(&heap), first = m->vertex_corner[v];
        for (int32_t c = first; c >= 0;) {
            for (int side = 0; side < 2; side++) {
                const int32_t h = side ? qc_prev(c) : qc_next(c);
                const int32_t w = m->face_vertex[side ? qc_next(c) : qc_prev(c)];
                double d[3];
                qc__halfedge_vector(m, h, d);
                const double far = key[v] + slope * qc__norm3(d);
                if (heap.place[w] < 0 || far >= key[w]) continue;
                key[w] = far;
                qc__heap_push(&heap, w);
            }
            c = qc_corner_ccw(m, c);
            if (c == first) break;
        }
    }
    qc__heap_free(&heap);
    return status;
}

static qc_status grade(qc_ctx *ctx, const qc_mesh *mesh, double slope, double *length) {
    double *at = QC__NEW(ctx, double, mesh->n_vertices);
    if (!at) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) at[v] = INFINITY;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++)
        at[mesh->face_vertex[c]] = fmin(at[mesh->face_vertex[c]], length[c / 3]);
    const qc_status status = limit_growth(ctx, mesh, slope, at);
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) {
        const int32_t *v = mesh->face_vertex + 3 * (int64_t)t;
        length[t] = (at[v[0]] + at[v[1]] + at[v[2]]) / 3;
    }
    qc__free(at);
    return status;
}

/* Number of quads which lengths ask for. */
static qc_status count_quads(qc_ctx *ctx, const qc_mesh *mesh, const double *length, double *n) {
    double *area = QC__NEW(ctx, double, mesh->n_faces);
    qc_status status = area ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_mesh_geometry(ctx, mesh, NULL, area, NULL, NULL, NULL, NULL);
    *n = 0;
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++)
        *n += area[t] / (length[t] * length[t]);
    qc__free(area);
    return status;
}

static qc_status check(qc_ctx *ctx, const qc_size_options *o) {
    if (!(o->edge_length > 0) || !(o->turn >= 0) || !(o->range >= 1) || !(o->gradation >= 0) ||
        !(o->anisotropy >= 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "edge length, turn, range, gradation or anisotropy is off");
    if (o->painted && !paint_of(o))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the input has no painted density; save it as PLY with the vertex property "
                        "`quality`");
    return QC_OK;
}

/* What the lengths are made of. */
typedef struct size_field {
    double *length;      /* n_faces */
    qc_complex *stretch; /* n_faces */
    bool directed;       /* whether a stretch was asked for */
    qc_complex *x;       /* n_faces, with curvatures: direction of the larger one */
    double *kappa;       /* 2 n_faces */
} size_field;

/* The curvatures, of disks of the radius of an edge. */
static qc_status find_curvature(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o,
                                size_field *f) {
    f->x = QC__NEW(ctx, qc_complex, mesh->n_faces);
    f->kappa = QC__NEW(ctx, double, 2 * (int64_t)mesh->n_faces);
    if (!f->x || !f->kappa) return QC_ERR_NOMEM;
    return qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN, o->edge_length, f->x,
                              f->kappa);
}

static qc_status fill(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o, size_field *f) {
    qc_status status = check(ctx, o);
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) f->length[t] = o->edge_length;
    if (status == QC_OK && (o->turn > 0 || o->anisotropy > 1))
        status = find_curvature(ctx, mesh, o, f);
    if (status == QC_OK && o->anisotropy > 1) {
        f->directed = true;
        status = qc__curvature_stretch(ctx, mesh, f->x, f->kappa, o->anisotropy, o->edge_length,
                                       f->stretch);
    }
    if (status == QC_OK && o->path)
        status = qc__size_file(ctx, mesh, o, f->length, f->stretch, &f->directed);
    if (status == QC_OK && o->painted) paint(mesh, o, f->length);
    if (status == QC_OK && o->turn > 0) bend(mesh, o, f->x, f->kappa, f->stretch, f->length);
    if (status == QC_OK && o->gradation > 0) status = grade(ctx, mesh, o->gradation, f->length);
    return status;
}

static qc_status publish(qc_ctx *ctx, const qc_mesh *mesh, double target_quads, const size_field *f,
                         qc_sizing **out) {
    double n = 0;
    qc_status status = count_quads(ctx, mesh, f->length, &n);
    if (status != QC_OK) return status;
    const double scale = target_quads > 0 ? sqrt(n / target_quads) : 1;
    qc_sizing *sizing = NULL;
    for (int32_t t = 0; t < mesh->n_faces; t++) f->length[t] *= scale;
    status =
        qc_sizing_create(ctx, mesh, scale * sqrt(mesh->area / n), target_quads, f->length, &sizing);
    if (status == QC_OK && f->directed) status = qc_sizing_set_stretch(ctx, sizing, f->stretch);
    if (status == QC_OK)
        *out = sizing;
    else
        qc_object_release(sizing);
    return status;
}

qc_status qc_sizing_create_varying(qc_ctx *ctx, const qc_mesh *mesh, double target_quads,
                                   const qc_size_options *options, qc_sizing **out) {
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    size_field f = {QC__NEW(ctx, double, mesh->n_faces), QC__ZERO(ctx, qc_complex, mesh->n_faces),
                    false, NULL, NULL};
    qc_status status = f.length && f.stretch ? fill(ctx, mesh, &o, &f) : QC_ERR_NOMEM;
    if (status == QC_OK) status = publish(ctx, mesh, target_quads, &f, out);
    qc__free(f.length);
    qc__free(f.stretch);
    qc__free(f.x);
    qc__free(f.kappa);
    return status;
}
