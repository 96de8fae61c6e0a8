/* Curl reduction (Algorithm 6.1, steps 2 and 3): the edges with the largest shares of E_D are
 * flipped such that |theta| falls, as long as E_D does. Several are tried at a time, those which
 * pay alone are applied together, and the better half of them while together they pay less than the
 * best. */
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/internal.h"

/* Candidates of largest share, of which those with the best prediction are tried; flips made at
 * once on the strength of their predictions, at most. */
enum { POOL = 512, SOME = 4 * QC__TRIALS, BULK = 32 };

/* A pair of new branch points has to gain so much more than a move to be tried as early. */
static const double NEW_SHARE = 0.5;

typedef struct candidate {
    qc_flip_step flip;
    double rank; /* larger is better: share, then predicted or measured gain */
    qc__prediction expected;
} candidate;

typedef struct search {
    qc_distortion *d;
    qc_reduce_options options;
    qc__rules rules;
    double *share, *theta; /* n_edges */
    uint8_t *tried;        /* n_edges: 1 = step +1, 2 = step -1 failed since the last change near */
    candidate *pool;       /* POOL */
    qc_complex *v;         /* n: copotential */
    double *slope;         /* n_faces */
    double weight[2];      /* sums of (change - first) self and of self^2 over the trials */
    int32_t bulk;
    int64_t first;    /* evaluations at the start */
    int64_t failures; /* in a row */
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

/* The POOL best in the order of by_rank: a heap with the worst at its root. */
static void insert(candidate *pool, int32_t *n, const candidate *c) {
    int32_t i;
    if (*n < POOL) {
        for (i = (*n)++; i > 0 && by_rank(c, &pool[(i - 1) / 2]) > 0; i = (i - 1) / 2)
            pool[i] = pool[(i - 1) / 2];
    } else {
        for (i = 0;;) {
            int32_t k = 2 * i + 1;
            if (k + 1 < POOL && by_rank(&pool[k + 1], &pool[k]) > 0) k++;
            if (k >= POOL || by_rank(&pool[k], c) <= 0) break;
            pool[i] = pool[k];
            i = k;
        }
    }
    pool[i] = *c;
}

static bool touches_branch_point(const qc_distortion *d, int32_t e) {
    const int32_t *p = d->mesh->edge_vertex + 2 * e;
    return d->index4[p[0]] != 0 || d->index4[p[1]] != 0;
}

static int32_t collect(const search *s) {
    candidate *pool = s->pool;
    const qc_distortion *d = s->d;
    int32_t n = 0;
    for (int32_t e = 0; e < d->mesh->n_edges; e++) {
        if (s->tried[e] == 3 || !qc_distortion_can_flip(d, e)) continue;
        if (!s->rules.create && !touches_branch_point(d, e)) continue;
        const int32_t down = s->theta[e] > 0 ? 1 : -1; /* lowers |theta| */
        for (int k = 0; k < (s->rules.create ? 1 : 2); k++) {
            const candidate c = {
                {e, k == 0 ? down : -down}, k == 0 ? s->share[e] : 0.5 * s->share[e], {0, 0}};
            if (s->tried[e] & mark(c.flip.step)) continue;
            if (n == POOL && by_rank(&c, &pool[0]) >= 0) continue;
            if (qc__flip_allowed(d, &s->rules, c.flip)) insert(pool, &n, &c);
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

static double least_gain(const search *s) {
    return fmax(s->options.gain, 1e-9 * s->d->energy);
}

/* Vertices of the two edges are disjoint, so that the rules hold for both together. */
static bool apart(const qc_mesh *mesh, int32_t a, int32_t b) {
    const int32_t *p = mesh->edge_vertex + 2 * a, *q = mesh->edge_vertex + 2 * b;
    return p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1];
}

/* Keeps the flips which are apart from all better ones. */
static int32_t choose(const search *s, const candidate *gain, int32_t n, qc_flip_step *flip) {
    int32_t k = 0;
    for (int32_t i = 0; i < n && k < BULK; i++) {
        bool free = true;
        for (int32_t j = 0; j < k && free; j++)
            free = apart(s->d->mesh, flip[j].edge, gain[i].flip.edge);
        if (free) flip[k++] = gain[i].flip;
    }
    return k;
}

static double weight(const search *s) {
    return s->weight[0] / s->weight[1];
}

static void learn(search *s, const qc__prediction *p, double change) {
    if (!(p->self > 0) || !isfinite(p->self) || !isfinite(change)) return;
    const double self = p->self / s->d->energy, rest = (change - p->first) / s->d->energy;
    for (int i = 0; i < 2; i++) s->weight[i] *= 0.99;
    s->weight[0] += rest * self;
    s->weight[1] += self * self;
}

static void predict_some(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const search *s = arg;
    (void)worker;
    for (int64_t i = begin; i < end; i++) {
        candidate *c = &s->pool[i];
        c->expected = qc__predict(s->d, s->v, s->slope, c->flip);
        c->rank = -(c->expected.first + weight(s) * c->expected.self);
        if (c->rank > 0 && qc__new_branch_points(s->d, c->flip) > 0) c->rank *= NEW_SHARE;
    }
}

/* The pool with the best prediction first. */
static qc_status fill_pool(qc_ctx *ctx, search *s, int32_t *n) {
    qc_status status = qc_distortion_shares(ctx, s->d, s->share, s->theta);
    if (status) return status;
    memcpy(s->v, s->d->curl, (size_t)s->d->n * sizeof *s->v);
    status = qc__prepare_slope(ctx, s->d, s->v, s->slope);
    if (status) return status;
    *n = collect(s);
    qc__parallel_for(ctx, *n, 32, predict_some, s);
    qsort(s->pool, (size_t)*n, sizeof *s->pool, by_rank);
    return QC_OK;
}

static qc_status change(qc_ctx *ctx, search *s, int32_t n, const qc_flip_step *flip, double limit,
                        bool *applied) {
    const qc_status status = qc_distortion_change(ctx, s->d, n, flip, limit, NULL, applied);
    for (int32_t i = 0; !status && *applied && i < n; i++) forget_around(s, flip[i].edge);
    return status;
}

/* Those which pay alone, at once: gain sorted, best first. The better half of them while together
 * they pay less than the best one. */
static qc_status apply(qc_ctx *ctx, search *s, const candidate *gain, int32_t n, bool *applied) {
    qc_flip_step flip[BULK];
    const double limit = s->d->energy - 0.999 * gain[0].rank;
    qc_status status = QC_OK;
    *applied = false;
    for (int32_t k = choose(s, gain, n, flip); !status && k > 0 && !*applied; k /= 2)
        status = change(ctx, s, k, flip, limit, applied);
    return status;
}

/* The best predictions at once, verified by one evaluation; their number follows the success. */
static qc_status apply_bulk(qc_ctx *ctx, search *s, int32_t n, bool *applied) {
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
static qc_status try_some(qc_ctx *ctx, search *s, const candidate *pool, int32_t n, candidate *gain,
                          int32_t *n_gain) {
    qc_flip_step flip[QC__TRIALS];
    double energy[QC__TRIALS];
    const double before = s->d->energy;
    for (int32_t i = 0; i < n; i++) flip[i] = pool[i].flip;
    const qc_status status = qc_distortion_try(ctx, s->d, n, flip, energy);
    *n_gain = 0;
    for (int32_t i = 0; !status && i < n; i++) {
        learn(s, &pool[i].expected, energy[i] - before);
        s->tried[flip[i].edge] |= mark(flip[i].step);
        if (before - energy[i] > least_gain(s)) {
            const candidate c = {flip[i], before - energy[i], {0, 0}};
            gain[(*n_gain)++] = c;
        }
    }
    if (*n_gain > 1) qsort(gain, (size_t)*n_gain, sizeof *gain, by_rank);
    return status;
}

/* Sorts once and tries from the top until something pays. *ended: nothing is left to try. */
static qc_status round_of_trials(qc_ctx *ctx, search *s, bool *applied, bool *ended) {
    candidate gain[QC__TRIALS];
    int32_t n = 0;
    qc_status status = fill_pool(ctx, s, &n);
    *applied = false;
    *ended = n == 0;
    if (!status) status = apply_bulk(ctx, s, n, applied);
    for (int32_t i = 0; !status && i < n && i < SOME && !*applied; i += QC__TRIALS) {
        const int32_t k = n - i < QC__TRIALS ? n - i : QC__TRIALS;
        int32_t n_gain = 0;
        status = try_some(ctx, s, s->pool + i, k, gain, &n_gain);
        if (!status && n_gain > 0) status = apply(ctx, s, gain, n_gain, applied);
        s->failures += k;
    }
    if (*applied) s->failures = 0;
    return status;
}

static qc_status run(qc_ctx *ctx, search *s) {
    const int64_t most = s->options.evaluations;
    bool any = false, applied = false, ended = false;
    qc_status status = QC_OK;
    s->bulk = BULK;
    s->failures = 0;
    memset(s->tried, 0, (size_t)s->d->mesh->n_edges);
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

static bool allocate(qc_ctx *ctx, search *s) {
    const qc_distortion *d = s->d;
    s->share = QC__NEW(ctx, double, d->mesh->n_edges);
    s->theta = QC__NEW(ctx, double, d->mesh->n_edges);
    s->tried = QC__NEW(ctx, uint8_t, d->mesh->n_edges);
    s->pool = QC__NEW(ctx, candidate, POOL);
    s->v = QC__NEW(ctx, qc_complex, d->n);
    s->slope = QC__NEW(ctx, double, d->mesh->n_faces);
    return s->share && s->theta && s->tried && s->pool && s->v && s->slope;
}

static void release(search *s) {
    qc__free(s->share);
    qc__free(s->theta);
    qc__free(s->tried);
    qc__free(s->pool);
    qc__free(s->v);
    qc__free(s->slope);
}

qc_status qc_distortion_reduce(qc_ctx *ctx, qc_distortion *d, const qc_reduce_options *options) {
    search s = {.d = d,
                .options = QC_REDUCE_OPTIONS_INIT,
                .first = d->evaluations,
                .weight = {1.2e-4, 1e-4}};
    if (options)
        memcpy(&s.options, options,
               options->struct_size < sizeof s.options ? options->struct_size : sizeof s.options);
    s.rules = (qc__rules){false, s.options.spacing};
    if (d->n == 0) return QC_OK;
    const double before = d->energy, start = qc__now();
    const int32_t points = d->branch_points;
    qc_status status = allocate(ctx, &s) ? run(ctx, &s) : QC_ERR_NOMEM;
    if (!status && s.options.create) { /* fewer are needed once the others are in place */
        s.rules.create = true;
        status = run(ctx, &s);
    }
    release(&s);
    const double evaluations = (double)(d->evaluations - s.first), seconds = qc__now() - start;
    qc__log(ctx, QC_LOG_INFO,
            "E_D %.3f %% to %.3f %% of the field, %d to %d branch points, %.0f evaluations, %.0f/s",
            100 * before / d->whole, 100 * d->energy / d->whole, (int)points, (int)d->branch_points,
            evaluations, seconds > 0 ? evaluations / seconds : 0);
    return status;
}
