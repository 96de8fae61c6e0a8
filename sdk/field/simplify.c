/* Removes the maxima and minima of a function which are hardly higher or deeper than the saddle
 * next to them: hills below the threshold are found by their persistence and filled
 * (docs/theory/poles.md). */
#include "hills.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = 12 };

/* Cotangents, but positive, so that no value leaves the range of those around. */
static qc_status make_weights(qc_ctx *ctx, const qc_mesh *mesh, double *weight) {
    const double least = 0.1;
    double *cotangent = QC__NEW(ctx, double, 3 * (int64_t)mesh->n_faces);
    qc_status status = cotangent ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL);
    for (int32_t e = 0; !status && e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[2 * e], g = mesh->edge_halfedge[2 * e + 1];
        weight[e] = fmax(0.5 * (cotangent[h] + (g >= 0 ? cotangent[g] : 0)), least);
    }
    qc__free(cotangent);
    return status;
}

static int32_t count_extrema(const qc__hills *s) {
    int32_t n = 0;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        int32_t c = -1, w, e;
        bool low = false, high = false;
        while ((w = qc__next_neighbour(s->mesh, v, &c, &e)) >= 0)
            if (s->rank[w] < s->rank[v])
                low = true;
            else
                high = true;
        n += !low || !high;
    }
    return n;
}

/* Hollows and hills in turn. First between true values on the shore, down to a floor which keeps
 * new extrema low: the fill is smooth, but on a ridge it may sink below the far shore. Then between
 * saddle and level shore, where no vertex becomes an extremum. */
static qc_status rounds(qc_ctx *ctx, qc__hills *s, const double *weight, int32_t *removed,
                        int32_t *left) {
    qc_status status = QC_OK;
    int32_t n[2] = {1, 1};
    for (int32_t i = 0; !status && i < ROUNDS && n[0] + n[1] > 0; i++) {
        if (!qc__progress(ctx, (double)i / ROUNDS)) return QC_ERR_CANCELLED;
        s->sign = i % 2 ? -1 : 1;
        s->flat = i >= 2;
        status = qc__hills_sort(ctx, s);
        if (status) break;
        if (i == 0) *removed = count_extrema(s);
        qc__hills_sweep(s);
        for (int32_t v = 0; i < 2 && v < s->mesh->n_vertices; v++) s->keep[v] |= s->extreme[v];
        n[i % 2] = qc__hills_release(s);
        if (n[i % 2] > 0) status = qc__hills_fill(ctx, s, weight);
    }
    if (!status) status = qc__hills_sort(ctx, s);
    if (!status) *removed -= count_extrema(s);
    *left = n[0] + n[1];
    return status;
}

static qc_status simplify(qc_ctx *ctx, const qc_mesh *mesh, double height, double *g,
                          int32_t *removed, int32_t *left) {
    const size_t size = sizeof *g * (size_t)mesh->n_vertices;
    double *copy = QC__NEW(ctx, double, mesh->n_vertices);
    double *weight = QC__NEW(ctx, double, mesh->n_edges);
    qc__hills hills = {0};
    qc_status status = copy && weight ? QC_OK : QC_ERR_NOMEM;
    if (!status) memcpy(copy, g, size);
    if (!status) status = qc__hills_create(ctx, mesh, copy, height, &hills);
    if (!status) status = make_weights(ctx, mesh, weight);
    if (!status) status = rounds(ctx, &hills, weight, removed, left);
    if (!status) memcpy(g, copy, size);
    qc__hills_free(&hills);
    qc__free(weight);
    qc__free(copy);
    return status;
}

qc_status qc_scalar_simplify(qc_ctx *ctx, const qc_mesh *mesh, double persistence, double *g,
                             int32_t *removed) {
    double least = INFINITY, most = -INFINITY;
    int32_t found = 0, left = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!isfinite(g[v]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, v, "the function is not finite at vertex %d",
                            (int)v);
        least = fmin(least, g[v]);
        most = fmax(most, g[v]);
    }
    if (!(persistence >= 0 && persistence < 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "persistence is %g, not in [0, 1)", persistence);
    const double height = persistence * (most - least);
    if (height > 0) {
        qc_status status = simplify(ctx, mesh, height, g, &found, &left);
        if (status) return status;
        if (left > 0)
            qc__log(ctx, QC_LOG_WARNING, "%d low extrema of the function stay", (int)left);
    }
    if (removed) *removed = found;
    return QC_OK;
}
