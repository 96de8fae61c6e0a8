/* Stage qc.open: cuts the vertices of positive integer index open (second paper, 5.2). */
#include <qc/field.h>
#include <qc/stages.h>

#include <stdio.h>

#include "sdk/pipeline/outputs.h"

typedef struct params {
    int64_t largest;
} params;

static qc_status publish(const qc_run *run, qc_mesh *mesh, qc_sizing *sizing,
                         qc_matching *matching) {
    char text[96];
    snprintf(text, sizeof text, "%d vertices of positive integer index cut open",
             (int)mesh->n_poles);
    run->log(run, QC_LOG_INFO, text);
    const qc__output made[] = {{"mesh", mesh}, {"sizing", sizing}, {"matching", matching}};
    return qc__publish(run, 3, made);
}

static qc_status open_poles(const qc_run *run, const void *raw) {
    const params *p = raw;
    qc_mesh *mesh = NULL;
    qc_sizing *sizing = NULL;
    qc_matching *matching = NULL;
    const qc_status status =
        qc_matching_open(run->ctx, run->input(run, "matching"), run->input(run, "sizing"),
                         (int32_t)p->largest, &mesh, &sizing, &matching);
    return status ? status : publish(run, mesh, sizing, matching);
}

static const qc_port inputs[] = {
    {"matching", QC_TYPE_MATCHING, 0, "cross field with its matching"},
    {"sizing", QC_TYPE_SIZING, 0, "target edge length of the quads"},
};
static const qc_port outputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "the same surface with a hole of no size at each pole"},
    {"sizing", QC_TYPE_SIZING, 0, "the sizing on that mesh"},
    {"matching", QC_TYPE_MATCHING, 0, "the field and its matching on that mesh"},
};

static const qc_param table[] = {
    QC_PARAM_INT(params, largest, 1, 1, 100, "",
                 "larger indices are an error which names the vertex: around them a map has many "
                 "more quads than were asked for"),
};

const qc_stage qc_stage_open = {
    QC_STAGE_SIZES,
    "qc.open",
    "1.0",
    "Cut vertices of index 1, 2, ... open",
    "A piecewise linear map cannot wind around such a vertex, since its gradient would have to be "
    "infinite. Each triangle of the star gets a vertex of its own there, after rings of vertices "
    "which "
    "keep the star smaller than half a quad; qc.round keeps the number of grid lines around the "
    "hole even "
    "and qc.extract closes it with quads. Where there is no such vertex nothing is copied. Comes "
    "after "
    "qc.split.",
    "second paper, 5.2, Algorithm 1",
    inputs,
    outputs,
    2,
    3,
    table,
    1,
    sizeof(params),
    open_poles,
};
