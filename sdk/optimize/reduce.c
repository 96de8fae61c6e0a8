/* Curl reduction (Algorithm 6.1, steps 2 and 3): the edges with the largest shares of E_D are
 * flipped such that |theta| falls, as long as E_D does. Several are tried at a time, those which
 * pay alone are applied together, and the better half of them while together they pay less than the
 * best. */
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/internal.h"

enum { POOL = 4 * QC__TRIALS };

typedef struct candidate {
    qc_flip_step flip;
    double rank; /* share, then gain */
} candidate;

typedef struct search {
    qc_distortion *d;
    qc_reduce_options options;
    qc__rules rules;
    double *share, *theta; /* n_edges */
    uint8_t *tried;        /* n_edges: 1 = step +1, 2 = step -1 failed since the last change near */
    int64_t first;         /* evaluations at the start */
    int64_t failures;      /* in a row */
} search;

static int by_rank(const void *a, const void *b) {
    const candidate *x = a, *y = b;
    if (x->rank != y->rank) return x->rank > y->rank ? -1 : 1;
    if (x->flip.edge != y->flip.edge) return x->flip.edge < y->flip.edge ? -1 : 1;
    return x->flip.step - y->flip.step;
}

static uint8_t mark(int32_t step) {
    return step > 0 ? 1 : 2;
}

/* The POOL best in the order of by_rank, kept sorted by insertion. */
static void insert(candidate *pool, int32_t *n, candidate c) {
    int32_t i = *n < POOL ? (*n)++ : POOL;
    if (i == POOL && by_rank(&c, &pool[--i]) >= 0) return;
    for (; i > 0 && by_rank(&c, &pool[i - 1]) < 0; i--) pool[i] = pool[i - 1];
    pool[i] = c;
}

static bool touches_branch_point(const qc_distortion *d, int32_t e) {
    const int32_t *p = d->mesh->edge_vertex + 2 * e;
    return d->index4[p[0]] != 0 || d->index4[p[1]] != 0;
}

static int32_t collect(const search *s, candidate *pool) {
    const qc_distortion *d = s->d;
    int32_t n = 0;
    for (int32_t e = 0; e < d->mesh->n_edges; e++) {
        if (s->tried[e] == 3 || !qc_distortion_can_flip(d, e)) continue;
        if (!s->rules.create && !touches_branch_point(d, e)) continue;
        const int32_t down = s->theta[e] > 0 ? 1 : -1; /* lowers |theta| */
        for (int k = 0; k < (s->rules.create ? 1 : 2); k++) {
            const candidate c = {{e, k == 0 ? down : -down},
                                 k == 0 ? s->share[e] : 0.5 * s->share[e]};
            if (s->tried[e] & mark(c.flip.step)) continue;
            if (n == POOL && by_rank(&c, &pool[n - 1]) >= 0) continue;
            if (qc__flip_allowed(d, &s->rules, c.flip)) insert(pool, &n, c);
        }
    }
    return n;
}

/* Edges of the faces around both ends of a flipped edge may be tried again. */
static void forget_around(search *s, int32_t e) {
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

/* Vertices of the two edges are disjoint, so that the rules hold for both together. */
static bool apart(const qc_mesh *mesh, int32_t a, int32_t b) {
    const int32_t *p = mesh->edge_vertex + 2 * a, *q = mesh->edge_vertex + 2 * b;
    return p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1];
}

/* Keeps the flips which are apart from all better ones. */
static int32_t choose(const search *s, const candidate *gain, int32_t n, qc_flip_step *flip) {
    int32_t k = 0;
    for (int32_t i = 0; i < n; i++) {
        bool free = true;
        for (int32_t j = 0; j < k && free; j++)
            free = apart(s->d->mesh, flip[j].edge, gain[i].flip.edge);
        if (free) flip[k++] = gain[i].flip;
    }
    return k;
}

/* gain: sorted, best first. */
static qc_status apply(qc_ctx *ctx, search *s, const candidate *gain, int32_t n, bool *applied) {
    qc_flip_step flip[POOL];
    const double limit = s->d->energy - 0.999 * gain[0].rank;
    qc_status status = QC_OK;
    *applied = false;
    for (int32_t k = choose(s, gain, n, flip); !status && k > 0 && !*applied; k /= 2) {
        status = qc_distortion_change(ctx, s->d, k, flip, limit, NULL, applied);
        for (int32_t i = 0; !status && *applied && i < k; i++) forget_around(s, flip[i].edge);
    }
    return status;
}

/* The next QC__TRIALS of the pool; *n_gain of them pay alone. */
static qc_status try_some(qc_ctx *ctx, search *s, const candidate *pool, int32_t n, candidate *gain,
                          int32_t *n_gain) {
    qc_flip_step flip[QC__TRIALS];
    double energy[QC__TRIALS];
    const double before = s->d->energy, least = fmax(s->options.gain, 1e-9 * before);
    for (int32_t i = 0; i < n; i++) flip[i] = pool[i].flip;
    const qc_status status = qc_distortion_try(ctx, s->d, n, flip, energy);
    *n_gain = 0;
    for (int32_t i = 0; !status && i < n; i++) {
        s->tried[flip[i].edge] |= mark(flip[i].step);
        if (before - energy[i] > least) {
            const candidate c = {flip[i], before - energy[i]};
            gain[(*n_gain)++] = c;
        }
    }
    qsort(gain, (size_t)*n_gain, sizeof *gain, by_rank);
    return status;
}

/* Sorts once and tries from the top until something pays. *ended: nothing is left to try. */
static qc_status round_of_trials(qc_ctx *ctx, search *s, bool *applied, bool *ended) {
    candidate pool[POOL], gain[QC__TRIALS];
    qc_status status = qc_distortion_shares(ctx, s->d, s->share, s->theta);
    const int32_t n = status ? 0 : collect(s, pool);
    *applied = false;
    *ended = n == 0;
    for (int32_t i = 0; !status && i < n && !*applied; i += QC__TRIALS) {
        const int32_t k = n - i < QC__TRIALS ? n - i : QC__TRIALS;
        int32_t n_gain = 0;
        status = try_some(ctx, s, pool + i, k, gain, &n_gain);
        if (!status && n_gain > 0) status = apply(ctx, s, gain, n_gain, applied);
        s->failures = *applied ? 0 : s->failures + k;
    }
    return status;
}

static qc_status run(qc_ctx *ctx, search *s) {
    const int64_t most = s->options.evaluations;
    bool any = false, applied = false, ended = false;
    qc_status status = QC_OK;
    while (!status && s->d->evaluations - s->first < most && s->failures < s->options.patience) {
        status = round_of_trials(ctx, s, &applied, &ended);
        any |= applied;
        if (ended && !any) break;
        if (ended) { /* the field has changed since the first trials: once more */
            memset(s->tried, 0, (size_t)s->d->mesh->n_edges);
            any = false;
        }
        if (!status && !qc__progress(ctx, (double)(s->d->evaluations - s->first) / (double)most))
            status = QC_ERR_CANCELLED;
    }
    return status;
}

qc_status qc_distortion_reduce(qc_ctx *ctx, qc_distortion *d, const qc_reduce_options *options) {
    search s = {.d = d, .options = QC_REDUCE_OPTIONS_INIT, .first = d->evaluations};
    if (options)
        memcpy(&s.options, options,
               options->struct_size < sizeof s.options ? options->struct_size : sizeof s.options);
    s.rules = (qc__rules){s.options.create != 0, s.options.spacing};
    if (d->n == 0) return QC_OK;
    s.share = QC__NEW(ctx, double, d->mesh->n_edges);
    s.theta = QC__NEW(ctx, double, d->mesh->n_edges);
    s.tried = QC__ZERO(ctx, uint8_t, d->mesh->n_edges);
    const double before = d->energy, start = qc__now();
    const int32_t points = d->branch_points;
    qc_status status = s.share && s.theta && s.tried ? run(ctx, &s) : QC_ERR_NOMEM;
    qc__free(s.share);
    qc__free(s.theta);
    qc__free(s.tried);
    const double evaluations = (double)(d->evaluations - s.first), seconds = qc__now() - start;
    qc__log(ctx, QC_LOG_INFO,
            "E_D %.3f %% to %.3f %% of the field, %d to %d branch points, %.0f evaluations, %.0f/s",
            100 * before / d->whole, 100 * d->energy / d->whole, (int)points, (int)d->branch_points,
            evaluations, seconds > 0 ? evaluations / seconds : 0);
    return status;
}
