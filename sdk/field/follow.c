/* Hard features of a field which was given: those it runs along already. */
#include "internal.h"

#include <string.h>

/* Part of its length by which a feature may differ from the field. */
#define DIFFERENT_MAX 0.1

typedef struct chains {
    int32_t n, dropped;
    int32_t *of;                /* n_edges */
    double *length, *differing; /* n */
} chains;

static void chains_free(chains *c) {
    qc__free(c->of);
    qc__free(c->length);
    qc__free(c->differing);
}

/* Lengths of the features and of what differs from the field on either side. */
static qc_status measure(qc_ctx *ctx, const qc_face_field *field, const uint8_t *edge,
                         double tolerance, chains *c) {
    const qc_mesh *mesh = field->mesh;
    qc_complex *tangent = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    c->of = QC__NEW(ctx, int32_t, mesh->n_edges);
    qc_status status = tangent && c->of ? qc_tangent_edges(ctx, mesh, tangent) : QC_ERR_NOMEM;
    if (!status) status = qc_features_chains(ctx, mesh, edge, c->of, &c->n);
    if (!status) {
        c->length = QC__ZERO(ctx, double, c->n);
        c->differing = QC__ZERO(ctx, double, c->n);
        if (!c->length || !c->differing) status = QC_ERR_NOMEM;
    }
    for (int32_t h = 0; !status && h < 3 * mesh->n_faces; h++) {
        const int32_t i = c->of[mesh->halfedge_edge[h]];
        if (i < 0) continue;
        const double length = cabs(qc__c(tangent[h]));
        c->length[i] += length;
        if (qc__axis_deviation(tangent[h], field->x[h / 3]) > tolerance) c->differing[i] += length;
    }
    qc__free(tangent);
    return status;
}

/* The flags of the features which agree. */
static void keep(const qc_mesh *mesh, chains *c, uint8_t *kept) {
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t i = c->of[e];
        kept[e] = i >= 0 && c->differing[i] <= DIFFERENT_MAX * c->length[i];
    }
    for (int32_t i = 0; i < c->n; i++) c->dropped += c->differing[i] > DIFFERENT_MAX * c->length[i];
}

static qc_status align(qc_ctx *ctx, const qc_face_field *field, const uint8_t *kept,
                       qc_face_field **out) {
    const size_t n = (size_t)field->mesh->n_faces;
    qc_complex *x = QC__NEW(ctx, qc_complex, n);
    double *weight = QC__ZERO(ctx, double, n);
    uint8_t *trusted = QC__ZERO(ctx, uint8_t, n);
    qc_face_field *made = NULL;
    qc_status status = x && weight && trusted ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        memcpy(x, field->x, n * sizeof *x);
        if (field->weight) memcpy(weight, field->weight, n * sizeof *weight);
        for (size_t t = 0; t < n; t++)
            trusted[t] = field->trusted ? field->trusted[t] : field->weight != NULL;
        status = qc_field_align(ctx, field->mesh, kept, INFINITY, x, weight, trusted);
    }
    if (!status) status = qc_face_field_create(ctx, field->mesh, x, weight, trusted, &made);
    if (!status) status = qc_face_field_set_aligned(ctx, made, kept, 0);
    qc__free(x);
    qc__free(weight);
    qc__free(trusted);
    if (status)
        qc_object_release(made);
    else
        *out = made;
    return status;
}

qc_status qc_field_follow(qc_ctx *ctx, const qc_face_field *field, const uint8_t *edge,
                          double tolerance, qc_face_field **out) {
    chains c = {0, 0, NULL, NULL, NULL};
    uint8_t *kept = QC__NEW(ctx, uint8_t, field->mesh->n_edges);
    qc_status status = kept ? measure(ctx, field, edge, tolerance, &c) : QC_ERR_NOMEM;
    if (!status) {
        keep(field->mesh, &c, kept);
        status = align(ctx, field, kept, out);
    }
    if (!status && c.dropped > 0)
        qc__log(ctx, QC_LOG_WARNING,
                "%d of %d features dropped: the given field does not run along them",
                (int)c.dropped, (int)c.n);
    chains_free(&c);
    qc__free(kept);
    return status;
}
