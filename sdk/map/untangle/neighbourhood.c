/* Where to untangle: the rings about bad places, which are folded faces and cones of a wrong
 * winding, and the patches into which they fall (docs/theory/untangling.md). */
#include "sdk/map/untangle/untangler.h"

typedef qc__untangler untangler;

static const double good_det = 1e-4; /* faces below it count as folded */

bool qc__is_wrong_cone(const untangler *u, int32_t v) {
    return u->guide.cross && qc__pinned(u->map, v) &&
           qc__guide_turns(&u->guide, v) != qc__map_turns(&u->guide, v);
}

static void mark(untangler *u, int32_t v, int32_t *n_queue) {
    if (u->distance[v] >= 0) return;
    u->distance[v] = 0;
    u->queue[(*n_queue)++] = v;
}

int32_t qc__mark_neighbourhood(untangler *u, int32_t rings) {
    const qc_mesh *mesh = u->mesh;
    int32_t n = 0, bad = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) u->distance[v] = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!qc__is_wrong_cone(u, v)) continue;
        bad++;
        mark(u, v, &n);
    }
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        if (qc__face_det(u->map, u->hat, t) > good_det) continue;
        bad++;
        for (int32_t k = 0; k < 3; k++) mark(u, mesh->face_vertex[3 * (int64_t)t + k], &n);
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = u->queue[i], start = mesh->vertex_corner[v];
        if (u->distance[v] >= rings) continue;
        int32_t c = start;
        do {
            for (int32_t k = 1; k < 3; k++) {
                const int32_t w = mesh->face_vertex[3 * (c / 3) + (c % 3 + k) % 3];
                if (u->distance[w] >= 0) continue;
                u->distance[w] = u->distance[v] + 1;
                u->queue[n++] = w;
            }
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
    return bad;
}

void qc__collect_patch(untangler *u, int32_t seed) {
    const qc_mesh *mesh = u->mesh;
    u->stamp++;
    u->n_patch = u->n_patch_faces = 0;
    u->vertex[u->n_patch++] = seed;
    u->distance[seed] = -1;
    for (int32_t i = 0; i < u->n_patch; i++) {
        const int32_t start = mesh->vertex_corner[u->vertex[i]];
        int32_t c = start;
        do {
            const int32_t t = c / 3;
            if (u->face_stamp[t] != u->stamp) {
                u->face_stamp[t] = u->stamp;
                u->face[u->n_patch_faces++] = t;
            }
            for (int32_t k = 0; k < 3; k++) {
                const int32_t w = mesh->face_vertex[3 * (int64_t)t + k];
                if (u->distance[w] < 0 || qc__pinned(u->map, w)) continue;
                u->distance[w] = -1;
                u->vertex[u->n_patch++] = w;
            }
            c = qc_corner_ccw(mesh, c);
        } while (c >= 0 && c != start);
    }
}
