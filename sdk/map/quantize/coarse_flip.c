/* Flips which the search of the integers has made, made again with the markers of the faces (see
 * coarse.h). */
#include "sdk/map/quantize/triangulation.h"

int32_t qc__coarse_origins(const qc__coarse *c) {
    int32_t n = 0;
    for (int32_t h = 0; h < 3 * c->n_triangles; h++)
        if (c->origin[h] >= n) n = c->origin[h] + 1;
    return n;
}

qc_status qc__coarse_flip(qc_ctx *ctx, qc__coarse *coarse, const qc__flips *flips, int32_t n,
                          int32_t *triangle, qc__point *place, int8_t *turn) {
    qc__triangulation T = {.ctx = ctx,
                           .n_triangles = coarse->n_triangles,
                           .vector = coarse->vector,
                           .twin = coarse->twin,
                           .origin = coarse->origin,
                           .rotation = coarse->rotation,
                           .axis = coarse->axis,
                           .spoke = QC__ZERO(ctx, int32_t, qc__coarse_origins(coarse)),
                           .first_marker = QC__NEW(ctx, int32_t, coarse->n_triangles),
                           .next_marker = QC__NEW(ctx, int32_t, n),
                           .place = place,
                           .turn = turn};
    const bool room = T.spoke && T.first_marker && T.next_marker;
    for (int32_t t = 0; t < T.n_triangles && room; t++) T.first_marker[t] = -1;
    for (int32_t f = 0; f < n && room; f++) {
        T.next_marker[f] = T.first_marker[triangle[f]];
        T.first_marker[triangle[f]] = f;
    }
    for (int64_t i = 0; i < flips->n && room; i++) qc__flip(&T, flips->halfedge[i]);
    for (int32_t t = 0; t < T.n_triangles && room; t++)
        for (int32_t f = T.first_marker[t]; f >= 0; f = T.next_marker[f]) triangle[f] = t;
    qc__free(T.spoke);
    qc__free(T.first_marker);
    qc__free(T.next_marker);
    return room ? QC_OK : QC_ERR_NOMEM;
}
