/* The covering as a mesh of its own (Kaelberer 2013, section 3.2.2): four copies of every face,
 * glued by the matching; one vertex per closed cycle (or, on the boundary, fan) of faces.
 *
 * Twins are carried over from the view and never searched by end points: between two branch points
 * of odd shift four different edges join the same two vertices. */
#include <qc/cover.h>

#include "sdk/base/internal.h"
#include "sdk/mesh/internal.h"

/* Corner or halfedge above c on a layer. */
static int32_t above(int32_t c, int32_t layer) {
    return 3 * (4 * (c / 3) + layer) + c % 3;
}

static int32_t *lift_twins(qc_ctx *ctx, const qc_cover *cover) {
    const qc_mesh *m = cover->mesh;
    int32_t *twin = QC__NEW(ctx, int32_t, 12 * (size_t)m->n_faces);
    for (int32_t h = 0; twin && h < 3 * m->n_faces; h++)
        for (int32_t l = 0; l < 4; l++)
            twin[above(h, l)] =
                m->twin[h] < 0 ? -1 : above(m->twin[h], qc_cover_layer(cover, h, l));
    return twin;
}

/* Numbers the vertices above v, starting with n; below[] gets v for each. Returns the next number.
 */
static int32_t lift_vertex(const qc_cover *cover, int32_t v, int32_t n, int32_t *face_vertex,
                           int32_t *below) {
    const qc_mesh *m = cover->mesh;
    const int32_t first = m->vertex_corner[v];
    for (int32_t l = 0; l < 4; l++) {
        if (face_vertex[above(first, l)] >= 0) continue;
        int32_t c = first, layer = l;
        do {
            face_vertex[above(c, layer)] = n;
            layer = qc_cover_layer(cover, qc_next(c), layer);
            c = qc_corner_ccw(m, c);
        } while (c >= 0 && face_vertex[above(c, layer)] < 0);
        below[n++] = v;
    }
    return n;
}

static qc_status fill(qc_ctx *ctx, const qc_cover *cover, qc_mesh *q) {
    const qc_mesh *m = cover->mesh;
    q->n_faces = 4 * m->n_faces;
    int32_t *face_vertex = QC__NEW(ctx, int32_t, 3 * (size_t)q->n_faces);
    q->face_vertex = face_vertex;
    int32_t *below = QC__NEW(ctx, int32_t, 4 * (size_t)m->n_vertices);
    q->source_vertex = below;
    int32_t *source_face = QC__NEW(ctx, int32_t, q->n_faces);
    q->source_face = source_face;
    q->twin = lift_twins(ctx, cover);
    if (!face_vertex || !below || !source_face || !q->twin) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < q->n_faces; i++) source_face[i] = i / 4;
    for (int32_t c = 0; c < 3 * q->n_faces; c++) face_vertex[c] = -1;
    for (int32_t v = 0; v < m->n_vertices; v++)
        q->n_vertices = lift_vertex(cover, v, q->n_vertices, face_vertex, below);
    double *position = QC__NEW(ctx, double, 3 * (size_t)q->n_vertices);
    q->position = position;
    if (!position) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < q->n_vertices; v++)
        for (int32_t i = 0; i < 3; i++) position[3 * v + i] = m->position[3 * below[v] + i];
    return QC_OK;
}

static qc_status connect(qc_ctx *ctx, const qc_mesh *m, qc_mesh *q) {
    qc_status status = qc__mesh_edges(ctx, q);
    if (status == QC_OK) status = qc__mesh_fans(ctx, q);
    if (status == QC_OK) status = qc__mesh_components(ctx, q);
    if (status == QC_OK) status = qc__mesh_walk_boundary(ctx, q, &q->n_boundary_loops, NULL, NULL);
    if (status != QC_OK) return status;
    q->euler = q->n_vertices - q->n_edges + q->n_faces;
    q->genus = (2 * q->n_components - q->n_boundary_loops - q->euler) / 2;
    q->diagonal = m->diagonal;
    q->area = 4 * m->area;
    q->mean_edge_length = m->mean_edge_length;
    return QC_OK;
}

qc_status qc_cover_mesh(qc_ctx *ctx, const qc_cover *cover, qc_mesh **out, int32_t **vertex_below) {
    const qc_mesh *m = cover->mesh;
    if (m->n_faces > INT32_MAX / 12)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the covering of %d faces does not fit 32-bit numbers", (int)m->n_faces);
    qc_mesh *q = QC__ZERO(ctx, qc_mesh, 1);
    if (!q) return QC_ERR_NOMEM;
    qc_object_init(&q->object, QC_TYPE_MESH, qc__mesh_destroy);
    qc_status status = fill(ctx, cover, q);
    if (status == QC_OK) status = connect(ctx, m, q);
    int32_t *below = NULL;
    if (status == QC_OK && vertex_below) {
        below = QC__NEW(ctx, int32_t, q->n_vertices);
        status = below ? QC_OK : QC_ERR_NOMEM;
    }
    if (status != QC_OK) {
        qc_object_release(q);
        return status;
    }
    for (int32_t v = 0; below && v < q->n_vertices; v++) below[v] = q->source_vertex[v];
    if (vertex_below) *vertex_below = below;
    *out = q;
    return QC_OK;
}

void qc_cover_free_array(void *array) {
    qc__free(array);
}
