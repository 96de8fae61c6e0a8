/* Pieces of features which must keep their length: points which follow each other on a feature may
 * each be nearer to a third (see separation.h). */
#include "sdk/map/round/separation_finder.h"

typedef qc__finder finder;

/* A feature edge at v which is not used; -1 = none. */
static int32_t next_on_feature(const finder *f, const uint8_t *used, int32_t v) {
    const qc_mesh *mesh = f->seams->mesh;
    const int32_t first = mesh->vertex_corner[v];
    for (int32_t c = first;;) {
        const int32_t before = mesh->halfedge_edge[qc_prev(c)];
        const int32_t after = mesh->halfedge_edge[qc_next(c)];
        if (f->axis[before] >= 0 && !used[before]) return before;
        if (f->axis[after] >= 0 && !used[after]) return after;
        c = qc_corner_ccw(mesh, c);
        if (c < 0 || c == first) return -1;
    }
}

/* The piece of a feature which leaves v, up to the next point or back to v: kept when it is shorter
 * than the reach. */
static qc_status separate_piece(finder *f, qc__separation *s, double reach, int32_t v,
                                uint8_t *used, int32_t *path, qc__walk *walk) {
    int32_t ends[2] = {v, v}, n = 0, parts = 0;
    double length = 0;
    double _Complex way = 0;
    for (int32_t w = v, e; (e = next_on_feature(f, used, w)) >= 0;) {
        used[e] = 1;
        path[n++] = e;
        length += qc__edge_length(f->seams->mesh, e);
        w = qc__other_end(f->seams->mesh, e, w);
        if (w == v || f->seams->vertex_cone[w] >= 0) break;
    }
    if (n == 0 || !(length < reach)) return QC_OK;
    qc_status status = qc__separation_reserve(f, s, s->n + 1);
    if (status == QC_OK) status = qc__separation_develop(f, path, n, walk, &ends[1], &parts, &way);
    return status == QC_OK ? qc__separation_store(f, s, ends, 3) : status;
}

qc_status qc__separation_along(finder *f, qc__separation *s, double reach) {
    const qc__seams *seams = f->seams;
    const qc_mesh *mesh = seams->mesh;
    uint8_t *used = QC__ZERO(f->ctx, uint8_t, mesh->n_edges);
    int32_t *path = QC__NEW(f->ctx, int32_t, mesh->n_edges);
    qc__walk walk = {0};
    qc_status status = used && path ? QC_OK : QC_ERR_NOMEM;
    for (int32_t i = 0; i < seams->n_cones && status == QC_OK; i++) {
        const int32_t v = seams->cone_vertex[i];
        while (status == QC_OK && next_on_feature(f, used, v) >= 0)
            status = separate_piece(f, s, reach, v, used, path, &walk);
    }
    for (int32_t e = 0; e < mesh->n_edges && status == QC_OK; e++)
        if (f->axis[e] >= 0 && !used[e])
            status =
                separate_piece(f, s, reach, mesh->edge_vertex[2 * (int64_t)e], used, path, &walk);
    qc__walk_free(&walk);
    qc__free(used);
    qc__free(path);
    return status;
}
