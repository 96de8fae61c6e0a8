/* Normal noise: vertex p moves by a normally distributed multiple of its unit normal. */
#include "sdk/shape/internal.h"

/* Sums of the face normals weighted by area. */
static void vertex_normals(const qc_mesh *m, double *normal) {
    for (int64_t i = 0; i < 3 * (int64_t)m->n_vertices; i++) normal[i] = 0;
    for (int32_t f = 0; f < m->n_faces; f++) {
        const int32_t *v = m->face_vertex + 3 * (int64_t)f;
        double a[3], b[3], n[3];
        for (int i = 0; i < 3; i++) {
            double p = m->position[3 * (int64_t)v[0] + i];
            a[i] = m->position[3 * (int64_t)v[1] + i] - p;
            b[i] = m->position[3 * (int64_t)v[2] + i] - p;
        }
        qc__cross(a, b, n);
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) normal[3 * (int64_t)v[k] + i] += n[i];
    }
}

qc_status qc__shape_noise(qc_ctx *ctx, const qc_mesh *m, double sigma, uint64_t seed,
                          qc_mesh **out) {
    double *normal = QC__NEW(ctx, double, 3 * (size_t)m->n_vertices);
    if (!normal) return QC_ERR_NOMEM;
    vertex_normals(m, normal);
    qc__random r = {seed};
    for (int64_t v = 0; v < m->n_vertices; v++) {
        double *n = normal + 3 * v, length = sqrt(qc__dot(n, n));
        double shift = sigma * m->mean_edge_length * qc__random_normal(&r);
        for (int i = 0; i < 3; i++)
            n[i] = m->position[3 * v + i] + (length > 0 ? shift * n[i] / length : 0);
    }
    qc_status status = qc_mesh_create(ctx, m->n_vertices, normal, m->n_faces, m->face_vertex, out);
    qc__free(normal);
    return status;
}
