/* Quad extraction from an exact integer-grid map (stages/extract/extract.md, after Ebke, Bommes,
 * Campen, Kobbelt, "QEx: robust quad mesh extraction", 2013) with its acceptance test. */
#include "sdk/map/extract/internal.h"
#include "sdk/mesh/names.h"

static qc_status check_map(qc_ctx *ctx, const qc_grid_map *g) {
    if (!g) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "grid is NULL");
    const int32_t n = g->n_flipped + g->n_degenerate;
    if (n == 0) return QC_OK;
    char list[128];
    int used = 0, named = 0;
    for (int32_t t = g->first_flipped; t < g->mesh->n_faces && named < 4; t++) {
        const int64_t area = qc_grid_map_orientation(g, t);
        if (area > 0 || (g->n_flipped > 0 && area == 0)) continue;
        used += snprintf(list + used, sizeof list - (size_t)used, "%s%d", named++ ? ", " : "",
                         (int)qc__face_number(g->mesh, t));
    }
    return qc__fail(
        ctx, QC_ERR_FAILED, g->first_flipped,
        "map %s at %d face%s (first: face %s%s); try a finer density or run qc.untangle "
        "before",
        g->n_flipped > 0 ? "folds over" : "is degenerate", (int)n, n == 1 ? "" : "s", list,
        n > named ? " ..." : "");
}

/* A face of the input next to a defect, for the error text: the source of a vertex of the first bad
 * quad. */
static int32_t place_of(const qc_polygon_mesh *q, const qc_polygon_topology *t) {
    const int32_t i = t->first_bad_element;
    if (i < 0 || q->n_faces == 0) return -1;
    if (t->non_manifold_edges == 0 && t->non_manifold_vertices > 0 && i < q->n_vertices)
        return q->source_face[i];
    return i < q->n_faces ? q->source_face[q->face_vertex[q->face_offset[i]]] : -1;
}

static qc_status accept(qc_ctx *ctx, const qc_mesh *m, const qc_polygon_mesh *q) {
    qc_polygon_topology t;
    const qc_status status = qc_polygon_mesh_topology(ctx, q, &t);
    if (status != QC_OK) return status;
    if (t.non_quads || t.non_manifold_edges || t.non_manifold_vertices || t.inconsistent_edges ||
        t.duplicate_faces || t.degenerate_faces || t.unreferenced_vertices) {
        const int32_t face = place_of(q, &t);
        return qc__fail(
            ctx, QC_ERR_FAILED, face,
            "the grid is too coarse near face %d: %d edges and %d vertices of the quad "
            "mesh are not manifold, %d quads coincide, %d are degenerate; try a finer "
            "density",
            (int)qc__face_number(m, face), (int)(t.non_manifold_edges + t.inconsistent_edges),
            (int)t.non_manifold_vertices, (int)t.duplicate_faces, (int)t.degenerate_faces);
    }
    const int32_t loops = m->n_boundary_loops - m->n_poles, euler = m->euler + m->n_poles;
    if (t.components == m->n_components && t.boundary_loops == loops && t.euler == euler)
        return QC_OK;
    return qc__fail(ctx, QC_ERR_FAILED, -1,
                    "the quad mesh has %d components, %d boundary loops and Euler characteristic "
                    "%d, the surface %d, %d and %d: something is narrower than a quad; try a finer "
                    "density",
                    (int)t.components, (int)t.boundary_loops, (int)t.euler, (int)m->n_components,
                    (int)loops, (int)euler);
}

static qc_status extract(qc_ctx *ctx, const qc_grid_map *grid, qc__lattice *lattice,
                         qc__ports *ports, qc__cells *cells, qc_polygon_mesh **quads) {
    qc_status status = qc__lattice_create(ctx, grid, lattice);
    if (status == QC_OK) status = qc__ports_create(ctx, lattice, ports);
    if (status == QC_OK) status = qc__ports_trace(ctx, ports);
    if (status == QC_OK) status = qc__cells_create(ctx, ports, cells);
    if (status == QC_OK && !qc__progress(ctx, 0.85)) status = QC_ERR_CANCELLED;
    if (status == QC_OK && lattice->open) status = qc__cells_keep(ctx, ports, cells);
    if (status == QC_OK && cells->n == 0)
        status =
            qc__fail(ctx, QC_ERR_FAILED, -1, "the map has no quad at all; try a finer density");
    if (status == QC_OK) status = qc__quads_create(ctx, ports, cells, quads);
    return status;
}

qc_status qc_map_extract(qc_ctx *ctx, const qc_grid_map *grid, qc_polygon_mesh **out) {
    qc_status status = check_map(ctx, grid);
    if (status != QC_OK) return status;
    qc__lattice lattice = {0};
    qc__ports ports = {0};
    qc__cells cells = {0};
    qc_polygon_mesh *quads = NULL;
    status = extract(ctx, grid, &lattice, &ports, &cells, &quads);
    qc__cells_free(&cells);
    qc__ports_free(&ports);
    qc__lattice_free(&lattice);
    if (status == QC_OK && !qc__progress(ctx, 0.9)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) status = accept(ctx, grid->mesh, quads);
    if (status == QC_OK && !qc__progress(ctx, 1.0)) status = QC_ERR_CANCELLED;
    if (status == QC_OK)
        *out = quads;
    else
        qc_object_release(quads);
    return status;
}
