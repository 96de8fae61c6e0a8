/* Stage qc.extract: quads from an integer-seamless map, through the exact grid map. */
#include <qc/map.h>
#include <qc/stages.h>

typedef struct extract_params {
    double tolerance;
} extract_params;

static qc_status run(const qc_run *run, const void *params) {
    const extract_params *p = params;
    const qc_corner_map *map = run->input(run, "map");
    qc_grid_map *grid = NULL;
    qc_polygon_mesh *quads = NULL;
    qc_status status = qc_grid_map_create(run->ctx, map, p->tolerance, &grid);
    if (status == QC_OK) status = qc_map_extract(run->ctx, grid, &quads);
    qc_object_release(grid);
    return status == QC_OK ? run->output(run, "quads", quads) : status;
}

static const qc_port in[] = {
    {"map", QC_TYPE_CORNER_MAP, 0, "integer-seamless parameters, all faces positively oriented"},
};
static const qc_port out[] = {
    {"quads", QC_TYPE_POLYGON_MESH, 0, "pure quad mesh with source faces and barycentrics"},
};
static const qc_param params[] = {
    QC_PARAM_REAL(extract_params, tolerance, 0.05, 0, 0.499, "",
                  "largest seam mismatch taken for rounding noise, in parameter units (0 = 0.05)"),
};

const qc_stage qc_stage_extract = {
    QC_STAGE_SIZES,
    "qc.extract",
    "1.0",
    "quads from an integer-seamless map",
    "Puts the map on a fixed-point grid, so that all transitions and orientation tests are exact, "
    "and "
    "traces the integer isolines from grid point to grid point. The result has only quads, is "
    "manifold "
    "and has the Euler characteristic and the boundary loops of the surface; otherwise the stage "
    "fails "
    "and names the place. Maps which fold over are refused: run qc.untangle before.\n\n"
    "Next to boundaries which do not follow isolines cells covered by half become quads whose "
    "outer "
    "vertices are on the boundary.",
    "Ebke, Bommes, Campen, Kobbelt: QEx: Robust Quad Mesh Extraction (2013)",
    in,
    out,
    1,
    1,
    params,
    1,
    sizeof(extract_params),
    run,
};
