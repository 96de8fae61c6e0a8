/* Refines the mesh under a matching until a piecewise linear map with the cones on lattice points
 * can be locally injective. A sector of k quarter turns needs more than k/2 triangles, as each
 * image angle is below pi; and the ends of an edge are not both to be pinned, as their images may
 * coincide or lie in a direction which another pinned neighbour has too. Hard features pin in the
 * same way, but for the edges along them. */
#include "refine.h"
#include "sector.h"

/* Vertices which the map pins: cones, and those on hard features. */
enum { CONE = 1, HARD = 2 };

static void mark_pinned(const qc_matching *matching, uint8_t *pinned) {
    const qc_mesh *mesh = matching->field->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) pinned[v] = matching->index4[v] ? CONE : 0;
    for (int32_t e = 0; matching->axis && e < mesh->n_edges; e++)
        for (int i = 0; i < 2; i++)
            if (matching->axis[e] >= 0) pinned[mesh->edge_vertex[2 * e + i]] |= HARD;
}

/* The link of vertices inside which have too few triangles for their angle of 4 - index4 quarter
 * turns. */
static void mark_links(const qc_matching *matching, const uint8_t *pinned, int32_t *valence,
                       uint8_t *split) {
    const qc_mesh *mesh = matching->field->mesh;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) valence[mesh->face_vertex[c]]++;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t v = mesh->face_vertex[c];
        if (2 * valence[v] <= 4 - matching->index4[v] && !qc_vertex_on_boundary(mesh, v) &&
            !(pinned[v] & HARD))
            split[mesh->halfedge_edge[c]] = 1;
    }
}

/* The same for sectors of k quarter turns at hard features. */
static qc_status mark_sectors(qc_ctx *ctx, const qc_matching *matching, uint8_t *split) {
    const qc_mesh *mesh = matching->field->mesh;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc__sectors all = {0, NULL};
    qc_status status = edge ? qc_tangent_edges(ctx, mesh, edge) : QC_ERR_NOMEM;
    if (!status)
        status =
            qc__sectors_create(ctx, mesh, matching->field->aligned, edge, matching->theta, &all);
    for (int32_t i = 0; i < all.n; i++) {
        const qc__sector *s = &all.sector[i];
        if (2 * s->n > s->turns) continue;
        for (int32_t j = 0, c = s->first; j < s->n; j++, c = qc_corner_ccw(mesh, c))
            split[mesh->halfedge_edge[c]] = 1;
    }
    qc__sectors_free(&all);
    qc__free(edge);
    return status;
}

static qc_status mark_edges(qc_ctx *ctx, const qc_matching *matching, uint8_t *split, bool *any) {
    const qc_mesh *mesh = matching->field->mesh;
    uint8_t *pinned = QC__NEW(ctx, uint8_t, mesh->n_vertices);
    int32_t *valence = QC__ZERO(ctx, int32_t, mesh->n_vertices);
    qc_status status = pinned && valence ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        mark_pinned(matching, pinned);
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            const uint8_t *ends[2] = {&pinned[mesh->edge_vertex[2 * e]],
                                      &pinned[mesh->edge_vertex[2 * e + 1]]};
            split[e] = *ends[0] && *ends[1] && !(matching->axis && matching->axis[e] >= 0);
        }
        mark_links(matching, pinned, valence, split);
        if (matching->axis) status = mark_sectors(ctx, matching, split);
    }
    *any = false;
    for (int32_t e = 0; !status && e < mesh->n_edges; e++) *any = *any || split[e];
    qc__free(pinned);
    qc__free(valence);
    return status;
}

qc_status qc_matching_split(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                            qc_mesh **mesh, qc_sizing **sizing_out, qc_matching **matching_out) {
    const qc_mesh *old = matching->field->mesh;
    if (sizing->mesh != old)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the sizing and the matching are of different meshes");
    uint8_t *split = QC__NEW(ctx, uint8_t, old->n_edges);
    qc__refinement b = {NULL, NULL, NULL, NULL};
    bool any = false;
    qc_status status = split ? mark_edges(ctx, matching, split, &any) : QC_ERR_NOMEM;
    if (!status && !any) {
        *mesh = qc_object_retain(old);
        *sizing_out = qc_object_retain(sizing);
        *matching_out = qc_object_retain(matching);
    } else if (!status) {
        status = qc__bisect_edges(ctx, old, split, &b);
        if (!status)
            status = qc__refinement_carry(ctx, &b, matching, sizing, matching_out, sizing_out);
        if (!status) *mesh = qc_object_retain(b.mesh);
    }
    qc__refinement_free(&b);
    qc__free(split);
    return status;
}
