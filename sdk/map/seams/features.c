/* Directions of features, and where they turn (see features.h). */
#include "sdk/map/seams/features.h"

int32_t qc__feature_direction(const qc__features *f, int32_t h) {
    const int32_t e = f->cover->mesh->halfedge_edge[h];
    const int32_t first = f->cover->mesh->edge_halfedge[2 * (int64_t)e];
    const int32_t direction = f->axis[e] + f->face_turn[first / 3];
    if (h == first) return direction & 3;
    return (direction + qc__combed_rotation(f->cover, f->face_turn, first) + 2) & 3;
}

/* The features about a vertex, seen in the chart of its first corner. */
typedef struct star {
    int32_t n, first, last; /* number; directions of the first and the last one */
    double angle;
} star;

static void see(star *s, int32_t direction) {
    if (s->n++ == 0) s->first = direction & 3;
    s->last = direction & 3;
}

static star look_around(const qc__features *f, const double *angle, int32_t v) {
    const qc_mesh *mesh = f->cover->mesh;
    const int32_t start = mesh->vertex_corner[v];
    star s = {0, 0, 0, 0};
    int32_t c = start, turn = 0;
    for (;;) {
        const int32_t out = qc_prev(c), in = qc_next(c);
        s.angle += angle[c];
        if (qc__is_feature(f, out)) see(&s, qc__feature_direction(f, out) - turn);
        const int32_t next = qc_corner_ccw(mesh, c);
        if (next < 0) { /* the boundary edge at the end */
            if (qc__is_feature(f, in)) see(&s, qc__feature_direction(f, in) + 2 - turn);
            return s;
        }
        turn += qc__combed_rotation(f->cover, f->face_turn, in);
        c = next;
        if (c == start) return s;
    }
}

qc_status qc__feature_corners(qc_ctx *ctx, const qc__features *f, uint8_t *corner) {
    const qc_mesh *mesh = f->cover->mesh;
    const double full = 6.28318530717958647692;
    for (int32_t v = 0; v < mesh->n_vertices; v++) corner[v] = 0;
    if (!f->axis) return QC_OK;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (f->axis[e] >= 0)
            for (int32_t k = 0; k < 2; k++) corner[mesh->edge_vertex[2 * (int64_t)e + k]] = 1;
    double *angle = QC__NEW(ctx, double, 3 * (int64_t)mesh->n_faces);
    if (!angle) return QC_ERR_NOMEM;
    const qc_status status = qc_mesh_geometry(ctx, mesh, NULL, NULL, NULL, angle, NULL, NULL);
    for (int32_t v = 0; v < mesh->n_vertices && status == QC_OK; v++) {
        if (!corner[v]) continue;
        const star s = look_around(f, angle, v);
        const bool opposite = s.n == 2 && ((s.first - s.last) & 3) == 2;
        /* at the boundary half a turn may also be one and a half */
        corner[v] = !opposite || (qc_vertex_on_boundary(mesh, v) && s.angle > full);
    }
    qc__free(angle);
    return status;
}
