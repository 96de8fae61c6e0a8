/* Evening out what untangling moved, what else is badly distorted, and a few rings about both
 * (docs/theory/untangling.md). */
#include "sdk/map/untangle/untangler.h"

#include <math.h>

typedef qc__untangler untangler;

static const double moved_far = 1e-6; /* parameter units: less is rounding on the way */
/* Times the mean energy, in which a face counts with most_energy per area at most: faces above it
 * are evened out. */
static const double distorted = 8, most_energy = 100;
enum { RELAXED_RINGS = 4 };

/* Symmetric Dirichlet energy of face t per area; 4 is the least. */
static double distortion(const untangler *u, int32_t t) {
    qc_complex f[3], gradient[3];
    for (int64_t c = 3 * (int64_t)t; c < 3 * (int64_t)t + 3; c++)
        f[c % 3] = qc__reduced_map_corner(u->map, u->map->value[u->mesh->face_vertex[c]], c);
    return qc__face_barrier(u->hat + 3 * (int64_t)t, 1, f, gradient);
}

/* The corners of badly distorted faces get distance 0. */
static void mark_distorted(untangler *u) {
    const qc_mesh *mesh = u->mesh;
    double energy = 0, area = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        energy += u->area[t] * fmin(distortion(u, t), most_energy);
        area += u->area[t];
    }
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (distortion(u, t) * area > distorted * energy)
            for (int k = 0; k < 3; k++) u->distance[mesh->face_vertex[3 * (int64_t)t + k]] = 0;
}

/* Vertices which moved from the rounded map and those of distorted faces have distance 0, rings
 * about them more, others -1. */
static void mark_uneven(untangler *u) {
    const qc_mesh *mesh = u->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const qc_complex a = u->map->value[v], b = u->target->value[v];
        u->distance[v] = hypot(a.re - b.re, a.im - b.im) > moved_far ? 0 : -1;
    }
    mark_distorted(u);
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

qc_status qc__relax_uneven(untangler *u) {
    const qc_status thin =
        qc__untangle_targets(u->ctx, u->mesh, u->unit, qc__thin_targets, u->hat, u->area);
    if (thin != QC_OK) return thin;
    mark_uneven(u);
    for (int32_t v = 0; v < u->mesh->n_vertices; v++) {
        if (u->distance[v] < 0 || qc__pinned(u->map, v)) continue;
        qc__collect_patch(u, v);
        const qc_status status = qc__descend(u, relax_step);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}
