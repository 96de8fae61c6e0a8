/* Global continuity: rounds the periods of a seamless map and adds the harmonic map which closes
 * the gap (thesis 4.2.1, 4.2.2, 6.3). When a number of quads is asked for, the map is rescaled and
 * rounded again until its area meets it: periods scale with the map, the period matrix does not
 * change. */
#include "sdk/map/periods/align.h"
#include "sdk/map/periods/features.h"
#include "sdk/map/periods/frame_form.h"
#include "sdk/map/periods/separation.h"
#include "sdk/map/periods/wrong_cones.h"
#include <math.h>
#include <string.h>

enum {
    LARGEST_PERIOD_MATRIX = 4000, /* variables; beyond it periods are rounded directly */
    STIFFENING_ROUNDS = 12,
    REFINEMENTS = 6,
    DENSITY_ROUNDS = 24,
    NEWTON_ROUNDS = 5,   /* of these; then scales about the best are scanned */
    WINDING_ROUNDS = 13, /* in so many, cones which wind wrong are a reason to go on */
    REACH = 3            /* target edge lengths within which points and features are kept apart */
};

static const double slack = 1e-9;    /* deviations nearer than that are equal    */
static const double promised = 0.05; /* deviation of the number of quads which is good enough */
/* Budget of the lattice search by variables and faces: a small part of the period matrix. */
static const double search_share = 1.0;

typedef struct rounding {
    qc_ctx *ctx;
    const qc_seamless_map *seamless;
    const qc_mesh *mesh;
    qc_round_options options;
    double *weight;    /* n_faces: of the seamless map, raised where features fold it; NULL = 1 */
    double *cotangent; /* times the weights of the faces */
    qc__seams *seams;
    qc__periods *periods;
    qc__separation *separation;
    double *P;                               /* n^2, NULL = direct rounding only */
    double *period;                          /* n: real-valued periods in lattice units */
    double *gap;                             /* n: rounded minus scaled periods */
    double *target, *rounded, *best_rounded; /* n */
    qc_complex *z;  /* 3 n_faces: the frame field in combed charts, where there are features */
    double *symbol; /* n_symbols */
    double _Complex *wedge;          /* n_wedges */
    double _Complex *F, *correction; /* n_vertices: unknown coordinates of f, and what is added */
    qc_complex *f; /* 3 n_faces: the shifted, aligned seamless map                                */
    qc_complex *trial, *best; /* 3 n_faces */
    double curl_energy;       /* of f, before scaling */
    double best_scale, best_miss, harmonic, harmonic_direct;
    int64_t moves, evaluations;
    bool coarse;             /* this trial only tells the number of quads */
    int32_t collisions;      /* pairs which could not be kept apart in the last trial ... */
    int32_t best_collisions; /* ... and in the best map                                           */
    int32_t wrong, best_wrong; /* cones which wind wrong */
} rounding;

/* --- one trial -------------------------------------------------------------------------------- */

static double signed_area(const qc_complex *f, int32_t n_faces) {
    double area = 0;
    for (int32_t t = 0; t < n_faces; t++) {
        const qc_complex *p = f + 3 * (int64_t)t;
        area += 0.5 * ((p[1].re - p[0].re) * (p[2].im - p[0].im) -
                       (p[2].re - p[0].re) * (p[1].im - p[0].im));
    }
    return area;
}

static double dirichlet_energy(const rounding *r, const qc_complex *f) {
    double energy = 0;
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces; c++) {
        const qc_complex a = f[qc_next((int32_t)c)], b = f[qc_prev((int32_t)c)];
        const double du = b.re - a.re, dv = b.im - a.im;
        const double weight = r->weight ? r->weight[c / 3] : 1.0;
        energy += 0.25 * r->cotangent[c] / weight * (du * du + dv * dv);
    }
    return energy;
}

static void scale_targets(rounding *r, double scale) {
    for (int32_t j = 0; j < r->seams->n_free; j++) r->target[j] = scale * r->period[j];
}

/* Less than the default where the rest of the stage is quick; other seeds search longer, since
 * small problems are solved from any. */
static int64_t search_budget(const rounding *r) {
    const int64_t n = r->seams->n_free, standard = 1000 * (n < 500 ? n : 500);
    const double share = search_share * r->mesh->n_faces * (1 + (double)(r->options.seed % 4));
    return share < (double)standard ? (int64_t)share * n : -1;
}

/* Rounds the targets to the lattice. */
static qc_status round_periods(rounding *r, qc_lattice_result *result) {
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
            status = qc__separate(r->ctx, r->separation, n, r->P, r->target, r->rounded,
                                  &result->energy, &r->collisions);
        if (status != QC_OK) return status;
    } else {
        for (int32_t j = 0; j < n; j++) r->rounded[j] = rint(r->target[j]);
    }
    for (int32_t j = 0; j < n; j++) r->gap[j] = r->rounded[j] - r->target[j];
    return QC_OK;
}

/* The harmonic map with the periods of the gap: values in the wedges, and at vertices. */
static qc_status solve_gap(rounding *r) {
    qc__seams_symbol_values(r->seams, r->gap, r->symbol);
    qc__seams_wedge_values(r->seams, r->symbol, r->wedge);
    return qc__periods_extend(r->ctx, r->periods, r->wedge, NULL, r->correction);
}

/* Energy of the harmonic map which direct rounding would add; the trial map serves as space. */
static qc_status energy_of_direct_rounding(rounding *r, double *energy) {
    for (int32_t j = 0; j < r->seams->n_free; j++) r->gap[j] = rint(r->target[j]) - r->target[j];
    const qc_status status = solve_gap(r);
    if (status != QC_OK) return status;
    qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
    *energy = dirichlet_energy(r, r->trial);
    return QC_OK;
}

/* The map with the rounded periods: what is given is exact, the rest is scale f plus the harmonic
 * correction. */
static void write_trial(rounding *r, double scale) {
    for (int32_t v = 0; v < r->mesh->n_vertices; v++) r->correction[v] += scale * r->F[v];
    qc__seams_symbol_values(r->seams, r->rounded, r->symbol);
    qc__seams_wedge_values(r->seams, r->symbol, r->wedge);
    qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
}

/* Whether the trial beats the best map so far: a number of quads which is good enough, then cones
 * kept apart and winding right, then the number of quads. */
static bool is_better(const rounding *r, double miss) {
    const bool good = miss <= promised + slack, best_good = r->best_miss <= promised + slack;
    if (good != best_good) return good;
    if (r->collisions != r->best_collisions) return r->collisions < r->best_collisions;
    if (r->wrong != r->best_wrong) return r->wrong < r->best_wrong;
    return miss < r->best_miss - slack;
}

/* The rounded map at a scale; unless coarse, keeps it when it is nearer to the wanted number of
 * quads. */
static qc_status try_scale(rounding *r, double scale, double wanted, double *quads) {
    qc_lattice_result result = {0};
    const bool weighted = r->P && r->weight; /* then P measures in another norm */
    const bool measured = !r->P || weighted;
    qc_status status = QC_OK;
    memset(r->correction, 0, sizeof *r->correction * (size_t)r->mesh->n_vertices);
    if (r->seams->n_free > 0) {
        double direct = 0;
        scale_targets(r, scale);
        if (weighted) status = energy_of_direct_rounding(r, &direct);
        if (status == QC_OK) status = round_periods(r, &result);
        if (status == QC_OK) status = solve_gap(r);
        if (weighted) result.energy_direct = direct;
    }
    if (status != QC_OK) return status;
    if (measured && r->seams->n_free > 0) {
        qc__periods_corners(r->seams, r->wedge, r->correction, r->trial);
        result.energy = dirichlet_energy(r, r->trial);
    }
    if (!r->P) result.energy_direct = result.energy;
    write_trial(r, scale);
    r->moves += result.moves;
    r->evaluations += result.evaluations;
    *quads = signed_area(r->trial, r->mesh->n_faces);
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

static double scale_factor(double wanted, double quads) {
    const double factor = quads > 0 ? sqrt(wanted / quads) : 1.5;
    return factor < 0.5 ? 0.5 : factor > 2.0 ? 2.0 : factor;
}

static qc_status meet_density(rounding *r) {
    const double wanted = r->options.refine * r->seamless->sizing->target_quads;
    double scale = sqrt(r->options.refine), middle = scale, quads = 0;
    if (wanted > 0 && r->P) {
        r->coarse = true;
        const qc_status status = try_scale(r, scale, wanted, &quads);
        if (status != QC_OK) return status;
        r->coarse = false;
        scale *= scale_factor(wanted, quads);
    }
    for (int32_t i = 0; i < DENSITY_ROUNDS; i++) {
        if (!qc__progress(r->ctx, 0.7 + 0.3 * i / DENSITY_ROUNDS)) return QC_ERR_CANCELLED;
        const qc_status status = try_scale(r, scale, wanted, &quads);
        if (status != QC_OK) return status;
        if (!(wanted > 0)) break;
        if (qc__out_of_time(r->ctx) && r->best_miss <= promised + slack) break;
        const bool sound =
            r->best_collisions == 0 && (r->best_wrong == 0 || i + 1 >= WINDING_ROUNDS);
        if (r->best_miss <= r->options.tolerance + slack && sound) break;
        if (i < NEWTON_ROUNDS - 1) {
            scale *= scale_factor(wanted, quads);
        } else { /* a map with few periods jumps: 1, -1, 2, -2, ... percent about the middle */
            if (i == NEWTON_ROUNDS - 1) middle = r->best_scale;
            const int32_t k = i - NEWTON_ROUNDS + 1;
            scale = middle * (1.0 + 0.01 * (k / 2 + 1) * (k % 2 ? -1 : 1));
            if (r->best_miss <= promised && sound) break;
        }
    }
    return QC_OK;
}

/* Where the quads asked for are too large for the distances between singularities and features, no
 * integers keep these apart: then smaller ones are taken, in steps of sqrt(2), up to 8 times as
 * many.
 */
static qc_status find_density(rounding *r) {
    const double asked = r->options.refine;
    qc_status status = meet_density(r);
    const int32_t pairs = r->best_collisions;
    if (r->options.trial) return status;
    for (int32_t k = 1; k <= REFINEMENTS && status == QC_OK && r->best_collisions > 0; k++) {
        r->options.refine = asked * pow(2, 0.5 * k);
        r->best_scale = 0;
        status = meet_density(r);
    }
    if (status != QC_OK || pairs == 0) return status;
    if (r->best_collisions > 0) {
        r->options.refine = asked;
        r->best_scale = 0;
        qc__log(r->ctx, QC_LOG_WARNING,
                "%d pairs of singularities or features are too close for this density", (int)pairs);
        return meet_density(r);
    }
    qc__log(r->ctx, QC_LOG_WARNING,
            "%d pairs of singularities or features are too close for this density; %.2g times as "
            "many quads are made",
            (int)pairs, r->options.refine / asked);
    return QC_OK;
}

/* --- the whole -------------------------------------------------------------------------------- */

static qc_status prepare(rounding *r) {
    const qc_seamless_map *seamless = r->seamless;
    const qc_cover cover = {r->mesh, seamless->matching->m};
    const int64_t n_corners = 3 * (int64_t)r->mesh->n_faces;
    r->cotangent = QC__NEW(r->ctx, double, n_corners);
    r->f = QC__NEW(r->ctx, qc_complex, n_corners);
    r->trial = QC__NEW(r->ctx, qc_complex, n_corners);
    r->best = QC__NEW(r->ctx, qc_complex, n_corners);
    if (!r->cotangent || !r->f || !r->trial || !r->best) return QC_ERR_NOMEM;
    memcpy(r->f, seamless->f, sizeof *r->f * (size_t)n_corners);
    qc_status status =
        qc_mesh_geometry(r->ctx, r->mesh, NULL, NULL, r->cotangent, NULL, NULL, NULL);
    if (status == QC_OK && seamless->weight) {
        r->weight = QC__NEW(r->ctx, double, r->mesh->n_faces);
        if (!r->weight) return QC_ERR_NOMEM;
        memcpy(r->weight, seamless->weight, sizeof *r->weight * (size_t)r->mesh->n_faces);
        for (int64_t c = 0; c < n_corners; c++) r->cotangent[c] *= r->weight[c / 3];
    }
    if (status == QC_OK)
        status = qc__seams_create(r->ctx, &cover, seamless->cut, seamless->face_turn,
                                  seamless->matching->index4, seamless->matching->axis, &r->seams);
    if (status == QC_OK) status = qc__seams_solve(r->ctx, r->seams, r->options.lattice);
    if (status != QC_OK) return status;
    const int64_t n = r->seams->n_free;
    r->period = QC__NEW(r->ctx, double, n);
    r->gap = QC__NEW(r->ctx, double, n);
    r->target = QC__NEW(r->ctx, double, n);
    r->rounded = QC__NEW(r->ctx, double, n);
    r->best_rounded = QC__NEW(r->ctx, double, n);
    r->symbol = QC__NEW(r->ctx, double, qc__seams_symbols(r->seams));
    r->wedge = QC__NEW(r->ctx, double _Complex, r->seams->n_wedges);
    r->F = QC__NEW(r->ctx, double _Complex, r->mesh->n_vertices);
    r->correction = QC__NEW(r->ctx, double _Complex, r->mesh->n_vertices);
    if (!r->period || !r->gap || !r->target || !r->rounded || !r->best_rounded || !r->symbol ||
        !r->wedge || !r->F || !r->correction)
        return QC_ERR_NOMEM;
    status = qc__seams_read(r->ctx, r->seams, r->f, r->period);
    if (status == QC_OK && (n > 0 || r->seams->n_levels > 0))
        status = qc__periods_create(r->ctx, r->seams, r->cotangent, r->options.solver, &r->periods);
    return status;
}

static qc_status make_period_matrix(rounding *r) {
    const int64_t n = r->seams->n_free;
    if (n == 0) return QC_OK;
    if (n > LARGEST_PERIOD_MATRIX) {
        if (!r->options.trial)
            qc__log(r->ctx, QC_LOG_WARNING,
                    "%lld periods are too many for a period matrix; they are rounded directly",
                    (long long)n);
        return QC_OK;
    }
    r->P = QC__NEW(r->ctx, double, n *n);
    if (!r->P) return QC_ERR_NOMEM;
    const qc__range outer = qc__range_begin(r->ctx, NULL, 0.2, 0.7);
    const qc_status status = qc__period_matrix(r->ctx, r->periods, r->P);
    qc__range_end(r->ctx, outer);
    return status;
}

/* The frame field in combed charts. */
static qc_status combed_frame(rounding *r) {
    const qc_seamless_map *seamless = r->seamless;
    r->z = QC__NEW(r->ctx, qc_complex, 3 * (int64_t)r->mesh->n_faces);
    if (!r->z) return QC_ERR_NOMEM;
    const qc_status status = qc__frame_form(r->ctx, seamless->matching, seamless->sizing, r->z);
    for (int64_t c = 0; c < 3 * (int64_t)r->mesh->n_faces && status == QC_OK; c++)
        r->z[c] = qc_quarter_turn(r->z[c], seamless->face_turn[c / 3]);
    return status;
}

/* 1/2 int |dg - z|^2 for the aligned map, before scaling. */
static double curl_energy(const rounding *r) {
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
static qc_status stiffen(rounding *r, const qc_complex *f) {
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

static int32_t count_folded(const rounding *r, const qc_complex *f) {
    int32_t n = 0;
    for (int32_t t = 0; t < r->mesh->n_faces; t++) n += signed_area(f + 3 * (int64_t)t, 1) <= 0;
    return n;
}

/* Puts the features of the seamless map on isolines, with real levels; stiffens while that makes it
 * fold over. */
static qc_status align_features(rounding *r) {
    qc_status status = combed_frame(r);
    for (int32_t i = 0; status == QC_OK; i++) {
        if (!qc__progress(r->ctx, 0.6)) status = QC_ERR_CANCELLED;
        if (status == QC_OK) status = qc__align(r->ctx, r->periods, r->P, r->z, r->f, r->period);
        if (status != QC_OK || i == STIFFENING_ROUNDS || count_folded(r, r->f) == 0) break;
        status = stiffen(r, r->f);
        if (status == QC_OK && r->P) status = qc__period_matrix(r->ctx, r->periods, r->P);
    }
    if (status == QC_OK) r->curl_energy = curl_energy(r);
    return status;
}

/* With the integers chosen, features let the map fold over where they lie close: it is stiffened
 * there and solved again. Of all maps the one with the fewest wrong cones, then folded faces, is
 * kept. */
static qc_status unfold_features(rounding *r) {
    if (r->seams->n_levels == 0) return QC_OK;
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
    r->harmonic = dirichlet_energy(r, r->trial);
    return status;
}

/* Then finds what has to stay apart. */
static qc_status align(rounding *r) {
    r->curl_energy = r->seamless->curl_energy;
    const qc_status status = r->seams->n_levels > 0 ? align_features(r) : QC_OK;
    if (status != QC_OK) return status;
    qc__periods_split(r->seams, r->f, r->wedge, r->F);
    if (!r->P) return QC_OK;
    return qc__separation_create(
        r->ctx, r->seams, r->seamless->matching->axis, r->seamless->matching->pole_index4, r->f,
        REACH * r->seamless->sizing->edge_length / sqrt(r->options.refine), &r->separation);
}

/* The features in the charts of the map. */
static qc_status publish_axis(rounding *r, qc_corner_map *map) {
    const qc_matching *matching = r->seamless->matching;
    if (!matching->axis) return QC_OK;
    const qc_cover cover = {r->mesh, matching->m};
    const qc__features features = {&cover, r->seamless->face_turn, matching->axis};
    int8_t *axis = QC__NEW(r->ctx, int8_t, r->mesh->n_edges);
    if (!axis) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < r->mesh->n_edges; e++) {
        const int32_t h = r->mesh->edge_halfedge[2 * (int64_t)e];
        axis[e] = qc__is_feature(&features, h) ? (int8_t)qc__feature_direction(&features, h) : -1;
    }
    const qc_status status = qc_corner_map_set_axis(r->ctx, map, axis);
    qc__free(axis);
    return status;
}

static qc_status publish(rounding *r, qc_corner_map **out) {
    const qc_seamless_map *seamless = r->seamless;
    const int32_t n_faces = r->mesh->n_faces;
    qc_complex *cross = QC__NEW(r->ctx, qc_complex, n_faces);
    if (!cross) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < n_faces; t++)
        cross[t] = qc_quarter_turn(seamless->matching->field->x[t], -seamless->face_turn[t]);
    const qc_cover cover = {r->mesh, seamless->matching->m};
    int8_t *rotation = QC__ZERO(r->ctx, int8_t, r->mesh->n_edges);
    qc_corner_map *map = NULL;
    qc_status status = rotation ? QC_OK : QC_ERR_NOMEM;
    for (int32_t e = 0; e < r->mesh->n_edges && status == QC_OK; e++) {
        const int32_t h = r->mesh->edge_halfedge[2 * (int64_t)e];
        if (r->mesh->twin[h] >= 0)
            rotation[e] = (int8_t)qc__combed_rotation(&cover, seamless->face_turn, h);
    }
    if (status == QC_OK)
        status = qc_corner_map_create(r->ctx, r->mesh, &r->best[0].re,
                                      seamless->sizing->edge_length / r->best_scale, cross, &map);
    if (status == QC_OK) status = qc_corner_map_set_rotation(r->ctx, map, rotation);
    if (status == QC_OK) status = publish_axis(r, map);
    if (status == QC_OK) {
        for (int64_t c = 0; c < 3 * (int64_t)n_faces; c++) {
            r->trial[c].re = r->best_scale * r->f[c].re;
            r->trial[c].im = r->best_scale * r->f[c].im;
        }
        status = qc_corner_map_set_relaxed(r->ctx, map, &r->trial[0].re);
    }
    qc__free(rotation);
    qc__free(cross);
    if (status != QC_OK) {
        qc_object_release(map);
        return status;
    }
    const double square = r->best_scale * r->best_scale;
    map->field_energy = square * seamless->field_energy;
    map->curl_energy = square * r->curl_energy;
    map->harmonic_energy = r->harmonic;
    map->harmonic_energy_direct = r->harmonic_direct;
    map->iterations = r->moves;
    map->evaluations = r->evaluations;
    *out = map;
    return QC_OK;
}

/* No quadrangulation of the torus has exactly two irregular vertices of valence 3 and 5: the
 * holonomy of such a flat metric would be trivial (Izmestiev, Kusner, Rote, Springborn, Sullivan
 * 2013). */
static qc_status refuse_impossible(const rounding *r) {
    const qc_mesh *mesh = r->mesh;
    const qc_matching *matching = r->seamless->matching;
    if (mesh->n_components != 1 || mesh->n_boundary_edges > 0 || mesh->genus != 1 ||
        matching->n_singular != 2)
        return QC_OK;
    int32_t cone[2] = {-1, -1};
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (matching->index4[v] == 1 || matching->index4[v] == -1)
            cone[matching->index4[v] < 0] = v;
    if (cone[0] < 0 || cone[1] < 0) return QC_OK;
    return qc__fail(
        r->ctx, QC_ERR_FAILED, cone[0],
        "no quad mesh of a torus has exactly one vertex of valence 3 (here %d) and one of "
        "valence 5 (here %d); smooth the field or give it more singularities",
        (int)cone[0], (int)cone[1]);
}

qc_status qc_map_round(qc_ctx *ctx, const qc_seamless_map *seamless,
                       const qc_round_options *options, qc_corner_map **out) {
    rounding r = {.ctx = ctx, .seamless = seamless, .mesh = seamless->matching->field->mesh};
    r.options = (qc_round_options)QC_ROUND_OPTIONS_INIT;
    if (options)
        memcpy(&r.options, options,
               options->struct_size < sizeof r.options ? options->struct_size : sizeof r.options);
    if (!(r.options.tolerance > 0)) r.options.tolerance = 0.02;
    if (!(r.options.refine > 0)) r.options.refine = 1;
    qc_status status = refuse_impossible(&r);
    if (status == QC_OK) status = prepare(&r);
    if (status == QC_OK) status = make_period_matrix(&r);
    if (status == QC_OK) status = align(&r);
    if (status == QC_OK) status = find_density(&r);
    if (status == QC_OK) status = unfold_features(&r);
    if (status == QC_OK) status = publish(&r, out);
    qc__separation_free(r.separation);
    qc__periods_free(r.periods);
    qc__seams_free(r.seams);
    void *const blocks[] = {r.weight, r.cotangent, r.f,      r.trial,     r.best,         r.P,
                            r.period, r.gap,       r.target, r.rounded,   r.best_rounded, r.z,
                            r.symbol, r.wedge,     r.F,      r.correction};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
