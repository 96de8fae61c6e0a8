/* Features which are noise or leave no room for quads dropped: creases blunt at the scale of a
 * quad, short ones, the weaker ones of sharp sectors (docs/theory/features.md, K.0). */
#include "sdk/mesh/crease_scale.h"
#include "sdk/mesh/feature_chains.h"
#include "sdk/mesh/names.h"

#include <string.h>

enum { NAMED = 8 };

typedef qc__feature_network network;
typedef qc__chain chain;

/* Chains of creases along which the surface does not bend by `blunt` on average, as measured at the
 * scale of half a quad, once in so much of their length. */
static qc_status mark_blunt(qc_ctx *ctx, network *w, double half, double blunt) {
    qc__crease_scale *scale = NULL;
    const qc_status status = qc__crease_scale_create(ctx, w->mesh, half, &scale);
    for (int32_t i = 0; status == QC_OK && i < w->n; i++) {
        chain *c = &w->chain[i];
        double sum = 0, total = 0, since = INFINITY, bend = 0;
        for (int32_t j = c->first; j < c->first + c->n; j++) {
            const int32_t e = w->list[j];
            if (w->edge[e] != QC_FEATURE_CREASE) continue;
            if (since >= half) {
                bend = qc__crease_scale_at(scale, w->of, e);
                since = 0;
            }
            since += w->length[e];
            total += w->length[e];
            sum += w->length[e] * bend;
        }
        c->drop = sum < blunt * total;
    }
    qc__crease_scale_free(scale);
    return status;
}

static void mark_short(network *w, double least) {
    for (int32_t i = 0; i < w->n; i++) {
        chain *c = &w->chain[i];
        const bool round = c->end[0] == c->end[1] && !w->node[c->end[0]];
        const bool loose = w->degree[c->end[0]] == 1 || w->degree[c->end[1]] == 1;
        c->drop = c->strength < 0.999 * QC__STRENGTH_DRAWN &&
                  ((round && c->length < 2 * least) || (loose && c->length < least));
    }
}

/* The edges before and after the sector from corner c on, and its angle; false when c begins none.
 */
static bool sector_at(const network *w, int32_t c, int32_t side[2], double *angle) {
    const qc_mesh *mesh = w->mesh;
    side[0] = mesh->halfedge_edge[qc_prev(c)];
    *angle = 0;
    if (!w->edge[side[0]]) return false;
    while (c >= 0) {
        *angle += w->angle[c];
        side[1] = mesh->halfedge_edge[qc_next(c)];
        if (w->edge[side[1]]) return side[0] != side[1];
        c = qc_corner_ccw(mesh, c);
    }
    return false;
}

/* Strengths and lengths are sums: rounding must not tell equal ones apart. */
static bool clearly_less(double a, double b) {
    return a < (1 - 1e-9) * b;
}

/* Of the two chains at a sharp sector the weaker one loses, of equal ones the shorter; -1 = both
 * are the boundary. */
static int32_t weaker(const network *w, const int32_t side[2]) {
    const int32_t i = w->of[side[0]], j = w->of[side[1]];
    const chain *a = &w->chain[i], *b = &w->chain[j];
    if (fmin(a->strength, b->strength) > 0.999 * QC__STRENGTH_BOUNDARY) return -1;
    if (clearly_less(a->strength, b->strength)) return i;
    if (clearly_less(b->strength, a->strength)) return j;
    if (clearly_less(a->length, b->length)) return i;
    if (clearly_less(b->length, a->length)) return j;
    return i > j ? i : j;
}

/* A chain which is the stronger one elsewhere waits: what it lost against may go first. */
static void mark_sharp(qc_ctx *ctx, network *w, double sharp) {
    int32_t side[2];
    double angle;
    for (int32_t c = 0; c < 3 * w->mesh->n_faces; c++) {
        if (!sector_at(w, c, side, &angle) || !(angle < sharp)) continue;
        const int32_t i = weaker(w, side), j = w->of[side[0]] + w->of[side[1]] - i;
        if (i < 0) continue;
        w->chain[i].lost = true;
        if (j != i) w->chain[j].won = true;
    }
    for (int32_t c = 0; c < 3 * w->mesh->n_faces; c++) {
        if (!sector_at(w, c, side, &angle) || !(angle < sharp)) continue;
        const int32_t i = weaker(w, side);
        if (i < 0 || w->chain[i].won || w->chain[i].drop) continue;
        w->chain[i].drop = true;
        if (w->named++ >= NAMED) continue;
        char name[3][QC__ELEMENT_NAME];
        qc__log(ctx, QC_LOG_WARNING,
                "feature from %s to %s, of length %.3g, dropped: at %s it meets another one in "
                "%.0f degrees, which leaves no room for quads",
                qc__vertex_name(w->mesh, w->chain[i].end[0], name[0]),
                qc__vertex_name(w->mesh, w->chain[i].end[1], name[1]), w->chain[i].length,
                qc__vertex_name(w->mesh, w->mesh->face_vertex[c], name[2]),
                angle * 57.29577951308232);
    }
}

static int32_t drop_marked(network *w) {
    int32_t dropped = 0;
    for (int32_t e = 0; e < w->mesh->n_edges; e++)
        if (w->of[e] >= 0 && w->chain[w->of[e]].drop) w->edge[e] = 0;
    for (int32_t i = 0; i < w->n; i++) dropped += w->chain[i].drop;
    return dropped;
}

static qc_status prune(qc_ctx *ctx, network *w, const qc_prune_options *o) {
    int32_t dropped = 1, noise = 0;
    qc__find_chains(w);
    qc_status status = mark_blunt(ctx, w, o->half, o->blunt);
    if (status != QC_OK) return status;
    noise += drop_marked(w);
    while (dropped > 0) {
        qc__find_chains(w);
        mark_short(w, o->least);
        dropped = drop_marked(w);
        noise += dropped;
        if (dropped == 0) {
            mark_sharp(ctx, w, o->sharp);
            dropped = drop_marked(w);
        }
        if (!qc__progress(ctx, 0.5)) return QC_ERR_CANCELLED;
    }
    if (noise > 0) qc__log(ctx, QC_LOG_INFO, "%d short creases dropped", (int)noise);
    if (w->named > NAMED)
        qc__log(ctx, QC_LOG_WARNING, "%d more features dropped for the same reason",
                (int)w->named - NAMED);
    return QC_OK;
}

qc_status qc_features_prune(qc_ctx *ctx, const qc_mesh *mesh, const qc_prune_options *options,
                            uint8_t *edge) {
    qc_prune_options o = QC_PRUNE_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    network w;
    qc_status status = qc__feature_network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) status = qc__close_feature_gaps(ctx, &w, o.weak);
    if (status == QC_OK) status = prune(ctx, &w, &o);
    for (int32_t e = 0; status == QC_OK && e < mesh->n_edges; e++) edge[e] = w.edge[e];
    qc__feature_network_free(&w);
    return status;
}
