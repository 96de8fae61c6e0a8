/* Local search which moves rounded periods until no two neighbouring cones collide (see
 * separation.h). */
#include "sdk/map/round/separation.h"
#include <math.h>
#include <string.h>

typedef struct step { /* z_variable += sign */
    int32_t variable, sign;
} step;

typedef struct search {
    const qc__separation *s;
    int32_t n; /* variables */
    const double *P;
    double *z, *slope;             /* slope = P (z - t) */
    double _Complex *now, *wanted; /* forms of the pairs for z and for t */
    int64_t *pair_start;           /* pairs and coefficients by variable */
    int32_t *pair;
    double _Complex *coefficient;
    double energy;
    int32_t coincidence; /* weight of two cones on one lattice point: 1, then 2 */
    int32_t *state;      /* of the pairs: collides() for z */
    int32_t *change;     /* of the steps: collision_change(), or unknown */
    int32_t *kept_change;
    int64_t *near_start; /* variables with a common pair, by variable */
    int32_t *near;
} search;

enum {
    UNKNOWN = INT32_MIN,
    MANY = 40 /* pairs, more than two steps at a time could part in good time */
};

/* Steps by number: z_variable - 1, z_variable + 1. */
static int64_t step_number(step a) {
    return 2 * (int64_t)a.variable + (a.sign > 0);
}

/* Positive: on one lattice point (1, or 2 when that counts more), or past each other (1); 0: apart.
 */
static int32_t collides(const search *q, int32_t pair, double _Complex now) {
    const double _Complex w = q->wanted[pair];
    if (creal(now) * creal(now) + cimag(now) * cimag(now) < 0.25) return q->coincidence;
    return creal(now) * creal(w) + cimag(now) * cimag(w) < 0;
}

static double energy_change(const search *q, step a) {
    const int64_t i = a.variable;
    return 0.5 * q->P[i + i * q->n] + a.sign * q->slope[i];
}

/* Remembered until a step on a variable with a common pair. */
static int32_t collision_change(const search *q, step a) {
    int32_t *known = &q->change[step_number(a)];
    if (*known != UNKNOWN) return *known;
    int32_t change = 0;
    for (int64_t i = q->pair_start[a.variable]; i < q->pair_start[a.variable + 1]; i++) {
        const int32_t p = q->pair[i];
        change += collides(q, p, q->now[p] + a.sign * q->coefficient[i]) - q->state[p];
    }
    return *known = change;
}

static void apply(search *q, step a) {
    const int64_t i = a.variable, n = q->n;
    q->energy += energy_change(q, a);
    q->z[i] += a.sign;
    for (int64_t k = 0; k < n; k++) q->slope[k] += a.sign * q->P[k + i * n];
    for (int64_t k = q->pair_start[a.variable]; k < q->pair_start[a.variable + 1]; k++) {
        const int32_t p = q->pair[k];
        q->now[p] += a.sign * q->coefficient[k];
        q->state[p] = collides(q, p, q->now[p]);
    }
    for (int64_t k = q->near_start[i]; k < q->near_start[i + 1]; k++)
        q->change[2 * (int64_t)q->near[k]] = q->change[2 * (int64_t)q->near[k] + 1] = UNKNOWN;
}

/* A coincidence counts so much from now on. */
static void weigh(search *q, int32_t coincidence) {
    q->coincidence = coincidence;
    for (int32_t p = 0; p < q->s->n; p++) q->state[p] = collides(q, p, q->now[p]);
    for (int64_t i = 0; i < 2 * (int64_t)q->n; i++) q->change[i] = UNKNOWN;
}

static step opposite(step a) {
    return (step){a.variable, -a.sign};
}

/* Cheapest single step on a variable of the pair which lowers the number of collisions. */
static bool best_step(const search *q, int32_t pair, step *best) {
    double least = INFINITY;
    for (int64_t i = q->s->start[pair]; i < q->s->start[pair + 1]; i++)
        for (int32_t sign = -1; sign <= 1; sign += 2) {
            const step a = {q->s->variable[i], sign};
            const double change = energy_change(q, a);
            if (change < least && collision_change(q, a) < 0) {
                least = change;
                *best = a;
            }
        }
    return least < INFINITY;
}

/* Cheapest two steps: the first on a variable of the pair, the second on one of any pair that the
 * first leaves colliding. */
static bool best_two_steps(search *q, int32_t pair, step *first, step *second) {
    double least = INFINITY;
    const size_t size = sizeof *q->change * 2 * (size_t)q->n;
    for (int64_t i = q->s->start[pair]; i < q->s->start[pair + 1]; i++)
        for (int32_t sign = -1; sign <= 1; sign += 2) {
            const step a = {q->s->variable[i], sign};
            const double change = energy_change(q, a);
            if (change > least) continue;
            const int32_t collisions = collision_change(q, a);
            memcpy(q->kept_change, q->change, size);
            apply(q, a);
            for (int64_t k = q->pair_start[a.variable]; k < q->pair_start[a.variable + 1]; k++) {
                step b;
                if (!q->state[q->pair[k]]) continue;
                if (!best_step(q, q->pair[k], &b)) continue;
                if (collisions + collision_change(q, b) >= 0) continue;
                const double both = change + energy_change(q, b);
                if (both >= least) continue;
                least = both;
                *first = a;
                *second = b;
            }
            apply(q, opposite(a));
            memcpy(q->change, q->kept_change, size);
        }
    return least < INFINITY;
}

static int32_t count_collisions(const search *q) {
    int32_t n = 0;
    for (int32_t p = 0; p < q->s->n; p++) n += q->state[p] > 0;
    return n;
}

/* two: by two steps where one does not help. Every accepted change lowers the number of collisions,
 * so this ends. */
static qc_status remove_collisions(qc_ctx *ctx, search *q, bool two) {
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t p = 0; p < q->s->n; p++) {
            if (!qc__progress(ctx, 0.0)) return QC_ERR_CANCELLED;
            step a, b;
            if (!q->state[p]) continue;
            if (best_step(q, p, &a)) {
                apply(q, a);
                changed = true;
            } else if (two && best_two_steps(q, p, &a, &b)) {
                apply(q, a);
                apply(q, b);
                changed = true;
            }
        }
    }
    return QC_OK;
}

/* Then the energy falls again as far as single steps without new collisions let it. */
static qc_status descend(qc_ctx *ctx, search *q) {
    const double enough = 1e-9 * (q->energy > 0 ? q->energy : 1.0);
    for (bool changed = true; changed;) {
        changed = false;
        if (!qc__progress(ctx, 0.5)) return QC_ERR_CANCELLED;
        for (int32_t j = 0; j < q->n; j++)
            for (int32_t sign = -1; sign <= 1; sign += 2) {
                const step a = {j, sign};
                if (energy_change(q, a) >= -enough || collision_change(q, a) > 0) continue;
                apply(q, a);
                changed = true;
            }
    }
    return QC_OK;
}

static qc_status find_near(qc_ctx *ctx, search *q) {
    int32_t *seen = QC__ZERO(ctx, int32_t, q->n); /* by variable + 1 */
    int64_t capacity = 0, n = 0;
    q->near_start = QC__NEW(ctx, int64_t, q->n + 1);
    qc_status status = seen && q->near_start ? QC_OK : QC_ERR_NOMEM;
    for (int32_t j = 0; j < q->n && status == QC_OK; j++) {
        q->near_start[j] = n;
        if (!qc__reserve(ctx, (void **)&q->near, &capacity, n + q->n, sizeof *q->near)) {
            status = QC_ERR_NOMEM;
            break;
        }
        for (int64_t k = q->pair_start[j]; k < q->pair_start[j + 1]; k++)
            for (int64_t i = q->s->start[q->pair[k]]; i < q->s->start[q->pair[k] + 1]; i++) {
                const int32_t other = q->s->variable[i];
                if (seen[other] == j + 1) continue;
                seen[other] = j + 1;
                q->near[n++] = other;
            }
    }
    if (status == QC_OK) q->near_start[q->n] = n;
    qc__free(seen);
    return status;
}

static qc_status prepare(qc_ctx *ctx, search *q, const double *t) {
    const qc__separation *s = q->s;
    const int64_t n = q->n, terms = s->start[s->n];
    q->slope = QC__ZERO(ctx, double, n);
    q->now = QC__ZERO(ctx, double _Complex, s->n);
    q->wanted = QC__ZERO(ctx, double _Complex, s->n);
    q->pair_start = QC__ZERO(ctx, int64_t, q->n + 2);
    q->pair = QC__NEW(ctx, int32_t, terms);
    q->coefficient = QC__NEW(ctx, double _Complex, terms);
    q->state = QC__NEW(ctx, int32_t, s->n);
    q->change = QC__NEW(ctx, int32_t, 2 * n);
    q->kept_change = QC__NEW(ctx, int32_t, 2 * n);
    if (!q->slope || !q->now || !q->wanted || !q->pair_start || !q->pair || !q->coefficient ||
        !q->state || !q->change || !q->kept_change)
        return QC_ERR_NOMEM;
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) q->slope[i] += q->P[i + j * n] * (q->z[j] - t[j]);
    for (int32_t p = 0; p < s->n; p++)
        for (int64_t i = s->start[p]; i < s->start[p + 1]; i++) {
            const int64_t j = s->variable[i];
            q->now[p] += s->value[i] * q->z[j];
            q->wanted[p] += s->value[i] * t[j];
        }
    for (int64_t i = 0; i < terms; i++) q->pair_start[s->variable[i] + 2]++;
    for (int32_t j = 0; j < q->n; j++) q->pair_start[j + 2] += q->pair_start[j + 1];
    for (int32_t p = 0; p < s->n; p++)
        for (int64_t i = s->start[p]; i < s->start[p + 1]; i++) {
            const int64_t at = q->pair_start[s->variable[i] + 1]++;
            q->pair[at] = p;
            q->coefficient[at] = s->value[i];
        }
    weigh(q, 1);
    return QC_OK;
}

qc_status qc__separate(qc_ctx *ctx, const qc__separation *separation, int32_t n_free,
                       const double *P, const double *t, bool thorough, double *z, double *energy,
                       int32_t *left) {
    search q = {.s = separation, .n = n_free, .P = P, .z = z, .energy = *energy};
    qc_status status = prepare(ctx, &q, t);
    if (status == QC_OK && count_collisions(&q) > 0) {
        status = find_near(ctx, &q);
        if (status == QC_OK) status = remove_collisions(ctx, &q, false);
        const bool two = thorough && count_collisions(&q) <= MANY;
        if (status == QC_OK && two) status = remove_collisions(ctx, &q, true);
        weigh(&q, 2); /* what cannot be parted is better past each other than in one place */
        if (status == QC_OK) status = remove_collisions(ctx, &q, two);
        if (status == QC_OK) status = descend(ctx, &q);
    }
    if (status == QC_OK) {
        *energy = q.energy;
        *left = count_collisions(&q);
    }
    void *const blocks[] = {q.slope, q.now,    q.wanted,      q.pair_start, q.pair, q.coefficient,
                            q.state, q.change, q.kept_change, q.near_start, q.near};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}

int32_t qc__first_collision(const qc__separation *s, const double *t, const double *z) {
    for (int32_t p = 0; p < s->n; p++) {
        double _Complex now = 0, wanted = 0;
        for (int64_t i = s->start[p]; i < s->start[p + 1]; i++) {
            now += s->value[i] * z[s->variable[i]];
            wanted += s->value[i] * t[s->variable[i]];
        }
        if (collides(&(search){.wanted = &wanted, .coincidence = 1}, 0, now)) return p;
    }
    return -1;
}
