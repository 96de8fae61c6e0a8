/* Which flips the search may make: the number of branch points, their indices, their distances. */
#include <stdlib.h>

#include "sdk/optimize/internal.h"

/* A vertex of index 1/4 has valence 3, one of -2/4 valence 6: what control cages bear well. */
enum { INDEX_MIN = -2, INDEX_MAX = 1 };

bool qc__index_allowed(int32_t old, int32_t new) {
    return (new >= INDEX_MIN &&new <= INDEX_MAX) || abs(new) < abs(old);
}

static double distance2(const qc_mesh *mesh, int32_t p, int32_t q) {
    double d[3];
    qc__sub(mesh->position + 3 * (size_t)p, mesh->position + 3 * (size_t)q, d);
    return qc__dot3(d, d);
}

/* Squared distance from p to the nearest other branch point, of those reached over edges inside the
 * ball of the given radius; its square when there is none. */
static double nearest2(const qc_distortion *d, double radius, int32_t p, int32_t except) {
    enum { MOST = 256 };
    const qc_mesh *mesh = d->mesh;
    int32_t seen[MOST], n = 1;
    double least = radius * radius;
    seen[0] = p;
    for (int32_t i = 0; i < n; i++) {
        const int32_t first = mesh->vertex_corner[seen[i]];
        for (int32_t c = first, go = 1; go && c >= 0;) {
            const int32_t q[2] = {mesh->face_vertex[qc_next(c)], mesh->face_vertex[qc_prev(c)]};
            for (int k = 0; k < 2; k++) {
                const double square = distance2(mesh, p, q[k]);
                bool known = square >= least;
                for (int32_t j = 0; j < n && !known; j++) known = seen[j] == q[k];
                if (known) continue;
                if (d->index4[q[k]] != 0 && q[k] != except) least = square;
                if (n < MOST) seen[n++] = q[k];
            }
            c = qc_corner_ccw(mesh, c);
            go = c != first;
        }
    }
    return least;
}

int32_t qc__new_branch_points(const qc_distortion *d, qc_flip_step flip) {
    const int32_t h = d->mesh->edge_halfedge[2 * flip.edge];
    const int32_t p[2] = {qc_halfedge_start(d->mesh, h), qc_halfedge_end(d->mesh, h)};
    int32_t more = 0;
    for (int i = 0; i < 2; i++) {
        if (qc_vertex_on_boundary(d->mesh, p[i])) continue;
        const int32_t old = d->index4[p[i]];
        more += (old + (i == 0 ? flip.step : -flip.step) != 0) - (old != 0);
    }
    return more;
}

bool qc__flip_allowed(const qc_distortion *d, const qc__rules *rules, qc_flip_step flip) {
    const int32_t h = d->mesh->edge_halfedge[2 * flip.edge];
    const int32_t p[2] = {qc_halfedge_start(d->mesh, h), qc_halfedge_end(d->mesh, h)};
    const int32_t step[2] = {flip.step, -flip.step};
    const int32_t more = qc__new_branch_points(d, flip);
    for (int i = 0; i < 2; i++) {
        const int32_t old = d->index4[p[i]];
        if (!qc_vertex_on_boundary(d->mesh, p[i]) && !qc__index_allowed(old, old + step[i]))
            return false;
    }
    if (!rules->create && more > 0) return false;
    if (!(rules->spacing > 0) || more != 0) return true;
    for (int i = 0; i < 2; i++) { /* from p[1 - i] to p[i] */
        if (qc_vertex_on_boundary(d->mesh, p[i]) || d->index4[p[i]] != 0) continue;
        const double there = nearest2(d, rules->spacing, p[i], p[1 - i]);
        if (there < rules->spacing * rules->spacing &&
            there < nearest2(d, rules->spacing, p[1 - i], p[i]))
            return false;
    }
    return true;
}
