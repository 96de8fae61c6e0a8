/* Local search in the lattice (thesis 6.3.1): change up to three entries of z by +-1 as long as the
 * energy falls. With g = P (z - t), a step s changes the energy by s.g + 1/2 s^T P s; with
 *     a_i(s) = P_ii / 2 + s g_i,   c_ij = s_i s_j P_ij
 * a pair changes it by a_i + a_j + c_ij and a triple by the three a and the three c. The best sign
 * of one more entry k is known: its part is P_kk / 2 - |g_k + s_i P_ik + s_j P_jk|. Pruning: a
 * triple can only gain if the sum of its -c exceeds the sum of its a, which is the sum over its
 * three pairs of (a_i + a_j) / 2. Hence one pair has -c_ij > (a_i + a_j) / 2, and only such pairs
 * are extended; nothing is missed. */
#include "sdk/sparse/lattice/internal.h"
#include <math.h>

/* A move counts when it gains more than this part of the energy and of the P_ii involved. */
static const double least_gain = 1e-10;

typedef struct search {
    qc__lattice *Q;
    double *half; /* P_ii / 2, raised by the gain which is asked of entry i */
    double *u;    /* g_k + s_i P_ik */
    double gain;  /* least gain from the energy */
} search;

static void move(search *W, int64_t i, double sign) {
    const int64_t n = W->Q->n;
    const double *column = W->Q->P + i * n;
    W->Q->z[i] += sign;
    for (int64_t k = 0; k < n; k++) W->Q->g[k] += sign * column[k];
}

static double against(double slope) {
    return slope > 0 ? -1.0 : 1.0;
}

static bool improve_one(search *W) {
    const qc__lattice *Q = W->Q;
    int64_t best = -1;
    double best_change = -W->gain;
    for (int64_t i = 0; i < Q->n; i++) {
        const double change = W->half[i] - fabs(Q->g[i]);
        if (change < best_change - qc__lattice_tie * W->half[i]) {
            best_change = change;
            best = i;
        }
    }
    W->Q->evaluations += 2 * (int64_t)Q->n;
    if (best < 0) return false;
    move(W, best, against(Q->g[best]));
    return true;
}

/* Best partner of i. */
static bool improve_two(search *W, int64_t i) {
    const qc__lattice *Q = W->Q;
    const double *p = Q->P + i * (int64_t)Q->n;
    double best_change = -W->gain, best_sign = 0;
    int64_t best = -1;
    for (double sign = -1; sign <= 1; sign += 2) {
        const double a = W->half[i] + sign * Q->g[i];
        for (int64_t j = 0; j < Q->n; j++) {
            const double change = a + (W->half[j] - fabs(Q->g[j] + sign * p[j]));
            if (change < best_change - qc__lattice_tie * W->half[j] && j != i) {
                best_change = change;
                best_sign = sign;
                best = j;
            }
        }
    }
    W->Q->evaluations += 4 * (int64_t)Q->n;
    if (best < 0) return false;
    move(W, i, best_sign);
    move(W, best, against(Q->g[best]));
    return true;
}

/* Any k with half_k - |u_k + t p_k| < limit? The count has no dependence between iterations. */
static bool any_third(int64_t n, const double *half, const double *u, double t, const double *p,
                      double limit) {
    int64_t hits = 0;
    for (int64_t k = 0; k < n; k++) hits += half[k] - fabs(u[k] + t * p[k]) < limit;
    return hits > 0;
}

/* The pair i, j with these signs, which changes the energy by e, and the best third entry. */
static bool improve_third(search *W, int64_t i, double si, int64_t j, double sj, double e) {
    const qc__lattice *Q = W->Q;
    const double *p = Q->P + j * (int64_t)Q->n, limit = -W->gain - e, hidden = W->half[j];
    double best_value = limit;
    int64_t best = -1;
    W->half[j] = INFINITY;
    if (any_third(Q->n, W->half, W->u, sj, p, limit))
        for (int64_t k = 0; k < Q->n; k++) {
            const double value = W->half[k] - fabs(W->u[k] + sj * p[k]);
            if (value < best_value - (best < 0 ? 0 : qc__lattice_tie * W->half[k])) {
                best_value = value;
                best = k;
            }
        }
    W->half[j] = hidden;
    W->Q->evaluations += 2 * (int64_t)Q->n;
    if (best < 0) return false;
    move(W, i, si);
    move(W, j, sj);
    move(W, best, against(Q->g[best]));
    return true;
}

/* Triples which extend a strongly coupled pair i < j. */
static bool improve_three(search *W, int64_t i) {
    const qc__lattice *Q = W->Q;
    const double *p = Q->P + i * (int64_t)Q->n, hidden = W->half[i];
    bool found = false;
    W->half[i] = INFINITY; /* neither j nor k */
    for (double si = -1; si <= 1 && !found; si += 2) {
        const double ai = hidden + si * Q->g[i];
        for (int64_t k = 0; k < Q->n; k++) W->u[k] = Q->g[k] + si * p[k];
        for (int64_t j = i + 1; j < Q->n && !found; j++) {
            const double sj = against(si * p[j]), coupling = -fabs(p[j]);
            const double aj = W->half[j] + sj * Q->g[j];
            if (-coupling > 0.5 * (ai + aj))
                found = improve_third(W, i, si, j, sj, ai + aj + coupling);
        }
    }
    W->half[i] = hidden;
    return found;
}

/* From the entry *start on, cyclically, until a move is found (then *start is its place). */
static qc_status scan(qc_ctx *ctx, search *W, bool improve(search *, int64_t), int64_t *start,
                      bool *found) {
    const int64_t n = W->Q->n;
    *found = false;
    for (int64_t q = 0; q < n && !*found; q++) {
        const int64_t i = (*start + q) % n;
        *found = improve(W, i);
        if (*found) *start = i;
        if (!qc__progress(ctx, (double)q / (double)n)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* Until no step of up to `radius` entries gains; smaller steps are exhausted first. */
static qc_status descend(qc_ctx *ctx, search *W, int32_t radius, bool *moved) {
    int64_t start[2] = {0, 0};
    bool found = true;
    *moved = false;
    while (found) {
        qc_status status = QC_OK;
        found = improve_one(W);
        if (!found && radius >= 2) status = scan(ctx, W, improve_two, &start[0], &found);
        if (status == QC_OK && !found && radius >= 3)
            status = scan(ctx, W, improve_three, &start[1], &found);
        if (status != QC_OK) return status;
        if (found) {
            W->Q->moves++;
            *moved = true;
        }
    }
    return QC_OK;
}

qc_status qc__lattice_search(qc_ctx *ctx, qc__lattice *Q, int32_t radius) {
    const int64_t n = Q->n;
    if (radius == 0) return QC_OK;
    double *work = QC__NEW(ctx, double, 2 * n);
    if (!work) return QC_ERR_NOMEM;
    search W = {Q, work, work + n, 0};
    for (int64_t i = 0; i < n; i++) W.half[i] = (0.5 + least_gain) * Q->P[i + i * n];
    qc_status status = QC_OK;
    /* the optimum counts when a freshly computed gradient confirms it */
    for (bool moved = true; moved && status == QC_OK;) {
        W.gain = least_gain * qc__lattice_gradient(Q);
        status = descend(ctx, &W, radius, &moved);
    }
    qc__free(work);
    return status;
}
