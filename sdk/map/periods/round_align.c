/* Features on isolines before and after the rounding, and what is done where the map folds over
 * (docs/theory/rounding.md, R.12). */
#include "sdk/map/periods/round.h"
#include <math.h>
#include <string.h>
#include "sdk/map/periods/align.h"
#include "sdk/map/periods/frame_form.h"
#include "sdk/map/periods/unfold.h"
#include "sdk/map/periods/wrong_cones.h"

enum {
    STIFFENING_ROUNDS = 12,
    REACH = 3 /* target edge lengths within which points and features are kept apart */
};

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

/* 1/2 int |dg - z|^2 for the aligned map, before scaling. */
static double curl_energy(const qc__rounding *r) {
    const qc_complex *z = r->z;
    double energy = 0;
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces; c++) {
        const qc_complex a = r->f[qc_next((int32_t)c)], b = r->f[qc_prev((int32_t)c)];
        const double re = b.re - a.re - z[c].re, im = b.im - a.im - z[c].im;
        energy +=
            0.25 * r->cotangent[c] / (r->weight ? r->weight[c / 3] : 1.0) * (re * re + im * im);
    }
    return energy;
}

/* Raises the weights where map f folds over, and makes the stiffness matrix anew. */
static qc_status stiffen(qc__rounding *r, const qc_complex *f) {
    const int32_t n_faces = r->mesh->n_faces;
    if (!r->weight) {
        r->weight = QC__NEW(r->ctx, double, n_faces);
        if (!r->weight) return QC_ERR_NOMEM;
        for (int32_t t = 0; t < n_faces; t++) r->weight[t] = 1;
    }
    for (int32_t c = 0; c < 3 * n_faces; c++) r->cotangent[c] /= r->weight[c / 3];
    qc__stiffen(r->mesh, f, r->weight);
    for (int32_t c = 0; c < 3 * n_faces; c++) r->cotangent[c] *= r->weight[c / 3];
    qc__periods_free(r->periods);
    r->periods = NULL;
    return qc__periods_create(r->ctx, r->seams, r->cotangent, r->options.solver, &r->periods);
}

static int32_t count_folded(const qc__rounding *r, const qc_complex *f) {
    int32_t n = 0;
    for (int32_t t = 0; t < r->mesh->n_faces; t++) n += qc__round_area(f + 3 * (int64_t)t, 1) <= 0;
    return n;
}

/* Unfolds the map; fewer faces fold and fewer cones wind wrong afterwards, mostly none. */
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
                "evaluations "
                "at %d and %d",
                (int)done.folded_before, (int)done.wrong_before, (int)done.evaluations,
                (int)done.folded, (int)done.wrong);
        r->curl_energy = curl_energy(r);
    }
    return status;
}

/* With the integers chosen, features let the map fold over where they lie close: it is stiffened
 * there and solved again. Of all maps the one with the fewest wrong cones, then folded faces, is
 * kept. */
qc_status qc__round_unfold(qc__rounding *r) {
    if (r->seams->n_levels == 0 || r->quantized) return QC_OK;
    const int64_t n_corners = 3 * (int64_t)r->mesh->n_faces;
    const int32_t *index4 = r->seamless->matching->index4;
    int32_t folded = count_folded(r, r->best), wrong = r->best_wrong, left = folded;
    if (folded == 0) return QC_OK;
    for (int64_t c = 0; c < n_corners; c++) {
        r->z[c].re *= r->best_scale;
        r->z[c].im *= r->best_scale;
    }
    memcpy(r->trial, r->best, sizeof *r->trial * (size_t)n_corners);
    qc_status status = QC_OK;
    for (int32_t i = 0; i < STIFFENING_ROUNDS && left > 0 && status == QC_OK; i++) {
        if (!qc__progress(r->ctx, 1)) return QC_ERR_CANCELLED;
        status = stiffen(r, r->trial);
        if (status == QC_OK)
            status = qc__align(r->ctx, r->periods, NULL, r->z, r->trial, r->best_rounded);
        if (status != QC_OK) return status;
        const int32_t winding = qc__wrong_cones(r->mesh, index4, r->trial);
        left = count_folded(r, r->trial);
        if (winding > wrong || (winding == wrong && left >= folded)) continue;
        wrong = winding;
        folded = left;
        memcpy(r->best, r->trial, sizeof *r->best * (size_t)n_corners);
    }
    for (int64_t c = 0; c < n_corners; c++)
        r->trial[c] = qc__pair(qc__complex(r->best[c]) - r->best_scale * qc__complex(r->f[c]));
    r->harmonic = qc__round_energy(r, r->trial);
    return status;
}

qc_status qc__round_align(qc__rounding *r) {
    r->curl_energy = r->seamless->curl_energy;
    qc_status status = combed_frame(r);
    if (status == QC_OK && r->seams->n_levels > 0) {
        status = qc__align(r->ctx, r->periods, r->P, r->z, r->f, r->period);
        r->curl_energy = curl_energy(r);
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
