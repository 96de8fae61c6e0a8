/* Feature edges: the boundary, creases by dihedral angle, and edges given as vertex pairs. */
#include <string.h>

#include "sdk/mesh/internal.h"

static void features_destroy(qc_object *object) {
    qc_features *f = (qc_features *)object;
    qc_object_release(f->mesh);
    qc__free((void *)f->edge);
    qc__free((void *)f->vertex);
    qc__free(f);
}

/* Angle between the normals of the two faces; 0 where one of them has no area worth a normal. */
static double dihedral(const qc_mesh *m, const double *normal, const double *cotangent, int32_t e) {
    double sine = 0, cosine = 0;
    int32_t f[2] = {m->edge_halfedge[2 * e] / 3, m->edge_halfedge[2 * e + 1] / 3};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            if (fabs(cotangent[3 * (size_t)f[i] + (size_t)k]) > 1e10) return 0;
    const double *a = normal + 3 * (size_t)f[0], *b = normal + 3 * (size_t)f[1];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double s = a[j] * b[k] - a[k] * b[j];
        sine += s * s;
        cosine += a[i] * b[i];
    }
    return atan2(sqrt(sine), cosine);
}

static qc_status mark_creases(qc_ctx *ctx, const qc_mesh *m, double angle, uint8_t *edge) {
    double *normal = QC__NEW(ctx, double, 3 * (size_t)m->n_faces);
    double *cotangent = QC__NEW(ctx, double, 3 * (size_t)m->n_faces);
    qc_status status = normal && cotangent ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = qc_mesh_geometry(ctx, m, NULL, NULL, cotangent, NULL, normal, NULL);
    for (int32_t e = 0; status == QC_OK && e < m->n_edges; e++) {
        if (m->edge_halfedge[2 * e + 1] < 0)
            edge[e] |= QC_FEATURE_BOUNDARY;
        else if (dihedral(m, normal, cotangent, e) > angle)
            edge[e] |= QC_FEATURE_CREASE;
    }
    qc__free(normal);
    qc__free(cotangent);
    return status;
}

/* Edge from v to w, -1 when there is none. */
static int32_t find_edge(const qc_mesh *m, int32_t v, int32_t w) {
    if (v < 0 || w < 0 || v >= m->n_vertices || w >= m->n_vertices) return -1;
    int32_t first = m->vertex_corner[v], c = first;
    do {
        if (m->face_vertex[qc_next(c)] == w) return m->halfedge_edge[qc_prev(c)];
        if (m->face_vertex[qc_prev(c)] == w) return m->halfedge_edge[qc_next(c)];
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != first);
    return -1;
}

static void mark_lines(qc_ctx *ctx, const qc_mesh *m, int32_t n_lines, const int32_t *line,
                       uint8_t *edge) {
    int32_t ignored = 0;
    for (int32_t i = 0; line && i < n_lines; i++) {
        int32_t e = find_edge(m, line[2 * (size_t)i], line[2 * (size_t)i + 1]);
        if (e >= 0)
            edge[e] |= QC_FEATURE_LINE;
        else
            ignored++;
    }
    if (ignored > 0)
        qc__log(ctx, QC_LOG_WARNING, "%d of %d feature lines are no edges of the mesh: ignored",
                (int)ignored, (int)n_lines);
}

static qc_status count_features(qc_ctx *ctx, qc_features *f, uint8_t *vertex) {
    const qc_mesh *m = f->mesh;
    int32_t *degree = QC__ZERO(ctx, int32_t, m->n_vertices);
    if (!degree) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (!f->edge[e]) continue;
        f->n_feature_edges++;
        f->n_creases += (f->edge[e] & QC_FEATURE_CREASE) != 0;
        degree[m->edge_vertex[2 * e]]++;
        degree[m->edge_vertex[2 * e + 1]]++;
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        f->n_corners += degree[v] != 0 && degree[v] != 2;
        vertex[v] = (uint8_t)(degree[v] > 255 ? 255 : degree[v]);
    }
    qc__free(degree);
    return QC_OK;
}

qc_status qc_features_create(qc_ctx *ctx, const qc_mesh *m, const uint8_t *edge, bool hard,
                             qc_features **out) {
    qc_features *f = QC__ZERO(ctx, qc_features, 1);
    if (!f) return QC_ERR_NOMEM;
    qc_object_init(&f->object, QC_TYPE_FEATURES, features_destroy);
    f->mesh = qc_object_retain(m);
    f->hard = hard;
    uint8_t *copy = QC__NEW(ctx, uint8_t, m->n_edges);
    f->edge = copy;
    uint8_t *vertex = QC__NEW(ctx, uint8_t, m->n_vertices);
    f->vertex = vertex;
    qc_status status = QC_ERR_NOMEM;
    if (copy && vertex) {
        memcpy(copy, edge, (size_t)m->n_edges);
        status = count_features(ctx, f, vertex);
    }
    if (status != QC_OK) {
        qc_object_release(f);
        return status;
    }
    *out = f;
    return QC_OK;
}

qc_status qc_features_detect(qc_ctx *ctx, const qc_mesh *m, double angle, int32_t n_lines,
                             const int32_t *line, qc_features **out) {
    uint8_t *edge = QC__ZERO(ctx, uint8_t, m->n_edges);
    qc_status status = edge ? mark_creases(ctx, m, angle, edge) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        mark_lines(ctx, m, n_lines, line, edge);
        status = qc_features_create(ctx, m, edge, false, out);
    }
    qc__free(edge);
    return status;
}
