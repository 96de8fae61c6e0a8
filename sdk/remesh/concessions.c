/* Which hard features are given up where a run fails on their account: the weakest near the place
 * the error names. The strength of a chain is its length times its mean dihedral angle, strokes,
 * borders of groups and boundaries counting as very sharp; it counts four times as much at each
 * doubling of the reach within which it lies. Without a place boundaries go last. */
#include <math.h>
#include <string.h>

#include "sdk/remesh/internal.h"
#include "sdk/mesh/names.h"

enum { NAMED = 8 };

static const double near = 2;   /* quads from the place to what may be its cause */
static const double sharp = 10; /* radians, in place of the dihedral angle */

void qc__concessions_clear(qc__concessions *c) {
    qc_object_release(c->features);
    qc__free(c->chain);
    qc__free(c->of);
    qc__free(c->gone);
    *c = (qc__concessions){0};
}

static bool is_boundary(const qc_feature_chain *chain) {
    return chain->kinds & QC_FEATURE_BOUNDARY;
}

static double strength(const qc_feature_chain *chain) {
    const int drawn = QC_FEATURE_LINE | QC_FEATURE_GROUP | QC_FEATURE_BOUNDARY;
    return chain->length * (chain->kinds & drawn ? sharp : chain->angle);
}

qc_status qc__concessions_create(qc_ctx *ctx, const qc_features *features, qc__concessions *out) {
    qc__concessions c = {.features = qc_object_retain(features)};
    const qc_mesh *mesh = features->mesh;
    c.of = QC__NEW(ctx, int32_t, mesh->n_edges);
    qc_status status =
        c.of ? qc_features_chains(ctx, mesh, features->edge, c.of, &c.n) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        c.chain = QC__NEW(ctx, qc_feature_chain, c.n);
        status =
            c.chain ? qc_features_measure_chains(ctx, mesh, features->edge, c.chain) : QC_ERR_NOMEM;
    }
    if (status == QC_OK) {
        c.gone = QC__ZERO(ctx, uint8_t, c.n);
        status = c.gone ? QC_OK : QC_ERR_NOMEM;
    }
    for (int32_t i = 0; status == QC_OK && i < c.n; i++) c.n_boundaries += is_boundary(&c.chain[i]);
    if (status == QC_OK)
        *out = c;
    else
        qc__concessions_clear(&c);
    return status;
}

/* What it costs to give up each chain, n; place: NULL = none is known. */
static void find_costs(const qc__concessions *c, const double *place, double quad, double *out) {
    const qc_mesh *mesh = c->features->mesh;
    for (int32_t i = 0; i < c->n; i++)
        out[i] = place || is_boundary(&c->chain[i]) ? INFINITY : strength(&c->chain[i]);
    for (int32_t e = 0; place && e < mesh->n_edges; e++) {
        double d = 0;
        if (c->of[e] < 0) continue;
        for (int k = 0; k < 3; k++) {
            const double *p = mesh->position + 3 * (size_t)mesh->edge_vertex[2 * e];
            const double *q = mesh->position + 3 * (size_t)mesh->edge_vertex[2 * e + 1];
            d += pow(0.5 * (p[k] + q[k]) - place[k], 2);
        }
        const double doublings = fmax(0, ceil(log2(sqrt(d) / (near * quad))));
        const double cost = strength(&c->chain[c->of[e]]) * pow(4, doublings);
        if (cost < out[c->of[e]]) out[c->of[e]] = cost;
    }
}

static const char *name_of(const qc_feature_chain *chain) {
    return is_boundary(chain)                ? "boundary"
           : chain->kinds & QC_FEATURE_LINE  ? "drawn line"
           : chain->kinds & QC_FEATURE_GROUP ? "border of groups"
                                             : "crease";
}

static void give_up(qc_ctx *ctx, qc__concessions *c, int32_t i, double quad, const char *reason) {
    const qc_feature_chain *chain = &c->chain[i];
    const qc_mesh *mesh = c->features->mesh;
    char from[QC__ELEMENT_NAME], to[QC__ELEMENT_NAME];
    c->gone[i] = 1;
    c->n_gone++;
    if (c->named++ >= NAMED) return;
    qc__log(ctx, QC_LOG_WARNING,
            "%s from %s to %s, %.1f quads long, %.0f degrees, is no edge of the quads: %s",
            name_of(chain), qc__vertex_name(mesh, chain->end[0], from),
            qc__vertex_name(mesh, chain->end[1], to), chain->length / quad,
            chain->angle * 57.29577951308232, reason);
}

static int32_t cheapest(const qc__concessions *c, const double *cost) {
    int32_t best = -1;
    for (int32_t i = 0; i < c->n; i++)
        if (!c->gone[i] && (best < 0 || cost[i] < cost[best])) best = i;
    return best;
}

qc_status qc__concessions_grow(qc_ctx *ctx, qc__concessions *c, int32_t n, const double *place,
                               double quad, const char *reason) {
    double *cost = QC__NEW(ctx, double, c->n);
    if (!cost) return QC_ERR_NOMEM;
    find_costs(c, place, quad, cost);
    c->named = 0;
    const int32_t before = c->n_gone;
    while (c->n_gone < n && c->n_gone < c->n) give_up(ctx, c, cheapest(c, cost), quad, reason);
    if (c->named > NAMED)
        qc__log(ctx, QC_LOG_WARNING,
                "%d more features are no edges of the quads for the same reason",
                (int)(c->n_gone - before - NAMED));
    qc__free(cost);
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
