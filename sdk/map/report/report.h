/* Parts of qc_report_measure, one file each. Internal to sdk/map. */
#ifndef QC_MAP_REPORT_H
#define QC_MAP_REPORT_H

#include "sdk/base/internal.h"
#include <qc/map.h>

/* report->uv and report->energy of a map. */
qc_status qc__report_map(qc_ctx *ctx, const qc_corner_map *map, qc_report *report);
/* Counts, edge lengths, angles and scaled Jacobian of quads. */
qc_status qc__report_quads(qc_ctx *ctx, const qc_polygon_mesh *quads, qc_report *report);
/* Distance between the features of the map and the lines of the quads. */
qc_status qc__report_features(qc_ctx *ctx, const qc_corner_map *map, const qc_polygon_mesh *quads,
                              qc_report *report);
/* Distances between quads and mesh. */
qc_status qc__report_distance(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads,
                              const qc_closest_point *closest, qc_report *report);

#endif
