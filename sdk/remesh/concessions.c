/* Which hard features are given up where a run fails on their account: those near the place the
 * error names first, else the weakest. The strength of a chain is its length times its mean
 * dihedral angle; strokes and borders of groups, which somebody drew, are stronger than all
 * creases, and boundaries stay. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/remesh/internal.h"

enum { NAMED = 8 };

/* Quads from the place to the features which may be its cause. */
#define NEAR 2.0

void qc__concessions_clear(qc__concessions *c) {
    qc_object_release(c->features);
    qc__free(c->chain);
    qc__free(c->of);
    qc__free(c->gone);
    qc__free(c->order);
    *c = (qc__concessions){0};
}

static double strength(const qc_feature_chain *chain) {
    const bool drawn = chain->kinds & (QC_FEATURE_LINE | QC_FEATURE_GROUP);
    return drawn ? chain->length * 10 : chain->length * chain->angle;
}

typedef struct ranked {
    double strength;
    int32_t chain;
} ranked;

static int compare(const void *p, const void *q) {
    const ranked *a = p, *b = q;
    if (a->strength != b->strength) return a->strength < b->strength ? -1 : 1;
    return a->chain < b->chain ? -1 : a->chain > b->chain;
}

/* Chains which may go, the weakest first. */
static qc_status rank(qc_ctx *ctx, qc__concessions *c, int32_t n) {
    ranked *r = QC__NEW(ctx, ranked, n);
    c->order = QC__NEW(ctx, int32_t, n);
    c->gone = QC__ZERO(ctx, uint8_t, n);
    const bool there = r && c->order && c->gone;
    for (int32_t i = 0; there && i < n; i++)
        if (!(c->chain[i].kinds & QC_FEATURE_BOUNDARY))
            r[c->n++] = (ranked){strength(&c->chain[i]), i};
    if (there) qsort(r, (size_t)c->n, sizeof *r, compare);
    for (int32_t i = 0; there && i < c->n; i++) c->order[i] = r[i].chain;
    qc__free(r);
    return there ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__concessions_create(qc_ctx *ctx, const qc_features *features, qc__concessions *out) {
    qc__concessions c = {.features = qc_object_retain(features)};
    const qc_mesh *mesh = features->mesh;
    c.of = QC__NEW(ctx, int32_t, mesh->n_edges);
    qc_status status =
        c.of ? qc_features_chains(ctx, mesh, features->edge, c.of, &c.n_chains) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        c.chain = QC__NEW(ctx, qc_feature_chain, c.n_chains);
        status =
            c.chain ? qc_features_measure_chains(ctx, mesh, features->edge, c.chain) : QC_ERR_NOMEM;
    }
    if (status == QC_OK) status = rank(ctx, &c, c.n_chains);
    if (status == QC_OK)
        *out = c;
    else
        qc__concessions_clear(&c);
    return status;
}

/* Flags the chains within the reach of a point. */
static void find_near(const qc__concessions *c, const double place[3], double reach,
                      uint8_t *near) {
    const qc_mesh *mesh = c->features->mesh;
    memset(near, 0, (size_t)c->n_chains);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        double d = 0;
        if (c->of[e] < 0 || near[c->of[e]]) continue;
        for (int k = 0; k < 3; k++) {
            const double *p = mesh->position + 3 * (size_t)mesh->edge_vertex[2 * e];
            const double *q = mesh->position + 3 * (size_t)mesh->edge_vertex[2 * e + 1];
            d += pow(0.5 * (p[k] + q[k]) - place[k], 2);
        }
        near[c->of[e]] = d < reach * reach;
    }
}

static void give_up(qc_ctx *ctx, qc__concessions *c, int32_t i, double quad, const char *reason) {
    const qc_feature_chain *chain = &c->chain[i];
    const qc_mesh *mesh = c->features->mesh;
    int32_t end[2] = {chain->end[0], chain->end[1]};
    for (int k = 0; k < 2; k++)
        if (mesh->source_vertex) end[k] = mesh->source_vertex[end[k]];
    c->gone[i] = 1;
    c->n_gone++;
    if (c->named++ >= NAMED) return;
    qc__log(ctx, QC_LOG_WARNING,
            "feature from vertex %d to %d, %.1f quads long, %.0f degrees, is no edge of the quads: "
            "%s",
            (int)end[0], (int)end[1], chain->length / quad, chain->angle * 57.29577951308232,
            reason);
}

qc_status qc__concessions_grow(qc_ctx *ctx, qc__concessions *c, int32_t n, const double *place,
                               double quad, const char *reason) {
    uint8_t *near = QC__ZERO(ctx, uint8_t, c->n_chains);
    if (!near) return QC_ERR_NOMEM;
    if (place) find_near(c, place, NEAR * quad, near);
    c->named = 0;
    const int32_t before = c->n_gone;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t i = 0; i < c->n && c->n_gone < n; i++)
            if (!c->gone[c->order[i]] && (pass == 1 || near[c->order[i]]))
                give_up(ctx, c, c->order[i], quad, reason);
    if (c->named > NAMED)
        qc__log(ctx, QC_LOG_WARNING,
                "%d more features are no edges of the quads for the same reason",
                (int)(c->n_gone - before - NAMED));
    qc__free(near);
    return QC_OK;
}

qc_status qc__concessions_features(qc_ctx *ctx, const qc__concessions *c, qc_features **out) {
    const qc_mesh *mesh = c->features->mesh;
    uint8_t *edge = QC__NEW(ctx, uint8_t, mesh->n_edges);
    if (!edge) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        edge[e] = c->of[e] >= 0 && c->gone[c->of[e]] ? 0 : c->features->edge[e];
    const qc_status status = qc_features_create(ctx, mesh, edge, c->features->hard, out);
    if (status == QC_OK) (*out)->bend = c->features->bend;
    qc__free(edge);
    return status;
}
