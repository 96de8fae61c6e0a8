/* Repair steps 9 and 10: small components and vertices without faces are left out; the rest becomes
 * the mesh. */
#include <string.h>

#include "sdk/mesh/repair/internal.h"

enum { LEAST_FACES = 4 }; /* of a component: the tetrahedron is the smallest closed surface */

/* Vertices of the input which neither live on nor were merged with another one, nor belong to a
 * line. */
static qc_status note_unreferenced(qc__repair *r) {
    uint8_t *used = QC__ZERO(r->ctx, uint8_t, r->soup->n_vertices);
    if (!used) return QC_ERR_NOMEM;
    for (int32_t c = 0; c < 3 * r->n_faces; c++)
        if (r->triangle[c - c % 3] >= 0) used[r->source_vertex[r->triangle[c]]] = 1;
    for (int32_t i = 0; r->soup->line && i < 2 * r->soup->n_lines; i++) used[r->soup->line[i]] = 1;
    for (int32_t v = 0; v < r->soup->n_vertices; v++)
        if (!used[v] && !r->merged[v]) qc__repair_note(r, QC_REPAIR_UNREFERENCED, v);
    qc__free(used);
    return QC_OK;
}

static qc_status drop_small_components(qc__repair *r) {
    int32_t *parent = QC__NEW(r->ctx, int32_t, r->n_faces);
    int32_t *size = QC__ZERO(r->ctx, int32_t, r->n_faces);
    qc_status status = parent && size ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        qc__sets_init(parent, r->n_faces);
        for (int32_t h = 0; h < 3 * r->n_faces; h++)
            if (r->triangle[h - h % 3] >= 0 && r->twin[h] > h)
                qc__sets_unite(parent, h / 3, r->twin[h] / 3);
        for (int32_t f = 0; f < r->n_faces; f++) size[qc__sets_find(parent, f)]++;
        for (int32_t f = 0; f < r->n_faces; f++) {
            int32_t root = qc__sets_find(parent, f);
            if (r->triangle[3 * f] < 0 || size[root] >= LEAST_FACES) continue;
            if (root == f) qc__repair_note(r, QC_REPAIR_SMALL_COMPONENT, r->source_face[f]);
            r->triangle[3 * f] = -1;
        }
    }
    qc__free(parent);
    qc__free(size);
    return status;
}

/* Renumbers faces and vertices without gaps, in their order. */
static qc_status compact(qc__repair *r) {
    int32_t *number = QC__ZERO(r->ctx, int32_t, r->n_vertices);
    if (!number) return QC_ERR_NOMEM;
    int32_t n_faces = 0, n_vertices = 0;
    for (int32_t f = 0; f < r->n_faces; f++) {
        const int32_t *t = r->triangle + 3 * (size_t)f;
        if (t[0] < 0) continue;
        for (int k = 0; k < 3; k++) number[t[k]] = 1;
        memmove(r->triangle + 3 * (size_t)n_faces, t, 3 * sizeof *t);
        r->source_face[n_faces++] = r->source_face[f];
    }
    for (int32_t v = 0; v < r->n_vertices; v++) {
        if (!number[v]) continue;
        r->source_vertex[n_vertices] = r->source_vertex[v];
        number[v] = n_vertices++;
    }
    for (int32_t c = 0; c < 3 * n_faces; c++) r->triangle[c] = number[r->triangle[c]];
    r->n_faces = n_faces;
    r->n_vertices = n_vertices;
    qc__free(number);
    return QC_OK;
}

qc_status qc__repair_finish(qc__repair *r, qc_mesh **mesh) {
    qc_status status = note_unreferenced(r);
    if (status == QC_OK) status = drop_small_components(r);
    if (status == QC_OK) status = compact(r);
    if (status != QC_OK) return status;
    if (r->n_faces == 0)
        return qc__fail(r->ctx, QC_ERR_INPUT, 0,
                        "no connected surface of at least %d triangles is left of %d faces; check "
                        "that neighbouring faces share vertices, or refine the mesh",
                        (int)LEAST_FACES, (int)r->soup->n_faces);
    double *position = QC__NEW(r->ctx, double, 3 * (size_t)r->n_vertices);
    if (!position) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < r->n_vertices; v++)
        memcpy(position + 3 * (size_t)v, qc__repair_point(r, v), 3 * sizeof *position);
    status = qc_mesh_create_from(r->ctx, r->n_vertices, position, r->n_faces, r->triangle,
                                 r->source_vertex, r->source_face, mesh);
    qc__free(position);
    return status;
}
