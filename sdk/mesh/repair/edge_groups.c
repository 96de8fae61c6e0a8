/* Halfedges of a triangle list grouped by their undirected edge, in linear time. */
#include "sdk/mesh/repair/internal.h"

qc_status qc__edge_groups_create(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces,
                                 const int32_t *vertex, qc__edge_groups *out) {
    int32_t n = 3 * n_faces;
    *out = (qc__edge_groups){0};
    int32_t *lo = QC__NEW(ctx, int32_t, n), *hi = QC__NEW(ctx, int32_t, n);
    int32_t *order = QC__NEW(ctx, int32_t, n), *start = QC__NEW(ctx, int32_t, (size_t)n + 1);
    qc_status status = lo && hi && order && start ? QC_OK : QC_ERR_NOMEM;
    for (int32_t h = 0; status == QC_OK && h < n; h++) {
        int32_t a = vertex[qc_next(h)], b = vertex[qc_prev(h)];
        lo[h] = a < b ? a : b;
        hi[h] = a < b ? b : a;
    }
    if (status == QC_OK) status = qc__sort_pairs(ctx, n_vertices, n, lo, hi, order);
    if (status == QC_OK) {
        int32_t m = 0;
        for (int32_t i = 0; i < n; i++)
            if (i == 0 || lo[order[i]] != lo[order[i - 1]] || hi[order[i]] != hi[order[i - 1]])
                start[m++] = i;
        start[m] = n;
        *out = (qc__edge_groups){m, order, start};
    } else {
        qc__free(order);
        qc__free(start);
    }
    qc__free(lo);
    qc__free(hi);
    return status;
}

void qc__edge_groups_free(qc__edge_groups *g) {
    qc__free(g->order);
    qc__free(g->start);
    *g = (qc__edge_groups){0};
}
