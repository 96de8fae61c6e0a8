/* Quarter turns of the sectors at hard features. With the angle a of a sector and the turning
 * angles theta of the edges inside it,
 *     k pi / 2 = a - sum +-theta,   + where s -> t is counter-clockwise about the vertex,
 * is a multiple of pi / 2, since the crosses of its first and last face run along the features
 * (Nieser, Parameterization and tiling of polyhedral surfaces (2012)). A map which is locally
 * injective and has the features on isolines needs k >= 1. */
#include "sector.h"

#include <stdlib.h>

/* The edge on the clockwise side of corner c, and on its counter-clockwise side. */
static int32_t edge_before(const qc_mesh *mesh, int32_t c) {
    return mesh->halfedge_edge[qc_prev(c)];
}
static int32_t edge_after(const qc_mesh *mesh, int32_t c) {
    return mesh->halfedge_edge[qc_next(c)];
}

/* +1 when crossing the edge after corner c is from s to t. */
static int32_t direction(const qc_mesh *mesh, int32_t c) {
    return mesh->edge_halfedge[2 * edge_after(mesh, c)] == qc_next(c) ? 1 : -1;
}

/* Number of faces from corner c on to the next feature, 0 when the boundary comes first. */
static int32_t count_faces(const qc_mesh *mesh, const uint8_t *aligned, int32_t c) {
    int32_t n = 1;
    for (; !aligned[edge_after(mesh, c)]; n++)
        if ((c = qc_corner_ccw(mesh, c)) < 0) return 0;
    return n;
}

static qc_status measure(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                         const double *theta, qc__sector *s) {
    double sum = s->angle = 0;
    for (int32_t i = 0, c = s->first; i < s->n; i++, c = qc_corner_ccw(mesh, c)) {
        s->angle += qc__corner_angle(edge, c);
        if (i < s->n - 1) sum += direction(mesh, c) * theta[edge_after(mesh, c)];
    }
    const double turns = 2 * (s->angle - sum) / QC__PI;
    s->turns = (int32_t)round(turns);
    if (fabs(turns - s->turns) < 0.1) return QC_OK;
    return qc__fail(ctx, QC_ERR_FAILED, s->vertex,
                    "the cross turns by %g quarters between two features at vertex %d: it does "
                    "not run along them",
                    turns, (int)s->vertex);
}

qc_status qc__sectors_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *aligned,
                             const qc_complex *edge, const double *theta, qc__sectors *out) {
    int32_t most = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) most += 2 * (aligned[e] != 0);
    qc__sectors all = {0, QC__NEW(ctx, qc__sector, most)};
    qc_status status = all.sector ? QC_OK : QC_ERR_NOMEM;
    for (int32_t v = 0; !status && v < mesh->n_vertices; v++) {
        const int32_t first = mesh->vertex_corner[v];
        int32_t c = first;
        do {
            const int32_t n = aligned[edge_before(mesh, c)] ? count_faces(mesh, aligned, c) : 0;
            if (n > 0) {
                qc__sector *s = &all.sector[all.n++];
                *s = (qc__sector){v, c, n, 0, 0, 0};
                status = measure(ctx, mesh, edge, theta, s);
            }
            c = qc_corner_ccw(mesh, c);
        } while (!status && c >= 0 && c != first);
    }
    if (status)
        qc__sectors_free(&all);
    else
        *out = all;
    return status;
}

void qc__sectors_free(qc__sectors *sectors) {
    qc__free(sectors->sector);
    *sectors = (qc__sectors){0, NULL};
}

static int32_t wanted_turns(const qc__sector *s) {
    const double angle = 2 * s->angle / QC__PI;
    if (s->wanted > 0) return s->wanted;
    if (s->turns >= 1 && fabs(s->turns - angle) < 1) return s->turns;
    return angle < 1 ? 1 : (int32_t)round(angle);
}

/* Of a vertex on no feature: by how much one quarter more raises the size of its index. */
static int32_t index_growth(const qc_mesh *mesh, const qc_complex *edge, const double *theta,
                            int32_t v, int32_t step) {
    if (qc_vertex_on_boundary(mesh, v)) return 0;
    const int32_t index4 = (int32_t)round(qc__vertex_index4(mesh, edge, theta, v));
    return abs(index4 + step) - abs(index4);
}

/* Corner before the edge of the sector where one more turn (step = 1 or -1) leaves the least angle,
 * where cones may cancel rather than grow; -1 = all of them end on features. */
static int32_t best_edge(const qc_mesh *mesh, const qc__sector *s, const uint8_t *hard,
                         const qc_complex *edge, const double *theta, int32_t step) {
    double least = INFINITY;
    int32_t best = -1;
    for (int32_t i = 0, c = s->first; i < s->n - 1; i++, c = qc_corner_ccw(mesh, c)) {
        const int32_t end = mesh->face_vertex[qc_prev(c)];
        if (hard[end]) continue;
        const double left =
            fabs(direction(mesh, c) * theta[edge_after(mesh, c)] - step * QC__PI / 2) +
            QC__PI / 2 * index_growth(mesh, edge, theta, end, step);
        if (!(left < least)) continue;
        least = left;
        best = c;
    }
    return best;
}

static bool open_sector(const qc_mesh *mesh, const qc__sector *s, const uint8_t *hard,
                        const qc_complex *edge, double *theta, int8_t *m) {
    const int32_t change = wanted_turns(s) - s->turns, step = change > 0 ? 1 : -1;
    for (int32_t i = 0; i != change; i += step) {
        const int32_t c = best_edge(mesh, s, hard, edge, theta, step);
        if (c < 0) return false;
        const int32_t e = edge_after(mesh, c), turn = step * direction(mesh, c);
        theta[e] -= turn * QC__PI / 2;
        if (m) m[e] = (int8_t)(m[e] + turn);
    }
    return true;
}

qc_status qc__sectors_open(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *aligned, double bend,
                           const qc_complex *edge, double *theta, int8_t *m, int32_t *changed) {
    qc__sectors all = {0, NULL};
    uint8_t *hard = QC__ZERO(ctx, uint8_t, mesh->n_vertices);
    qc_status status =
        hard ? qc__sectors_create(ctx, mesh, aligned, edge, theta, &all) : QC_ERR_NOMEM;
    if (!status && bend > 0) status = qc__sectors_find_corners(ctx, mesh, edge, bend, &all);
    if (changed && !status) *changed = 0;
    for (int32_t e = 0; !status && e < mesh->n_edges; e++)
        if (aligned[e]) hard[mesh->edge_vertex[2 * e]] = hard[mesh->edge_vertex[2 * e + 1]] = 1;
    for (int32_t i = 0; i < all.n && !status; i++) {
        const qc__sector *s = &all.sector[i];
        if (wanted_turns(s) == s->turns) continue;
        if (changed) ++*changed;
        if (!open_sector(mesh, s, hard, edge, theta, m))
            status = qc__fail(ctx, QC_ERR_FAILED, s->vertex,
                              "two features meet at vertex %d in an angle which leaves no room "
                              "for a quad: split the mesh there (qc.split.features)",
                              (int)s->vertex);
    }
    qc__sectors_free(&all);
    qc__free(hard);
    return status;
}
