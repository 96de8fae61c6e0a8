/* Curl reduction (Algorithm 6.1, steps 2 and 3): the edges with the largest shares of E_D are
 * flipped such that |theta| falls, as long as E_D does. Several are tried at a time, those which
 * pay alone are applied together, and the better half of them while together they pay less than the
 * best. */
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/search.h"

/* Edges of the faces around both ends of a flipped edge may be tried again. */
static void forget_around(qc__search *s, int32_t e) {
    const qc_mesh *mesh = s->d->mesh;
    for (int i = 0; i < 2; i++) {
        const int32_t first = mesh->vertex_corner[mesh->edge_vertex[2 * e + i]];
        for (int32_t c = first, go = 1; go && c >= 0;) {
            for (int32_t h = c - c % 3; h < c - c % 3 + 3; h++) {
                const int32_t g = mesh->twin[h];
                s->tried[mesh->halfedge_edge[h]] = 0;
                for (int32_t k = 0; g >= 0 && k < 3; k++)
                    s->tried[mesh->halfedge_edge[g - g % 3 + k]] = 0;
            }
            c = qc_corner_ccw(mesh, c);
            go = c != first;
        }
    }
}

/* Share of the field below which E_D is rounding. */
static const double NOTHING = 1e-12;

static double least_gain(const qc__search *s) {
    return fmax(s->options.gain, 1e-9 * s->d->energy);
}

/* Vertices of the two edges are disjoint, so that the rules hold for both together. */
static bool apart(const qc_mesh *mesh, int32_t a, int32_t b) {
    const int32_t *p = mesh->edge_vertex + 2 * a, *q = mesh->edge_vertex + 2 * b;
    return p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1];
}

/* Keeps the flips which are apart from all better ones. */
static int32_t choose(const qc__search *s, const qc__candidate *gain, int32_t n,
                      qc_flip_step *flip) {
    int32_t k = 0;
    for (int32_t i = 0; i < n && k < BULK; i++) {
        bool free = true;
        for (int32_t j = 0; j < k && free; j++)
            free = apart(s->d->mesh, flip[j].edge, gain[i].flip.edge);
        if (free) flip[k++] = gain[i].flip;
    }
    return k;
}

static qc_status change(qc_ctx *ctx, qc__search *s, int32_t n, const qc_flip_step *flip,
                        double limit, bool *applied) {
    const qc_status status = qc_distortion_change(ctx, s->d, n, flip, limit, NULL, applied);
    for (int32_t i = 0; !status && *applied && i < n; i++) forget_around(s, flip[i].edge);
    return status;
}

/* Those which pay alone, at once: gain sorted, best first. The better half of them while together
 * they pay less than the best one. */
static qc_status apply(qc_ctx *ctx, qc__search *s, const qc__candidate *gain, int32_t n,
                       bool *applied) {
    qc_flip_step flip[BULK];
    const double limit = s->d->energy - 0.999 * gain[0].rank;
    qc_status status = QC_OK;
    *applied = false;
    for (int32_t k = choose(s, gain, n, flip); !status && k > 0 && !*applied; k /= 2)
        status = change(ctx, s, k, flip, limit, applied);
    return status;
}

/* The best predictions at once, verified by one evaluation; their number follows the success. */
static qc_status apply_bulk(qc_ctx *ctx, qc__search *s, int32_t n, bool *applied) {
    qc_flip_step flip[BULK];
    double expected = 0;
    int32_t k = 0;
    while (k < n && s->pool[k].rank > least_gain(s)) k++;
    k = choose(s, s->pool, k, flip);
    if (k > s->bulk) k = s->bulk;
    *applied = false;
    if (k < 2) return QC_OK;
    for (int32_t i = 0; i < k; i++) expected += s->pool[i].rank;
    const qc_status status = change(ctx, s, k, flip, s->d->energy - 0.25 * expected, applied);
    s->bulk = *applied ? 2 * k : k / 2;
    if (s->bulk > BULK) s->bulk = BULK;
    return status;
}

/* The next QC__TRIALS of the pool; *n_gain of them pay alone. */
static qc_status try_some(qc_ctx *ctx, qc__search *s, const qc__candidate *pool, int32_t n,
                          qc__candidate *gain, int32_t *n_gain) {
    qc_flip_step flip[QC__TRIALS];
    double energy[QC__TRIALS];
    const double before = s->d->energy;
    for (int32_t i = 0; i < n; i++) flip[i] = pool[i].flip;
    const qc_status status = qc_distortion_try(ctx, s->d, n, flip, energy);
    *n_gain = 0;
    for (int32_t i = 0; !status && i < n; i++) {
        qc__learn(s, &pool[i].expected, energy[i] - before);
        s->tried[flip[i].edge] |= qc__tried_mark(flip[i].step);
        if (before - energy[i] > least_gain(s)) {
            const qc__candidate c = {flip[i], before - energy[i], {0, 0}};
            gain[(*n_gain)++] = c;
        }
    }
    if (*n_gain > 1) qsort(gain, (size_t)*n_gain, sizeof *gain, qc__by_rank);
    return status;
}

/* Share of the budget which is used up, evaluations or seconds. */
static double used(const qc__search *s) {
    const double evaluations =
        (double)(s->d->evaluations - s->first) / fmax((double)s->options.evaluations, 1);
    const double limit = s->options.seconds;
    return limit > 0 ? fmax(evaluations, (qc__now() - s->start) / limit) : evaluations;
}

/* Sorts once and tries from the top until something pays. *ended: nothing is left to try. */
static qc_status round_of_trials(qc_ctx *ctx, qc__search *s, bool *applied, bool *ended) {
    qc__candidate gain[QC__TRIALS];
    int32_t n = 0;
    qc_status status = qc__fill_pool(ctx, s, &n);
    *applied = false;
    *ended = n == 0;
    if (!status) status = apply_bulk(ctx, s, n, applied);
    for (int32_t i = 0; !status && i < n && i < SOME && !*applied; i += QC__TRIALS) {
        const int32_t k = n - i < QC__TRIALS ? n - i : QC__TRIALS;
        int32_t n_gain = 0;
        status = try_some(ctx, s, s->pool + i, k, gain, &n_gain);
        if (!status && n_gain > 0) status = apply(ctx, s, gain, n_gain, applied);
        s->failures += k;
        if (!status && !*applied && !qc__progress(ctx, fmin(used(s), 1))) status = QC_ERR_CANCELLED;
    }
    if (*applied) s->failures = 0;
    return status;
}

/* The state beside the progress, ten times a second. */
static void show_state(qc_ctx *ctx, qc__search *s) {
    const double now = qc__now(), passed = now - s->start, part = used(s);
    if (now - s->shown < 0.1) return;
    s->shown = now;
    const double left = part > 0 ? passed * fmax(1 - part, 0) / part : 0;
    qc__detail(ctx, "E_D %.3f %%, %d branch points, %.0f evaluations/s, at most %.0f s more",
               100 * s->d->energy / s->d->whole, (int)s->d->branch_points,
               (double)(s->d->evaluations - s->first) / passed, fmin(left, qc__time_left(ctx)));
}

/* Until the budget or the patience is at an end, or nothing is left to try. */
static qc_status run(qc_ctx *ctx, qc__search *s) {
    bool any = false, applied = false, ended = false;
    qc_status status = QC_OK;
    s->bulk = BULK;
    s->failures = 0;
    memset(s->tried, 0, (size_t)s->d->mesh->n_edges);
    while (!status && s->failures < s->options.patience && used(s) < 1 && !qc__out_of_time(ctx)) {
        status = round_of_trials(ctx, s, &applied, &ended);
        any |= applied;
        if (ended && !any) break;
        if (ended) { /* the field has changed since the first trials: once more */
            memset(s->tried, 0, (size_t)s->d->mesh->n_edges);
            any = false;
        }
        show_state(ctx, s);
        if (!status && !qc__progress(ctx, fmin(used(s), 1))) status = QC_ERR_CANCELLED;
    }
    return status;
}

static bool allocate(qc_ctx *ctx, qc__search *s) {
    const qc_distortion *d = s->d;
    s->share = QC__NEW(ctx, double, d->mesh->n_edges);
    s->theta = QC__NEW(ctx, double, d->mesh->n_edges);
    s->tried = QC__NEW(ctx, uint8_t, d->mesh->n_edges);
    s->pool = QC__NEW(ctx, qc__candidate, POOL);
    s->v = QC__NEW(ctx, qc_complex, d->n);
    s->slope = QC__NEW(ctx, double, d->mesh->n_faces);
    return s->share && s->theta && s->tried && s->pool && s->v && s->slope;
}

static void release(qc__search *s) {
    qc__free(s->share);
    qc__free(s->theta);
    qc__free(s->tried);
    qc__free(s->pool);
    qc__free(s->v);
    qc__free(s->slope);
}

qc_status qc_distortion_reduce(qc_ctx *ctx, qc_distortion *d, const qc_reduce_options *options) {
    qc__search s = {.d = d,
                    .options = QC_REDUCE_OPTIONS_INIT,
                    .first = d->evaluations,
                    .start = qc__now(),
                    .weight = {1.2e-4, 1e-4}};
    if (options)
        memcpy(&s.options, options,
               options->struct_size < sizeof s.options ? options->struct_size : sizeof s.options);
    s.rules = (qc__rules){false, s.options.spacing};
    if (d->n == 0 || !(d->energy > NOTHING * d->whole)) return QC_OK;
    const double before = d->energy;
    const int32_t points = d->branch_points;
    const int64_t patience = s.options.patience;
    if (s.options.create) s.options.patience = patience / 4 > 0 ? patience / 4 : 1;
    qc_status status = allocate(ctx, &s) ? run(ctx, &s) : QC_ERR_NOMEM;
    if (!status && s.options.create) { /* fewer are needed once the others are in place */
        s.options.patience = patience;
        s.rules.create = true;
        status = run(ctx, &s);
    }
    release(&s);
    const double evaluations = (double)(d->evaluations - s.first), seconds = qc__now() - s.start;
    qc__log(ctx, QC_LOG_INFO,
            "E_D %.3f %% to %.3f %% of the field, %d to %d branch points, %.0f evaluations, %.0f/s",
            100 * before / d->whole, 100 * d->energy / d->whole, (int)points, (int)d->branch_points,
            evaluations, seconds > 0 ? evaluations / seconds : 0);
    return status;
}
