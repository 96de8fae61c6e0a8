/* Stage qc.split.features: splits edges between hard features, so that each side of one has faces
 * of its own, and around spikes, so that the field can turn there. */
#include <qc/field.h>
#include <qc/stages.h>

#include <stdio.h>

#include "sdk/pipeline/outputs.h"

static qc_status publish(const qc_run *run, const qc_mesh *old, qc_mesh *mesh,
                         qc_features *features, qc_sizing *sizing) {
    char text[96];
    snprintf(text, sizeof text, "%d edges split, %d faces more",
             (int)(mesh->n_vertices - old->n_vertices), (int)(mesh->n_faces - old->n_faces));
    run->log(run, QC_LOG_INFO, text);
    const qc__output made[] = {{"mesh", mesh}, {"features", features}, {"sizing", sizing}};
    return qc__publish(run, 3, made);
}

static qc_status split(const qc_run *run, const void *params) {
    (void)params;
    const qc_features *old = run->input(run, "features");
    qc_mesh *mesh = NULL;
    qc_features *features = NULL;
    qc_sizing *sizing = NULL;
    const qc_status status =
        qc_features_split(run->ctx, old, run->input(run, "sizing"), &mesh, &features, &sizing);
    return status ? status : publish(run, old->mesh, mesh, features, sizing);
}

static const qc_port inputs[] = {
    {"features", QC_TYPE_FEATURES, 0, "feature edges, hard or not"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL, "target edge length of the quads"},
};
static const qc_port outputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "the same surface with some edges bisected"},
    {"features", QC_TYPE_FEATURES, 0, "the same features on that mesh"},
    {"sizing", QC_TYPE_SIZING, QC_PORT_OPTIONAL, "the sizing on that mesh, when one is given"},
};

const qc_stage qc_stage_split_features = {
    QC_STAGE_SIZES,
    "qc.split.features",
    "1.1",
    "Split mesh edges between hard features and around spikes",
    "Bisects every edge which joins two vertices on hard features and is none itself, and the "
    "edges "
    "of faces with three feature edges, until there is none. A face between two features could "
    "follow one of them only, and a piecewise linear map which has both on isolines may have to "
    "fold over there. Bisects the edges opposite vertices of large curvature and few edges, whose "
    "index would have to be above 1/4 or below -2/4. The surface stays the same; nothing is copied "
    "when there is nothing to split.",
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
