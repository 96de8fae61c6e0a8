/* Which object an input port takes: the one wire names, else the latest earlier output of its type,
 * the objects in the bag counting as earliest. Used before a run (with promises) and during it. */
#include "sdk/pipeline/internal.h"
#include <string.h>

static bool has_type(const qc_object *object, const char *type) {
    return object && strcmp(object->type, type) == 0;
}

/* Output `out` of step s, which lies before the one that asks. */
static qc__fit output_of(const qc__scope *scope, uint32_t s, const qc_port *out, const char *type,
                         const qc_object **object) {
    const qc__step *step = &scope->pipeline->step[s];
    if (strcmp(out->type, type) != 0) return QC__FIT_NONE;
    if (s >= scope->first && !scope->held)
        return out->flags & QC_PORT_OPTIONAL ? QC__FIT_MAYBE : QC__FIT_SURE;
    const qc_bag *bag = s >= scope->first ? scope->held : scope->io;
    const qc_object *found = qc__bag_output(bag, step->name, out->name);
    if (!has_type(found, type)) return QC__FIT_NONE;
    *object = found;
    return QC__FIT_SURE;
}

/* Is this bag object the product of a step of the pipeline (in an earlier run)? */
static bool is_product(const qc_pipeline *pipeline, const char *name) {
    for (int64_t s = 0; s < pipeline->n; s++) {
        const size_t n = strlen(pipeline->step[s].name);
        if (strncmp(name, pipeline->step[s].name, n) == 0 && name[n] == '.' &&
            !strchr(name + n + 1, '.'))
            return true;
    }
    return false;
}

static qc__fit by_rule(const qc__scope *scope, uint32_t step, const char *type,
                       const qc_object **object) {
    qc__fit best = QC__FIT_NONE;
    for (uint32_t s = step; s-- > 0;) {
        const qc_stage *stage = scope->pipeline->step[s].stage;
        for (uint32_t o = stage->n_out; o-- > 0;) {
            const qc__fit fit = output_of(scope, s, &stage->out[o], type, object);
            if (fit == QC__FIT_SURE) return fit;
            if (fit > best) best = fit;
        }
    }
    for (uint32_t i = scope->io ? qc_bag_count(scope->io) : 0; i-- > 0;) {
        const qc_object *found = qc__bag_object(scope->io, i);
        if (!has_type(found, type) || is_product(scope->pipeline, qc_bag_name(scope->io, i)))
            continue;
        *object = found;
        return QC__FIT_SURE;
    }
    return best;
}

static qc__fit by_wire(const qc__scope *scope, uint32_t step, const char *wire, const char *type,
                       const qc_object **object) {
    const char *dot = strrchr(wire, '.');
    for (uint32_t s = scope->first; dot && s < step; s++) {
        const qc__step *from = &scope->pipeline->step[s];
        const size_t n = strlen(from->name);
        if (n != (size_t)(dot - wire) || strncmp(wire, from->name, n) != 0) continue;
        for (uint32_t o = 0; o < from->stage->n_out; o++)
            if (strcmp(from->stage->out[o].name, dot + 1) == 0)
                return output_of(scope, s, &from->stage->out[o], type, object);
        return QC__FIT_NONE;
    }
    const qc_object *found = scope->io ? qc_bag_get(scope->io, wire) : NULL;
    if (!has_type(found, type)) return QC__FIT_NONE;
    *object = found;
    return QC__FIT_SURE;
}

qc__fit qc__port_resolve(const qc__scope *scope, uint32_t step, uint32_t port,
                         const qc_object **object) {
    const qc__step *s = &scope->pipeline->step[step];
    const char *wire = s->wire[port], *type = s->stage->in[port].type;
    *object = NULL;
    if (!wire) return by_rule(scope, step, type, object);
    return *wire ? by_wire(scope, step, wire, type, object) : QC__FIT_NONE;
}
