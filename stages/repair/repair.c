/* Stage qc.repair: polygon soup in, oriented manifold triangle mesh and report out. */
#include <qc/mesh.h>
#include <qc/stages.h>

#include <stdio.h>

#include "sdk/pipeline/outputs.h"

static void log_report(const qc_run *run, const qc_repair_report *report) {
    for (int32_t kind = 0; kind < QC_REPAIR_KINDS; kind++) {
        if (report->count[kind] == 0) continue;
        char text[160];
        snprintf(text, sizeof text, "%s: %d (first: %d)", qc_repair_kind_name(kind),
                 (int)report->count[kind], (int)report->first[kind][0]);
        run->log(run, QC_LOG_INFO, text);
    }
}

static qc_status repair(const qc_run *run, const void *params) {
    (void)params;
    qc_mesh *mesh = NULL;
    qc_repair_report *report = NULL;
    const qc_status status = qc_mesh_repair(run->ctx, run->input(run, "soup"), &mesh, &report);
    if (status) return status;
    log_report(run, report);
    const qc__output made[] = {{"mesh", mesh}, {"report", report}};
    return qc__publish(run, 2, made);
}

static const qc_port inputs[] = {
    {"soup", QC_TYPE_POLYGON_MESH, 0, "polygons as a file holds them"},
};
static const qc_port outputs[] = {
    {"mesh", QC_TYPE_MESH, 0,
     "oriented manifold triangle mesh; knows the source of each face and vertex"},
    {"report", QC_TYPE_REPAIR_REPORT, QC_PORT_OPTIONAL,
     "what was changed, with the first elements"},
};

const qc_stage qc_stage_repair = {
    QC_STAGE_SIZES,
    "qc.repair",
    "1.0",
    "Turn a polygon soup into an oriented manifold triangle mesh",
    "Triangulates polygons, welds vertices with equal coordinates, drops degenerate and duplicate "
    "faces, cuts non-manifold edges and vertices open, orients faces consistently and drops "
    "crumbs. "
    "Every change is counted in the report; input which has no orientable surface is refused with "
    "the "
    "face named.",
    "stages/repair/repair.md",
    inputs,
    outputs,
    1,
    2,
    NULL,
    0,
    0,
    repair,
};
