/* Refined meshes: how they are put together, and fields, sizings and matchings carried to them. */
#include "refine.h"

#include <string.h>

void qc__refinement_free(qc__refinement *refinement) {
    qc_object_release(refinement->mesh);
    qc__free(refinement->parent);
    qc__free(refinement->parent_halfedge);
    qc__free(refinement->turn);
    *refinement = (qc__refinement){NULL, NULL, NULL, NULL};
}

/* --- construction ----------------------------------------------------------------------------- */

qc_status qc__refiner_create(qc_ctx *ctx, const qc_mesh *old, int32_t n_vertices, int32_t n_faces,
                             qc__refiner *out) {
    qc__refiner r = {.old = old, .n_vertices = n_vertices, .capacity = n_faces};
    r.position = QC__NEW(ctx, double, 3 * (size_t)n_vertices);
    r.source_vertex = QC__NEW(ctx, int32_t, n_vertices);
    r.face_vertex = QC__NEW(ctx, int32_t, 3 * (size_t)n_faces);
    r.source_face = QC__NEW(ctx, int32_t, n_faces);
    r.out.parent = QC__NEW(ctx, int32_t, n_faces);
    r.out.parent_halfedge = QC__NEW(ctx, int32_t, 3 * (size_t)n_faces);
    r.out.turn = QC__NEW(ctx, qc_complex, n_faces);
    if (!r.position || !r.source_vertex || !r.face_vertex || !r.source_face || !r.out.parent ||
        !r.out.parent_halfedge || !r.out.turn) {
        qc__refiner_free(&r);
        return QC_ERR_NOMEM;
    }
    memcpy(r.position, old->position, 3 * sizeof(double) * (size_t)old->n_vertices);
    for (int32_t v = 0; v < old->n_vertices; v++)
        r.source_vertex[v] = old->source_vertex ? old->source_vertex[v] : v;
    *out = r;
    return QC_OK;
}

void qc__refiner_free(qc__refiner *r) {
    qc__free(r->position);
    qc__free(r->source_vertex);
    qc__free(r->face_vertex);
    qc__free(r->source_face);
    qc__refinement_free(&r->out);
}

int32_t qc__refiner_add(qc__refiner *r, int32_t t, const int32_t vertex[3],
                        const int32_t halfedge[3], qc__cplx direction) {
    const int32_t f = r->n_faces++;
    for (int k = 0; k < 3; k++) {
        r->face_vertex[3 * f + k] = vertex[k];
        r->out.parent_halfedge[3 * f + k] = halfedge[k];
    }
    r->source_face[f] = r->old->source_face ? r->old->source_face[t] : t;
    r->out.parent[f] = t;
    r->out.turn[f] = qc__z(direction == 0 ? 1 : conj(qc__unit(direction)));
    return f;
}

qc_status qc__refiner_finish(qc_ctx *ctx, qc__refiner *r, qc__refinement *out) {
    const qc_status status =
        qc_mesh_create_from(ctx, r->n_vertices, r->position, r->n_faces, r->face_vertex,
                            r->source_vertex, r->source_face, &r->out.mesh);
    if (status) return status;
    *out = r->out;
    r->out = (qc__refinement){NULL, NULL, NULL, NULL};
    return QC_OK;
}

/* --- what lives on the faces and edges ---------------------------------------------------------
 */

void qc__refinement_flags(const qc__refinement *b, const qc_mesh *old_mesh, const uint8_t *old,
                          uint8_t *out) {
    for (int32_t e = 0; e < b->mesh->n_edges; e++) {
        const int32_t h = b->parent_halfedge[b->mesh->edge_halfedge[2 * e]];
        out[e] = h < 0 ? 0 : old[old_mesh->halfedge_edge[h]];
    }
}

/* Squares of directions turn twice with the frame. */
static qc_status carry_stretch(qc_ctx *ctx, const qc__refinement *b, const qc_complex *old,
                               qc_sizing *sizing) {
    qc_complex *stretch = QC__NEW(ctx, qc_complex, b->mesh->n_faces);
    if (!stretch) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < b->mesh->n_faces; t++) {
        const qc__cplx turn = qc__c(b->turn[t]);
        stretch[t] = qc__z(qc__c(old[b->parent[t]]) * turn * turn);
    }
    const qc_status status = qc_sizing_set_stretch(ctx, sizing, stretch);
    qc__free(stretch);
    return status;
}

qc_status qc__refinement_sizing(qc_ctx *ctx, const qc__refinement *b, const qc_sizing *old,
                                qc_sizing **out) {
    double *length = NULL;
    if (old->length) {
        length = QC__NEW(ctx, double, b->mesh->n_faces);
        if (!length) return QC_ERR_NOMEM;
        for (int32_t t = 0; t < b->mesh->n_faces; t++) length[t] = old->length[b->parent[t]];
    }
    qc_sizing *sizing = NULL;
    qc_status status =
        qc_sizing_create(ctx, b->mesh, old->edge_length, old->target_quads, length, &sizing);
    if (status == QC_OK && old->stretch) status = carry_stretch(ctx, b, old->stretch, sizing);
    qc__free(length);
    if (status == QC_OK)
        *out = sizing;
    else
        qc_object_release(sizing);
    return status;
}

static qc_status carry_field(qc_ctx *ctx, const qc_face_field *old, const qc__refinement *b,
                             qc_face_field **out) {
    const size_t n = (size_t)b->mesh->n_faces;
    qc_complex *x = QC__NEW(ctx, qc_complex, n);
    double *weight = old->weight ? QC__NEW(ctx, double, n) : NULL;
    uint8_t *trusted = old->trusted ? QC__NEW(ctx, uint8_t, n) : NULL;
    uint8_t *aligned = old->aligned ? QC__NEW(ctx, uint8_t, b->mesh->n_edges) : NULL;
    qc_face_field *field = NULL;
    qc_status status = QC_ERR_NOMEM;
    if (x && (weight || !old->weight) && (trusted || !old->trusted) && (aligned || !old->aligned)) {
        for (size_t t = 0; t < n; t++) {
            const int32_t p = b->parent[t];
            x[t] = qc__z(qc__c(old->x[p]) * qc__c(b->turn[t]));
            if (weight) weight[t] = old->weight[p];
            if (trusted) trusted[t] = old->trusted[p];
        }
        status = qc_face_field_create(ctx, b->mesh, x, weight, trusted, &field);
        if (!status) field->is_vector = old->is_vector;
    }
    if (!status && aligned) {
        qc__refinement_flags(b, old->mesh, old->aligned, aligned);
        status = qc_face_field_set_aligned(ctx, field, aligned, old->bend);
    }
    qc__free(x);
    qc__free(weight);
    qc__free(trusted);
    qc__free(aligned);
    if (status)
        qc_object_release(field);
    else
        *out = field;
    return status;
}

/* The parts of an edge keep its theta, and its m up to multiples of 4: a turn of nearly pi may
 * come out with the other sign in a child. Edges inside a face have theta = 0. */
static qc_status carry_turns(qc_ctx *ctx, const qc_matching *old, const qc__refinement *b,
                             const qc_face_field *field, int8_t *m) {
    const qc_mesh *mesh = b->mesh;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc_complex *rho = QC__NEW(ctx, qc_complex, mesh->n_edges);
    qc_status status = edge && rho ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_edges(ctx, mesh, edge);
    if (!status) status = qc_tangent_transport(ctx, mesh, edge, rho);
    for (int32_t e = 0; !status && e < mesh->n_edges; e++) {
        const int32_t h = b->parent_halfedge[mesh->edge_halfedge[2 * e]];
        const int32_t t = mesh->edge_halfedge[2 * e + 1];
        m[e] = 0;
        if (h < 0 || t < 0) continue;
        const int32_t parent = old->field->mesh->halfedge_edge[h];
        const qc__cplx before = qc__c(rho[e]) * qc__c(field->x[mesh->edge_halfedge[2 * e] / 3]);
        const double turning = qc__arg(qc__c(field->x[t / 3]) * conj(before));
        const double inherited = old->theta[parent] + old->m[parent] * QC__PI / 2;
        m[e] = (int8_t)(old->m[parent] + 4 * (int)round((turning - inherited) / (2 * QC__PI)));
    }
    qc__free(edge);
    qc__free(rho);
    return status;
}

static qc_status carry_matching(qc_ctx *ctx, const qc_matching *old, const qc__refinement *b,
                                qc_matching **out) {
    qc_face_field *field = NULL;
    int8_t *m = QC__NEW(ctx, int8_t, b->mesh->n_edges);
    qc_status status = m ? carry_field(ctx, old->field, b, &field) : QC_ERR_NOMEM;
    if (!status) status = carry_turns(ctx, old, b, field, m);
    if (!status) status = qc_matching_create(ctx, field, m, out);
    qc_object_release(field);
    qc__free(m);
    return status;
}

qc_status qc__refinement_carry(qc_ctx *ctx, const qc__refinement *refinement,
                               const qc_matching *matching, const qc_sizing *sizing,
                               qc_matching **matching_out, qc_sizing **sizing_out) {
    qc_sizing *s = NULL;
    qc_matching *m = NULL;
    if (!qc__progress(ctx, 0.5)) return QC_ERR_CANCELLED;
    qc_status status = qc__refinement_sizing(ctx, refinement, sizing, &s);
    if (!status) status = carry_matching(ctx, matching, refinement, &m);
    if (status) {
        qc_object_release(s);
        return status;
    }
    *sizing_out = s;
    *matching_out = m;
    return QC_OK;
}
