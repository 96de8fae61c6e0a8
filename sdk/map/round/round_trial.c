/* One trial of rounding: periods at a scale go to the lattice, and the harmonic map which closes
 * the gap is added (thesis 4.2.1, 6.3). */
#include "sdk/map/round/round.h"
#include <math.h>
#include <string.h>
#include "sdk/map/periods/wrong_cones.h"

/* Budget of the lattice search by variables and faces: a small part of the period matrix. */
static const double search_share = 1.0;

double qc__round_area(const qc_complex *f, int32_t n_faces) {
    double area = 0;
    for (int32_t t = 0; t < n_faces; t++) {
        const qc_complex *p = f + 3 * (int64_t)t;
        area += 0.5 * ((p[1].re - p[0].re) * (p[2].im - p[0].im) -
                       (p[2].re - p[0].re) * (p[1].im - p[0].im));
    }
    return area;
}

bool qc__round_folds(const qc__rounding *r) {
    for (int32_t t = 0; t < r->mesh->n_faces; t++)
        if (qc__is_folded(r->best + 3 * (int64_t)t)) return true;
    return r->best_wrong > 0;
}

double qc__round_energy(const qc__rounding *r, const qc_complex *f, const qc_complex *z) {
    const double *weight = r->seamless->weight;
    double energy = 0;
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces; c++) {
        const qc_complex a = f[qc_next((int32_t)c)], b = f[qc_prev((int32_t)c)];
        const double du = b.re - a.re - (z ? z[c].re : 0), dv = b.im - a.im - (z ? z[c].im : 0);
        energy += 0.25 * r->cotangent[c] / (weight ? weight[c / 3] : 1.0) * (du * du + dv * dv);
    }
    return energy;
}

static void scale_targets(qc__rounding *r, double scale) {
    for (int32_t j = 0; j < r->seams->n_free; j++) r->target[j] = scale * r->period[j];
}

/* Less than the default where the rest of the stage is quick; other seeds search longer, since
 * small problems are solved from any. */
static int64_t search_budget(const qc__rounding *r) {
    const int64_t n = r->seams->n_free, standard = 1000 * (n < 500 ? n : 500);
    const double share = search_share * r->mesh->n_faces * (1 + (double)(r->options.seed % 4));
    return share < (double)standard ? (int64_t)share * n : -1;
}

/* Rounds the targets to the lattice. */
static qc_status round_periods(qc__rounding *r, qc_lattice_result *result) {
    const int32_t n = r->seams->n_free;
    if (r->P) {
        qc_lattice_options options = QC_LATTICE_OPTIONS_INIT;
        options.start = r->options.start;
        options.radius = r->options.radius;
        options.budget = search_budget(r);
        options.seed += r->options.seed;
        if (r->coarse || qc__out_of_time(r->ctx)) {
            options.radius = r->options.radius < 1 ? r->options.radius : 1;
            options.budget = 0;
        }
        qc_status status =
            qc_lattice_round(r->ctx, n, r->P, r->target, &options, r->rounded, result);
        if (status == QC_OK)
            status =
                qc__separate(r->ctx, r->separation, n, r->P, r->target, !qc__round_can_quantize(r),
                             r->rounded, &result->energy, &r->collisions);
        if (status != QC_OK) return status;
    } else {
        for (int32_t j = 0; j < n; j++) r->rounded[j] = rint(r->target[j]);
    }
    return QC_OK;
}

/* The harmonic map with the periods of the gap: values in the wedges, and at vertices. */
static qc_status solve_gap(qc__rounding *r) {
    qc__seams_symbol_values(r->seams, r->gap, r->symbol);
    qc__seams_wedge_values(r->seams, r->symbol, r->wedge);
    return qc__periods_extend(r->ctx, r->periods, r->wedge, NULL, r->correction);
}

/* Energy of the harmonic map which direct rounding would add; the trial map serves as space. */
static qc_status energy_of_direct_rounding(qc__rounding *r, double *energy) {
    for (int32_t j = 0; j < r->seams->n_free; j++) r->gap[j] = rint(r->target[j]) - r->target[j];
    const qc_status status = solve_gap(r);
    if (status != QC_OK) return status;
    qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
    *energy = qc__round_energy(r, r->trial, NULL);
    return QC_OK;
}

/* The map with the rounded periods: what is given is exact, the rest is scale f plus the harmonic
 * correction. */
static void write_trial(qc__rounding *r, double scale) {
    for (int32_t v = 0; v < r->mesh->n_vertices; v++) r->correction[v] += scale * r->F[v];
    qc__seams_symbol_values(r->seams, r->rounded, r->symbol);
    qc__seams_wedge_values(r->seams, r->symbol, r->wedge);
    qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
}

/* Whether the trial beats the best map so far: a number of quads which is good enough, then cones
 * kept apart and winding right, then the number of quads. */
static bool is_better(const qc__rounding *r, double miss) {
    const bool good = miss <= qc__round_promised + qc__round_slack,
               best_good = r->best_miss <= qc__round_promised + qc__round_slack;
    if (good != best_good) return good;
    if (r->collisions != r->best_collisions) return r->collisions < r->best_collisions;
    if (r->wrong != r->best_wrong) return r->wrong < r->best_wrong;
    return miss < r->best_miss - qc__round_slack;
}

qc_status qc__round_extend(qc__rounding *r, double scale, double wanted,
                           const qc_lattice_result *found, double *quads) {
    qc_lattice_result result = found ? *found : (qc_lattice_result){0};
    const bool weighted = r->P && r->seamless->weight; /* then P measures in another norm */
    const bool measured = !found || !r->P || weighted;
    const int32_t n = r->seams->n_free;
    memset(r->correction, 0, sizeof *r->correction * (size_t)r->mesh->n_vertices);
    if (n > 0) {
        qc_status status = QC_OK;
        scale_targets(r, scale);
        if (measured && r->P) status = energy_of_direct_rounding(r, &result.energy_direct);
        for (int32_t j = 0; j < n; j++) r->gap[j] = r->rounded[j] - r->target[j];
        if (status == QC_OK) status = solve_gap(r);
        if (status != QC_OK) return status;
    }
    if (measured && n > 0) {
        qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
        result.energy = qc__round_energy(r, r->trial, NULL);
    }
    if (!r->P) result.energy_direct = result.energy;
    write_trial(r, scale);
    r->moves += result.moves;
    r->evaluations += result.evaluations;
    *quads = qc__round_area(r->trial, r->mesh->n_faces);
    if (r->coarse) return QC_OK;
    r->wrong = qc__wrong_cones(r->mesh, r->seamless->matching->index4, r->trial);
    const double miss = wanted > 0 ? fabs(*quads / wanted - 1.0) : 0.0;
    if (r->best_scale > 0 && !is_better(r, miss)) return QC_OK;
    qc_complex *swap = r->best;
    r->best = r->trial;
    r->trial = swap;
    double *integers = r->best_rounded;
    r->best_rounded = r->rounded;
    r->rounded = integers;
    r->best_scale = scale;
    r->best_miss = miss;
    r->best_collisions = r->collisions;
    r->best_wrong = r->wrong;
    r->harmonic = result.energy;
    r->harmonic_direct = result.energy_direct;
    return QC_OK;
}

/* The rounded map at a scale; unless coarse, keeps it when it is nearer to the wanted number of
 * quads. */
qc_status qc__round_try(qc__rounding *r, double scale, double wanted, double *quads) {
    qc_lattice_result result = {0};
    scale_targets(r, scale);
    const qc_status status = r->seams->n_free > 0 ? round_periods(r, &result) : QC_OK;
    return status == QC_OK ? qc__round_extend(r, scale, wanted, &result, quads) : status;
}
