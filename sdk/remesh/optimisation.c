/* The steps of a pipeline which optimise the branch points: a rehearsal without them, and the field
 * as it was before them. */
#include <string.h>

#include "sdk/map/round/room.h"
#include "sdk/remesh/internal.h"

qc__optimisation qc__optimisation_find(const qc_pipeline *pipeline, uint32_t first, uint32_t end) {
    static const char prefix[] = "qc.optimize.";
    qc__optimisation o = {0, 0};
    for (uint32_t i = first; i < end; i++) {
        if (strncmp(qc_pipeline_step_stage(pipeline, i)->id, prefix, sizeof prefix - 1) != 0)
            continue;
        if (o.end == 0) o.first = i;
        o.end = i + 1;
    }
    return o;
}

qc_status qc__optimisation_undo(const qc_pipeline *pipeline, qc_bag *bag, qc__optimisation o) {
    qc_status status = QC_OK;
    for (uint32_t i = o.first; i < o.end; i++) {
        const qc_stage *stage = qc_pipeline_step_stage(pipeline, i);
        for (uint32_t k = 0; k < stage->n_out && status == QC_OK; k++) {
            const qc_port *port = qc_stage_out(stage, k);
            const qc__product before = qc__product_of(pipeline, bag, o.first, port->type);
            char name[128];
            snprintf(name, sizeof name, "%s.%s", qc_pipeline_step_name(pipeline, i), port->name);
            if (before.object) status = qc_bag_put(bag, name, before.object);
        }
    }
    return status;
}

static qc_status run_range(qc_pipeline *pipeline, uint32_t from, uint32_t end, qc_bag *bag) {
    return from < end ? qc_pipeline_run_range(pipeline, from, end, bag) : QC_OK;
}

static qc_status check_room(qc_ctx *ctx, const qc_pipeline *pipeline, const qc_bag *bag,
                            uint32_t round) {
    const qc__product map = qc__product_of(pipeline, bag, round, QC_TYPE_SEAMLESS_MAP);
    if (!map.object) return QC_OK;
    const qc__range outer = qc__range_begin(ctx, qc_pipeline_step_name(pipeline, round), 0, 0);
    const qc__time time = qc__time_begin_step(ctx);
    const qc_status status = qc__map_has_room(ctx, map.object);
    qc__time_end_step(ctx, time);
    qc__range_end(ctx, outer);
    return status;
}

qc_status qc__optimisation_rehearse(qc_ctx *ctx, qc_pipeline *pipeline, qc_bag *bag,
                                    qc__optimisation o, uint32_t from, uint32_t round) {
    const qc__range outer = qc__range_begin(ctx, NULL, 0, 0);
    qc_status status = run_range(pipeline, from, o.first, bag);
    if (status == QC_OK && qc__has_hard_features(pipeline, bag, round)) {
        status = run_range(pipeline, o.end, round, bag);
        if (status == QC_OK) status = check_room(ctx, pipeline, bag, round);
    }
    qc__range_end(ctx, outer);
    return status;
}
