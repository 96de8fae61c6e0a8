/* Edge lengths which change over the surface: given by a file, painted, or bounded by the
 * curvature, and limited in how fast they grow. */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "internal.h"
#include "sdk/mesh/internal.h"

/* --- values of a file ------------------------------------------------------------------------- */

/* All numbers of a text; # begins a comment. */
static qc_status parse_numbers(qc_ctx *ctx, const char *path, char *text, double **out,
                               int64_t *n) {
    int64_t line = 1, capacity = 0;
    *out = NULL;
    *n = 0;
    for (char *p = text; *p;) {
        if (*p == '\n') line++;
        if (isspace((unsigned char)*p) || *p == ',') {
            p++;
        } else if (*p == '#') {
            p += strcspn(p, "\n");
        } else {
            char *end;
            const double x = qc__parse_double(p, &end);
            if (end == p || !(x > 0) || !isfinite(x))
                return qc__fail(ctx, QC_ERR_INPUT, line,
                                "%s:%lld: '%.16s' is not a positive number; a length for each "
                                "vertex or face is needed",
                                path, (long long)line, p);
            if (!qc__reserve(ctx, (void **)out, &capacity, *n + 1, sizeof **out))
                return QC_ERR_NOMEM;
            (*out)[(*n)++] = x;
            p = end;
        }
    }
    return QC_OK;
}

/* Mean of the values of the corners of face t; value counts vertices of the input. -1 where no
 * corner has one. */
static double corner_mean(const qc_mesh *mesh, int32_t t, const double *value, int64_t n) {
    double sum = 0;
    int found = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t v = mesh->face_vertex[3 * (int64_t)t + k];
        const int32_t i = mesh->source_vertex ? mesh->source_vertex[v] : v;
        if (i < 0 || i >= n) continue;
        sum += value[i];
        found++;
    }
    return found ? sum / found : -1;
}

static qc_status read_lengths(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o,
                              double *length) {
    char *text = NULL;
    double *value = NULL;
    int64_t n = 0;
    size_t size;
    qc_status status = qc__read_file(ctx, o->path, &text, &size);
    if (status == QC_OK) status = parse_numbers(ctx, o->path, text, &value, &n);
    const int32_t n_vertices = o->input ? o->input->n_vertices : mesh->n_vertices;
    const int32_t n_faces = o->input ? o->input->n_faces : mesh->n_faces;
    if (status == QC_OK && n != n_vertices && n != n_faces)
        status = qc__fail(ctx, QC_ERR_INPUT, n,
                          "%s: %lld lengths for a mesh of %d vertices and %d faces; give one for "
                          "each vertex or for each face",
                          o->path, (long long)n, (int)n_vertices, (int)n_faces);
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) {
        const int32_t f = mesh->source_face ? mesh->source_face[t] : t;
        const double x = n == n_vertices ? corner_mean(mesh, t, value, n) : f >= 0 ? value[f] : -1;
        if (x > 0) length[t] = x;
    }
    qc__free(text);
    qc__free(value);
    return status;
}

/* --- paint and curvature ---------------------------------------------------------------------- */

static void paint(const qc_mesh *mesh, const qc_size_options *o, double *length) {
    const double least = 1 / (o->range * o->range), most = o->range * o->range;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double q = corner_mean(mesh, t, o->input->quality, o->input->n_vertices);
        length[t] /= sqrt(fmin(fmax(isfinite(q) ? q : 1, least), most));
    }
}

/* length <= turn / |kappa|: the surface turns by at most `turn` along an edge. The curvature is
 * that of disks of the radius of an edge. */
static qc_status bend(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o, double *length) {
    qc_complex *x = QC__NEW(ctx, qc_complex, mesh->n_faces);
    double *kappa = QC__NEW(ctx, double, 2 * (int64_t)mesh->n_faces);
    qc_status status = x && kappa ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN, o->edge_length, x,
                                    kappa);
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) {
        const double k = fmax(fabs(kappa[2 * (int64_t)t]), fabs(kappa[2 * (int64_t)t + 1]));
        if (k * length[t] > o->turn) length[t] = fmax(o->turn / k, length[t] / o->range);
    }
    qc__free(x);
    qc__free(kappa);
    return status;
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
    if (!(o->edge_length > 0) || !(o->turn >= 0) || !(o->range >= 1) || !(o->gradation >= 0))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "edge length, turn, range or gradation is off");
    if (o->painted && (!o->input || !o->input->quality))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the input has no painted density; save it as PLY with the vertex property "
                        "`quality`");
    return QC_OK;
}

qc_status qc_sizing_create_varying(qc_ctx *ctx, const qc_mesh *mesh, double target_quads,
                                   const qc_size_options *options, qc_sizing **out) {
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    double *length = QC__NEW(ctx, double, mesh->n_faces), n = 0;
    qc_status status = length ? check(ctx, &o) : QC_ERR_NOMEM;
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) length[t] = o.edge_length;
    if (status == QC_OK && o.path) status = read_lengths(ctx, mesh, &o, length);
    if (status == QC_OK && o.painted) paint(mesh, &o, length);
    if (status == QC_OK && o.turn > 0) status = bend(ctx, mesh, &o, length);
    if (status == QC_OK && o.gradation > 0) status = grade(ctx, mesh, o.gradation, length);
    if (status == QC_OK) status = count_quads(ctx, mesh, length, &n);
    if (status == QC_OK) {
        const double scale = target_quads > 0 ? sqrt(n / target_quads) : 1;
        for (int32_t t = 0; t < mesh->n_faces; t++) length[t] *= scale;
        status =
            qc_sizing_create(ctx, mesh, scale * sqrt(mesh->area / n), target_quads, length, out);
    }
    qc__free(length);
    return status;
}
