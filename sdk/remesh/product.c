/* Products of the steps of a pipeline, by type. */
#include <string.h>

#include "sdk/remesh/internal.h"

qc__product qc__product_of(const qc_pipeline *pipeline, const qc_bag *bag, uint32_t end,
                           const char *type) {
    qc__product p = {-1, NULL, ""};
    for (p.step = (int64_t)end - 1; p.step >= 0; p.step--) {
        const qc_stage *stage = qc_pipeline_step_stage(pipeline, (uint32_t)p.step);
        for (uint32_t i = 0; i < stage->n_out; i++) {
            const qc_port *port = qc_stage_out(stage, i);
            if (strcmp(port->type, type) != 0) continue;
            snprintf(p.name, sizeof p.name, "%s.%s",
                     qc_pipeline_step_name(pipeline, (uint32_t)p.step), port->name);
            p.object = qc_bag_get(bag, p.name);
            if (p.object) return p;
        }
    }
    return p;
}

bool qc__has_hard_features(const qc_pipeline *pipeline, const qc_bag *bag, uint32_t end) {
    const qc_features *features = qc__product_of(pipeline, bag, end, QC_TYPE_FEATURES).object;
    return features && features->hard && features->n_feature_edges > 0;
}
