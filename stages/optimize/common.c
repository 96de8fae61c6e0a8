/* From the ports to a qc_distortion and back. */
#include "stages/optimize/common.h"

#include <stdio.h>

qc_status qc__optimize_begin(const qc_run *run, double lambda, qc_distortion **out) {
    return qc_distortion_create(run->ctx, run->input(run, "matching"), run->input(run, "sizing"),
                                lambda, out);
}

double qc__quad_length(const qc_run *run) {
    const qc_sizing *sizing = run->input(run, "sizing");
    return sizing->edge_length;
}

static void report(const qc_run *run, const qc_distortion *distortion) {
    const qc_matching *before = run->input(run, "matching");
    qc_distortion_state s;
    char text[160];
    qc_distortion_get_state(distortion, &s);
    snprintf(text, sizeof text,
             "E_D = %.3f %% of the field, %d branch points (before: %d), %lld evaluations, %lld "
             "flips",
             s.whole > 0 ? 100 * s.energy / s.whole : 0, (int)s.branch_points,
             (int)before->n_singular, (long long)s.evaluations, (long long)s.changes);
    run->log(run, QC_LOG_INFO, text);
}

qc_status qc__optimize_end(const qc_run *run, qc_status status, qc_distortion *distortion) {
    qc_matching *matching = NULL;
    if (!status) status = qc_distortion_matching(run->ctx, distortion, &matching);
    if (!status) report(run, distortion);
    qc_distortion_free(distortion);
    if (status) return status;
    qc_face_field *field = qc_object_retain(matching->field);
    status = run->output(run, "matching", matching);
    if (!status) return run->output(run, "field", field);
    qc_object_release(field);
    return status;
}
