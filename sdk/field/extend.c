/* Trusted regions and their extension (thesis 5.1.2): the most stable part of each component keeps
 * its directions, which are then transported breadth first to the rest. */
#include "internal.h"

#include "sdk/mesh/internal.h"

/* Below this weight (a radius of curvature of 1e6 quads) a face is flat and says nothing. */
#define FLAT 1e-6

/* Faces by falling weight, then by number: keys grow where weights fall. */
static qc_status sort_by_stability(qc_ctx *ctx, int32_t n, const double *weight, int32_t *face) {
    uint64_t *key = QC__NEW(ctx, uint64_t, n);
    qc_status status = key ? qc__poll(ctx) : QC_ERR_NOMEM;
    for (int32_t t = 0; !status && t < n; t++) {
        face[t] = t;
        key[t] = weight[t] > 0 ? ~qc__sort_key(weight[t]) : UINT64_MAX;
    }
    if (!status) status = qc__sort_keys(ctx, n, key, face);
    qc__free(key);
    return status;
}

/* Flags the most stable faces which make up the fraction of each component's area. */
static qc_status trust(qc_ctx *ctx, const qc_mesh *mesh, const double *weight, const double *area,
                       double fraction, uint8_t *trusted) {
    int32_t F = mesh->n_faces;
    int32_t *order = QC__NEW(ctx, int32_t, F);
    double *budget = QC__ZERO(ctx, double, mesh->n_components);
    qc_status status = order && budget ? sort_by_stability(ctx, F, weight, order) : QC_ERR_NOMEM;
    if (!status) {
        for (int32_t t = 0; t < F; t++) budget[mesh->face_component[t]] += fraction * area[t];
        for (int32_t i = 0; i < F; i++) {
            const int32_t t = order[i];
            double *left = budget + mesh->face_component[t];
            if (!(weight[t] > FLAT) || !(*left > 0)) continue;
            trusted[t] = 1;
            *left -= area[t];
        }
    }
    qc__free(order);
    qc__free(budget);
    return status;
}

static int32_t spread(const qc_mesh *mesh, const qc_complex *rho, qc_complex *x, uint8_t *reached,
                      int32_t *queue, int32_t head, int32_t tail) {
    while (head < tail) {
        int32_t t = queue[head++];
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            int32_t g = mesh->twin[h], e = mesh->halfedge_edge[h];
            if (g < 0 || reached[g / 3]) continue;
            bool forward = mesh->edge_halfedge[2 * e] == h; /* t is the face s of the edge */
            qc__cplx r = forward ? qc__c(rho[e]) : conj(qc__c(rho[e]));
            x[g / 3] = qc__z(qc__unit(r * qc__c(x[t])));
            reached[g / 3] = 1;
            queue[tail++] = g / 3;
        }
    }
    return head;
}

/* Starts of the breadth-first search: the trusted faces; in components without any, the faces on
 * the boundary, along their boundary edge. */
static int32_t seed(const qc_mesh *mesh, const qc_complex *edge, const uint8_t *trusted,
                    uint8_t *stable, qc_complex *x, uint8_t *reached, int32_t *queue) {
    int32_t tail = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        reached[t] = trusted[t] != 0;
        if (!trusted[t]) continue;
        stable[mesh->face_component[t]] = 1;
        queue[tail++] = t;
    }
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
        int32_t t = h / 3;
        if (mesh->twin[h] >= 0 || stable[mesh->face_component[t]] || reached[t]) continue;
        x[t] = qc__z(qc__unit(qc__c(edge[h])));
        reached[t] = 1;
        queue[tail++] = t;
    }
    return tail;
}

/* Whatever is left is a flat closed component: it starts along the first edge of its first face. */
static void extend_directions(const qc_mesh *mesh, const qc__connection *c, const uint8_t *trusted,
                              uint8_t *stable, qc_complex *x, uint8_t *reached, int32_t *queue) {
    int32_t tail = seed(mesh, c->edge, trusted, stable, x, reached, queue);
    int32_t head = spread(mesh, c->rho, x, reached, queue, 0, tail);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        if (reached[t]) continue;
        x[t] = qc__z(qc__unit(qc__c(c->edge[3 * t])));
        reached[t] = 1;
        queue[head] = t;
        head = spread(mesh, c->rho, x, reached, queue, head, head + 1);
    }
}

qc_status qc_field_extend(qc_ctx *ctx, const qc_mesh *mesh, const double *weight, double fraction,
                          qc_complex *x, uint8_t *trusted) {
    if (!(fraction >= 0 && fraction <= 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the trusted fraction %g is not in [0, 1]",
                        fraction);
    qc__connection c;
    qc_status status = qc__connection_create(ctx, mesh, &c);
    if (status) return status;
    uint8_t *reached = QC__NEW(ctx, uint8_t, mesh->n_faces);
    uint8_t *stable = QC__ZERO(ctx, uint8_t, mesh->n_components);
    int32_t *queue = QC__NEW(ctx, int32_t, mesh->n_faces);
    status = reached && stable && queue ? trust(ctx, mesh, weight, c.area, fraction, trusted)
                                        : QC_ERR_NOMEM;
    if (!status) extend_directions(mesh, &c, trusted, stable, x, reached, queue);
    qc__free(reached);
    qc__free(stable);
    qc__free(queue);
    qc__connection_free(&c);
    return status;
}
