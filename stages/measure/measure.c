/* Stage qc.measure: the figures of a result (thesis Table 7.1; distances to the input). */
#include <qc/map.h>
#include <qc/stages.h>

typedef struct params {
    const char *closest;
} params;
static const char *const closest_points[] = {QC_CLOSEST_POINT_ID, NULL};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_report *report = NULL;
    const qc_interface *closest = r->find(r, QC_CLOSEST_POINT_ID, p->closest);
    if (!closest) return QC_ERR_NOT_FOUND;
    qc_status status = qc_report_create(r->ctx, &report);
    if (status == QC_OK)
        status = qc_report_measure(r->ctx, r->input(r, "mesh"), r->input(r, "sizing"),
                                   r->input(r, "matching"), r->input(r, "map"),
                                   r->input(r, "quads"), (const qc_closest_point *)closest, report);
    if (status == QC_OK) return r->output(r, "report", report);
    qc_object_release(report);
    return status;
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "the surface"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL, "the density which was asked for"},
    {"matching", QC_TYPE_MATCHING, QC_PORT_OPTIONAL, "singularities are counted by index"},
    {"map", QC_TYPE_CORNER_MAP, QC_PORT_OPTIONAL, "the parameterization"},
    {"quads", QC_TYPE_POLYGON_MESH, QC_PORT_OPTIONAL, "the quad mesh"},
};
static const qc_port outputs[] = {
    {"report", QC_TYPE_REPORT, 0, "all figures; those of absent inputs are zero"},
};

static const qc_param table[] = {
    QC_PARAM_INTERFACE(params, closest, closest_points,
                       "finds closest points; builtin unless a plugin or the program offers "
                       "another"),
};

const qc_stage qc_stage_measure = {
    QC_STAGE_SIZES,
    "qc.measure",
    "1.0",
    "Measure the map and the quads: valences, angles, distortion, distance",
    "Counts flipped triangles and seam mismatch of the parameterization and its "
    "as-rigid-as-possible "
    "distortion (area-weighted mean of the squared distance of the Jacobian from the rotations); "
    "topology, edge lengths, angles and scaled Jacobian of the quads; and their two-sided distance "
    "to "
    "the surface, sampled at the vertices, edge midpoints and face centres of the quads and at the "
    "vertices of the surface.",
    "thesis chapter 7, Table 7.1; 6.1 (as-rigid-as-possible energy)",
    inputs,
    outputs,
    sizeof inputs / sizeof *inputs,
    sizeof outputs / sizeof *outputs,
    table,
    sizeof table / sizeof *table,
    sizeof(params),
    run};
