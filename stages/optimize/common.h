/* What the stages of this folder share: from the ports to a qc_distortion and back. */
#ifndef QC_STAGES_OPTIMIZE_COMMON_H
#define QC_STAGES_OPTIMIZE_COMMON_H

#include <qc/optimize.h>
#include <qc/stages.h>

#define QC__OPTIMIZE_PORTS                                                                         \
    static const qc_port in[] = {                                                                  \
        {"matching", QC_TYPE_MATCHING, 0, "cross field with its matching"},                        \
        {"sizing", QC_TYPE_SIZING, 0, "target edge length of the quads"},                          \
    };                                                                                             \
    static const qc_port out[] = {                                                                 \
        {"matching", QC_TYPE_MATCHING, 0, "the changed matching with the field it leads to"},      \
        {"field", QC_TYPE_FACE_FIELD, 0, "that field"},                                            \
    };

#define QC__LAMBDA_DOC                                                                             \
    "smoothness against alignment, as in qc.field.smooth, for what the field changes as the "      \
    "branch points move; 0 keeps the trusted directions"

/* The distortion at the input matching. */
qc_status qc__optimize_begin(const qc_run *run, double lambda, qc_distortion **out);
/* Publishes its state, logs what changed, frees it. status: of the work done in between. */
qc_status qc__optimize_end(const qc_run *run, qc_status status, qc_distortion *distortion);
/* Lengths in quads as lengths of the mesh. */
double qc__quad_length(const qc_run *run);

#endif
