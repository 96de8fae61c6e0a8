/* What every result promises, whatever stages made it: quads only, a manifold, with the components,
 * boundary loops and Euler characteristic of the surface. */
#include <math.h>

#include "sdk/remesh/internal.h"

static qc_status check_points(qc_ctx *ctx, const qc_polygon_mesh *q) {
    for (int64_t i = 0; i < 3 * (int64_t)q->n_vertices; i++)
        if (!isfinite(q->position[i]))
            return qc__fail(ctx, QC_ERR_FAILED, i / 3,
                            "vertex %lld of the quads is not finite; nothing is written",
                            (long long)(i / 3));
    return QC_OK;
}

qc_status qc__check_promises(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *q) {
    qc_polygon_topology t;
    qc_status status = check_points(ctx, q);
    if (status == QC_OK) status = qc_polygon_mesh_topology(ctx, q, &t);
    if (status != QC_OK) return status;
    if (t.non_quads || t.non_manifold_edges || t.non_manifold_vertices || t.inconsistent_edges ||
        t.duplicate_faces || t.degenerate_faces || t.unreferenced_vertices)
        return qc__fail(ctx, QC_ERR_FAILED, t.first_bad_element,
                        "the result is no manifold of quads: %d faces are no quads, %d edges and "
                        "%d vertices are not manifold, %d faces coincide, %d are degenerate, %d "
                        "vertices are unused; nothing is written",
                        (int)t.non_quads, (int)(t.non_manifold_edges + t.inconsistent_edges),
                        (int)t.non_manifold_vertices, (int)t.duplicate_faces,
                        (int)t.degenerate_faces, (int)t.unreferenced_vertices);
    if (t.components != mesh->n_components || t.boundary_loops != mesh->n_boundary_loops ||
        t.euler != mesh->euler)
        return qc__fail(ctx, QC_ERR_FAILED, -1,
                        "the result has %d components, %d boundary loops and Euler characteristic "
                        "%d, the surface %d, %d and %d; nothing is written",
                        (int)t.components, (int)t.boundary_loops, (int)t.euler,
                        (int)mesh->n_components, (int)mesh->n_boundary_loops, (int)mesh->euler);
    return QC_OK;
}
