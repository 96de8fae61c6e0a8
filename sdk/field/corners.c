/* Corners of hard features by their direction over a length L instead of from edge to edge. Along
 * the border of a region between features, which passes one sector after the other, the geodesic
 * turn at a sector of angle a is t = pi - a; seen over the length L it is
 *     T(s) = sum of t_j max(0, 1 - |s_j - s| / L),   s: arc length.
 * Where |T| exceeds pi / 4, a quarter turn is put into the sector with the largest |T|, and as much
 * turning is taken from the sectors about it, the nearest first: zigzags cancel, a round corner
 * becomes one, and a circle has four at most. */
#include "sector.h"

#include <stdlib.h>

enum { SWEEPS = 3 };

typedef struct border { /* sectors in order, with the region on the left */
    int32_t n;
    bool closed;
    int32_t *sector;
    double *s, *turn; /* arc length, t less what became corners */
    double total;     /* length */
    double reach;     /* L */
} border;

/* The sector which follows on the border: the first edge of this one leads to its vertex. */
static int32_t *link_sectors(qc_ctx *ctx, const qc_mesh *mesh, const qc__sectors *all) {
    int32_t *by_last = QC__NEW(ctx, int32_t, 3 * (size_t)mesh->n_faces);
    int32_t *next = QC__NEW(ctx, int32_t, all->n);
    if (!by_last || !next) {
        qc__free(by_last);
        qc__free(next);
        return NULL;
    }
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) by_last[c] = -1;
    for (int32_t i = 0; i < all->n; i++) {
        int32_t c = all->sector[i].first;
        for (int32_t j = 1; j < all->sector[i].n; j++) c = qc_corner_ccw(mesh, c);
        by_last[c] = i;
    }
    for (int32_t i = 0; i < all->n; i++) next[i] = by_last[qc_next(all->sector[i].first)];
    qc__free(by_last);
    return next;
}

/* Arc length from position i to j of the border, the shorter way round. */
static double distance(const border *b, int32_t i, int32_t j) {
    const double d = fabs(b->s[i] - b->s[j]);
    return b->closed ? fmin(d, b->total - d) : d;
}

/* The neighbour of j in direction `way`, -1 beyond the end. */
static int32_t step(const border *b, int32_t j, int32_t way) {
    const int32_t k = j + way;
    if (k >= 0 && k < b->n) return k;
    return b->closed ? (k < 0 ? b->n - 1 : 0) : -1;
}

/* Positions within the reach of i, nearest first; their number. */
static int32_t window(const border *b, int32_t i, int32_t *out) {
    const double reach = b->closed ? fmin(b->reach, b->total / 2) : b->reach;
    int32_t n = 0, at[2] = {step(b, i, -1), step(b, i, 1)};
    out[n++] = i;
    while (n < b->n) {
        const double d[2] = {at[0] < 0 ? INFINITY : distance(b, i, at[0]),
                             at[1] < 0 ? INFINITY : distance(b, i, at[1])};
        const int32_t side = d[1] < d[0] ? 1 : 0;
        if (!(d[side] < reach)) break;
        out[n++] = at[side];
        at[side] = step(b, at[side], side ? 1 : -1);
    }
    return n;
}

static double seen_turn(const border *b, int32_t i, const int32_t *near, int32_t n) {
    double sum = 0;
    for (int32_t k = 0; k < n; k++)
        sum += b->turn[near[k]] * (1 - distance(b, i, near[k]) / b->reach);
    return sum;
}

/* Whether no other place within the window turns much more. */
static bool stands_out(const border *b, int32_t i, double sign, const int32_t *near, int32_t n) {
    double most = 0;
    for (int32_t k = 0; k < n; k++) most = fmax(most, sign * b->turn[near[k]]);
    return sign * b->turn[i] > 0 && sign * b->turn[i] >= 0.5 * most;
}

static void take_quarter(border *b, double sign, const int32_t *near, int32_t n) {
    double taken = 0;
    for (int32_t k = 0; k < n; k++) {
        taken += sign * b->turn[near[k]];
        b->turn[near[k]] = 0;
        if (taken < QC__PI / 2) continue;
        b->turn[near[k]] = sign * (taken - QC__PI / 2);
        return;
    }
}

/* Corners at position i as long as the turn seen there asks for them; whether there were any. */
static bool turn_at(border *b, qc__sector *sector, int32_t i, int32_t *near) {
    qc__sector *s = &sector[b->sector[i]];
    const int32_t n = window(b, i, near);
    bool any = false;
    for (;;) {
        const double turn = seen_turn(b, i, near, n), sign = turn < 0 ? -1 : 1;
        if (!(fabs(turn) > QC__PI / 4) || !stands_out(b, i, sign, near, n)) return any;
        if (sign > 0 && s->wanted == 1) return any;
        s->wanted -= (int32_t)sign;
        take_quarter(b, sign, near, n);
        any = true;
    }
}

typedef struct ranked {
    double turn;
    int32_t at;
} ranked;

static int compare(const void *p, const void *q) {
    const ranked *a = p, *b = q;
    if (a->turn != b->turn) return a->turn > b->turn ? -1 : 1;
    return a->at < b->at ? -1 : a->at > b->at;
}

/* The sectors with the largest turn first. near: n, order: n. */
static void turn_border(border *b, qc__sector *sector, int32_t *near, ranked *order) {
    bool any = true;
    for (int sweep = 0; sweep < SWEEPS && any; sweep++) {
        any = false;
        for (int32_t i = 0; i < b->n; i++) {
            const int32_t n = window(b, i, near);
            order[i] = (ranked){fabs(seen_turn(b, i, near, n)), i};
        }
        qsort(order, (size_t)b->n, sizeof *order, compare);
        for (int32_t i = 0; i < b->n && order[i].turn > QC__PI / 4; i++)
            any = turn_at(b, sector, order[i].at, near) || any;
    }
}

/* The border from sector i on. */
static void walk(const qc_complex *edge, const qc__sectors *all, const int32_t *next, uint8_t *seen,
                 int32_t i, border *b) {
    const int32_t start = i;
    b->n = 0;
    b->total = 0;
    for (; i >= 0 && !seen[i]; i = next[i]) {
        const qc__sector *s = &all->sector[i];
        seen[i] = 1;
        b->sector[b->n] = i;
        b->s[b->n] = b->total;
        b->turn[b->n++] = QC__PI - s->angle;
        b->total += cabs(qc__c(edge[qc_prev(s->first)]));
    }
    b->closed = i == start;
}

qc_status qc__sectors_find_corners(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                                   double bend, qc__sectors *all) {
    const int32_t n = all->n;
    int32_t *next = link_sectors(ctx, mesh, all), *near = QC__NEW(ctx, int32_t, n);
    uint8_t *seen = QC__ZERO(ctx, uint8_t, n), *later = QC__ZERO(ctx, uint8_t, n);
    ranked *order = QC__NEW(ctx, ranked, n);
    border b = {.reach = bend};
    b.sector = QC__NEW(ctx, int32_t, n);
    b.s = QC__NEW(ctx, double, n);
    b.turn = QC__NEW(ctx, double, n);
    const bool there = next && near && seen && later && order && b.sector && b.s && b.turn;
    for (int32_t i = 0; there && i < n; i++) {
        all->sector[i].wanted = 2;
        if (next[i] >= 0) later[next[i]] = 1;
    }
    for (int open = 1; there && open >= 0; open--)
        for (int32_t i = 0; i < n; i++) {
            if (seen[i] || (open && later[i])) continue;
            walk(edge, all, next, seen, i, &b);
            turn_border(&b, all->sector, near, order);
        }
    void *blocks[] = {next, near, seen, later, order, b.sector, b.s, b.turn};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return there ? QC_OK : QC_ERR_NOMEM;
}
