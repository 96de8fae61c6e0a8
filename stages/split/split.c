/* Stage qc.split: splits edges between cones, so that the map has room to unfold there. */
#include <qc/field.h>
#include <qc/stage.h>

#include <stdio.h>

#include "sdk/pipeline/outputs.h"

static qc_status publish(const qc_run *run, const qc_mesh *old, qc_mesh *mesh, qc_sizing *sizing,
                         qc_matching *matching) {
    char text[96];
    const int n = (int)(mesh->n_vertices - old->n_vertices);
    snprintf(text, sizeof text, "%d edges split, %d faces more", n,
             (int)(mesh->n_faces - old->n_faces));
    run->log(run, QC_LOG_INFO, text);
    const qc__output made[] = {{"mesh", mesh}, {"sizing", sizing}, {"matching", matching}};
    return qc__publish(run, 3, made);
}

static qc_status split(const qc_run *run, const void *params) {
    (void)params;
    const qc_matching *old = run->input(run, "matching");
    qc_mesh *mesh = NULL;
    qc_sizing *sizing = NULL;
    qc_matching *matching = NULL;
    const qc_status status =
        qc_matching_split(run->ctx, old, run->input(run, "sizing"), &mesh, &sizing, &matching);
    return status ? status : publish(run, old->field->mesh, mesh, sizing, matching);
}

static const qc_port inputs[] = {
    {"matching", QC_TYPE_MATCHING, 0, "cross field with its matching"},
    {"sizing", QC_TYPE_SIZING, 0, "target edge length of the quads"},
};
static const qc_port outputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "the same surface with some edges bisected"},
    {"sizing", QC_TYPE_SIZING, 0, "the sizing on that mesh"},
    {"matching", QC_TYPE_MATCHING, 0,
     "the field and its matching on that mesh, with the same cones"},
};

const qc_stage qc_stage_split = {
    QC_STAGE_SIZES,
    "qc.split",
    "1.0",
    "Split mesh edges between cones",
    "Bisects every edge whose two ends are cones, and the edges opposite a vertex which has too "
    "few "
    "triangles for its angle. The images of cones are pinned to lattice points: where they are "
    "neighbours in a coarse mesh, a piecewise linear map may have to fold over. The surface and "
    "the "
    "field stay the same; nothing is copied when there is nothing to split.",
    "Bank, Sherman, Weiser: Refinement algorithms and data structures for regular local mesh "
    "refinement (1983)",
    inputs,
    outputs,
    2,
    3,
    NULL,
    0,
    0,
    split,
};
