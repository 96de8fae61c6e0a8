/* Features on isolines before and after the rounding, and what is done where the map folds over
 * (docs/theory/rounding.md, R.12). */
#include "sdk/map/round/round.h"
#include <math.h>
#include <string.h>
#include "sdk/map/periods/align.h"
#include "sdk/map/periods/frame_form.h"
#include "sdk/map/periods/unfold.h"
#include "sdk/mesh/names.h"

enum { REACH = 3 /* target edge lengths within which points and features are kept apart */ };

/* The frame field in combed charts. */
static qc_status combed_frame(qc__rounding *r) {
    const qc_seamless_map *seamless = r->seamless;
    r->z = QC__NEW(r->ctx, qc_complex, 3 * (int64_t)r->mesh->n_faces);
    if (!r->z) return QC_ERR_NOMEM;
    const qc_status status = qc__frame_form(r->ctx, seamless->matching, seamless->sizing, r->z);
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces && status == QC_OK; c++)
        r->z[c] = qc_quarter_turn(r->z[c], seamless->face_turn[c / 3]);
    return status;
}

/* Unfolds the map; fewer faces fold and fewer cones wind wrong afterwards, mostly none. What is
 * left with hard features no integers mend. */
static qc_status unfold(qc__rounding *r) {
    const qc_matching *matching = r->seamless->matching;
    const qc_cover cover = {r->mesh, matching->m};
    const qc__features features = {&cover, r->seamless->face_turn, matching->axis};
    qc__unfolding done = {0};
    const qc_status status =
        qc__unfold(r->ctx, r->periods, r->P, &features, r->z, r->f, r->period, &done);
    if (status == QC_OK && done.evaluations > 0) {
        qc__log(r->ctx, QC_LOG_INFO,
                "the seamless map folds over at %d faces and winds wrong at %d places; after %d "
                "evaluations at %d and %d",
                (int)done.folded_before, (int)done.wrong_before, (int)done.evaluations,
                (int)done.folded, (int)done.wrong);
        r->curl_energy = qc__round_energy(r, r->f, r->z);
    }
    const bool clean = done.folded + done.wrong == 0;
    if (status != QC_OK || clean || r->seams->n_levels == 0) return status;
    char name[QC__ELEMENT_NAME];
    return qc__fail(r->ctx, QC_ERR_FAILED, done.where,
                    "the map folds over at %d faces and winds wrong at %d places before integers "
                    "are chosen (first: %s); hard features leave no room there",
                    (int)done.folded, (int)done.wrong, qc__vertex_name(r->mesh, done.where, name));
}

qc_status qc__round_align(qc__rounding *r) {
    r->curl_energy = r->seamless->curl_energy;
    qc_status status = combed_frame(r);
    if (status == QC_OK && r->seams->n_levels > 0) {
        status = qc__align(r->ctx, r->periods, r->P, r->z, r->f, r->period);
        r->curl_energy = qc__round_energy(r, r->f, r->z);
    }
    if (status == QC_OK && r->periods && !r->options.trial && r->mesh->n_poles == 0)
        status = unfold(r);
    if (status != QC_OK) return status;
    qc__periods_split(r->seams, r->f, r->wedge, r->F);
    if (!r->P) return QC_OK;
    return qc__separation_create(
        r->ctx, r->seams, r->seamless->matching->axis, r->seamless->matching->pole_index4, r->f,
        REACH * r->seamless->sizing->edge_length / sqrt(r->options.refine), &r->separation);
}
