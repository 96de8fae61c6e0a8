/* Stage qc.matching: the straightest matching of a cross field, its singularities. */
#include <qc/field.h>
#include <qc/stages.h>

#include <stdio.h>

static qc_status matching(const qc_run *run, const void *params) {
    (void)params;
    qc_matching *out = NULL;
    qc_status status = qc_matching_create(run->ctx, run->input(run, "field"), NULL, &out);
    if (status) return status;
    char text[96];
    snprintf(text, sizeof text, "%d singularities, indices sum to %d/4", (int)out->n_singular,
             (int)out->index4_sum);
    run->log(run, QC_LOG_INFO, text);
    return run->output(run, "matching", out);
}

static const qc_port inputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "cross field on faces"}};
static const qc_port outputs[] = {
    {"matching", QC_TYPE_MATCHING, 0, "quarter turns at edges, indices at vertices"},
};

const qc_stage qc_stage_matching = {
    QC_STAGE_SIZES,
    "qc.matching",
    "1.0",
    "Match the crosses of neighbouring faces and find the singularities",
    "Each edge gets the number of quarter turns which makes the crosses on its two sides as "
    "parallel as "
    "possible. The angles that remain give the index of each vertex, a multiple of 1/4; on a "
    "closed "
    "surface the indices sum to the Euler characteristic, which is checked.",
    "thesis 3.1.2, (5.1)",
    inputs,
    outputs,
    1,
    1,
    NULL,
    0,
    0,
    matching,
};
