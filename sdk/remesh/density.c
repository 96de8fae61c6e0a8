/* One density for all components: a number of quads is shared by area, a relative length is made
 * absolute with the diagonal of the whole surface. Components then meet at the same edge length
 * sqrt(area / quads). */
#include <math.h>
#include <string.h>

#include "sdk/remesh/internal.h"

/* The cube: no closed quad mesh has fewer faces. */
#define FEWEST_QUADS 6.0

static double get(const qc_pipeline *pipeline, const char *step, const char *name) {
    const char *text = qc_pipeline_get(pipeline, step, name);
    return text ? qc__parse_double(text, NULL) : 0.0;
}

static qc_status set(qc_pipeline *pipeline, const char *step, const char *name, double value) {
    char text[40];
    qc__print_double(text, sizeof text, value);
    return qc_pipeline_set(pipeline, step, name, text);
}

bool qc__density_find(const qc_pipeline *pipeline, uint32_t first, qc__density *out) {
    for (uint32_t i = first; i < qc_pipeline_count(pipeline); i++) {
        if (strcmp(qc_pipeline_step_stage(pipeline, i)->id, "qc.size") != 0) continue;
        snprintf(out->step, sizeof out->step, "%s", qc_pipeline_step_name(pipeline, i));
        out->quads = get(pipeline, out->step, "quads");
        out->edge_length = get(pipeline, out->step, "edge_length");
        out->edge_length_rel = get(pipeline, out->step, "edge_length_rel");
        return true;
    }
    return false;
}

qc_status qc__density_share(qc_pipeline *pipeline, const qc__density *density, const qc_mesh *mesh,
                            double area) {
    if (density->edge_length > 0) return QC_OK;
    if (density->edge_length_rel > 0)
        return set(pipeline, density->step, "edge_length",
                   density->edge_length_rel * mesh->diagonal);
    const double quads = density->quads > 0 ? density->quads : QC__DEFAULT_QUADS;
    return set(pipeline, density->step, "quads",
               fmax(FEWEST_QUADS, round(quads * area / mesh->area)));
}

qc_status qc__density_restore(qc_pipeline *pipeline, const qc__density *density) {
    const qc_status quads = set(pipeline, density->step, "quads", density->quads);
    const qc_status length = set(pipeline, density->step, "edge_length", density->edge_length);
    return quads != QC_OK ? quads : length;
}
