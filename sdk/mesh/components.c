/* Connected components (faces joined by interior edges), numbered by their lowest face. */
#include "sdk/mesh/internal.h"

qc_status qc__mesh_components(qc_ctx *ctx, qc_mesh *m) {
    int32_t *component = QC__NEW(ctx, int32_t, m->n_faces);
    m->face_component = component;
    int32_t *stack = QC__NEW(ctx, int32_t, m->n_faces);
    if (!component || !stack) {
        qc__free(stack);
        return QC_ERR_NOMEM;
    }
    for (int32_t f = 0; f < m->n_faces; f++) component[f] = -1;
    m->n_components = 0;
    for (int32_t f = 0; f < m->n_faces; f++) {
        if (component[f] >= 0) continue;
        int32_t top = 0;
        component[f] = m->n_components;
        stack[top++] = f;
        while (top > 0) {
            int32_t t = stack[--top];
            for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
                int32_t other = m->twin[h] < 0 ? -1 : m->twin[h] / 3;
                if (other < 0 || component[other] >= 0) continue;
                component[other] = m->n_components;
                stack[top++] = other;
            }
        }
        m->n_components++;
    }
    qc__free(stack);
    return QC_OK;
}

typedef struct part {
    int32_t n_vertices, n_faces;
    double *position;
    int32_t *face_vertex, *source_vertex, *source_face;
} part;

static void part_free(part *p) {
    qc__free(p->position);
    qc__free(p->face_vertex);
    qc__free(p->source_vertex);
    qc__free(p->source_face);
}

/* Vertices keep their order; local[v] = number in the part, -1 outside. */
static qc_status extract(qc_ctx *ctx, const qc_mesh *m, int32_t component, int32_t *local,
                         part *p) {
    for (int32_t v = 0; v < m->n_vertices; v++) {
        bool inside = m->face_component[m->vertex_corner[v] / 3] == component;
        local[v] = inside ? p->n_vertices++ : -1;
    }
    for (int32_t f = 0; f < m->n_faces; f++) p->n_faces += m->face_component[f] == component;
    p->position = QC__NEW(ctx, double, 3 * (size_t)p->n_vertices);
    p->face_vertex = QC__NEW(ctx, int32_t, 3 * (size_t)p->n_faces);
    p->source_vertex = QC__NEW(ctx, int32_t, p->n_vertices);
    p->source_face = QC__NEW(ctx, int32_t, p->n_faces);
    if (!p->position || !p->face_vertex || !p->source_vertex || !p->source_face)
        return QC_ERR_NOMEM;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        if (local[v] < 0) continue;
        p->source_vertex[local[v]] = v;
        for (int i = 0; i < 3; i++)
            p->position[3 * (size_t)local[v] + (size_t)i] = m->position[3 * (size_t)v + (size_t)i];
    }
    for (int32_t f = 0, k = 0; f < m->n_faces; f++) {
        if (m->face_component[f] != component) continue;
        for (int i = 0; i < 3; i++) p->face_vertex[3 * k + i] = local[m->face_vertex[3 * f + i]];
        p->source_face[k++] = f;
    }
    return QC_OK;
}

qc_status qc_mesh_component(qc_ctx *ctx, const qc_mesh *m, int32_t component, qc_mesh **out) {
    if (component < 0 || component >= m->n_components)
        return qc__fail(ctx, QC_ERR_ARGUMENT, component, "component %d of a mesh with %d of them",
                        (int)component, (int)m->n_components);
    part p = {0};
    int32_t *local = QC__NEW(ctx, int32_t, m->n_vertices);
    qc_status status = local ? extract(ctx, m, component, local, &p) : QC_ERR_NOMEM;
    if (status == QC_OK)
        status = qc_mesh_create_from(ctx, p.n_vertices, p.position, p.n_faces, p.face_vertex,
                                     p.source_vertex, p.source_face, out);
    part_free(&p);
    qc__free(local);
    return status;
}
