/* Evening out what untangling moved, and a few rings about it (docs/theory/untangling.md). */
#include "sdk/map/untangle/untangler.h"

#include <math.h>

typedef qc__untangler untangler;

static const double moved_far = 1e-6; /* parameter units: less is rounding on the way */
enum { RELAXED_RINGS = 4 };

/* Vertices which moved from the rounded map have distance 0, rings about them more, others -1. */
static void mark_moved(untangler *u) {
    const qc_mesh *mesh = u->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const qc_complex a = u->map->value[v], b = u->target->value[v];
        u->distance[v] = hypot(a.re - b.re, a.im - b.im) > moved_far ? 0 : -1;
    }
    for (int32_t i = 0; i < RELAXED_RINGS; i++)
        for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
            const int32_t v = qc_halfedge_start(mesh, h), w = qc_halfedge_end(mesh, h);
            if (u->distance[v] == i && u->distance[w] < 0) u->distance[w] = i + 1;
            if (u->distance[w] == i && u->distance[v] < 0) u->distance[v] = i + 1;
        }
}

static qc_status relax_step(untangler *u, qc__patch *patch) {
    return qc__patch_relax(u->ctx, patch, u->options.relax, u->x);
}

qc_status qc__relax_moved(untangler *u) {
    mark_moved(u);
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (u->distance[v] < 0 || qc__pinned(u->map, v)) continue;
        qc__collect_patch(u, v);
        const qc_status status = qc__descend(u, relax_step);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}
