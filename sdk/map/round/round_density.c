/* Meeting a number of quads: the map is scaled and rounded again until its area meets it. Periods
 * scale with the map, the period matrix does not change (docs/theory/rounding.md, R.8 and R.9). */
#include "sdk/map/round/round.h"
#include "sdk/mesh/names.h"
#include <math.h>

enum {
    REFINEMENTS = 6,
    ALIGNED_REFINEMENTS = 2, /* with hard features, of which some had better go than that */
    DENSITY_ROUNDS = 24,
    NEWTON_ROUNDS = 5,    /* of these; then scales about the best are scanned */
    WINDING_ROUNDS = 13,  /* in so many, cones which wind wrong are a reason to go on, ... */
    FEW_COLLISIONS = 3,   /* ... and pairs which collide where they are no more than these */
    MANY_COLLISIONS = 60, /* with hard features so many stay at any scale near this one */
    WRONG_CONES = 20,     /* so many, or ... */
    WRONG_SHARE = 3       /* ... one in so many, can be unwound */
};

static double scale_factor(double wanted, double quads) {
    const double factor = quads > 0 ? sqrt(wanted / quads) : 1.5;
    return factor < 0.5 ? 0.5 : factor > 2.0 ? 2.0 : factor;
}

static qc_status meet_density(qc__rounding *r) {
    const double wanted = r->options.refine * r->seamless->sizing->target_quads;
    const bool may_quantize = !r->options.trial && qc__round_can_quantize(r);
    double scale = sqrt(r->options.refine), middle = scale, quads = 0;
    if (wanted > 0 && r->P) {
        r->coarse = true;
        const qc_status status = qc__round_try(r, scale, wanted, &quads);
        if (status != QC_OK) return status;
        r->coarse = false;
        scale *= scale_factor(wanted, quads);
    }
    for (int32_t i = 0; i < DENSITY_ROUNDS; i++) {
        if (!qc__progress(r->ctx, 0.7 + 0.3 * i / DENSITY_ROUNDS)) return QC_ERR_CANCELLED;
        const qc_status status = qc__round_try(r, scale, wanted, &quads);
        if (status != QC_OK) return status;
        if (!(wanted > 0)) break;
        if (qc__out_of_time(r->ctx) && r->best_miss <= qc__round_promised + qc__round_slack) break;
        const bool sound =
            r->best_collisions == 0 && (r->best_wrong == 0 || i + 1 >= WINDING_ROUNDS);
        if (r->seams->n_levels > 0 && r->best_collisions > MANY_COLLISIONS && i > 0) break;
        if (may_quantize &&
            (r->best_collisions > FEW_COLLISIONS || (i + 1 >= NEWTON_ROUNDS && !sound)))
            break;
        if (r->best_miss <= r->options.tolerance + qc__round_slack && sound) break;
        if (i < NEWTON_ROUNDS - 1) {
            scale *= scale_factor(wanted, quads);
        } else { /* a map with few periods jumps: 1, -1, 2, -2, ... percent about the middle */
            if (i == NEWTON_ROUNDS - 1) middle = r->best_scale;
            const int32_t k = i - NEWTON_ROUNDS + 1;
            scale = middle * (1.0 + 0.01 * (k / 2 + 1) * (k % 2 ? -1 : 1));
            if (r->best_miss <= qc__round_promised && sound) break;
            if (i + 1 >= WINDING_ROUNDS && r->best_collisions > FEW_COLLISIONS) break;
        }
    }
    return QC_OK;
}

/* Whether this map is not worth untangling, which parts no points and unwinds few cones. */
static bool is_hopeless(const qc__rounding *r) {
    const int32_t share = r->seams->n_cones / WRONG_SHARE;
    return r->best_collisions > 0 || r->best_wrong > (share > WRONG_CONES ? share : WRONG_CONES);
}

/* Whether untangling could be in vain: features leave a fold-over little room. */
static bool needs_quantization(const qc__rounding *r) {
    if (r->best_collisions > 0 || r->best_wrong > 0) return true;
    return r->seams->n_levels > 0 && qc__round_folds(r);
}

static qc_status meet_refined(qc__rounding *r, double refine) {
    r->options.refine = refine;
    r->best_scale = 0;
    return meet_density(r);
}

/* Hard features which no integers keep apart from points and each other. */
static qc_status refuse_collisions(const qc__rounding *r) {
    if (r->seams->n_levels == 0 || r->best_collisions == 0) return QC_OK;
    for (int32_t j = 0; j < r->seams->n_free; j++) r->target[j] = r->best_scale * r->period[j];
    const int32_t pair = qc__first_collision(r->separation, r->target, r->best_rounded);
    const int32_t v = pair < 0 ? -1 : r->separation->vertex[2 * pair];
    char name[QC__ELEMENT_NAME];
    return qc__fail(r->ctx, QC_ERR_FAILED, v,
                    "%d pairs of singularities or hard features are too close for this density "
                    "(first: %s); try a finer one or fewer features",
                    (int)r->best_collisions, qc__vertex_name(r->mesh, v, name));
}

/* Where the quads asked for are too large for the distances between singularities and features, no
 * integers keep these apart or let the cones wind right: then smaller ones are taken, in steps of
 * sqrt(2), up to 8 times as many; with hard features twice as many. */
qc_status qc__round_meet(qc__rounding *r) {
    const double asked = r->options.refine;
    const bool may_quantize = !r->options.trial && qc__round_can_quantize(r);
    const bool always = may_quantize && r->options.quantize == QC_QUANTIZE_ALWAYS;
    bool quantized = false;
    qc_status status = always ? QC_OK : meet_density(r);
    if (status == QC_OK && (always || (may_quantize && needs_quantization(r)))) {
        status = qc__round_quantized(r, &quantized);
        if (status != QC_OK || quantized) return status;
        r->options.quantize = QC_QUANTIZE_NEVER;
        status = meet_refined(r, asked);
    }
    const int32_t pairs = r->best_collisions, wrong = r->best_wrong;
    if (status != QC_OK || r->options.trial || !is_hopeless(r)) return status;
    const int32_t most = r->seams->n_levels == 0   ? REFINEMENTS
                         : pairs > MANY_COLLISIONS ? 0
                                                   : ALIGNED_REFINEMENTS;
    for (int32_t k = 1; k <= most && status == QC_OK && is_hopeless(r); k++)
        status = meet_refined(r, asked * pow(2, 0.5 * k));
    if (status != QC_OK) return status;
    const bool helped = !is_hopeless(r) || r->best_collisions < pairs || 2 * r->best_wrong < wrong;
    if (!helped && most > 0) status = meet_refined(r, asked);
    if (status == QC_OK) status = refuse_collisions(r);
    if (status == QC_OK)
        qc__log(r->ctx, QC_LOG_WARNING,
                "%d pairs of singularities or features are too close for this density, where %d "
                "cones wind wrong; %.2g times as many quads are made",
                (int)pairs, (int)wrong, r->options.refine / asked);
    return status;
}
