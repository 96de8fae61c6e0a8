/* From the ports to a qc_distortion and back. */
#include "stages/optimize/common.h"

#include <math.h>
#include <stdio.h>

#include "sdk/pipeline/outputs.h"

qc_status qc__optimize_begin(const qc_run *run, double lambda, qc_distortion **out) {
    return qc_distortion_create(run->ctx, run->input(run, "matching"), run->input(run, "sizing"),
                                lambda, out);
}

double qc__quad_length(const qc_run *run) {
    const qc_sizing *sizing = run->input(run, "sizing");
    return sizing->edge_length;
}

qc_status qc__error_sum(const qc_run *run, const qc_matching *matching, double *sum) {
    qc_seamless_map *seamless = NULL;
    qc_corner_map *map = NULL;
    qc_round_options options = QC_ROUND_OPTIONS_INIT;
    options.trial = 1;
    qc_status status =
        qc_seamless_map_create(run->ctx, matching, run->input(run, "sizing"), NULL, &seamless);
    if (!status) status = qc_map_round(run->ctx, seamless, &options, &map);
    if (!status) *sum = (map->curl_energy + map->harmonic_energy) / map->field_energy;
    if (status == QC_ERR_FAILED) {
        *sum = INFINITY;
        status = QC_OK;
    }
    qc_object_release(map);
    qc_object_release(seamless);
    return status;
}

static void report(const qc_run *run, const qc_distortion *distortion,
                   const qc_matching *matching) {
    const qc_matching *before = run->input(run, "matching");
    qc_distortion_state s;
    char text[160];
    qc_distortion_get_state(distortion, &s);
    snprintf(text, sizeof text, "%d branch points (before: %d), %lld evaluations, %lld flips",
             (int)matching->n_singular, (int)before->n_singular, (long long)s.evaluations,
             (long long)s.changes);
    run->log(run, QC_LOG_INFO, text);
}

qc_status qc__optimize_end(const qc_run *run, qc_status status, qc_distortion *distortion,
                           qc_matching *chosen) {
    qc_matching *matching = chosen;
    if (!status && !matching) status = qc_distortion_matching(run->ctx, distortion, &matching);
    if (!status) report(run, distortion, matching);
    qc_distortion_free(distortion);
    if (status) {
        qc_object_release(matching);
        return status;
    }
    const qc__output made[] = {{"matching", matching},
                               {"field", qc_object_retain(matching->field)}};
    return qc__publish(run, 2, made);
}
