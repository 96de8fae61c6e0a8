/* Charts carried across seams (see qc__walk in seams.h). */
#include "sdk/map/seams/seams.h"

static bool walk_reserve(qc_ctx *ctx, qc__walk *w) {
    if (w->n < w->capacity) return true;
    const int32_t capacity = w->capacity < 16 ? 16 : 2 * w->capacity;
    int32_t *segment = qc__realloc(ctx, w->segment, (size_t)capacity, sizeof *segment);
    if (!segment) return false;
    w->segment = segment;
    int8_t *turn = qc__realloc(ctx, w->term_turn, (size_t)capacity, sizeof *turn);
    if (!turn) return false;
    w->term_turn = turn;
    w->capacity = capacity;
    return true;
}

void qc__walk_free(qc__walk *w) {
    qc__free(w->segment);
    qc__free(w->term_turn);
    *w = (qc__walk){0};
}

/* f -> i^rho f + tau from left to right, i^-rho (f - tau) the other way. */
bool qc__walk_cross(qc_ctx *ctx, const qc__seams *s, qc__walk *w, int32_t h) {
    const int32_t e = s->mesh->halfedge_edge[h], k = s->edge_segment[e];
    if (k < 0) return true;
    const bool from_left = s->edge_left[e] == h;
    const int32_t turn = from_left ? s->segment_turn[k] : -s->segment_turn[k];
    if (!walk_reserve(ctx, w)) return false;
    w->turn = (w->turn + turn) & 3;
    for (int32_t j = 0; j < w->n; j++) w->term_turn[j] = (int8_t)((w->term_turn[j] + turn) & 3);
    w->segment[w->n] = k;
    w->term_turn[w->n++] = (int8_t)(from_left ? 0 : (turn + 2) & 3);
    return true;
}
