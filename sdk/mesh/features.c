/* Feature edges: the boundary, creases by dihedral angle, borders between groups of faces. */
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

qc_status qc__crease_angles(qc_ctx *ctx, const qc_mesh *m, double *angle) {
    double *normal = QC__NEW(ctx, double, 3 * (size_t)m->n_faces);
    double *cotangent = QC__NEW(ctx, double, 3 * (size_t)m->n_faces);
    qc_status status = normal && cotangent ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = qc_mesh_geometry(ctx, m, NULL, NULL, cotangent, NULL, normal, NULL);
    if (status == QC_OK) status = qc__poll(ctx);
    for (int32_t e = 0; status == QC_OK && e < m->n_edges; e++)
        angle[e] = m->edge_halfedge[2 * e + 1] < 0 ? 0 : dihedral(m, normal, cotangent, e);
    qc__free(normal);
    qc__free(cotangent);
    return status;
}

static qc_status mark_creases(qc_ctx *ctx, const qc_mesh *m, double angle, uint8_t *edge) {
    double *crease = QC__NEW(ctx, double, m->n_edges);
    const qc_status status = crease ? qc__crease_angles(ctx, m, crease) : QC_ERR_NOMEM;
    for (int32_t e = 0; status == QC_OK && e < m->n_edges; e++) {
        if (m->edge_halfedge[2 * e + 1] < 0)
            edge[e] |= QC_FEATURE_BOUNDARY;
        else if (crease[e] > angle)
            edge[e] |= QC_FEATURE_CREASE;
    }
    qc__free(crease);
    return status;
}

void qc_features_add_groups(const qc_mesh *m, const int32_t *group, uint8_t *edge) {
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t *h = m->edge_halfedge + 2 * e;
        if (h[1] >= 0 && group[h[0] / 3] != group[h[1] / 3]) edge[e] |= QC_FEATURE_GROUP;
    }
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
    if (status == QC_OK && line)
        status =
            qc_features_add_strokes(ctx, m, m->n_vertices, m->position, n_lines, line, 0, edge);
    if (status == QC_OK) status = qc_features_create(ctx, m, edge, false, out);
    qc__free(edge);
    return status;
}
