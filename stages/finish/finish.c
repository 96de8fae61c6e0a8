/* Stage qc.finish: quads relaxed towards squares on the surface, features and boundary kept. */
#include <qc/field.h>
#include <qc/finish.h>
#include <qc/map.h>
#include <qc/stages.h>

#include "sdk/base/internal.h"

typedef struct params {
    int64_t rounds;
    double quality, uniformity;
    const char *closest;
} params;
static const char *const closest_points[] = {QC_CLOSEST_POINT_ID, NULL};

/* The hard features of the map, which the quads follow, and those of the mesh. */
static void flag_features(const qc_run *r, const qc_mesh *mesh, uint8_t *flag) {
    const qc_corner_map *map = r->input(r, "map");
    const qc_features *features = r->input(r, "features");
    for (int32_t e = 0; e < mesh->n_edges; e++)
        flag[e] = (features && features->mesh == mesh && features->edge[e]) ||
                  (map && map->mesh == mesh && map->axis && map->axis[e] >= 0);
}

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    const qc_corner_map *map = r->input(r, "map");
    const qc_mesh *mesh = map ? map->mesh : r->input(r, "mesh");
    qc_relax_options options = QC_RELAX_OPTIONS_INIT;
    options.rounds = (int32_t)p->rounds;
    options.quality = p->quality;
    options.uniformity = p->uniformity;
    const qc_sizing *sizing = r->input(r, "sizing");
    options.rectangles = sizing && sizing->stretch;
    options.closest = (const qc_closest_point *)r->find(r, QC_CLOSEST_POINT_ID, p->closest);
    if (!options.closest) return QC_ERR_NOT_FOUND;
    uint8_t *flag = QC__NEW(r->ctx, uint8_t, mesh->n_edges);
    if (!flag) return QC_ERR_NOMEM;
    flag_features(r, mesh, flag);
    options.feature = flag;
    qc_polygon_mesh *quads = NULL;
    const qc_status status = qc_quads_relax(r->ctx, mesh, r->input(r, "quads"), &options, &quads);
    qc__free(flag);
    return status == QC_OK ? r->output(r, "quads", quads) : status;
}

static const qc_port in[] = {
    {"quads", QC_TYPE_POLYGON_MESH, 0, "pure quad mesh"},
    {"mesh", QC_TYPE_MESH, 0, "the surface its source faces count, unless there is a map"},
    {"features", QC_TYPE_FEATURES, QC_PORT_OPTIONAL,
     "edges of that surface which quad edges on them stay on"},
    {"map", QC_TYPE_CORNER_MAP, QC_PORT_OPTIONAL,
     "which the quads are cut from: tells the surface and hard features, which are kept as well"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL,
     "tells whether edge lengths depend on the direction: then quads keep their proportions"},
};
static const qc_port out[] = {
    {"quads", QC_TYPE_POLYGON_MESH, 0, "the same quads, with new positions and sources"},
};
static const qc_param table[] = {
    QC_PARAM_INT(params, rounds, 10, 0, 1000, "",
                 "sweeps over all vertices; 0 = leave them where they are"),
    QC_PARAM_REAL(params, quality, 0.6, -1, 1, "",
                  "scaled Jacobian below which no quad may fall, unless it is lower already; worse "
                  "quads are improved"),
    QC_PARAM_REAL(params, uniformity, 1, 0, 1, "",
                  "0 = squares as large as their quad, 1 = as large as the quads around it"),
    QC_PARAM_INTERFACE(params, closest, closest_points,
                       "finds closest points; builtin unless a plugin or the program offers "
                       "another"),
};

const qc_stage qc_stage_finish = {
    QC_STAGE_SIZES,
    .id = "qc.finish",
    .version = "1.0",
    .brief = "Relaxes the quads on the surface, with features and boundary kept.",
    .doc = "Each vertex moves to the mean of the places which the squares closest to its quads "
           "give it, in the tangent plane, and from there to the closest point of the surface. "
           "Vertices on the boundary and on features slide along their curve; corners stay. A step "
           "which would turn a quad over, or make it worse than `quality`, is halved or not made. "
           "Then the vertices of quads which are still worse are searched a better place, of the "
           "worst "
           "ones all about them together, and no quad comes to face away from the surface. Where "
           "edge lengths depend on the direction, rectangles of the proportions around take the "
           "place of squares. Source "
           "faces and barycentric coordinates are those of the new places.",
    .cite = "Bouaziz et al., Shape-Up (2012); Freitag and Ollivier-Gooch (1997); Garanzha et al., "
            "Foldover-free maps in 50 lines of code (2021)",
    .in = in,
    .out = out,
    .n_in = sizeof in / sizeof *in,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
