/* Candidates for flips: the edges of largest share of E_D (Algorithm 6.1, step 2), in the order of
 * what their surroundings predict. */
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/search.h"

/* A pair of new branch points has to gain so much more than a move to be tried as early. */
static const double NEW_SHARE = 0.5;

int qc__by_rank(const void *a, const void *b) {
    const qc__candidate *x = a, *y = b;
    if (x->rank != y->rank) return x->rank > y->rank ? -1 : 1;
    if (x->flip.edge != y->flip.edge) return x->flip.edge < y->flip.edge ? -1 : 1;
    return x->flip.step - y->flip.step;
}

/* The POOL best in the order of qc__by_rank: a heap with the worst at its root. */
static void insert(qc__candidate *pool, int32_t *n, const qc__candidate *c) {
    int32_t i;
    if (*n < POOL) {
        for (i = (*n)++; i > 0 && qc__by_rank(c, &pool[(i - 1) / 2]) > 0; i = (i - 1) / 2)
            pool[i] = pool[(i - 1) / 2];
    } else {
        for (i = 0;;) {
            int32_t k = 2 * i + 1;
            if (k + 1 < POOL && qc__by_rank(&pool[k + 1], &pool[k]) > 0) k++;
            if (k >= POOL || qc__by_rank(&pool[k], c) <= 0) break;
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

static int32_t collect(const qc__search *s) {
    qc__candidate *pool = s->pool;
    const qc_distortion *d = s->d;
    int32_t n = 0;
    for (int32_t e = 0; e < d->mesh->n_edges; e++) {
        if (s->tried[e] == 3 || !qc_distortion_can_flip(d, e)) continue;
        if (!s->rules.create && !touches_branch_point(d, e)) continue;
        const int32_t down = s->theta[e] > 0 ? 1 : -1; /* lowers |theta| */
        for (int k = 0; k < (s->rules.create ? 1 : 2); k++) {
            const qc__candidate c = {
                {e, k == 0 ? down : -down}, k == 0 ? s->share[e] : 0.5 * s->share[e], {0, 0}};
            if (s->tried[e] & qc__tried_mark(c.flip.step)) continue;
            if (n == POOL && qc__by_rank(&c, &pool[0]) >= 0) continue;
            if (qc__flip_allowed(d, &s->rules, c.flip)) insert(pool, &n, &c);
        }
    }
    return n;
}

static double weight(const qc__search *s) {
    return s->weight[0] / s->weight[1];
}

void qc__learn(qc__search *s, const qc__prediction *p, double change) {
    if (!(p->self > 0) || !isfinite(p->self) || !isfinite(change)) return;
    const double self = p->self / s->d->energy, rest = (change - p->first) / s->d->energy;
    for (int i = 0; i < 2; i++) s->weight[i] *= 0.99;
    s->weight[0] += rest * self;
    s->weight[1] += self * self;
}

static void predict_some(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const qc__search *s = arg;
    (void)worker;
    for (int64_t i = begin; i < end; i++) {
        qc__candidate *c = &s->pool[i];
        c->expected = qc__predict(s->d, s->v, s->slope, c->flip);
        c->rank = -(c->expected.first + weight(s) * c->expected.self);
        if (c->rank > 0 && qc__new_branch_points(s->d, c->flip) > 0) c->rank *= NEW_SHARE;
    }
}

qc_status qc__fill_pool(qc_ctx *ctx, qc__search *s, int32_t *n) {
    qc_status status = qc_distortion_shares(ctx, s->d, s->share, s->theta);
    if (status) return status;
    memcpy(s->v, s->d->curl, (size_t)s->d->n * sizeof *s->v);
    status = qc__prepare_slope(ctx, s->d, s->v, s->slope);
    if (status) return status;
    *n = collect(s);
    qc__parallel_for(ctx, *n, 32, predict_some, s);
    qsort(s->pool, (size_t)*n, sizeof *s->pool, qc__by_rank);
    return QC_OK;
}
