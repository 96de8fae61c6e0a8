/* Quantization (docs/theory/quantization.md): integers for which an injective map exists, and its
 * values at the vertices of the mesh. */
#include "sdk/map/quantize/imprint.h"

/* Coarse complex and its integer vectors. */
static qc_status find_integers(qc_ctx *ctx, const qc__exact_map *map, double scale, double quads,
                               qc__coarse_map **coarse, qc__point **x, double *made) {
    qc__range outer = qc__range_begin(ctx, NULL, 0, 0.4);
    qc_status status = qc__coarse_map_create(ctx, map, coarse);
    qc__range_end(ctx, outer);
    if (status != QC_OK) return status;
    *x = QC__NEW(ctx, qc__point, 3 * (int64_t)(*coarse)->coarse.n_triangles);
    if (!*x) return QC_ERR_NOMEM;
    outer = qc__range_begin(ctx, NULL, 0.4, 0.9);
    qc__flips flips = {0};
    status = qc__coarse_integers(ctx, &(*coarse)->coarse, scale, quads, *x, made, &flips);
    qc__range_end(ctx, outer);
    qc__coarse_map *c = *coarse;
    if (status == QC_OK)
        status = qc__coarse_flip(ctx, &c->coarse, &flips, map->mesh->n_faces, c->triangle, c->place,
                                 c->turn);
    qc__free(flips.halfedge);
    return status;
}

qc_status qc__quantize(qc_ctx *ctx, const qc__exact_map *map, double scale, double quads,
                       double *uv, double *made, qc__imprint *imprint) {
    qc__coarse_map *coarse = NULL;
    qc__point *x = NULL;
    qc_status status = find_integers(ctx, map, scale, quads, &coarse, &x, made);
    if (status == QC_OK) qc__quantized_values(map, coarse, x, uv);
    if (status == QC_OK && imprint) status = qc__imprint_create(ctx, map, coarse, x, imprint);
    qc__coarse_map_free(coarse);
    qc__free(x);
    return status;
}
