/* What the stages of this folder share: from the ports to a qc_distortion and back. */
#ifndef QC_STAGES_OPTIMIZE_COMMON_H
#define QC_STAGES_OPTIMIZE_COMMON_H

#include <qc/map.h>
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
/* Publishes `chosen`, or the present state when that is NULL; logs what changed, frees both.
 * status: of the work done in between. */
qc_status qc__optimize_end(const qc_run *run, qc_status status, qc_distortion *distortion,
                           qc_matching *chosen);
/* (E_D + E_H) / (1/2 |X|^2) of the map which the matching leads to at the density of the run:
 * curl removed, periods rounded. Infinity where there is none. */
qc_status qc__error_sum(const qc_run *run, const qc_matching *matching, double *sum);
/* Lengths in quads as lengths of the mesh. */
double qc__quad_length(const qc_run *run);

#endif
