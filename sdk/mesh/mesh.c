/* Creation of a triangle mesh: input check, connectivity, counts and extent. */
#include <string.h>

#include "sdk/mesh/internal.h"

void qc__mesh_destroy(qc_object *object) {
    qc_mesh *m = (qc_mesh *)object;
    qc__free((void *)m->position);
    qc__free((void *)m->face_vertex);
    qc__free((void *)m->twin);
    qc__free((void *)m->halfedge_edge);
    qc__free((void *)m->edge_halfedge);
    qc__free((void *)m->vertex_corner);
    qc__free((void *)m->edge_vertex);
    qc__free((void *)m->face_component);
    qc__free((void *)m->source_face);
    qc__free((void *)m->source_vertex);
    qc__free((void *)m->pole_start);
    qc__free((void *)m->pole_corner);
    qc__free(m);
}

static qc_status check_input(qc_ctx *ctx, int32_t n_vertices, const double *position,
                             int32_t n_faces, const int32_t *face_vertex) {
    if (n_faces <= 0 || n_vertices <= 0 || n_faces > INT32_MAX / 3)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "a mesh of %d vertices and %d faces: need 1 to %d faces", (int)n_vertices,
                        (int)n_faces, (int)(INT32_MAX / 3));
    if (!position || !face_vertex)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "position or face_vertex is NULL");
    for (int32_t v = 0; v < n_vertices; v++)
        for (int i = 0; i < 3; i++)
            if (!isfinite(position[3 * (size_t)v + (size_t)i]))
                return qc__fail(ctx, QC_ERR_ARGUMENT, v,
                                "vertex %d has a coordinate which is not finite", (int)v);
    for (int32_t f = 0; f < n_faces; f++) {
        const int32_t *v = face_vertex + 3 * (size_t)f;
        for (int k = 0; k < 3; k++)
            if (v[k] < 0 || v[k] >= n_vertices)
                return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face %d has vertex %d, valid are 0 to %d",
                                (int)f, (int)v[k], (int)n_vertices - 1);
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            return qc__fail(
                ctx, QC_ERR_ARGUMENT, f,
                "face %d (%d, %d, %d) has a vertex twice; drop it or run the repair stage", (int)f,
                (int)v[0], (int)v[1], (int)v[2]);
    }
    return QC_OK;
}

/* A copy of n elements, NULL for a NULL source; *failed is set when memory runs out. */
static void *copy(qc_ctx *ctx, const void *from, size_t n, size_t size, bool *failed) {
    if (!from) return NULL;
    void *to = qc__malloc(ctx, n, size);
    if (to)
        memcpy(to, from, n * size);
    else
        *failed = true;
    return to;
}

static double triangle_area(const qc_mesh *m, int32_t f) {
    double a[3], b[3];
    qc__halfedge_vector(m, 3 * f, a);
    qc__halfedge_vector(m, 3 * f + 1, b);
    double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
    return 0.5 * qc__norm3(cross);
}

static void measure(qc_mesh *m) {
    double low[3], high[3], length = 0;
    for (int i = 0; i < 3; i++) low[i] = high[i] = m->position[i];
    for (int32_t v = 0; v < m->n_vertices; v++) {
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], m->position[3 * (size_t)v + (size_t)i]);
            high[i] = fmax(high[i], m->position[3 * (size_t)v + (size_t)i]);
        }
    }
    double extent[3] = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    m->diagonal = qc__norm3(extent);
    m->area = 0;
    for (int32_t f = 0; f < m->n_faces; f++) m->area += triangle_area(m, f);
    for (int32_t e = 0; e < m->n_edges; e++) {
        double d[3];
        qc__halfedge_vector(m, m->edge_halfedge[2 * e], d);
        length += qc__norm3(d);
    }
    m->mean_edge_length = length / m->n_edges;
}

static qc_status connect(qc_ctx *ctx, qc_mesh *m) {
    qc_status status = qc__poll(ctx);
    if (status == QC_OK) status = qc__mesh_pair(ctx, m);
    if (status == QC_OK) status = qc__poll(ctx);
    if (status == QC_OK) status = qc__mesh_edges(ctx, m);
    if (status == QC_OK) status = qc__poll(ctx);
    if (status == QC_OK) status = qc__mesh_fans(ctx, m);
    if (status == QC_OK) status = qc__mesh_components(ctx, m);
    if (status == QC_OK) status = qc__mesh_walk_boundary(ctx, m, &m->n_boundary_loops, NULL, NULL);
    if (status != QC_OK) return status;
    m->euler = m->n_vertices - m->n_edges + m->n_faces;
    /* chi = sum over the components of 2 - 2 g - b. */
    m->genus = (2 * m->n_components - m->n_boundary_loops - m->euler) / 2;
    return QC_OK;
}

qc_status qc_mesh_create_from(qc_ctx *ctx, int32_t n_vertices, const double *position,
                              int32_t n_faces, const int32_t *face_vertex,
                              const int32_t *source_vertex, const int32_t *source_face,
                              qc_mesh **out) {
    qc_status status = check_input(ctx, n_vertices, position, n_faces, face_vertex);
    if (status != QC_OK) return status;
    qc_mesh *m = QC__ZERO(ctx, qc_mesh, 1);
    if (!m) return QC_ERR_NOMEM;
    qc_object_init(&m->object, QC_TYPE_MESH, qc__mesh_destroy);
    bool failed = false;
    m->n_vertices = n_vertices;
    m->n_faces = n_faces;
    m->position = copy(ctx, position, (size_t)n_vertices, 3 * sizeof(double), &failed);
    m->face_vertex = copy(ctx, face_vertex, (size_t)n_faces, 3 * sizeof(int32_t), &failed);
    m->source_vertex = copy(ctx, source_vertex, (size_t)n_vertices, sizeof(int32_t), &failed);
    m->source_face = copy(ctx, source_face, (size_t)n_faces, sizeof(int32_t), &failed);
    status = failed ? QC_ERR_NOMEM : connect(ctx, m);
    if (status != QC_OK) {
        qc_object_release(m);
        return status;
    }
    measure(m);
    *out = m;
    return QC_OK;
}

qc_status qc_mesh_create(qc_ctx *ctx, int32_t n_vertices, const double *position, int32_t n_faces,
                         const int32_t *face_vertex, qc_mesh **out) {
    return qc_mesh_create_from(ctx, n_vertices, position, n_faces, face_vertex, NULL, NULL, out);
}
